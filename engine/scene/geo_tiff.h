// What a GeoTIFF says of its samples: their heights' unit and how far they stand apart.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace gfxrepro::scene {

/// Along a meridian, whose length is 40,007,863 m (WGS 84).
inline constexpr double kMetresPerDegree = 40'007'863.0 / 360.0;

/// The values of a file's tags; empty where it lacks them.
struct GeoTags {
    std::string metadata;             // 42112, GDAL's
    std::vector<double> pixelScale;   // 33550
    std::vector<double> transform;    // 34264: 4 x 4, rows first
    std::vector<std::uint16_t> keys;  // 34735
    std::vector<double> keyDoubles;   // 34736
};

/// height in metres = value · scale + offset.
struct GeoUnits {
    float scale = 1.0F;
    float offset = 0.0F;
    std::optional<float> spacingM;
};

/// Feet and kilometres become metres, degrees those along a meridian. Throws Error, which names the
/// file, for other units, and where samples on the ground do not stand on squares.
GeoUnits unitsOf(const GeoTags& tags, const std::string& file);

}  // namespace gfxrepro::scene
