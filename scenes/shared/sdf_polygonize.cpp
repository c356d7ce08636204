// Marching tetrahedra over the blocks of a cubic grid that the surface passes through.
#include <algorithm>
#include <array>
#include <cmath>

#include "engine/scene/topology.h"
#include "scenes/shared/sdf.h"

namespace gfxrepro::scene::sdf {

namespace {

// Parts of the shape are sorted out for groups of blocks first, then for each block.
constexpr int kGroupBlocks = 4;
constexpr int kBlockCells = 4;
constexpr int kBlockNodes = kBlockCells + 1;

/// Vertices stay this share of an edge away from its ends, so that no triangle shrinks to nothing
/// where the surface passes through a grid node.
constexpr float kEndMargin = 0.12F;

/// Of the grid, in cells: keeps its nodes off the planes of symmetry and the flat faces of shapes.
constexpr glm::vec3 kShift(0.37F, 0.21F, 0.59F);

/// Nodes nearer to the surface than this share of a cell count as outside: where a flat face lies
/// in a plane of the grid, rounding alone would say on which side each node is, and vertices
/// coincide.
constexpr float kSnap = 1e-3F;

/// Kuhn's division of a cube into six positively oriented tetrahedra. Corners are bit masks of x,
/// y, z; every edge leads from a corner to one whose mask contains it, and neighbouring cubes agree
/// on the diagonals of their common face.
constexpr std::array<std::array<int, 4>, 6> kTetrahedra = {
    {{0, 1, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}, {0, 3, 2, 7}, {0, 6, 4, 7}}};

/// Even permutations of a tetrahedron's corners that put the inside corners first.
constexpr std::array<std::array<int, 4>, 16> kInsideFirst = {{{0, 1, 2, 3},
                                                              {0, 1, 2, 3},
                                                              {1, 0, 3, 2},
                                                              {0, 1, 2, 3},
                                                              {2, 0, 1, 3},
                                                              {0, 2, 3, 1},
                                                              {1, 2, 0, 3},
                                                              {3, 0, 2, 1},
                                                              {3, 0, 2, 1},
                                                              {0, 3, 1, 2},
                                                              {1, 3, 2, 0},
                                                              {2, 0, 1, 3},
                                                              {2, 3, 0, 1},
                                                              {1, 0, 3, 2},
                                                              {0, 1, 2, 3},
                                                              {0, 1, 2, 3}}};

class Polygonizer {
  public:
    Polygonizer(const Shape& shape, float extent, float spacing)
        : shape_(shape), origin_(-extent - kShift * spacing), spacing_(spacing) {
        groups_ = static_cast<int>(
            std::ceil((2.0F * extent + spacing) / (spacing * kGroupBlocks * kBlockCells)));
    }

    Mesh run() {
        constexpr int kGroupCells = kGroupBlocks * kBlockCells;
        forEachIn(groups_, [&](const glm::ivec3& group) {
            if (!restrict(shape_, group * kGroupCells, kGroupCells, nearGroup_)) return;
            forEachIn(kGroupBlocks, [&](const glm::ivec3& block) {
                firstNode_ = group * kGroupCells + block * kBlockCells;
                if (restrict(nearGroup_, firstNode_, kBlockCells, near_)) addBlock();
            });
        });
        return std::move(mesh_);
    }

  private:
    /// Calls visit for every (x, y, z) in [0, count)³.
    template <class Visit>
    static void forEachIn(int count, const Visit& visit) {
        for (int z = 0; z < count; ++z) {
            for (int y = 0; y < count; ++y) {
                for (int x = 0; x < count; ++x) visit(glm::ivec3(x, y, z));
            }
        }
    }

    /// What `shape` is in a cube of cells and around it, as far as onSurface() looks.
    bool restrict(const Shape& shape, const glm::ivec3& firstNode, int cells, Shape& near) const {
        const float halfSide = 0.5F * spacing_ * static_cast<float>(cells);
        const float reach = std::sqrt(3.0F) * halfSide + 1.2F * spacing_;
        return shape.restrictTo(positionOf(firstNode) + halfSide, reach, near);
    }

    glm::vec3 positionOf(const glm::ivec3& node) const {
        return origin_ + spacing_ * glm::vec3(node);
    }
    static glm::ivec3 offsetOf(int corner) {
        return {corner & 1, (corner >> 1) & 1, (corner >> 2) & 1};
    }
    float& valueAt(const glm::ivec3& local) {
        return values_[static_cast<std::size_t>((local.z * kBlockNodes + local.y) * kBlockNodes +
                                                local.x)];
    }

