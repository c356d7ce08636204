// What a collision test answers: how many voxels two models share, and where. [zju2005] Sec. 2.4.3.
#pragma once

#include <cstdint>

#include "engine/gl/pass.h"
#include "techniques/voxelization/worksheet.h"

namespace gfxrepro::voxelization {

/// The full voxels of a grid.
struct GridExtent {
    std::uint32_t count = 0;
    glm::ivec3 lowest{0};   // voxels, inclusive; meaningless when there is none
    glm::ivec3 highest{0};  // voxels, inclusive

    /// World space; empty when there is no full voxel.
    scene::Box bounds(const VoxelGrid& grid) const;
};

/// Finds the extent of a grid, on the device.
class ExtentPass {
  public:
    ExtentPass(const gl::ShaderLibrary& shaders, const WorksheetLayout& layout);
    void run(const gl::Texture& sheets);
    /// Of the last run; waits for the device.
    GridExtent read() const;

  private:
    WorksheetLayout layout_;
    gl::Pass pass_;
    gl::Buffer extent_;
};

}  // namespace gfxrepro::voxelization
