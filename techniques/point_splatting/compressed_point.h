// A point in 8 bytes (zju2005 Table 3.1, Sec. 3.3.2).
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "engine/scene/scene.h"

namespace gfxrepro::point_splatting {

/// Bits of a word.
struct BitField {
    int shift, bits;
    constexpr std::uint32_t put(std::uint32_t value) const { return value << shift; }
    constexpr std::uint32_t of(std::uint32_t word) const {
        return word >> shift & ((1U << bits) - 1U);
    }
};
constexpr int bitsOf(std::span<const BitField> fields) {
    int sum = 0;
    for (const BitField& field : fields) sum += field.bits;
    return sum;
}

/// Where they are, as the vertex stage reads them (shaders/decode_point.glsl).
namespace layout {
/// Of `position`: x, y, z of the 256³ grid in the patch's box, then the cell's x, y and z within.
inline constexpr std::array<BitField, 6> kPosition{
    {{0, 8}, {8, 8}, {16, 8}, {24, 3}, {27, 3}, {30, 2}}};
/// Of `surface`. The tangent's byte has six bits more, in which the thesis keeps the second
/// tangent's choice and the corner.
inline constexpr BitField kTheta{0, 8}, kPhi{8, 8}, kTangent{16, 2}, kRadius{24, 8};
}  // namespace layout

/// A quad's corner is the number of its vertex and the second tangent a cross product, so that a
/// drawn point takes one record. The thesis keeps both in the record, of which a point then takes
/// four.
struct CompressedPoint {
    std::uint32_t position = 0;
    std::uint32_t surface = 0;
    bool operator==(const CompressedPoint&) const = default;
};
static_assert(sizeof(CompressedPoint) == 8);

/// 256 radii, ascending: the middles of clusters of a model's radii (Sec. 3.3.2.5), by k-means of
/// their logarithms in one dimension. Fewer different radii are all kept.
std::vector<float> clusteredRadii(std::span<const float> radii);
/// Index of the nearest radius of an ascending table of 1 to 256, by binary search.
std::uint8_t nearestRadius(std::span<const float> table, float radius);

/// The tangent of a normal by its two bits: (0, −n.z, n.y), (n.z, 0, −n.x), (−n.y, n.x, 0), of unit
/// length (Sec. 3.3.2.3; three choices fit two bits). The one that drops the smallest component of
/// the normal is the longest, and never zero.
int tangentChoice(const glm::vec3& normal);
glm::vec3 tangentOf(const glm::vec3& normal, int choice);

struct DecodedPoint {
    glm::vec3 position{0.0F}, normal{0.0F};
    glm::vec3 tangent{0.0F}, bitangent{0.0F};  // orthonormal: bitangent = normal × tangent
    float radius = 0.0F;
};
/// `normal` is of unit length, `position` in the box.
CompressedPoint compressed(const glm::vec3& position, const glm::vec3& normal, float radius,
                           const scene::Box& patchBounds, std::span<const float> radiusTable);
DecodedPoint decoded(const CompressedPoint& point, const scene::Box& patchBounds,
                     std::span<const float> radiusTable);

/// Largest possible errors: half a cell of 2048 × 2048 × 1024 in the box, with what single
/// precision rounds on the way to a cell and back (all there is in a flat patch's box); half a step
/// of theta (of 256 over 360°) and of phi (of 256 over 180°) together.
glm::vec3 positionErrorBound(const scene::Box& patchBounds);
float normalErrorBoundRad();

/// An uncompressed point as the thesis counts it: 60 bytes.
struct FullPoint {
    glm::vec3 position, normal, tangent, bitangent;
    glm::vec2 corner;
    float radius;
};
static_assert(sizeof(FullPoint) == 60);

}  // namespace gfxrepro::point_splatting
