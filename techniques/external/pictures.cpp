#include "techniques/external/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/image/image_file.h"
#include "engine/metrics/hdr_flip.h"
#include "engine/metrics/image_error.h"
#include "engine/metrics/mean_test.h"

namespace gfxrepro::external {

namespace {

namespace fs = std::filesystem;
using image::ImageF;

constexpr int kLeastSsimPx = 11;  // structural similarity has no value for smaller pictures

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

/// Grey with alpha has no place among recorded pictures.
ImageF withoutLoneAlpha(const ImageF& image) {
    if (image.channels() != 2) return image;
    ImageF grey(image.width(), image.height(), 1);
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) grey.at(x, y) = image.at(x, y);
    }
    return grey;
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
        picture.isPng = !image::isExrFile(file);
        picture.stored = withoutLoneAlpha(image::readStored(file));
        picture.linear = picture.isPng ? withoutLoneAlpha(image::readLinear(file)) : picture.stored;
    } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", what, error.what()));
    }
    requireFinite(picture.stored, what);
    const glm::ivec2 found{picture.stored.width(), picture.stored.height()};
    if (sizePx.x > 0 && found != sizePx) {
        throw Error(fmt::format("{}: has {} × {} pixels; {} × {} were asked for", what, found.x,
                                found.y, sizePx.x, sizePx.y));
    }
    return picture;
}

config::Outputs errorOutputs() {
    using config::Better;
    return {{{"mse", "1", "mean squared error of all values: EXR linear, PNG sRGB", Better::Lower},
             {"rmse", "1", "its square root", Better::Lower},
             {"rel_mse", "1", "mean of squared errors ÷ (squared truth + 0.01)", Better::Lower},
             {"psnr_db", "dB", "10 · log10(1 ÷ mse)", Better::Higher},
             {"ssim", "1", "structural similarity of luminance", Better::Higher},
             {"flip", "1", "mean FLIP; HDR-FLIP of EXR files with values beyond 1", Better::Lower},
             {"same_mean_p", "1",
              "chance that frames and truths of one expectation differ as these do: a claim "
              "same_mean judges it",
              Better::Neither},
             {"bias_seen", "1",
              "of a tile, as a share of the mean value: what same_mean_p shows more often than not "
              "at 1 % of false alarms",
              Better::Lower}},
            {}};
}

void recordErrors(const Picture& picture, const Picture& truth, const std::string& name,
                  technique::Recorder& recorder) {
    if (picture.isPng != truth.isPng) {
        throw Error(
            fmt::format("image '{}': one of it and its truth is an EXR file, which is "
                        "linear, the other a PNG file, which is not",
                        name));
    }
    const ImageF& test = picture.stored;
    const ImageF& reference = truth.stored;
    try {
        metrics::requireComparable(reference, test);
    } catch (const Error& error) {
        throw Error(fmt::format("image '{}' and its truth: {}", name, error.what()));
    }
    const double mse = metrics::meanSquaredError(reference, test);
    recorder.metric("mse", mse, "1", name);
    recorder.metric("rmse", std::sqrt(mse), "1", name);
    recorder.metric("rel_mse", metrics::relativeMeanSquaredError(reference, test), "1", name);
    recorder.metric("psnr_db", metrics::peakSignalToNoiseDb(reference, test), "dB", name);
    if (test.width() >= kLeastSsimPx && test.height() >= kLeastSsimPx) {
        recorder.metric("ssim", metrics::structuralSimilarity(reference, test), "1", name);
    }
    const ImageF seen = metrics::coloursOf(picture.linear);
    const ImageF seenTruth = metrics::coloursOf(truth.linear);
    const bool isHdr = metrics::exceedsDisplay(seen) || metrics::exceedsDisplay(seenTruth);
    recorder.metric("flip",
                    isHdr ? metrics::hdrFlip(seenTruth, seen) : metrics::flip(seenTruth, seen), "1",
                    name);
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
    recorder.metric("same_mean_p", test.p, "1", name);
    if (std::isfinite(test.seen)) recorder.metric("bias_seen", test.seen, "1", name);
}

}  // namespace gfxrepro::external
