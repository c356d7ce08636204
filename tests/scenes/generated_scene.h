// What the tests of generated scenes share.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "engine/core/hash.h"
#include "scenes/registry.h"
#include "tests/support/support.h"

namespace gfxrepro::scene {

/// The scene of a generator with parameters in YAML.
inline Scene generated(const std::string& name, const std::string& yaml, std::uint64_t seed = 1) {
    Params params(parseYaml(yaml, "t.yaml"), "generator '" + name + "'");
    return findGenerator(registeredGenerators(), name, {}).generate(params, seed);
}

/// What it says against them.
inline std::string refusalOf(const std::string& name, const std::string& yaml) {
    return errorText([&] { generated(name, yaml); });
}

inline const Mesh& meshNamed(const Scene& scene, const std::string& name) {
    for (const Mesh& mesh : scene.meshes) {
        if (mesh.name == name) return mesh;
    }
    throw Error("no mesh '" + name + "'");
}

template <class T>
std::string digestOf(const std::vector<T>& values) {
    return sha256(std::as_bytes(std::span(values)));
}

/// Of positions, normals, colours and triangles of all meshes.
inline std::string digestOf(const Scene& scene) {
    std::string digests;
    for (const Mesh& mesh : scene.meshes) {
        digests += digestOf(mesh.positions) + digestOf(mesh.normals) + digestOf(mesh.colors) +
                   digestOf(mesh.triangles);
    }
    return sha256(digests);
}

/// Finite points, unit normals on the side that the winding says, valid colours, no slivers.
inline void expectSoundMesh(const Mesh& mesh) {
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    ASSERT_TRUE(mesh.colors.empty() || mesh.colors.size() == mesh.positions.size());
    float largest = 0.0F;
    float furthestFromUnit = 0.0F;
    bool areColorsValid = true;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            const float p = mesh.positions[i][c];
            largest = std::isfinite(p) ? std::max(largest, std::abs(p)) : HUGE_VALF;
            if (mesh.colors.empty()) continue;
            const float color = mesh.colors[i][c];
            areColorsValid &= color >= 0.0F && color <= 1.0F;
        }
        const float error = std::abs(glm::length(mesh.normals[i]) - 1.0F);
        // The negation counts not-a-number.
        if (!(error <= furthestFromUnit)) furthestFromUnit = error;
    }
    EXPECT_LT(largest, 1e4F);
    EXPECT_LT(furthestFromUnit, 1e-4F);
    EXPECT_TRUE(areColorsValid);

    std::size_t bad = 0;
    for (const glm::uvec3& t : mesh.triangles) {
        ASSERT_LT(std::max({t.x, t.y, t.z}), mesh.positions.size());
        const glm::vec3 a = mesh.positions[t.x];
        const glm::vec3 b = mesh.positions[t.y];
        const glm::vec3 c = mesh.positions[t.z];
        const glm::vec3 cross = glm::cross(b - a, c - a);
        const float longest =
            std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
        // Twice the area against the longest side's square: a sliver of 1 : 10⁵ is a mistake.
        bad += !(glm::length(cross) > 1e-5F * longest * longest);
        // Winding and vertex normals must agree about the outside.
        bad += !(glm::dot(cross, mesh.normals[t.x] + mesh.normals[t.y] + mesh.normals[t.z]) > 0.0F);
    }
    EXPECT_EQ(bad, 0U);
}

inline double surfaceArea(const Mesh& mesh) {
    double sum = 0.0;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::vec3 a = mesh.positions[t.x];
        sum += 0.5 * glm::length(glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a));
    }
    return sum;
}

/// A sheet of fronts, then their backs in the same order: the same points bit by bit, opposite
/// winding and normals. No two fronts lie on each other.
inline void expectTwoSidedSheet(const Mesh& mesh) {
    const std::size_t half = mesh.triangles.size() / 2;
    ASSERT_EQ(mesh.triangles.size(), 2 * half);
    std::size_t bad = 0;
    std::set<std::array<float, 9>> seen;
    for (std::size_t i = 0; i < half; ++i) {
        const glm::uvec3 front = mesh.triangles[i];
        const glm::uvec3 turned = mesh.triangles[i + half];
        const glm::uvec3 back(turned.x, turned.z, turned.y);
        std::array<std::array<float, 3>, 3> corners;
        for (int k = 0; k < 3; ++k) {
            const glm::vec3 p = mesh.positions[front[k]];
            bad += p != mesh.positions[back[k]] || mesh.colors[front[k]] != mesh.colors[back[k]] ||
                   mesh.normals[front[k]] != -mesh.normals[back[k]];
            corners[static_cast<std::size_t>(k)] = {p.x, p.y, p.z};
        }
        std::ranges::sort(corners);
        const auto& c = corners;
        bad += !seen.insert({c[0][0], c[0][1], c[0][2], c[1][0], c[1][1], c[1][2], c[2][0], c[2][1],
                             c[2][2]})
                    .second;
    }
    EXPECT_EQ(bad, 0U);
}

}  // namespace gfxrepro::scene
