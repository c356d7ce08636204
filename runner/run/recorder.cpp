#include "runner/run/recorder.h"

#include <fmt/format.h>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <glm/gtc/type_ptr.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/core/hash.h"
#include "engine/core/output_files.h"
#include "engine/image/exr_io.h"
#include "engine/image/png_io.h"
#include "engine/image/resample.h"
#include "engine/image/srgb.h"
#include "engine/metrics/flip.h"
#include "engine/metrics/image_error.h"
#include "engine/metrics/statistics.h"
#include "runner/run/manifest.h"

namespace gfxrepro::run {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kLongestSettings = 96;  // a file's name has at most 255 bytes

std::string plain(std::string text) {
    for (char& c : text) {
        const auto byte = static_cast<unsigned char>(c);
        const bool isPlain =
            std::isalnum(byte) != 0 || std::string_view("._-").find(c) != std::string_view::npos;
        if (!isPlain) c = '_';
    }
    return text;
}

}  // namespace

std::string fileStem(const Case& item) {
    std::string settings;
    if (item.axes.isMap()) {
        for (const auto& [axis, value] : item.axes.entries()) {
            const std::string text = value.isScalar() ? value.text() : value.toFlowText();
            const std::string own = std::filesystem::path(text).filename().string();
            if (!settings.empty()) settings += ',';
            settings += plain(axis);
            settings += '=';
            settings += plain(own);
        }
    }
    if (settings.size() > kLongestSettings) settings.resize(kLongestSettings);
    if (!settings.empty()) settings += '-';
    return item.slug() + '/' + settings + item.id + '-';
}

namespace {

Json numbers(const glm::vec3& v) {
    return {v.x, v.y, v.z};
}

std::array<float, 16> rowsOf(const glm::mat4& matrix) {
    std::array<float, 16> values;
    std::copy_n(glm::value_ptr(matrix), values.size(), values.begin());
    return values;
}

void describeCamera(image::ExrImage& exr, const technique::ImageCamera& camera) {
    const glm::mat4 worldFromView = glm::inverse(camera.viewFromWorld);
    Json text = {{"eye", numbers(worldFromView[3])},
                 {"forward", numbers(-worldFromView[2])},
                 {"up", numbers(worldFromView[1])}};
    const bool isPerspective = camera.clipFromView[2].w != 0.0F;
    if (isPerspective) {
        text["vertical_fov_deg"] =
            glm::degrees(2.0 * std::atan(1.0 / double{camera.clipFromView[1].y}));
    }
    text["near_m"] = camera.nearM;
    text["far_m"] = camera.farM;
    exr.attributes["camera"] = text.dump();

    glm::mat4 leftHanded(1.0F);
    leftHanded[2].z = -1.0F;
    glm::mat4 ndcFromClip(1.0F);  // y downwards
    ndcFromClip[0].x = 0.5F;
    ndcFromClip[1].y = -0.5F;
    ndcFromClip[3] = {0.5F, 0.5F, 0.0F, 1.0F};
    exr.matrices["worldToCamera"] = rowsOf(leftHanded * camera.viewFromWorld);
    exr.matrices["worldToNDC"] = rowsOf(ndcFromClip * camera.clipFromView * camera.viewFromWorld);
}

}  // namespace

void describeImage(image::ExrImage& exr, const Case& item, int frame, const std::string& command,
                   const technique::ImageOptions& options) {
    exr.attributes["case"] = item.id;
    exr.attributes["table"] = item.experiment;
    exr.attributes["title"] = item.title();
    exr.attributes["technique"] = item.technique;
    if (const std::string method = item.method(); !method.empty()) {
        exr.attributes["method"] = method;
    }
    Json params = item.recordedParams().toJson();
    if (!item.scene.isNull()) params["scene"] = item.scene.toJson();
    exr.attributes["params"] = params.dump();
    exr.attributes["frame"] = std::to_string(frame);
    exr.attributes["command"] = command;
    exr.attributes["commit"] = programCommit();
    if (options.camera) describeCamera(exr, *options.camera);
}

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

