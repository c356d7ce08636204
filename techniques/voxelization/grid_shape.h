// How many voxels a grid has along each axis.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <glm/glm.hpp>
#include <string>

namespace gfxrepro::voxelization {

/// L × M × N voxels along x, y and z, all cubes of one size. [zju2005] Sec. 2.2.2. A number stands
/// for as many along each axis.
struct GridShape {
    glm::ivec3 size{1};

    GridShape() = default;
    GridShape(int edge) : size(edge) {}
    explicit GridShape(const glm::ivec3& voxels) : size(voxels) {}

    /// Of equal ones the first.
    int longestAxis() const {
        return size.x >= std::max(size.y, size.z) ? 0 : size.y >= size.z ? 1 : 2;
    }
    int longest() const { return size[longestAxis()]; }
    std::size_t voxelCount() const {
        return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) *
               static_cast<std::size_t>(size.z);
    }
    bool has(const glm::ivec3& voxel) const {
        return glm::all(glm::greaterThanEqual(voxel, glm::ivec3(0))) &&
               glm::all(glm::lessThan(voxel, size));
    }
    /// "256³" or "300 × 20 × 160".
    std::string text() const {
        if (size == glm::ivec3(size.x)) return fmt::format("{}³", size.x);
        return fmt::format("{} × {} × {}", size.x, size.y, size.z);
    }

    bool operator==(const GridShape&) const = default;
};

/// Calls visit(voxel) for all of a grid, x fastest, then y.
template <class Visit>
void forEachVoxel(const GridShape& shape, Visit&& visit) {
    for (int z = 0; z < shape.size.z; ++z)
        for (int y = 0; y < shape.size.y; ++y)
            for (int x = 0; x < shape.size.x; ++x) visit(glm::ivec3(x, y, z));
}

}  // namespace gfxrepro::voxelization
