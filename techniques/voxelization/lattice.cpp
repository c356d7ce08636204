#include "techniques/voxelization/lattice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"

namespace gfxrepro::voxelization {

LatticeMesh snapped(const scene::Mesh& mesh, const scene::Box& box, int resolution) {
    const glm::dvec3 origin(box.min);
    const double unitsPerMetre = static_cast<double>(resolution) * kLatticePerVoxel /
                                 (static_cast<double>(box.max.x) - static_cast<double>(box.min.x));
    const double limit = static_cast<double>(kMaxExtentVoxels) * kLatticePerVoxel;
    LatticeMesh result{.positions = {}, .triangles = mesh.triangles};
    result.positions.reserve(mesh.positions.size());
    for (const glm::vec3& position : mesh.positions) {
        const glm::dvec3 p = glm::floor((glm::dvec3(position) - origin) * unitsPerMetre + 0.5);
        const double farthest = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
        if (!(farthest <= limit)) {
            throw Error(fmt::format(
                "vertex {} lies {:.0f} voxels from the grid's corner; the exact rules allow {}",
                result.positions.size(), farthest / kLatticePerVoxel, kMaxExtentVoxels));
        }
        result.positions.emplace_back(p);
    }
    return result;
}

bool isWide(const scene::Mesh& mesh, const scene::Box& box, int resolution) {
    const glm::vec3 size = mesh.bounds().size();
    const float voxels = static_cast<float>(resolution) / box.size().x;
    const float margin = 1.0F;  // corners are rounded to the lattice
    return voxels * std::max({size.x, size.y, size.z}) + margin > kIntegerExtentVoxels;
}

}  // namespace gfxrepro::voxelization
