// Preprocess: the index buffer split in three by the axis of largest projected area.
// [zju2005] Sec. 2.3.1.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "techniques/voxelization/worksheet.h"

namespace gfxrepro::voxelization {

/// Triangles [first, first + count) of the split index buffer.
struct TriangleRange {
    int first = 0;
    int count = 0;
};

/// The triangles in the order x, y, z of their axes; within an axis in the mesh's order.
struct AxisSplit {
    std::vector<glm::uvec3> triangles;
    std::array<TriangleRange, 3> ranges;

    TriangleRange range(Axis axis) const { return ranges[static_cast<std::size_t>(axis)]; }
};

/// The axis on which the triangle's projected area is largest, so that it is never seen edge-on;
/// ties go to z, then y. Triangles without area go to z.
Axis dominantAxis(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

/// Time linear in the triangles; `split` keeps its memory from call to call.
void splitByAxis(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                 AxisSplit& split);

}  // namespace gfxrepro::voxelization
