#include "engine/image/image_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "engine/image/exr_io.h"
#include "engine/image/png_io.h"
#include "engine/image/resample.h"
#include "engine/image/srgb.h"

namespace gfxrepro::image {
namespace {

ImageF storedPng(const std::filesystem::path& path) {
    PngRows stored(path, kMaxSidePx, ImageUse::Picture);
    ImageF result(stored.width(), stored.height(), stored.channels());
    std::vector<std::uint16_t> row(result.row(0).size());
    for (int y = 0; y < result.height(); ++y) {
        stored.read(row.data());
        std::ranges::transform(row, result.row(y).begin(), [](std::uint16_t value) {
            return static_cast<float>(value) / 65535.0F;
        });
    }
    return result;
}

/// Of sRGB beside its alpha.
ImageF lightOf(ImageF image) {
    const auto channels = static_cast<std::size_t>(image.channels());
    const bool hasAlpha = isAlpha(channels - 1, channels);
    const std::size_t colours = hasAlpha ? channels - 1 : channels;
    for (std::size_t i = 0; i < image.values().size(); i += channels) {
        for (float& value : image.values().subspan(i, colours)) {
            value = linearOf(value) * (hasAlpha ? image.values()[i + colours] : 1.0F);
        }
    }
    return image;
}

/// What `display` shows of an image whose pixels lie in `data`.
Picture shownOf(ImageF linear, const Rectangle& data, const Rectangle& display,
                const std::filesystem::path& path) {
    Rectangle part = intersection(data, display);
    if (part.width == 0 || part.height == 0) {
        const auto text = [](const Rectangle& r) {
            return fmt::format("{}x{} from ({}, {})", r.width, r.height, r.left, r.top);
        };
        throw Error(fmt::format("{}: its pixels, {}, lie outside of its display window, {}",
                                path.string(), text(data), text(display)));
    }
    part.left -= data.left;
    part.top -= data.top;
    if (part.width < data.width || part.height < data.height) linear = cropped(linear, part);
    part.left += data.left - display.left;
    part.top += data.top - display.top;
    Picture picture{linear, {}, true, display.width, display.height, part};
    picture.linear = std::move(linear);
    return picture;
}

}  // namespace

bool isExrFile(const std::filesystem::path& path) {
    const std::string extension = path.extension();
    if (extension == ".exr" || extension == ".png") return extension == ".exr";
    throw UsageError(path.string() + ": is neither .exr nor .png");
}

Picture readPicture(const std::filesystem::path& path) {
    if (isExrFile(path)) {
        const ExrImage exr = readExr(path);
        return shownOf(exr.colour(), exr.dataWindow(), exr.shownWindow(), path);
    }
    Picture picture;
    picture.stored = storedPng(path);
    picture.linear = lightOf(picture.stored);
    picture.width = picture.stored.width();
    picture.height = picture.stored.height();
    picture.part = {0, 0, picture.width, picture.height};
    return picture;
}

void keepCommon(Picture& a, Picture& b) {
    if (a.isWhole() && b.isWhole()) return;
    const Rectangle common = intersection(a.part, b.part);
    if (a.width != b.width || a.height != b.height || common.width == 0 || common.height == 0) {
        throw Error(fmt::format("the images show no place that both have: {} and {}", placeOf(a),
                                placeOf(b)));
    }
    for (Picture* picture : {&a, &b}) {
        const Rectangle part{common.left - picture->part.left, common.top - picture->part.top,
                             common.width, common.height};
        picture->stored = cropped(picture->stored, part);
        picture->linear = cropped(picture->linear, part);
        picture->part = common;
    }
}

std::string placeOf(const Picture& picture) {
    return fmt::format("{}x{} pixels from ({}, {}) of {}x{}", picture.part.width,
                       picture.part.height, picture.part.left, picture.part.top, picture.width,
                       picture.height);
}

}  // namespace gfxrepro::image
