// Meshes of few triangles, and of random ones.
#pragma once

#include "engine/core/random.h"
#include "engine/scene/scene.h"

namespace gfxrepro::test {

/// Facing cross(u, v); texture coordinates have v = 0 at the top.
inline scene::Mesh rectangle(const glm::vec3& centre = glm::vec3(0.0F),
                             const glm::vec3& u = {1, 0, 0}, const glm::vec3& v = {0, 1, 0}) {
    return scene::Mesh{
        .positions = {centre - u - v, centre + u - v, centre + u + v, centre - u + v},
        .texcoords = {{0, 1}, {1, 1}, {1, 0}, {0, 0}},
        .triangles = {{0, 1, 2}, {0, 2, 3}}};
}

inline glm::vec3 randomIn(Random& random, float low, float high) {
    const float x = random.uniform(low, high);
    const float y = random.uniform(low, high);
    return {x, y, random.uniform(low, high)};
}

/// Unconnected triangles in [−1, 1]³, facing anywhere.
inline scene::Mesh randomTriangles(int count, float size, std::uint64_t seed) {
    Random random(seed);
    scene::Mesh mesh;
    for (unsigned i = 0; i < static_cast<unsigned>(count); ++i) {
        const glm::vec3 centre = randomIn(random, size - 1.0F, 1.0F - size);
        for (int corner = 0; corner < 3; ++corner) {
            mesh.positions.push_back(centre + randomIn(random, -size, size));
        }
        mesh.triangles.push_back(glm::uvec3(3 * i) + glm::uvec3(0, 1, 2));
    }
    return mesh;
}

}  // namespace gfxrepro::test
