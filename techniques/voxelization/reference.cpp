#include "techniques/voxelization/reference.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>

namespace gfxrepro::voxelization::reference {
namespace {

using Triangle = std::array<glm::dvec3, 3>;  // lattice units, local (u, v, w)

/// A grid of bits that threads may fill together.
class SharedBits {
  public:
    explicit SharedBits(const GridShape& shape) : layout_(shape, 1), words_(layout_.wordCount()) {}
    const GridShape& shape() const { return layout_.shape(); }
    void set(const glm::ivec3& voxel) {
        std::atomic_ref(word(voxel)).fetch_or(1U << layout_.shift(voxel.z));
    }
    void toggle(const glm::ivec3& voxel) {
        std::atomic_ref(word(voxel)).fetch_xor(1U << layout_.shift(voxel.z));
    }
    DenseGrid grid() && { return DenseGrid(layout_, std::move(words_)); }

  private:
    std::uint32_t& word(const glm::ivec3& voxel) { return words_[layout_.wordIndex(voxel)]; }
    WorksheetLayout layout_;
    std::vector<std::uint32_t> words_;
};

template <class Visit>
void forEachTriangle(const LatticeMesh& mesh, Axis axis, Visit visit) {
    tbb::parallel_for(std::size_t{0}, mesh.triangles.size(), [&](std::size_t i) {
        Triangle triangle;
        for (int k = 0; k < 3; ++k) {
            triangle[static_cast<std::size_t>(k)] =
                localFromVolume(axis, glm::dvec3(mesh.positions[mesh.triangles[i][k]]));
        }
        visit(triangle);
    });
}

/// Voxel indices whose closed extent meets [low, high] lattice units, within the grid.
glm::ivec3 firstVoxel(const Triangle& t) {
    const glm::dvec3 low = glm::min(t[0], glm::min(t[1], t[2]));
    return glm::max(glm::ivec3(glm::ceil(low / 256.0)) - 1, glm::ivec3(0));
}
glm::ivec3 lastVoxel(const Triangle& t, const glm::ivec3& size) {
    const glm::dvec3 high = glm::max(t[0], glm::max(t[1], t[2]));
    return glm::min(glm::ivec3(glm::floor(high / 256.0)), size - 1);
}

/// Whether the projections on `axis` of the triangle and of the cube, half a lattice unit larger on
/// all sides, are apart.
bool isSeparating(const glm::dvec3& axis, const Triangle& t) {
    const double radius = 128.5 * (std::abs(axis.x) + std::abs(axis.y) + std::abs(axis.z));
    const double a = glm::dot(axis, t[0]);
    const double b = glm::dot(axis, t[1]);
    const double c = glm::dot(axis, t[2]);
    return std::min({a, b, c}) > radius || std::max({a, b, c}) < -radius;
}

bool overlaps(const Triangle& triangle, const glm::ivec3& voxel) {
    const glm::dvec3 centre = glm::dvec3(voxel) * 256.0 + 128.0;
    const Triangle t = {triangle[0] - centre, triangle[1] - centre, triangle[2] - centre};
    const std::array<glm::dvec3, 3> edges = {t[1] - t[0], t[2] - t[1], t[0] - t[2]};
    const std::array<glm::dvec3, 3> units = {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0),
                                             glm::dvec3(0, 0, 1)};
    for (const glm::dvec3& unit : units) {
        if (isSeparating(unit, t)) return false;
        for (const glm::dvec3& edge : edges) {
            if (isSeparating(glm::cross(unit, edge), t)) return false;
        }
    }
    return !isSeparating(glm::cross(edges[0], edges[1]), t);
}

/// The sign of `value`, or where it is 0 that of the direction (ε, ε², ε³), in x, y, z, along
/// `gradient`, which is given in local coordinates.
double shiftedSign(double value, Axis axis, const glm::dvec3& gradient) {
    if (value != 0.0) return value;
    const glm::dvec3 g = volumeFromLocal(axis, gradient);
    return g.x != 0.0 ? g.x : g.y != 0.0 ? g.y : g.z;
}

/// Where the line through a pixel's centre crosses a triangle.
struct Crossing {
    glm::ivec3 voxel;     // local; the one that holds the crossing
    bool isBeforeCentre;  // of the voxel, so that the centre lies behind
    bool isOnVoxelFloor;  // exactly
};

/// Calls visit(Crossing) for each of the axis's lines that crosses the triangle; `size` of the
/// grid, local.
template <class Visit>
void visitCrossings(const Triangle& t, Axis axis, const glm::ivec3& size, Visit visit) {
    const glm::dvec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
    if (normal.z == 0.0) return;
    const double side = normal.z > 0.0 ? 1.0 : -1.0;
    const glm::ivec3 first = firstVoxel(t);
    const glm::ivec3 last = lastVoxel(t, size);
    for (int v = first.y; v <= last.y; ++v) {
        for (int u = first.x; u <= last.x; ++u) {
            const glm::dvec3 p(u * 256.0 + 128.0, v * 256.0 + 128.0, 0.0);
            bool isInside = true;
            for (std::size_t k = 0; k < 3 && isInside; ++k) {
                const glm::dvec3 edge = t[(k + 1) % 3] - t[k];
                const glm::dvec3 offset = p - t[k];
                const glm::dvec3 gradient(-edge.y * side, edge.x * side, 0.0);
                isInside = shiftedSign(gradient.x * offset.x + gradient.y * offset.y, axis,
                                       gradient) > 0.0;
            }
            if (!isInside) continue;
            // Height above the plane, positive where w is larger than the crossing's.
            const auto above = [&](double w) {
                return side * glm::dot(normal, glm::dvec3(p.x, p.y, w) - t[0]);
            };
            const double height =
                t[0].z - (normal.x * (p.x - t[0].x) + normal.y * (p.y - t[0].y)) / normal.z;
            int w = static_cast<int>(std::floor(height / 256.0));
            while (above(w * 256.0) > 0.0) --w;
            while (above(w * 256.0 + 256.0) <= 0.0) ++w;
            const double atCentre = shiftedSign(above(w * 256.0 + 128.0), axis, side * normal);
            visit(Crossing{{u, v, w}, atCentre > 0.0, above(w * 256.0) == 0.0});
        }
    }
}

/// Sets the voxels in which lines along `axis` cross the triangles that takes(triangle) names.
template <class Takes>
void setCrossed(SharedBits& bits, const LatticeMesh& mesh, Axis axis, Takes takes) {
    const glm::ivec3 size = localFromVolume(axis, bits.shape().size);
    forEachTriangle(mesh, axis, [&](const Triangle& t) {
        if (!takes(t)) return;
        visitCrossings(t, axis, size, [&](const Crossing& crossing) {
            glm::ivec3 voxel = crossing.voxel;
            // The grid is closed: its far face belongs to the last voxel.
            if (voxel.z == size.z && crossing.isOnVoxelFloor) --voxel.z;
            if (voxel.z < 0 || voxel.z >= size.z) return;
            bits.set(volumeFromLocal(axis, voxel));
        });
    });
}

/// Whether the centres along one axis lie inside; `oddLines` counts lines crossed an odd number of
/// times.
DenseGrid insideAlong(const LatticeMesh& mesh, Axis axis, const GridShape& shape,
                      std::size_t& oddLines) {
    const glm::ivec3 size = localFromVolume(axis, shape.size);
    const auto flipsPerLine = static_cast<std::size_t>(size.z) + 1;
    const auto lineOf = [&](int u, int v) {
        return static_cast<std::size_t>(v) * static_cast<std::size_t>(size.x) +
               static_cast<std::size_t>(u);
    };
    // toggles[line · (N + 1) + w]: the flag flips before centre w; w = N: behind the grid.
    std::vector<std::uint8_t> toggles(lineOf(0, size.y) * flipsPerLine);
    forEachTriangle(mesh, axis, [&](const Triangle& t) {
        visitCrossings(t, axis, size, [&](const Crossing& crossing) {
            const int w = crossing.voxel.z + (crossing.isBeforeCentre ? 0 : 1);
            const auto at = static_cast<std::size_t>(std::clamp(w, 0, size.z));
            const std::size_t line = lineOf(crossing.voxel.x, crossing.voxel.y);
            std::atomic_ref(toggles[line * flipsPerLine + at]).fetch_xor(1);
        });
    });
    DenseGrid inside(WorksheetLayout(shape, 1));
    for (int v = 0; v < size.y; ++v) {
        for (int u = 0; u < size.x; ++u) {
            const std::uint8_t* flips = &toggles[lineOf(u, v) * flipsPerLine];
            bool isInside = false;
            for (int w = 0; w < size.z; ++w) {
                isInside ^= flips[w] != 0;
                if (isInside) inside.set(volumeFromLocal(axis, glm::ivec3(u, v, w)), 1);
            }
            if (isInside != (flips[size.z] != 0)) ++oddLines;
        }
    }
    return inside;
}

}  // namespace

