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
    std::optional<glm::vec2> spacingM;  // along x and z
    std::string warning;                // of that
    std::string unitWarning;            // of heights that are taken as metres
};

/// The whole text, but for blanks around it, as a number; none of an empty one. Throws Error, which
/// begins with `what`, for others.
std::optional<float> floatIn(const std::string& text, const std::string& what);

/// Feet and kilometres become metres, degrees those on the ground in the middle. Throws Error,
/// which names the file, for other units, and where rows and columns of samples are askew on the
/// ground; not for what says their spacing, if another is given.
GeoUnits unitsOf(const GeoTags& tags, const std::string& file, bool needsSpacing);

/// A way on the ground, east and north, of one that is as long as degrees along a meridian: those
/// from west to east are shorter at a latitude (radians).
glm::dvec2 groundStep(glm::dvec2 step, double latitude);
/// The latitude (radians) of the middle of an SRTM tile, whose name is that of its corner in the
/// south-west, as N46E007; none of other names.
std::optional<double> middleOfTile(const std::string& name);

}  // namespace gfxrepro::scene
