#include "engine/image/srgb.h"

#include <cmath>
#include <cstddef>

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

}  // namespace gfxrepro::image