void checkFileName(std::string_view name) {
    const bool isPlain =
        !name.empty() && name.front() != '.' && std::all_of(name.begin(), name.end(), [](char c) {
            return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                   c == '_' || c == '-' || c == '.';
        });
    if (!isPlain) {
        throw Error("'" + std::string(name) + "' is no file name: letters, digits, '_', '-', '.'");
    }
}

/// `name`, or the beginning and the end of a longer one with digits of its hash between: with the
/// case's id and further suffixes no file system takes more.
std::string shortName(std::string_view name) {
    constexpr std::size_t kLongest = 100, kBegin = 60, kEnd = 20;
    if (name.size() <= kLongest) return std::string(name);
    return std::string(name.substr(0, kBegin)) + '-' + sha256(name).substr(0, 12) + '-' +
           std::string(name.substr(name.size() - kEnd));
}

/// Makes a folder below the run's, which is not made again where it was moved or removed.
void makeBelow(const fs::path& runDir, const fs::path& folder) {
    if (!fs::is_directory(runDir)) {
        throw Error(runDir.string() + ": was removed or moved while a case wrote to it");
    }
    makeFolder(runDir / folder);
}

/// By the names of config::pictureErrors(); `seen` is the picture in linear light.
std::vector<std::pair<const char*, double>> errorsOf(const image::ImageF& test,
                                                     const image::ImageF& truth,
                                                     const image::ImageF& seen,
                                                     const image::ImageF& seenTruth) {
    constexpr int kLeastSsimPx = 11;  // structural similarity has no value for smaller pictures
    const double mse = metrics::meanSquaredError(truth, test);
    std::vector<std::pair<const char*, double>> errors = {
        {"mse", mse},
        {"rmse", std::sqrt(mse)},
        {"rel_mse", metrics::relativeMeanSquaredError(truth, test)},
        {"psnr_db", metrics::peakSignalToNoiseDb(truth, test)}};
    if (test.width() >= kLeastSsimPx && test.height() >= kLeastSsimPx) {
        errors.emplace_back("ssim", metrics::structuralSimilarity(truth, test));
    }
    const image::ImageF colours = image::rgbOf(seen), known = image::rgbOf(seenTruth);
    const bool isHdr = metrics::exceedsDisplay(colours) || metrics::exceedsDisplay(known);
    errors.emplace_back("flip",
                        isHdr ? metrics::hdrFlip(known, colours) : metrics::flip(known, colours));
    const std::vector<double> largest = metrics::largestDifferences(truth, test);
    errors.emplace_back("error_p95", metrics::summarize(largest, metrics::Statistic::P95));
    errors.emplace_back("error_p99", metrics::summarize(largest, metrics::Statistic::P99));
    return errors;
}

}  // namespace

void RunRecorder::metric(std::string_view metric, double value, std::string_view pass,
                         std::optional<std::string_view> givenUnit) {
    std::string unit = declaredUnit(metric, pass, givenUnit);
    const bool isPerfect = value == kInfinity && unit == "dB";
    if (!std::isfinite(value) && !isPerfect) {
        throw Error(
            fmt::format("metric '{}' is {}; a metric is a finite number, or ∞ dB", metric, value));
    }
    if (!given_.insert({frame_, repeat_, std::string(pass), std::string(metric)}).second) {
        const std::string where = frame_ == records::kSetup
                                      ? "the whole case"
                                      : fmt::format("frame {}, repeat {}", frame_, repeat_);
        throw Error(fmt::format("metric '{}'{} is given twice for {}", metric,
                                pass.empty() ? "" : fmt::format(" of pass '{}'", pass), where));
    }
    result_.samples.push_back(
        {frame_, repeat_, std::string(pass), std::string(metric), std::move(unit), value, false});
}

