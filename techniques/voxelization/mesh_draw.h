// Draws a mesh along an axis so that its fragments become voxels: the part that rasterization and
// the one-pass baselines share.
#pragma once

#include "techniques/voxelization/device_mesh.h"

namespace gfxrepro::voxelization {

/// Where the fragments' voxels go.
enum class DrawTarget {
    FragmentList,  // bound at kRecordBinding and kCounterBinding
    Grid,          // the z layout, bound as an image at kSheetUnit
    GridSlice,     // as Grid, one slice of the drawn axis at a time
};

class MeshDraw {
  public:
    MeshDraw(const gl::ShaderLibrary& shaders, const MeshRequest& request, DrawTarget target);

    const gl::Program& program() const { return program_; }
    /// Draws the triangles that the rule projects along `axis`, into an N × N framebuffer without
    /// attachments.
    void draw(const DeviceMesh& mesh, Axis axis) const;
    /// As draw(), with the voxels of slice `slice` of the axis only.
    void drawSlice(const DeviceMesh& mesh, Axis axis, int slice) const;

  private:
    void drawExact(const DeviceMesh& mesh, Axis axis) const;

    gl::Program program_;
    gl::Framebuffer framebuffer_;
    gl::VertexArray noAttributes_;
    glm::vec3 boxCentreWorld_;
    float clipFromWorldScale_;
    bool isExact_;
    bool drawsAllAxes_;
};

}  // namespace gfxrepro::voxelization
