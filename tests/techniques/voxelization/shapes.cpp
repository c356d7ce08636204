#include "tests/techniques/voxelization/shapes.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <map>

#include "tests/support/grid.h"

namespace gfxrepro::voxelization::shapes {

scene::Mesh cube(const glm::vec3& low, const glm::vec3& high) {
    scene::Mesh mesh;
    for (int i = 0; i < 8; ++i) {
        mesh.positions.emplace_back(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y,
                                    i & 4 ? high.z : low.z);
    }
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return mesh;
}

scene::Mesh sphere(const glm::vec3& centre, float radius, int levels) {
    const float g = 0.5F * (1.0F + std::sqrt(5.0F));
    scene::Mesh mesh;
    mesh.positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                      {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    mesh.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                      {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                      {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                      {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    for (int level = 0; level < levels; ++level) {
        std::map<std::pair<unsigned, unsigned>, unsigned> middles;
        const auto middle = [&](unsigned a, unsigned b) {
            const std::pair key(std::min(a, b), std::max(a, b));
            const auto [at, isNew] =
                middles.emplace(key, static_cast<unsigned>(mesh.positions.size()));
            if (isNew) mesh.positions.push_back(mesh.positions[a] + mesh.positions[b]);
            return at->second;
        };
        std::vector<glm::uvec3> finer;
        for (const glm::uvec3& t : mesh.triangles) {
            const unsigned a = middle(t.x, t.y), b = middle(t.y, t.z), c = middle(t.z, t.x);
            for (const glm::uvec3& part :
                 {glm::uvec3(t.x, a, c), {t.y, b, a}, {t.z, c, b}, {a, b, c}}) {
                finer.push_back(part);
            }
        }
        mesh.triangles = std::move(finer);
        for (glm::vec3& p : mesh.positions) p = glm::normalize(p);
    }
    for (glm::vec3& p : mesh.positions) p = centre + radius * glm::normalize(p);
    return mesh;
}

scene::Mesh torus(const glm::vec3& centre, float radius, float tube, int around, int across) {
    scene::Mesh mesh;
    const auto index = [&](int i, int j) {
        return static_cast<unsigned>(i % around * across + j % across);
    };
    for (const auto [i, j] : test::grid(around, across)) {
        const float a = glm::two_pi<float>() * static_cast<float>(i) / static_cast<float>(around);
        const float b = glm::two_pi<float>() * static_cast<float>(j) / static_cast<float>(across);
        const float ring = radius + tube * std::cos(b);
        mesh.positions.push_back(
            centre + glm::vec3(ring * std::cos(a), tube * std::sin(b), ring * std::sin(a)));
        mesh.triangles.emplace_back(index(i, j), index(i, j + 1), index(i + 1, j));
        mesh.triangles.emplace_back(index(i + 1, j), index(i, j + 1), index(i + 1, j + 1));
    }
    return mesh;
}

scene::Mesh randomTriangles(int count, std::uint64_t seed) {
    Random random(seed);
    const auto point = [&] {
        const float x = random.uniform(), y = random.uniform(), z = random.uniform();
        return glm::vec3(x, y, z);
    };
    scene::Mesh mesh;
    for (int i = 0; i < count; ++i) {
        const glm::vec3 a = point();
        // Large and small ones.
        const float size = i % 3 == 0 ? 1.0F : 0.08F;
        const glm::vec3 b = glm::mix(a, point(), size);
        glm::vec3 c = glm::mix(a, point(), size);
        if (i % 4 == 1) c = glm::mix(a, b, 0.4F) + 0.002F * point();
        if (i % 8 == 3) c = i % 16 == 3 ? glm::mix(a, b, 0.5F) : a;
        const auto first = static_cast<unsigned>(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), {a, i % 32 == 11 ? a : b, c});
        mesh.triangles.emplace_back(first, first + 1, first + 2);
    }
    return mesh;
}

scene::Mesh joined(const scene::Mesh& a, const scene::Mesh& b) {
    scene::Mesh mesh = a;
    const auto first = static_cast<unsigned>(a.positions.size());
    mesh.positions.insert(mesh.positions.end(), b.positions.begin(), b.positions.end());
    for (const glm::uvec3& t : b.triangles) mesh.triangles.push_back(t + first);
    return mesh;
}

}  // namespace gfxrepro::voxelization::shapes
