// What a GeoTIFF says of its samples: their heights' unit and how far they stand apart.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
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
    std::vector<double> tiepoint;     // 33922: i, j, k of a sample, x, y, z of the model
    glm::ivec2 sizeSamples{0};
};

/// height in metres = value · scale + offset.
struct GeoUnits {
    float scale = 1.0F;
    float offset = 0.0F;
    std::optional<float> spacingM;
    std::string warning;      // of degrees that are no squares, and of what else spaces samples
    std::string unitWarning;  // of heights that are taken as metres
};

/// The whole text, but for blanks around it, as a number; none of an empty one. Throws Error, which
/// begins with `what`, for others.
std::optional<float> floatIn(const std::string& text, const std::string& what);

/// Feet and kilometres become metres, degrees those along a meridian. Throws Error, which names the
/// file, for other units, and where samples on the ground do not stand on squares; not for what
/// says their spacing, if another is given.
GeoUnits unitsOf(const GeoTags& tags, const std::string& file, bool needsSpacing);

/// What to say of samples that are drawn as far apart from west to east as from north to south,
/// though they are not; empty where the two differ by less than 1 %.
std::string unevenSpacing(double eastM, double northM);
/// The same of an SRTM tile, whose name is that of its corner in the south-west, as N46E007: or
/// that another name says no latitude.
std::string warningOfTile(const std::string& name, double spacingM);

}  // namespace gfxrepro::scene