std::string RunRecorder::declaredUnit(std::string_view metric, std::string_view pass,
                                      std::optional<std::string_view> unit) const {
    const std::string owner = "technique '" + item_.technique + "'";
    outputs_.requireMetric(metric, owner);
    if (!pass.empty()) outputs_.requirePass(pass, owner);
    const config::MetricInfo& info = *outputs_.find(metric);
    if (info.of == config::MetricInfo::Of::Pass && pass.empty()) {
        throw Error(
            fmt::format("metric '{}' is declared of passes alone, and given of none", metric));
    }
    if (info.name != metric) return std::string(unit.value_or(""));  // what a share is of
    if (!unit || *unit == info.unit) return info.unit;
    throw Error(fmt::format("metric '{}' is recorded in '{}', but declared in '{}'", metric, *unit,
                            info.unit));
}

void RunRecorder::image(std::string_view name, const image::ImageF& image,
                        const technique::ImageOptions& options) {
    static const std::vector<std::string> kChannels[] = {
        {}, {"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};
    const int channels = image.channels();
    if (channels > 4) {
        throw Error("image '" + std::string(name) + "' has " + std::to_string(channels) +
                    " channels; 1 to 4 are allowed");
    }
    checkFileName(name);
    keepCompared(name, image, options);
    makeBelow(runDir_, "images/" + item_.slug());
    std::string stem = "images/" + fileStem(item_) + shortName(name);
    if (item_.measure.frames > 1) {
        char frame[16];
        std::snprintf(frame, sizeof(frame), "-f%04d", frame_);
        stem += frame;
    }
    image::ExrImage exr = options.layers;
    exr.add(image, kChannels[channels]);
    describeImage(exr, item_, frame_, command_, options);
    image::writeExr(runDir_ / (stem + ".exr"), exr);
    image::writePng(runDir_ / (stem + ".png"), image::toSrgb8(image::withStraightAlpha(image)));
    result_.images.push_back({item_.id, item_.experiment, frame_, std::string(name), stem + ".png",
                              stem + ".exr", item_.title(), options.truthOf,
                              sha256OfFile(runDir_ / (stem + ".png")),
                              sha256OfFile(runDir_ / (stem + ".exr"))});
}

void RunRecorder::keepCompared(std::string_view name, const image::ImageF& image,
                               const technique::ImageOptions& options) {
    const auto isDeclared = [&](std::string_view picture) {
        return std::ranges::find(outputs_.withTruth, picture) != outputs_.withTruth.end();
    };
    const std::optional<image::ImageF> stored =
        options.stored ? std::optional(*options.stored) : std::nullopt;
    if (isDeclared(name)) {
        Compared& own = compared_[std::string(name)];
        own.picture = image;
        own.pictureStored = stored;
    }
    if (options.truthOf.empty()) return;
    if (!isDeclared(options.truthOf)) {
        throw Error(
            fmt::format("image '{}' is the truth of '{}', of which technique '{}' does not "
                        "declare that it has one",
                        name, options.truthOf, item_.technique));
    }
    Compared& own = compared_[options.truthOf];
    if (own.truth) return;
    own.truth = image;
    own.truthStored = stored;
}

void RunRecorder::compareWithTruths() {
    for (const records::ImageEntry& truth : result_.images) {
        if (truth.frame != frame_ || truth.truthOf.empty()) continue;
        const bool isThere = std::any_of(
            result_.images.begin(), result_.images.end(), [&](const records::ImageEntry& other) {
                return other.frame == frame_ && other.name == truth.truthOf;
            });
        if (!isThere) {
            throw Error("image '" + truth.name + "' is the truth of '" + truth.truthOf +
                        "', which is not among the frame's images");
        }
    }
    for (const auto& [name, own] : compared_) {
        if (!own.picture || !own.truth) continue;
        const image::ImageF& test = own.pictureStored ? *own.pictureStored : *own.picture;
        const image::ImageF& reference = own.truthStored ? *own.truthStored : *own.truth;
        try {
            metrics::requireComparable(reference, test);
        } catch (const Error& error) {
            throw Error(fmt::format("image '{}' and its truth: {}", name, error.what()));
        }
        for (const auto& [metric, value] : errorsOf(test, reference, *own.picture, *own.truth)) {
            this->metric(metric, value, name);
        }
    }
    compared_.clear();
}

}  // namespace gfxrepro::run
