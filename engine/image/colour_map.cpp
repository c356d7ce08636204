#include "engine/image/colour_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace gfxrepro::image {
namespace {

using Colour = std::array<std::uint8_t, 3>;

// At equal steps; between them the map is linear.

/// Every 17th of the 256 colours of `magma` of matplotlib 3.6.3 (by N. Smith and S. van der Walt,
/// CC0): less than 3 of 255 levels from all of them.
constexpr Colour kMagma[] = {
    {0, 0, 4},       {11, 9, 36},     {32, 17, 75},    {59, 15, 112},
    {87, 21, 126},   {114, 31, 129},  {140, 41, 129},  {168, 50, 125},
    {196, 60, 117},  {222, 73, 104},  {241, 96, 93},   {250, 127, 94},
    {254, 159, 109}, {254, 191, 132}, {253, 222, 160}, {252, 253, 191},
};

/// Moreland 2009, "Diverging Color Maps for Scientific Visualization": every second of the 33
/// colours that he publishes.
constexpr Colour kCoolWarm[] = {
    {59, 76, 192},   {77, 104, 215},  {98, 130, 234},  {119, 154, 247}, {141, 176, 254},
    {163, 194, 255}, {184, 208, 249}, {204, 217, 238}, {221, 221, 221}, {236, 211, 197},
    {245, 196, 173}, {247, 177, 148}, {244, 154, 123}, {236, 127, 99},  {222, 96, 77},
    {203, 62, 56},   {180, 4, 38},
};

constexpr Colour kNotANumber{0, 255, 0};

std::span<const Colour> coloursOf(ColourMap map) {
    switch (map) {
        case ColourMap::Magma:
            return kMagma;
        case ColourMap::CoolWarm:
            break;
    }
    return kCoolWarm;
}

}  // namespace

std::array<std::uint8_t, 3> colourOf(ColourMap map, float unit) {
    if (std::isnan(unit)) return kNotANumber;
    const std::span<const Colour> colours = coloursOf(map);
    const float position = std::clamp(unit, 0.0F, 1.0F) * static_cast<float>(colours.size() - 1);
    const auto below = std::min(static_cast<std::size_t>(position), colours.size() - 2);
    const float share = position - static_cast<float>(below);
    Colour colour;
    for (std::size_t c = 0; c < colour.size(); ++c) {
        const float a = colours[below][c], b = colours[below + 1][c];
        colour[c] = static_cast<std::uint8_t>(a + share * (b - a) + 0.5F);
    }
    return colour;
}

Image8 coloured(const ImageF& image, ColourMap map, float low, float high) {
    if (image.channels() != 1) {
        throw Error(fmt::format("a colour map shows 1 channel, found {}", image.channels()));
    }
    if (!std::isfinite(low) || !std::isfinite(high) || low == high) {
        throw Error(fmt::format(
            "a colour map needs two finite ends that differ, found {:g} and {:g}", low, high));
    }
    Image8 picture(image.width(), image.height(), 3);
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) {
            const Colour colour = colourOf(map, (image.at(x, y) - low) / (high - low));
            for (int c = 0; c < 3; ++c) {
                picture.at(x, y, c) = colour[static_cast<std::size_t>(c)];
            }
        }
    }
    return picture;
}

}  // namespace gfxrepro::image
