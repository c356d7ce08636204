// Marching tetrahedra over the blocks of a cubic grid that the surface passes through.
#include <algorithm>
#include <array>
#include <cmath>

#include "runner/scene/key_table.h"
#include "runner/scene/sdf.h"

namespace gfxrepro::scene::sdf {

namespace {

constexpr int kBlockCells = 8;
constexpr int kBlockNodes = kBlockCells + 1;

/// Vertices stay this share of an edge away from its ends, so that no triangle shrinks to nothing
/// where the surface passes through a grid node.
constexpr float kEndMargin = 0.12F;

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
        : shape_(shape), origin_(-extent), spacing_(spacing) {
        blocks_ = static_cast<int>(std::ceil(2.0F * extent / (spacing * kBlockCells)));
    }

    Mesh run() {
        const float radius = 0.5F * std::sqrt(3.0F) * spacing_ * kBlockCells;
        for (int z = 0; z < blocks_; ++z) {
            for (int y = 0; y < blocks_; ++y) {
                for (int x = 0; x < blocks_; ++x) {
                    firstNode_ = glm::ivec3(x, y, z) * kBlockCells;
                    const glm::vec3 centre = positionOf(firstNode_) + 0.5F * spacing_ * kBlockCells;
                    // Twice the radius, for the steps that move vertices onto the surface.
                    if (shape_.restrictTo(centre, 2.0F * radius, near_)) addBlock();
                }
            }
        }
        return std::move(mesh_);
    }

  private:
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
        for (int z = 0; z < kBlockNodes; ++z) {
            for (int y = 0; y < kBlockNodes; ++y) {
                for (int x = 0; x < kBlockNodes; ++x) {
                    const glm::ivec3 local(x, y, z);
                    valueAt(local) = near_.distance(positionOf(firstNode_ + local));
                }
            }
        }
        for (int z = 0; z < kBlockCells; ++z) {
            for (int y = 0; y < kBlockCells; ++y) {
                for (int x = 0; x < kBlockCells; ++x) addCell({x, y, z});
            }
        }
    }

    void addCell(const glm::ivec3& cell) {
        std::array<float, 8> corners{};
        int inside = 0;
        for (int c = 0; c < 8; ++c) {
            corners[static_cast<std::size_t>(c)] = valueAt(cell + offsetOf(c));
            if (corners[static_cast<std::size_t>(c)] < 0.0F) inside |= 1 << c;
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
        } else if (count == 1) {
            mesh_.triangles.emplace_back(cut(0, 1), cut(0, 2), cut(0, 3));
        } else {  // three inside: kInsideFirst puts the outside corner first here
            mesh_.triangles.emplace_back(cut(0, 1), cut(0, 3), cut(0, 2));
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

    /// Newton steps along the gradient, each at most half a cell.
    glm::vec3 onSurface(glm::vec3 p) const {
        for (int step = 0; step < 2; ++step) {
            const glm::vec3 slope = near_.gradient(p, 0.05F * spacing_);
            const float squaredSlope = std::max(glm::dot(slope, slope), 0.01F);
            glm::vec3 move = slope * (-near_.distance(p) / squaredSlope);
            const float length = glm::length(move);
            if (length > 0.5F * spacing_) move *= 0.5F * spacing_ / length;
            p += move;
        }
        return p;
    }

    const Shape& shape_;
    glm::vec3 origin_;
    float spacing_;
    int blocks_ = 0;
    Mesh mesh_;
    KeyTable<std::uint64_t> table_;
    // Of the block in progress:
    Shape near_;
    glm::ivec3 firstNode_{0};
    std::array<float, static_cast<std::size_t>(kBlockNodes* kBlockNodes* kBlockNodes)> values_{};
};

}  // namespace

Mesh polygonized(const Shape& shape, float extent, float spacing) {
    return Polygonizer(shape, extent, spacing).run();
}

}  // namespace gfxrepro::scene::sdf
