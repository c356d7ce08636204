// Stage 2: fragments become bits of the directional sheets. [zju2005] Sec. 2.2.1, 2.2.2.
#pragma once

#include "techniques/voxelization/rasterization.h"

namespace gfxrepro::voxelization {

/// The sheets of the two axes that synthesis merges into the third, the grid's own.
struct DirectionalSheets {
    gl::Texture x;
    gl::Texture y;

    explicit DirectionalSheets(const WorksheetLayout& layout)
        : x(makeSheets(layout)), y(makeSheets(layout)) {}
};

/// What solid filling found; on the device.
struct SolidStatistics {
    std::uint32_t ambiguousScanLines = 0;  // over the three axes
    std::uint32_t disagreeingVoxels = 0;   // where the three axes differ
};

/// The tiles of C³ voxels that hold fragments (tiles.glsl): how many, a flag each, their indices.
/// Empty unless synthesis is sparse.
struct TileList {
    gl::Buffer buffer;
    std::size_t capacity = 0;
};

class Texelization {
  public:
    /// `fragments` holds what rasterization can make of the mesh.
    Texelization(const gl::ShaderLibrary& shaders, const MeshRequest& request,
                 const FragmentList& fragments);

    /// Clears the three sheets (that of z is grid's) and writes every fragment's voxel. `tables`:
    /// LookupTables::resources(), of Addressing::Tables only.
    void run(const FragmentList& fragments, DirectionalSheets& sheets, VoxelGrid& grid,
             const gl::Resources& tables);
    /// Solid: scan lines whose crossing lies behind the grid, one bit each, for each axis.
    const gl::Buffer& behind(Axis axis) const { return behind_[static_cast<std::size_t>(axis)]; }
    const TileList& tiles() const { return tiles_; }
    std::size_t sizeBytes() const;

  private:
    gl::Pass pass_;
    std::array<gl::Buffer, 3> behind_;
    TileList tiles_;
};

}  // namespace gfxrepro::voxelization
