#include "engine/image/srgb.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

namespace gfxrepro::image {
namespace {

double decodedSrgb(double srgb) {
    return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

}  // namespace

float srgbOf(float linear) {
    return linear <= 0.0031308F ? 12.92F * linear : 1.055F * std::pow(linear, 1.0F / 2.4F) - 0.055F;
}

float linearOf(float srgb) {
    return static_cast<float>(decodedSrgb(srgb));
}

std::array<float, 256> srgbDecoding() {
    std::array<float, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i) {
        table[i] = static_cast<float>(decodedSrgb(static_cast<double>(i) / 255.0));
    }
    return table;
}

namespace {

float aces(float value) {
    constexpr AcesCurve c;
    const double x = double{value};
    return static_cast<float>((c.n2 * x * x + c.n1 * x) / (c.d2 * x * x + c.d1 * x + c.d0));
}

}  // namespace

ImageF withStraightAlpha(ImageF image) {
    const auto channels = static_cast<std::size_t>(image.channels());
    if (!isAlpha(channels - 1, channels)) return image;
    for (std::size_t i = 0; i < image.values().size(); i += channels) {
        const float alpha = image.values()[i + channels - 1];
        if (!(alpha > 0.0F)) continue;
        for (float& value : image.values().subspan(i, channels - 1)) value /= alpha;
    }
    return image;
}

ImageF toneMapped(const ImageF& linear, float exposureStops, ToneMap toneMap) {
    const float scale = std::exp2(exposureStops);
    const auto channels = static_cast<std::size_t>(linear.channels());
    const std::size_t colours = channels - (isAlpha(channels - 1, channels) ? 1 : 0);
    ImageF result = linear;
    for (std::size_t i = 0; i < result.values().size(); i += channels) {
        const std::span<float> colour = result.values().subspan(i, colours);
        for (float& value : colour) {  // not-a-number becomes 0
            value = std::min(std::max(0.0F, scale * value), std::numeric_limits<float>::max());
        }
        for (float& value : colour) {
            if (toneMap == ToneMap::Aces) value = aces(value);
            value = std::min(value, 1.0F);
        }
    }
    return result;
}

}  // namespace gfxrepro::image
