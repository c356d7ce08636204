#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "engine/image/exr_io.h"
#include "engine/image/image_file.h"
#include "engine/image/png_io.h"
#include "engine/metrics/error_map.h"
#include "engine/metrics/flip.h"
#include "engine/metrics/image_error.h"
#include "runner/cli/commands.h"
#include "runner/cli/image_commands.h"

namespace gfxrepro::cli {

using image::ImageF;

namespace {

struct Pair {
    bool isLinear = false;   // EXR; else sRGB as stored in PNG files
    ImageF reference, test;  // as stored
    ImageF linearReference, linearTest;
};

Pair readPair(const ImageDiffOptions& options) {
    Pair pair;
    pair.isLinear = image::isExrFile(options.reference);
    if (image::isExrFile(options.test) != pair.isLinear) {
        throw UsageError(fmt::format(
            "image diff: {} and {} are of different kinds; an EXR is linear, a PNG is not",
            options.reference, options.test));
    }
    if (!options.out.empty()) image::isExrFile(options.out);
    pair.reference = image::readStored(options.reference);
    pair.test = image::readStored(options.test);
    metrics::requireComparable(pair.reference, pair.test);
    metrics::requireFlipSize(pair.reference);
    pair.linearReference = pair.isLinear ? pair.reference : image::readLinear(options.reference);
    pair.linearTest = pair.isLinear ? pair.test : image::readLinear(options.test);
    return pair;
}

bool usesHdrFlip(const ImageDiffOptions& options, const Pair& pair) {
    if (options.flip != "auto") return options.flip == "hdr";
    return pair.isLinear &&
           (metrics::exceedsDisplay(pair.reference) || metrics::exceedsDisplay(pair.test));
}

ImageF flipMapOf(const ImageDiffOptions& options, const Pair& pair) {
    const ImageF reference = metrics::coloursOf(pair.linearReference);
    const ImageF test = metrics::coloursOf(pair.linearTest);
    return usesHdrFlip(options, pair) ? metrics::hdrFlipMap(reference, test)
                                      : metrics::flipMap(reference, test);
}

/// Structural similarity has no value for smaller images.
constexpr int kLeastSsimPx = 11;

std::vector<std::pair<std::string, double>> differencesOf(const ImageDiffOptions& options,
                                                          const Pair& pair,
                                                          std::optional<ImageF>& flipMap) {
    const ImageF& a = pair.reference;
    const ImageF& b = pair.test;
    const auto isWanted = [&](const char* name) {
        return options.metrics.empty() || std::find(options.metrics.begin(), options.metrics.end(),
                                                    name) != options.metrics.end();
    };
    const bool fitsSsim = a.width() >= kLeastSsimPx && a.height() >= kLeastSsimPx;
    std::vector<std::pair<std::string, double>> values;
    if (isWanted("mse")) values.emplace_back("mse", metrics::meanSquaredError(a, b));
    if (isWanted("psnr")) values.emplace_back("psnr_db", metrics::peakSignalToNoiseDb(a, b));
    if (isWanted("ssim") && (fitsSsim || !options.metrics.empty())) {
        values.emplace_back("ssim", metrics::structuralSimilarity(a, b));
    }
    if (isWanted("flip")) {
        flipMap = flipMapOf(options, pair);
        values.emplace_back(usesHdrFlip(options, pair) ? "hdr_flip" : "flip",
                            metrics::meanOfFlip(*flipMap));
    }
    if (isWanted("max")) values.emplace_back("max", metrics::maxAbsoluteError(a, b));
    return values;
}

/// The map's numbers: gain · (reference − test) or its magnitude a channel, or FLIP.
ImageF numbersOf(const ImageDiffOptions& options, const Pair& pair, const ImageF* flipMap) {
    if (flipMap != nullptr) return *flipMap;
    const auto gain = static_cast<float>(options.gain);
    if (options.map == "abs") {
        return metrics::absoluteDifference(pair.reference, pair.test, gain);
    }
    ImageF difference = pair.reference;
    for (std::size_t i = 0; i < difference.values().size(); ++i) {
        difference.values()[i] = gain * (difference.values()[i] - pair.test.values()[i]);
    }
    return difference;
}

/// Differences of what is compared above: linear light of EXR files, displayed values of PNG files.
image::Image8 diffPicture(const ImageDiffOptions& options, const Pair& pair,
                          const ImageF* flipMap) {
    if (flipMap != nullptr) return metrics::flipPicture(*flipMap);
    const auto draw =
        options.map == "abs" ? metrics::absoluteErrorPicture : metrics::signedErrorPicture;
    return draw(pair.linearReference, pair.linearTest, static_cast<float>(options.gain),
                pair.isLinear ? metrics::ErrorOf::Linear : metrics::ErrorOf::Displayed);
}

void writeMap(const ImageDiffOptions& options, const Pair& pair, std::optional<ImageF> flipMap) {
    if (options.map == "flip" && !flipMap) flipMap = flipMapOf(options, pair);
    const ImageF* flip = options.map == "flip" ? &*flipMap : nullptr;
    if (!image::isExrFile(options.out)) {
        image::writePng(options.out, diffPicture(options, pair, flip));
        return;
    }
    static const std::vector<std::string> kNames[] = {
        {}, {"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};
    const ImageF numbers = numbersOf(options, pair, flip);
    image::ExrImage exr;
    exr.add(numbers, kNames[numbers.channels()], image::ExrPixelType::Float);
    exr.attributes["reference"] = options.reference;
    exr.attributes["test"] = options.test;
    exr.attributes["map"] = options.map;
    exr.attributes["gain"] = flip ? "1" : fmt::format("{:g}", options.gain);
    image::writeExr(options.out, exr);
}

}  // namespace

int imageDiff(const ImageDiffOptions& options) {
    if (!options.out.empty()) {
        const std::string inputs[] = {options.reference, options.test};
        requireNoInput(options.out, inputs);
    }
    const Pair pair = readPair(options);
    std::optional<ImageF> flipMap;
    const auto values = differencesOf(options, pair, flipMap);
    if (options.asJson) {
        nlohmann::ordered_json json;
        for (const auto& [name, value] : values) {
            json[name] = std::isfinite(value) ? nlohmann::ordered_json(value) : nullptr;
        }
        fmt::print("{}\n", json.dump(2));
    } else {
        for (const auto& [name, value] : values) fmt::print("{} {:.6g}\n", name, value);
    }
    if (!options.out.empty()) writeMap(options, pair, std::move(flipMap));
    return kExitOk;
}

}  // namespace gfxrepro::cli
