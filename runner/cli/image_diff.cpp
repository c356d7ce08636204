#include <fmt/core.h>

#include <filesystem>

#include "runner/cli/commands.h"
#include "runner/image/exr_io.h"
#include "runner/image/png_io.h"
#include "runner/metrics/image_error.h"

namespace gfxrepro::cli {

namespace fs = std::filesystem;

namespace {

std::string extensionOf(const fs::path& path) {
    const std::string extension = path.extension();
    if (extension == ".exr" || extension == ".png") return extension;
    throw UsageError(path.string() + ": is neither .exr nor .png");
}

/// EXR: linear values. PNG: values as stored, in [0, 1].
image::ImageF readImage(const fs::path& path) {
    if (extensionOf(path) == ".exr") return image::readExr(path).colour();
    const image::Image16 stored = image::readPng16(path);
    image::ImageF result(stored.width(), stored.height(), stored.channels());
    const auto from = stored.values();
    const auto to = result.values();
    for (std::size_t i = 0; i < from.size(); ++i) to[i] = static_cast<float>(from[i]) / 65535.0F;
    return result;
}

void writeImage(const fs::path& path, const image::ImageF& image) {
    if (extensionOf(path) == ".png") {
        image::writePng(path, image::toSrgb8(image));
        return;
    }
    image::ExrImage exr;
    const std::vector<std::string> names = image.channels() == 1 ? std::vector<std::string>{"Y"}
                                           : image.channels() == 3
                                               ? std::vector<std::string>{"R", "G", "B"}
                                               : std::vector<std::string>{"R", "G", "B", "A"};
    exr.add(image, names, image::ExrPixelType::Float);
    image::writeExr(path, exr);
}

}  // namespace

int imageDiff(const std::string& a, const std::string& b, const std::string& out) {
    if (extensionOf(a) != extensionOf(b)) {
        throw UsageError("image diff: " + a + " and " + b +
                         " are of different kinds; an EXR is linear, a PNG is not");
    }
    if (!out.empty()) extensionOf(out);
    const image::ImageF first = readImage(a);
    const image::ImageF second = readImage(b);
    fmt::print("mse {:.6g}\n", metrics::meanSquaredError(first, second));
    fmt::print("psnr_db {:.4g}\n", metrics::peakSignalToNoiseDb(first, second));
    fmt::print("ssim {:.6g}\n", metrics::structuralSimilarity(first, second));
    fmt::print("max {:.6g}\n", metrics::maxAbsoluteError(first, second));
    if (!out.empty()) writeImage(out, metrics::absoluteDifference(first, second));
    return kExitOk;
}

}  // namespace gfxrepro::cli
