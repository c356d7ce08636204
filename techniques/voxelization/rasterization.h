// Stage 1: every triangle, once, becomes fragments with a voxel position. [zju2005] Sec. 2.2.1.
#pragma once

#include "techniques/voxelization/mesh_draw.h"

namespace gfxrepro::voxelization {

/// The fragments of each axis, appended in any order; see shaders/emit_voxel.glsl.
struct FragmentList {
    std::array<gl::Buffer, 3> records;
    gl::Buffer counters = gl::Buffer(3 * sizeof(std::uint32_t));
    std::array<std::uint32_t, 3> capacities{};

    /// Fragments of each axis, those beyond the capacity too; waits for the device.
    std::array<std::uint32_t, 3> counts() const;
    std::size_t sizeBytes() const;
};

class Rasterization {
  public:
    /// Makes the list as long as a counting draw finds necessary. Throws UnsupportedError when a
    /// list would not fit a storage block.
    Rasterization(technique::SetupContext& context, const MeshRequest& request,
                  const DeviceMesh& mesh);

    /// Draws the mesh once, in three parts (thin and solid: once an axis).
    void run(const DeviceMesh& mesh);
    const FragmentList& fragments() const { return fragments_; }
    /// Fragments of the last run. Throws Error when they were more than the list holds.
    std::size_t checkedCount() const;

  private:
    MeshDraw draw_;
    FragmentList fragments_;
};

}  // namespace gfxrepro::voxelization
