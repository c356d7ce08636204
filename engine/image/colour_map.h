// Numbers as colours.
#pragma once

#include <array>
#include <cstdint>

#include "engine/image/image.h"

namespace gfxrepro::image {

enum class ColourMap {
    Magma,     // black, purple, orange, pale yellow: of magnitudes
    CoolWarm,  // blue, grey, red: of what has a sign, grey in the middle
};

/// The sRGB colour of `unit` in [0, 1]; what lies outside has the colour of the nearer end.
/// Not-a-number is pure green, which no map holds.
std::array<std::uint8_t, 3> colourOf(ColourMap map, float unit);

/// One channel, `low` … `high` shown as the map's ends. Throws Error for more channels, and where
/// the two are equal or not finite.
Image8 coloured(const ImageF& image, ColourMap map, float low, float high);

}  // namespace gfxrepro::image
