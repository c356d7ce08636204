#include "scenes/shared/mesh_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "engine/core/error.h"
#include "scenes/shared/sdf.h"

namespace gfxrepro::scene {

void MeshBuilder::addIndexed(std::span<const glm::vec3> positions,
                             std::span<const glm::vec3> normals,
                             std::span<const glm::uvec3> triangles,
                             std::span<const glm::vec2> texcoords) {
    GFXREPRO_ASSERT_EQ(positions.size(), normals.size());
    GFXREPRO_ASSERT(texcoords.empty() || texcoords.size() == positions.size());
    const auto first = static_cast<unsigned>(mesh_.positions.size());
    mesh_.positions.insert(mesh_.positions.end(), positions.begin(), positions.end());
    mesh_.normals.insert(mesh_.normals.end(), normals.begin(), normals.end());
    mesh_.colors.insert(mesh_.colors.end(), positions.size(), color_);
    for (const glm::uvec3& t : triangles) mesh_.triangles.push_back(t + first);
    if (!texcoords.empty() || !mesh_.texcoords.empty()) {
        mesh_.texcoords.resize(first, glm::vec2(0.0F));
        mesh_.texcoords.insert(mesh_.texcoords.end(), texcoords.begin(), texcoords.end());
        mesh_.texcoords.resize(mesh_.positions.size(), glm::vec2(0.0F));
    }
}

void MeshBuilder::addTriangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const std::array positions{a, b, c};
    const glm::vec3 normal = glm::normalize(glm::cross(b - a, c - a));
    const std::array normals{normal, normal, normal};
    const std::array triangles{glm::uvec3(0, 1, 2)};
    addIndexed(positions, normals, triangles);
}

void MeshBuilder::addQuad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c,
                          const glm::vec3& d) {
    const std::array positions{a, b, c, d};
    const glm::vec3 normal = glm::normalize(glm::cross(b - a, c - a));
    const std::array normals{normal, normal, normal, normal};
    const std::array triangles{glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3)};
    addIndexed(positions, normals, triangles);
}

void MeshBuilder::addBox(const glm::vec3& centre, const glm::vec3& halfSize,
                         const glm::mat3& axes) {
    // Faces take their corners from here: computed face by face they would differ in the last bit,
    // and a turned box would leak.
    std::array<glm::vec3, 8> corners;
    for (unsigned i = 0; i < 8; ++i) {
        const glm::vec3 sign((i & 1) != 0 ? 1.0F : -1.0F, (i & 2) != 0 ? 1.0F : -1.0F,
                             (i & 4) != 0 ? 1.0F : -1.0F);
        corners[i] = centre + axes * (sign * halfSize);
    }
    for (unsigned axis = 0; axis < 3; ++axis) {
        const unsigned out = 1U << axis;
        const unsigned u = 1U << ((axis + 1) % 3);
        const unsigned v = 1U << ((axis + 2) % 3);
        addQuad(corners[0], corners[v], corners[u + v], corners[u]);
        addQuad(corners[out], corners[out + u], corners[out + u + v], corners[out + v]);
    }
}

namespace {

glm::vec3 tangentAt(std::span<const MeshBuilder::Station> stations, std::size_t i) {
    const std::size_t before = i == 0 ? 0 : i - 1;
    const std::size_t after = std::min(i + 1, stations.size() - 1);
    return glm::normalize(stations[after].position - stations[before].position);
}

}  // namespace

glm::vec3 anyAcross(const glm::vec3& direction) {
    const glm::vec3 axis = std::abs(direction.y) < 0.8F ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    return glm::normalize(glm::cross(axis, direction));
}

void MeshBuilder::addTube(std::span<const Station> stations, int sides, bool isCapped) {
    GFXREPRO_ASSERT(stations.size() >= 2 && sides >= 3);
    const auto ring = static_cast<unsigned>(sides);
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::uvec3> triangles;
    glm::vec3 across = anyAcross(tangentAt(stations, 0));
    for (std::size_t i = 0; i < stations.size(); ++i) {
        const glm::vec3 tangent = tangentAt(stations, i);
        // Parallel transport: what is left of the last direction across the new tangent.
        const glm::vec3 carried = across - tangent * glm::dot(across, tangent);
        across = glm::length(carried) > 1e-4F ? glm::normalize(carried) : anyAcross(tangent);
        const glm::vec3 up = glm::cross(tangent, across);
        for (unsigned k = 0; k < ring; ++k) {
            const float angleRad = 2.0F * std::numbers::pi_v<float> * static_cast<float>(k) /
                                   static_cast<float>(sides);
            const glm::vec3 normal = across * sdf::cosine(angleRad) + up * sdf::sine(angleRad);
            positions.push_back(stations[i].position + normal * stations[i].radius);
            normals.push_back(normal);
        }
        if (i == 0) continue;
        const unsigned base = static_cast<unsigned>(i - 1) * ring;
        for (unsigned k = 0; k < ring; ++k) {
            const unsigned a = base + k;
            const unsigned b = base + (k + 1) % ring;
            triangles.emplace_back(a, b, b + ring);
            triangles.emplace_back(a, b + ring, a + ring);
        }
    }
    addIndexed(positions, normals, triangles);
    if (!isCapped) return;
    const std::span<const glm::vec3> all(positions);
    for (const bool isEnd : {false, true}) {
        const auto rim = isEnd ? all.last(ring) : all.first(ring);
        const glm::vec3 out =
            isEnd ? tangentAt(stations, stations.size() - 1) : -tangentAt(stations, 0);
        const std::vector<glm::vec3> capNormals(ring, out);
        std::vector<glm::uvec3> fan;
        for (unsigned k = 1; k + 1 < ring; ++k) {
            fan.push_back(isEnd ? glm::uvec3(0, k, k + 1) : glm::uvec3(0, k + 1, k));
        }
        addIndexed(rim, capNormals, fan);
    }
}

void addBackSides(Mesh& mesh) {
    const auto append = [](auto& values, auto&& changed) {
        const std::size_t count = values.size();
        values.reserve(2 * count);
        for (std::size_t i = 0; i < count; ++i) values.push_back(changed(values[i]));
    };
    const auto same = [](const auto& value) { return value; };
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    append(mesh.positions, same);
    append(mesh.normals, [](const glm::vec3& normal) { return -normal; });
    append(mesh.texcoords, same);
    append(mesh.colors, same);
    append(mesh.triangles,
           [first](const glm::uvec3& t) { return glm::uvec3(t.x, t.z, t.y) + first; });
}

Mesh MeshBuilder::take(std::string_view name, int material) {
    Mesh mesh = std::exchange(mesh_, {});
    mesh.name = name;
    mesh.material = material;
    return mesh;
}

void MeshBuilder::addTo(Scene& scene, const char* name, float roughness, bool isDoubleSided) {
    const int index = static_cast<int>(scene.meshes.size());
    Material material;
    material.name = name;
    material.baseColor = glm::vec4(1.0F);
    material.roughness = roughness;
    material.isDoubleSided = isDoubleSided;
    scene.materials.push_back(material);
    scene.meshes.push_back(take(name, index));
    scene.instances.push_back({index, glm::mat4(1.0F)});
}

}  // namespace gfxrepro::scene
