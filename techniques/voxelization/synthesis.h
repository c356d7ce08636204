// Stage 3: the directional sheets become one grid of the z layout; solid filling before it.
// [zju2005] Sec. 2.2.1, 2.2.3.
#pragma once

#include "techniques/voxelization/texelization.h"

namespace gfxrepro::voxelization {

/// Solid only: turns the crossings (or surface voxels) in the sheets into inside flags, scan line
/// by scan line.
class SolidFill {
  public:
    SolidFill(const gl::ShaderLibrary& shaders, const MeshRequest& request);
    void run(const Texelization& texelization, const DirectionalSheets& sheets,
             const VoxelGrid& grid, gl::Buffer& statistics);

  private:
    gl::Pass pass_;
    unsigned groupsAcross_;
};

/// Merges the sheets of x and y into the grid's: OR, the largest value, or the majority
/// (solid by crossings).
class Synthesis {
  public:
    Synthesis(const gl::ShaderLibrary& shaders, const MeshRequest& request);
    /// `tiles` are texelization's (used by Merging::Sparse only), `statistics` holds
    /// SolidStatistics (used by solid only), `tables` are as Texelization::run() takes them.
    void run(const DirectionalSheets& sheets, const VoxelGrid& grid, const TileList& tiles,
             const gl::Buffer& statistics, const gl::Resources& tables);

  private:
    gl::Pass pass_;
    Merging merging_;
};

}  // namespace gfxrepro::voxelization