DenseGrid conservative(const LatticeMesh& mesh, const GridShape& shape) {
    SharedBits bits(shape);
    forEachTriangle(mesh, Axis::Z, [&](const Triangle& t) {
        const glm::ivec3 first = firstVoxel(t);
        const glm::ivec3 last = lastVoxel(t, shape.size);
        for (int z = first.z; z <= last.z; ++z) {
            for (int y = first.y; y <= last.y; ++y) {
                for (int x = first.x; x <= last.x; ++x) {
                    if (overlaps(t, {x, y, z})) bits.set({x, y, z});
                }
            }
        }
    });
    return std::move(bits).grid();
}

DenseGrid thin(const LatticeMesh& mesh, const GridShape& shape) {
    SharedBits bits(shape);
    for (Axis axis : kAxes) {
        setCrossed(bits, mesh, axis, [](const Triangle&) { return true; });
    }
    return std::move(bits).grid();
}

DenseGrid thinAlongDominantAxes(const LatticeMesh& mesh, const GridShape& shape) {
    SharedBits bits(shape);
    for (Axis axis : kAxes) {
        setCrossed(bits, mesh, axis, [&](const Triangle& t) {
            const auto corner = [&](const glm::dvec3& p) {
                return glm::vec3(volumeFromLocal(axis, p));
            };
            return dominantAxis(corner(t[0]), corner(t[1]), corner(t[2])) == axis;
        });
    }
    return std::move(bits).grid();
}

