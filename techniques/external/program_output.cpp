#include "techniques/external/program_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/files.h"
#include "engine/core/json_shape.h"
#include "engine/core/text.h"
#include "engine/image/colour_map.h"
#include "engine/image/image_file.h"
#include "engine/image/srgb.h"
#include "engine/metrics/mean_test.h"

namespace gfxrepro::external {
namespace {

constexpr std::uintmax_t kMostBytes = std::uintmax_t{64} << 20;
constexpr std::size_t kLongestLine = 65536;
constexpr std::size_t kLongestShown = 80;

std::string textOf(const Json& line, const char* key, bool isRequired, const std::string& what) {
    const auto found = line.find(key);
    if (found == line.end() && !isRequired) return "";
    if (found != line.end() && found->is_string()) return found->get<std::string>();
    throw Error(fmt::format("{}: {}; allowed: text", what,
                            found == line.end() ? fmt::format("no \"{}\"", key)
                                                : fmt::format("\"{}\" is {}", key, found->dump())));
}

/// One of `count` from `first` on.
int frameOf(const Json& line, int first, int count, const std::string& what) {
    const auto given = line.find("frame");
    if (given == line.end() || given->is_null()) {
        if (count == 1) return first;
        throw Error(fmt::format("{}: no \"frame\"; allowed: 0 … {}", what, first + count - 1));
    }
    const double frame = given->is_number() ? given->get<double>() : -1.0;
    if (frame >= first && frame < first + count && frame == std::floor(frame)) {
        return static_cast<int>(frame);
    }
    throw Error(fmt::format("{}: \"frame\" is {}; {}", what, given->dump(),
                            count == 1 ? fmt::format("it was asked for frame {}", first)
                                       : fmt::format("allowed: 0 … {}", first + count - 1)));
}

GivenMetric metricOf(std::string_view text, int number, int frame, int count) {
    const std::string what = fmt::format("line {} of its metrics", number);
    // An object of many keys takes time with the square of them.
    if (text.size() > kLongestLine && !isTooDeepJson(text)) {
        throw Error(
            fmt::format("{} has {} bytes; allowed: up to {}", what, text.size(), kLongestLine));
    }
    const Json line = [&] {
        try {
            return parseJsonObject(text, {});
        } catch (const Error& error) {
            const bool isNan = text.find("NaN") != text.npos || text.find("Infinity") != text.npos;
            throw Error(fmt::format("{} {}{}: {}", what, error.what(),
                                    isNan ? ", which has no NaN and no Infinity" : "",
                                    shown(text)));
        }
    }();
    static constexpr std::string_view kKeys[] = {"metric", "pass", "frame", "value", "unit"};
    for (const auto& [key, value] : line.items()) {
        if (std::ranges::find(kKeys, key) != std::end(kKeys)) continue;
        throw Error(fmt::format("{}: unknown key \"{}\"; allowed: metric, pass, frame, value, unit",
                                what, key));
    }
    GivenMetric given{textOf(line, "metric", true, what), textOf(line, "unit", true, what),
                      textOf(line, "pass", false, what)};
    const auto value = line.find("value");
    if (value == line.end() || !value->is_number()) {
        throw Error(fmt::format(
            "{}: {}; allowed: a number", what,
            value == line.end() ? "no \"value\"" : fmt::format("\"value\" is {}", value->dump())));
    }
    given.value = value->get<double>();
    given.frame = frameOf(line, frame, count, what);
    return given;
}

}  // namespace

std::string shown(std::string_view line) {
    return line.size() <= kLongestShown ? std::string(line)
                                        : std::string(line.substr(0, kLongestShown)) + "…";
}

std::string withoutColours(std::string_view text) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (!text.substr(i).starts_with("\x1b[")) {
            const bool isCharset = text.substr(i).starts_with("\x1b(");
            if (isCharset) i += 2;  // as of `tput sgr0`
            if (!isCharset && text[i] != '\x0f') result += text[i];
            continue;
        }
        // The digits beside a colour are of one number, those beside a step of the cursor are not.
        i = std::min(text.find_first_not_of("0123456789;:?<=>", i + 2), text.size());
        if (i == text.size() || text[i] != 'm') result += ' ';
    }
    return result;
}

std::vector<GivenMetric> metricsIn(const std::filesystem::path& file, int frame, int count) {
    std::error_code isAbsent;
    if (!std::filesystem::is_regular_file(std::filesystem::symlink_status(file, isAbsent))) {
        throw Error(fmt::format("its file of metrics, {}, {}", file.filename().string(),
                                std::filesystem::exists(file, isAbsent)
                                    ? "is no plain file any more; it is there to be added to"
                                    : "is gone; it is there to be added to"));
    }
    if (std::filesystem::file_size(file) > kMostBytes) {
        throw Error(fmt::format("its metrics have more than {} MiB", kMostBytes >> 20));
    }
    std::vector<GivenMetric> metrics;
    int number = 0;
    for (const std::string& line : split(readFile(file), '\n')) {
        ++number;
        if (!trimmed(line).empty()) metrics.push_back(metricOf(line, number, frame, count));
    }
    return metrics;
}

