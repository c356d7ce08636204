#include "runner/run/recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "engine/core/hash.h"
#include "engine/image/exr_io.h"
#include "engine/image/png_io.h"
#include "runner/run/file_stem.h"
#include "runner/run/image_attributes.h"

namespace gfxrepro::run {

namespace fs = std::filesystem;

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
    fs::create_directories(runDir / folder);
}

}  // namespace

void RunRecorder::metric(std::string_view metric, double value, std::string_view unit,
                         std::string_view pass) {
    requireDeclared(metric, unit, pass);
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
        {frame_, repeat_, std::string(pass), std::string(metric), std::string(unit), value, false});
}

void RunRecorder::requireDeclared(std::string_view metric, std::string_view unit,
                                  std::string_view pass) const {
    const std::string owner = "technique '" + item_.technique + "'";
    outputs_.requireMetric(metric, owner);
    if (!pass.empty()) outputs_.requirePass(pass, owner);
    const config::MetricInfo& info = *outputs_.find(metric);
    if (info.name != metric || info.unit == unit) return;  // what a share is of has any unit
    throw Error(fmt::format("metric '{}' is recorded in '{}', but declared in '{}'", metric, unit,
                            info.unit));
}

void RunRecorder::image(std::string_view name, const image::ImageF& image,
                        const technique::ImageOptions& options) {
    static const std::vector<std::string> kChannels[] = {
        {}, {"Y"}, {}, {"R", "G", "B"}, {"R", "G", "B", "A"}};
    const int channels = image.channels();
    if (channels != 1 && channels != 3 && channels != 4) {
        throw Error("image '" + std::string(name) + "' has " + std::to_string(channels) +
                    " channels; 1, 3 or 4 are allowed");
    }
    checkFileName(name);
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
    image::writePng(runDir_ / (stem + ".png"), image::toSrgb8(image));
    result_.images.push_back({item_.id, item_.experiment, frame_, std::string(name), stem + ".png",
                              stem + ".exr", item_.title(), options.truthOf});
}

void RunRecorder::checkTruths() const {
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
}

fs::path RunRecorder::artifact(std::string_view fileName) {
    checkFileName(fileName);
    makeBelow(runDir_, "artifacts/" + item_.slug());
    return runDir_ / ("artifacts/" + fileStem(item_) + shortName(fileName));
}

}  // namespace gfxrepro::run