std::size_t countOddScanLines(const LatticeMesh& mesh, const GridShape& shape) {
    std::size_t odd = 0;
    for (Axis axis : kAxes) {
        SharedBits bits(shape);
        setCrossed(bits, mesh, axis, [](const Triangle&) { return true; });
        const DenseGrid grid = std::move(bits).grid();
        const glm::ivec3 size = localFromVolume(axis, shape.size);
        for (int v = 0; v < size.y; ++v) {
            for (int u = 0; u < size.x; ++u) {
                bool isOdd = false;
                for (int w = 0; w < size.z; ++w) {
                    isOdd ^= grid.isFull(volumeFromLocal(axis, glm::ivec3(u, v, w)));
                }
                odd += isOdd ? 1 : 0;
            }
        }
    }
    return odd;
}

SolidVoxels solid(const LatticeMesh& mesh, const GridShape& shape) {
    SolidVoxels result;
    const DenseGrid x = insideAlong(mesh, Axis::X, shape, result.ambiguousScanLines);
    const DenseGrid y = insideAlong(mesh, Axis::Y, shape, result.ambiguousScanLines);
    const DenseGrid z = insideAlong(mesh, Axis::Z, shape, result.ambiguousScanLines);
    std::vector<std::uint32_t> words(x.words().size());
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::uint32_t a = x.words()[i];
        const std::uint32_t b = y.words()[i];
        const std::uint32_t c = z.words()[i];
        words[i] = (a & b) | (b & c) | (c & a);
        result.disagreeingVoxels += static_cast<std::size_t>(std::popcount((a ^ b) | (b ^ c)));
    }
    result.grid = DenseGrid(x.layout(), std::move(words));
    return result;
}

std::size_t countMissing(const DenseGrid& expected, const DenseGrid& grid) {
    const glm::ivec3& size = expected.shape().size;
    GFXREPRO_ASSERT(size == grid.shape().size);
    std::atomic<std::size_t> missing = 0;
    tbb::parallel_for(0, size.z, [&](int z) {
        std::size_t count = 0;
        for (int y = 0; y < size.y; ++y) {
            for (int x = 0; x < size.x; ++x) {
                if (expected.isFull({x, y, z}) && !grid.isFull({x, y, z})) ++count;
            }
        }
        missing += count;
    });
    return missing;
}

}  // namespace gfxrepro::voxelization::reference
