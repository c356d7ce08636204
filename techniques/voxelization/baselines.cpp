// What the worksheet method is measured against.
#include "engine/gpu_scene/gpu_mesh.h"
#include "techniques/voxelization/mesh_voxelizer.h"

namespace gfxrepro::voxelization {
namespace {

/// Image atomics straight into the grid, no directional sheets: the modern comparator in one pass,
/// or, as [zju2005] Sec. 2.5.3 has it, the whole mesh drawn once per slice, N times in all.
/// Departure [zju2005] Sec. 2.5.3: triangles outside the slice are culled, not clipped, and a
/// fragment's depth decides; clipping would move the edges, and each triangle keeps its own axis,
/// so that the result is the same grid.
class GridMethod : public MeshMethod {
  public:
    GridMethod(technique::SetupContext& context, const MeshRequest& request, DrawTarget target)
        : draw_(context.shaders, request, target),
          drawCount_(target == DrawTarget::GridSlice ? request.settings.layout.resolution() : 1),
          grid_{makeSheets(request.settings.layout), request.settings.layout, request.box} {}

    void run(const DeviceMesh& mesh, gl::Profiler& profiler) override {
        gl::GpuScope scope(profiler, "voxelization");
        grid_.sheets.clearToZero();
        draw_.use(mesh, {{"sheet", grid_.sheets}});
        for (int slice = 0; slice < drawCount_; ++slice) {
            draw_.pass().setIfActive("slice", slice);
            for (Axis axis : kAxes) draw_.draw(mesh, axis);
        }
    }
    const VoxelGrid* grid() const override { return &grid_; }
    void record(technique::Recorder&) override {}
    std::size_t sizeBytes() const override { return grid_.sheets.sizeBytes(); }

  private:
    MeshDraw draw_;
    int drawCount_;
    VoxelGrid grid_;
};

/// The yardstick of speed: the mesh's depth along z in N × N pixels.
class DepthOnlyMethod : public MeshMethod {
  public:
    DepthOnlyMethod(technique::SetupContext& context, const MeshRequest& request)
        : pass_(context.shaders, {"voxelization/depth_only.vert.glsl"},
                gpu_scene::attributeDefines()),
          depth_(gl::Texture::make2D(GL_DEPTH_COMPONENT32F,
                                     glm::ivec2(request.settings.layout.resolution()))),
          framebuffer_({}, &depth_),
          boxCentreWorld_(request.box.centre()),
          clipFromWorldScale_(2.0F / request.box.size().x) {}

    void run(const DeviceMesh& mesh, gl::Profiler& profiler) override {
        gl::GpuScope scope(profiler, "draw_depth");
        framebuffer_.bind();
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_LESS);
        glDepthMask(GL_TRUE);
        glDisable(GL_CULL_FACE);
        framebuffer_.clearDepth(1.0F);
        pass_.set("boxCentreWorld", boxCentreWorld_);
        pass_.set("clipFromWorldScale", clipFromWorldScale_);
        pass_.use({});
        mesh.drawIndexed(mesh.allTriangles());
    }
    const VoxelGrid* grid() const override { return nullptr; }
    void record(technique::Recorder&) override {}
    std::size_t sizeBytes() const override { return depth_.sizeBytes(); }

  private:
    gl::Pass pass_;
    gl::Texture depth_;
    gl::Framebuffer framebuffer_;
    glm::vec3 boxCentreWorld_;
    float clipFromWorldScale_;
};

}  // namespace

std::unique_ptr<MeshMethod> makeBaseline(technique::SetupContext& context,
                                         const MeshRequest& request, Method method) {
    switch (method) {
        case Method::Direct:
            return std::make_unique<GridMethod>(context, request, DrawTarget::Grid);
        case Method::Slices:
            return std::make_unique<GridMethod>(context, request, DrawTarget::GridSlice);
        case Method::DepthOnly:
            return std::make_unique<DepthOnlyMethod>(context, request);
        case Method::Worksheet:
            break;
    }
    GFXREPRO_ASSERT(false);
    return nullptr;
}

}  // namespace gfxrepro::voxelization
