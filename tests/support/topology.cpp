#include "tests/support/topology.h"

#include <numeric>

#include "engine/scene/topology.h"

namespace gfxrepro::scene {

namespace {

/// Disjoint sets with path halving.
class Sets {
  public:
    explicit Sets(std::size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), std::uint32_t{0});
    }
    std::uint32_t root(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(std::uint32_t a, std::uint32_t b) { parent_[root(a)] = root(b); }

  private:
    std::vector<std::uint32_t> parent_;
};

std::uint32_t nextInTriangle(std::uint32_t corner) {
    return corner % 3 == 2 ? corner - 2 : corner + 1;
}

struct WeldedTriangles {
    std::span<const glm::uvec3> triangles;
    const Welding& welding;

    std::uint32_t startOf(std::uint32_t corner) const {
        return welding.idOfVertex[triangles[corner / 3][static_cast<int>(corner % 3)]];
    }
};

/// Joins the corners that meet at both ends of an edge: what remains apart at a vertex are fans.
void joinFans(const WeldedTriangles& mesh, const EdgeTable& table, std::uint32_t first,
              Sets& fans) {
    const std::uint32_t a = first;
    const std::uint32_t b = nextInTriangle(first);
    for (std::uint32_t c = table.nextCorner[first]; c != kNone; c = table.nextCorner[c]) {
        const bool isSameWay = mesh.startOf(c) == mesh.startOf(a);
        fans.join(a, isSameWay ? c : nextInTriangle(c));
        fans.join(b, isSameWay ? nextInTriangle(c) : c);
    }
}

}  // namespace

Topology topologyOf(const Mesh& mesh) {
    const Welding welding = weldedByPosition(mesh.positions);
    const EdgeTable table = edgesOf(mesh.triangles, welding);
    const WeldedTriangles triangles{mesh.triangles, welding};
    Topology topology{.edges = table.firstCorner.size()};
    Sets fans(mesh.triangles.size() * 3);
    Sets parts(mesh.triangles.size());
    for (const std::uint32_t first : table.firstCorner) {
        std::size_t count = 0;
        std::size_t sameWay = 0;
        for (std::uint32_t c = first; c != kNone; c = table.nextCorner[c]) {
            ++count;
            if (triangles.startOf(c) == triangles.startOf(first)) ++sameWay;
            parts.join(c / 3, first / 3);
        }
        if (count == 1) ++topology.boundaryEdges;
        if (count > 2) ++topology.nonManifoldEdges;
        if (count == 2 && sameWay == 2) ++topology.misorientedEdges;
        joinFans(triangles, table, first, fans);
    }
    std::vector<std::uint32_t> fansOfVertex(welding.count, 0);
    for (std::uint32_t c = 0; c < table.edgeOfCorner.size(); ++c) {
        if (table.edgeOfCorner[c] == kNone) continue;
        if (fans.root(c) == c) ++fansOfVertex[triangles.startOf(c)];
        if (c % 3 == 0) {
            ++topology.triangles;
            if (parts.root(c / 3) == c / 3) ++topology.components;
        }
    }
    for (const std::uint32_t count : fansOfVertex) {
        if (count > 0) ++topology.vertices;
        if (count > 1) ++topology.nonManifoldVertices;
    }
    topology.degenerateTriangles = mesh.triangles.size() - topology.triangles;
    return topology;
}

double signedVolume(const Mesh& mesh) {
    double volume = 0.0;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a = mesh.positions[t.x];
        const glm::dvec3 b = mesh.positions[t.y];
        const glm::dvec3 c = mesh.positions[t.z];
        volume += glm::dot(a, glm::cross(b, c)) / 6.0;
    }
    return volume;
}

}  // namespace gfxrepro::scene
