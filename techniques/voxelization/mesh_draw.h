// Draws a mesh along an axis so that its fragments become voxels: the part that rasterization and
// the one-pass baselines share.
#pragma once

#include "techniques/voxelization/device_mesh.h"

namespace gfxrepro::voxelization {

/// Where the fragments' voxels go.
enum class DrawTarget {
    FragmentList,  // the blocks Records and Counters
    Grid,          // the z layout, the image `sheet`
    GridSlice,     // as Grid, one slice of the drawn axis at a time
};

class MeshDraw {
  public:
    MeshDraw(const gl::ShaderLibrary& shaders, const MeshRequest& request, DrawTarget target);

    const gl::Pass& pass() const { return pass_; }
    /// For the draws that follow; `target` is what the DrawTarget names. Not before each of them
    /// where it stays: llvmpipe finishes what was drawn when an image is bound again.
    void use(const DeviceMesh& mesh, const gl::Resources& target) const;
    /// Draws the triangles that the rule projects along `axis`, into an N × N framebuffer without
    /// attachments. Slices: the pass's uniform `slice` says which one.
    void draw(const DeviceMesh& mesh, Axis axis) const;

  private:
    void drawExact(const DeviceMesh& mesh, Axis axis) const;

    gl::Pass pass_;
    gl::Framebuffer framebuffer_;
    gl::VertexArray noAttributes_;
    glm::vec3 boxCentreWorld_;
    float clipFromWorldScale_;
    bool isExact_;
    bool drawsAllAxes_;
};

}  // namespace gfxrepro::voxelization
