// What rays meet, for tests that count it.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/raycast/ray_tracer.h"

namespace gfxrepro::test {

inline std::vector<raycast::TriangleHit> allHits(const raycast::RayTracer& tracer,
                                                 const glm::vec3& origin,
                                                 const glm::vec3& direction) {
    std::vector<raycast::TriangleHit> hits;
    tracer.hitsBetween(origin, direction, 0.0F, std::numeric_limits<float>::infinity(),
                       raycast::Faces::All, hits);
    return hits;
}

/// Distances of all hits, ascending, of which those at one distance (to 16 units in the last place)
/// that face the same way count once: a ray through a shared edge meets both triangles. Two
/// parallel sheets nearer than that merge, too.
inline std::vector<float> crossings(const raycast::RayTracer& tracer, const glm::vec3& origin,
                                    const glm::vec3& direction) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    // Distances of one edge from its two triangles differ by rounding, which grows with the
    // coordinates that went into them.
    const float scale = std::max({std::abs(origin.x), std::abs(origin.y), std::abs(origin.z)});
    std::vector<float> distances;
    float lastOfFacing[2] = {-kInfinity, -kInfinity};
    for (const raycast::TriangleHit& hit : allHits(tracer, origin, direction)) {
        const auto& corners = tracer.triangle(hit.triangle).corners;
        const glm::vec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
        const float tolerance =
            16.0F * std::numeric_limits<float>::epsilon() * std::max(scale, hit.distance);
        float& last = lastOfFacing[glm::dot(normal, direction) < 0.0F ? 1 : 0];
        if (hit.distance - last > tolerance) distances.push_back(hit.distance);
        last = hit.distance;
    }
    return distances;
}

}  // namespace gfxrepro::test
