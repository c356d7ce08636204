// The mesh and the box of a voxelization, from the case's scene.
#pragma once

#include <optional>

#include "techniques/voxelization/grid_source.h"

namespace gfxrepro::voxelization {

/// Cubic, about the centre of `bounds`, with `paddingVoxels` free voxels at both ends of its
/// longest side, which has a length.
scene::Box cubicBox(const scene::Box& bounds, int resolution, int paddingVoxels);

/// All triangles of a scene in world space: the scene's own mesh where it is the only one and lies
/// there already, else a copy.
/// Throws Error for a scene without triangles, or with all of them at one point.
void requireVoxelizable(const scene::Scene& scene);

class MeshInput {
  public:
    /// `scene` must outlive this. For VoxelValue::Color, vertices without a colour take their
    /// material's.
    MeshInput(const scene::Scene& scene, VoxelValue value);
    MeshInput(const MeshInput&) = delete;
    MeshInput& operator=(const MeshInput&) = delete;

    const scene::Mesh& mesh() const { return copy_ ? *copy_ : *original_; }

  private:
    const scene::Mesh* original_ = nullptr;
    std::optional<scene::Mesh> copy_;
};

}  // namespace gfxrepro::voxelization
