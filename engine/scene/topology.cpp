#include "engine/scene/topology.h"

#include <algorithm>
#include <numeric>

namespace gfxrepro::scene {

Welding weldedByPosition(std::span<const glm::vec3> positions) {
    Welding welding;
    welding.idOfVertex.reserve(positions.size());
    KeyNumbers<std::array<std::uint32_t, 3>> table(positions.size());
    for (const glm::vec3& p : positions) {
        // Adding 0 turns −0 into 0, which compares equal.
        const auto id = table.number({std::bit_cast<std::uint32_t>(p.x + 0.0F),
                                      std::bit_cast<std::uint32_t>(p.y + 0.0F),
                                      std::bit_cast<std::uint32_t>(p.z + 0.0F)});
        welding.idOfVertex.push_back(id.first);
    }
    welding.count = static_cast<std::uint32_t>(table.size());
    return welding;
}

namespace {

bool areAllUsed(std::span<const glm::uvec3> triangles, std::size_t vertexCount) {
    if (3 * triangles.size() < vertexCount) return false;
    std::vector<char> isUsed(vertexCount, 0);
    for (const glm::uvec3& triangle : triangles) {
        isUsed[triangle.x] = isUsed[triangle.y] = isUsed[triangle.z] = 1;
    }
    return std::ranges::find(isUsed, 0) == isUsed.end();
}

}  // namespace

std::vector<std::uint32_t> UsedVertices::renumber(std::span<glm::uvec3> triangles,
                                                  std::size_t vertexCount) {
    std::vector<std::uint32_t> used;
    if (areAllUsed(triangles, vertexCount)) {  // mostly: that is soon known
        used.resize(vertexCount);
        std::iota(used.begin(), used.end(), 0U);
        return used;
    }
    if (placeOf_.size() < vertexCount) placeOf_.resize(vertexCount, kNone);
    for (const glm::uvec3& triangle : triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            std::uint32_t& place = placeOf_[triangle[corner]];
            if (place == kNone) used.push_back(triangle[corner]);
            place = 0;
        }
    }
    std::ranges::sort(used);
    for (std::uint32_t i = 0; i < used.size(); ++i) placeOf_[used[i]] = i;
    for (glm::uvec3& triangle : triangles) {
        for (int corner = 0; corner < 3; ++corner) triangle[corner] = placeOf_[triangle[corner]];
    }
    for (const std::uint32_t vertex : used) placeOf_[vertex] = kNone;
    return used;
}

std::size_t dropUnusedVertices(Mesh& mesh) {
    const std::size_t before = mesh.positions.size();
    const std::vector<std::uint32_t> used = UsedVertices().renumber(mesh.triangles, before);
    if (used.size() == before) return 0;
    const auto keep = [&](auto& values) {
        if (values.empty()) return;
        for (std::size_t i = 0; i < used.size(); ++i) values[i] = values[used[i]];
        values.resize(used.size());
        values.shrink_to_fit();
    };
    keep(mesh.positions);
    keep(mesh.normals);
    keep(mesh.texcoords);
    keep(mesh.colors);
    return before - used.size();
}

EdgeTable edgesOf(std::span<const glm::uvec3> triangles, const Welding& welding) {
    EdgeTable edges;
    edges.edgeOfCorner.assign(triangles.size() * 3, kNone);
    edges.nextCorner.assign(triangles.size() * 3, kNone);
    KeyNumbers<std::uint64_t> table(triangles.size() * 3 / 2);
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        std::uint32_t id[3];
        for (int i = 0; i < 3; ++i) id[i] = welding.idOfVertex[triangles[t][i]];
        if (id[0] == id[1] || id[1] == id[2] || id[2] == id[0]) continue;
        for (std::uint32_t i = 0; i < 3; ++i) {
            const std::uint32_t a = id[i];
            const std::uint32_t b = id[(i + 1) % 3];
            const auto [edge, isNew] =
                table.number((std::uint64_t{std::min(a, b)} << 32) | std::max(a, b));
            const std::uint32_t corner = 3 * t + i;
            if (isNew) edges.firstCorner.push_back(kNone);
            edges.edgeOfCorner[corner] = edge;
            edges.nextCorner[corner] = edges.firstCorner[edge];
            edges.firstCorner[edge] = corner;
        }
    }
    return edges;
}

}  // namespace gfxrepro::scene