    void addBlock() {
        forEachIn(kBlockNodes, [&](const glm::ivec3& node) {
            valueAt(node) = near_.distance(positionOf(firstNode_ + node));
        });
        forEachIn(kBlockCells, [&](const glm::ivec3& cell) { addCell(cell); });
    }

    void addCell(const glm::ivec3& cell) {
        std::array<float, 8> corners{};
        int inside = 0;
        for (int c = 0; c < 8; ++c) {
            corners[static_cast<std::size_t>(c)] = valueAt(cell + offsetOf(c));
            if (corners[static_cast<std::size_t>(c)] < -kSnap * spacing_) inside |= 1 << c;
        }
        if (inside == 0 || inside == 255) return;
        for (const std::array<int, 4>& tetrahedron : kTetrahedra) {
            addTetrahedron(firstNode_ + cell, tetrahedron, corners, inside);
        }
    }

    void addTetrahedron(const glm::ivec3& node, const std::array<int, 4>& tetrahedron,
                        const std::array<float, 8>& corners, int inside) {
        std::size_t mask = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            if ((inside >> tetrahedron[i]) & 1) mask |= std::size_t{1} << i;
        }
        if (mask == 0 || mask == 15) return;
        std::array<int, 4> c{};
        for (std::size_t i = 0; i < 4; ++i) {
            c[i] = tetrahedron[static_cast<std::size_t>(kInsideFirst[mask][i])];
        }
        const auto cut = [&](std::size_t i, std::size_t j) {
            return vertexOn(node, c[i], c[j], corners);
        };
        const int count = std::popcount(mask);
        if (count == 2) {
            const std::uint32_t quad[4] = {cut(0, 2), cut(0, 3), cut(1, 3), cut(1, 2)};
            mesh_.triangles.emplace_back(quad[0], quad[1], quad[2]);
            mesh_.triangles.emplace_back(quad[0], quad[2], quad[3]);
        } else {  // of three inside, kInsideFirst puts the outside corner first
            const std::size_t second = count == 1 ? 2 : 3, third = 5 - second;
            const std::uint32_t triangle[3] = {cut(0, third), cut(0, second), cut(0, 1)};
            mesh_.triangles.emplace_back(triangle[2], triangle[1], triangle[0]);
        }
    }

    /// The one vertex on the grid edge between two corners of a cube.
    std::uint32_t vertexOn(const glm::ivec3& node, int a, int b,
                           const std::array<float, 8>& corners) {
        if (a > b) std::swap(a, b);  // a's mask is contained in b's
        const glm::ivec3 from = node + offsetOf(a);
        const auto key =
            static_cast<std::uint64_t>(from.x) | (static_cast<std::uint64_t>(from.y) << 20) |
            (static_cast<std::uint64_t>(from.z) << 40) | (static_cast<std::uint64_t>(b - a) << 60);
        const auto [index, isNew] = table_.number(key);
        if (isNew) {
            const float valueA = corners[static_cast<std::size_t>(a)];
            const float valueB = corners[static_cast<std::size_t>(b)];
            const float t = std::clamp(valueA / (valueA - valueB), kEndMargin, 1.0F - kEndMargin);
            const glm::vec3 start = positionOf(from);
            mesh_.positions.push_back(
                onSurface(start + t * (positionOf(node + offsetOf(b)) - start)));
        }
        return index;
    }

    /// Two Newton steps along the gradient, each at most half a cell.
    glm::vec3 onSurface(glm::vec3 p) const {
        float distance = near_.distance(p);
        const glm::vec3 slope = near_.gradient(p, distance, 0.05F * spacing_);
        const glm::vec3 inverseSlope = slope / std::max(glm::dot(slope, slope), 0.01F);
        for (int step = 0; step < 2; ++step) {
            glm::vec3 move = -distance * inverseSlope;
            const float length = glm::length(move);
            if (length > 0.5F * spacing_) move *= 0.5F * spacing_ / length;
            p += move;
            if (step == 0) distance = near_.distance(p);
        }
        return p;
    }

    const Shape& shape_;
    glm::vec3 origin_;
    float spacing_;
    int groups_ = 0;
    Mesh mesh_;
    KeyNumbers<std::uint64_t> table_;
    // Of the block in progress:
    Shape nearGroup_;
    Shape near_;
    glm::ivec3 firstNode_{0};
    std::array<float, static_cast<std::size_t>(kBlockNodes* kBlockNodes* kBlockNodes)> values_{};
};

}  // namespace

Mesh polygonized(const Shape& shape, float extent, float spacing) {
    return Polygonizer(shape, extent, spacing).run();
}

}  // namespace gfxrepro::scene::sdf
