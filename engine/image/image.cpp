#include "engine/image/image.h"

#include <algorithm>

#include "engine/core/error.h"
#include "engine/image/srgb.h"

namespace gfxrepro::image {

void checkDeclaredSize(std::int64_t width, std::int64_t height, std::size_t bytesPerPixel,
                       std::size_t fileBytes, const std::string& name, std::int64_t maxSidePx,
                       ImageUse use) {
    const std::string declared =
        name + ": the header declares " + std::to_string(width) + " x " + std::to_string(height);
    if (width < 1 || height < 1 || width > maxSidePx || height > maxSidePx) {
        throw Error(declared + " pixels; 1 to " + std::to_string(maxSidePx) +
                    " a side are allowed");
    }
    constexpr std::size_t kAlwaysAllowedBytes = std::size_t{128} << 20;
    constexpr std::size_t kMaxExpansion = 500;
    constexpr std::size_t kMaxPictureBytes = std::size_t{1} << 30;
    constexpr std::size_t kMaxPictureExpansion = 4200;  // deflate: 1,030, grey counted as RGBA
    const std::size_t bytes = static_cast<std::size_t>(width * height) * bytesPerPixel;
    const bool isEvenPicture = use == ImageUse::Picture && bytes <= kMaxPictureBytes &&
                               bytes <= kMaxPictureExpansion * fileBytes;
    if (!isEvenPicture && bytes > std::max(kAlwaysAllowedBytes, kMaxExpansion * fileBytes)) {
        throw Error(declared + " pixels of " + std::to_string(bytesPerPixel) +
                    " bytes, too many for a file of " + std::to_string(fileBytes) + " bytes");
    }
}

namespace {

std::uint8_t quantized(float unit) {
    return static_cast<std::uint8_t>(unit * 255.0F + 0.5F);
}

/// NaN fails both comparisons' opposites and so becomes 0.
float clampedToUnit(float value) {
    return value > 0.0F ? (value < 1.0F ? value : 1.0F) : 0.0F;
}

}  // namespace

Image8 toSrgb8(const ImageF& linear) {
    Image8 result(linear.width(), linear.height(), linear.channels());
    const auto channels = static_cast<std::size_t>(linear.channels());
    const std::span<const float> from = linear.values();
    const std::span<std::uint8_t> to = result.values();
    for (std::size_t i = 0; i < from.size(); ++i) {
        const float value = clampedToUnit(from[i]);
        to[i] = quantized(i % channels == 3 ? value : srgbOf(value));
    }
    return result;
}

}  // namespace gfxrepro::image
