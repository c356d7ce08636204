// The way back from sRGB.
#pragma once

#include <array>

namespace gfxrepro::image {

/// sRGB to linear (IEC 61966-2-1) for every 8-bit value.
std::array<float, 256> srgbDecoding();

}  // namespace gfxrepro::image
