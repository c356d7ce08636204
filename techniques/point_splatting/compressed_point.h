// A point in 8 bytes (zju2005 Table 3.1, Sec. 3.3.2).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "runner/scene/scene.h"

namespace gfxrepro::point_splatting {

/// As the vertex stage reads it (shaders/decode_point.glsl):
///   word 0: x, y, z of the 256³ grid in the patch's box (8 bits each), cell x, y (3), z (2)
///   word 1: theta (8), phi (8), tangents (2 × 2) and two bits that the quad's corner takes in the
///           thesis (0 here: the corner is the vertex's number), radius (8: into the table)
struct CompressedPoint {
    std::uint32_t position = 0;
    std::uint32_t surface = 0;
};
static_assert(sizeof(CompressedPoint) == 8);

/// 256 radii, ascending, made by clustering a model's radii (Sec. 3.3.2.5): one-dimensional
/// k-means of their logarithms.
using RadiusTable = std::vector<float>;
RadiusTable clusteredRadii(std::span<const float> radii);
/// Binary search for the nearest entry.
std::uint8_t nearestRadius(const RadiusTable& table, float radius);

struct DecodedPoint {
    glm::vec3 position{0.0F}, normal{0.0F}, tangent{0.0F}, bitangent{0.0F};
    float radius = 0.0F;
};
CompressedPoint compress(const glm::vec3& position, const glm::vec3& normal, float radius,
                         const scene::Box& patchBounds, const RadiusTable& table);
DecodedPoint decompress(const CompressedPoint& point, const scene::Box& patchBounds,
                        const RadiusTable& table);

/// Largest possible errors, from the grids alone: what measured errors must not pass.
glm::vec3 positionErrorBound(const scene::Box& patchBounds);  // half a cell an axis
float normalErrorBoundRad();                                  // half a step in theta and phi

/// An uncompressed point as the thesis counts it: 60 bytes.
struct FullPoint {
    glm::vec3 position, normal, tangent, bitangent;
    glm::vec2 corner;
    float radius;
};
static_assert(sizeof(FullPoint) == 60);

}  // namespace gfxrepro::point_splatting
