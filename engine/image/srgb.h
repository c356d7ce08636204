// The transfer curve of sRGB, both ways.
#pragma once

#include <array>

namespace gfxrepro::image {

/// Linear in [0, 1] to sRGB (IEC 61966-2-1).
float srgbOf(float linear);
/// And back.
float linearOf(float srgb);
/// sRGB to linear for every 8-bit value.
std::array<float, 256> srgbDecoding();

}  // namespace gfxrepro::image
