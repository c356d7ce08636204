#include "engine/image/image.h"

#include "engine/image/srgb.h"

namespace gfxrepro::image {

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