namespace {

namespace fs = std::filesystem;
using image::ImageF;

void requireFinite(const ImageF& image, const std::string& what) {
    const auto values = image.values();
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (std::isfinite(values[i])) continue;
        const std::size_t pixel = i / static_cast<std::size_t>(image.channels());
        const auto width = static_cast<std::size_t>(image.width());
        throw Error(fmt::format("{}: holds {} at pixel ({}, {})", what, values[i], pixel % width,
                                pixel / width));
    }
}

}  // namespace

Picture readPicture(const fs::path& file, const std::string& what, glm::ivec2 sizePx) {
    std::error_code isAbsent;
    const fs::file_status status = fs::status(file, isAbsent);
    if (!fs::is_regular_file(status)) {
        const std::string name = file.filename().string();
        if (!fs::exists(status)) throw Error(fmt::format("{}: there is no file {}", what, name));
        throw Error(fmt::format("{}: {} is {}, no file", what, name,
                                fs::is_directory(status) ? "a folder"
                                : fs::is_fifo(status)    ? "a pipe"
                                                         : "a device or socket"));
    }
    Picture picture;
    try {
        picture = image::readPicture(file);
    } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", what, error.what()));
    }
    requireFinite(picture.stored, what);
    const glm::ivec2 found{picture.width, picture.height};
    if (sizePx.x > 0 && found != sizePx) {
        throw Error(fmt::format("{}: has {} × {} pixels; {} × {} were asked for", what, found.x,
                                found.y, sizePx.x, sizePx.y));
    }
    return picture;
}

config::Outputs errorOutputs() {
    using config::Better;
    constexpr bool kIsDetail = true;
    const auto errors = config::pictureErrors();
    config::Outputs outputs{{errors.begin(), errors.end()}};
    outputs.metrics.push_back({std::string(metrics::kSameMeanP), "1",
                               "chance that frames and truths of one expectation differ as these "
                               "do: a claim same_mean judges it",
                               Better::Neither, !kIsDetail, config::MetricInfo::Of::Pass});
    outputs.metrics.push_back({std::string(metrics::kBiasSeen), "1",
                               fmt::format("of a tile, as a share of the mean value: what {} shows "
                                           "more often than not at 1 % of false alarms",
                                           metrics::kSameMeanP),
                               Better::Lower, !kIsDetail, config::MetricInfo::Of::Pass});
    return outputs;
}

void requireOneKind(const Picture& picture, const Picture& truth, const std::string& name) {
    if (picture.isLinear == truth.isLinear) return;
    throw Error(fmt::format(
        "image '{}': one of it and its truth is linear, as EXR files are, the other sRGB, "
        "as PNG files are",
        name));
}

namespace {

void requireRandom(const Samples& samples, const std::string& what) {
    const bool isRandom = std::ranges::any_of(
        samples, [&](const std::vector<double>& sample) { return sample != samples.front(); });
    if (isRandom) return;
    throw Error(
        fmt::format("{}: all {} frames are the same picture: nothing is random, or {{frame}} "
                    "is not the seed",
                    what, samples.size()));
}

}  // namespace

void recordSameMean(const Samples& pictures, const Samples& truths, const std::string& name,
                    technique::Recorder& recorder) {
    const std::string what = fmt::format("image '{}'", name);
    requireRandom(pictures, what);
    requireRandom(truths, what + ": truth");
    for (const std::vector<double>& picture : pictures) {
        if (std::ranges::find(truths, picture) == truths.end()) continue;
        throw Error(what +
                    ": one of its frames is a picture of the truth: the two need seeds of "
                    "their own");
    }
    const metrics::MeanTest test = metrics::testMeans(pictures, truths);
    if (test.isUnlike) {
        throw Error(
            fmt::format("{}: its noise is {:.2g} times that of the truth, which cannot be tested; "
                        "allowed: {:g} "
                        "times, by as many samples a pixel, or as many more frames",
                        what, test.noiseRatio, metrics::kMostNoiseRatio));
    }
    recorder.metric(metrics::kSameMeanP, test.p, name);
    if (std::isfinite(test.seen)) recorder.metric(metrics::kBiasSeen, test.seen, name);
}

void recordDifferences(const Samples& pictures, const Samples& truths, const image::ImageF& picture,
                       const std::string& name, technique::Recorder& recorder) {
    const image::ImageF errors = metrics::tileDifferences(pictures, truths, picture.width(),
                                                          picture.height(), picture.channels());
    // As in the viewer: red is too dark, blue too bright.
    const image::Image8 colours = image::coloured(errors, image::ColourMap::CoolWarm,
                                                  metrics::kShownErrors, -metrics::kShownErrors);
    static const std::array<float, 256> kDecoded = image::srgbDecoding();
    image::ImageF shown(colours.width(), colours.height(), colours.channels());
    std::ranges::transform(colours.values(), shown.values().begin(),
                           [](std::uint8_t value) { return kDecoded[value]; });
    technique::ImageOptions options;
    options.layers.add(errors, {"standard_errors"}, image::ExrPixelType::Float);
    recorder.image(name + std::string(metrics::kDifferencesSuffix), shown, options);
}

}  // namespace gfxrepro::external
