#include "techniques/voxelization/mesh_voxelizer.h"

#include "engine/gpu_scene/gpu_mesh.h"

namespace gfxrepro::voxelization {
namespace {

/// Image atomics straight into the grid, no directional sheets: in one pass, or, as [zju2005]
/// Sec. 2.5.3 has it, the whole mesh drawn once per slice, as often as the longest side has voxels.
/// Departure [zju2005] Sec. 2.5.3: triangles outside the slice are culled, not clipped, and a
/// fragment's depth decides; clipping would move the edges, and each triangle keeps its own axis,
/// so that the result is the same grid.
class GridMethod : public MeshMethod {
  public:
    GridMethod(technique::SetupContext& context, const MeshRequest& request, DrawTarget target)
        : draw_(context.shaders, request, target),
          drawCount_(target == DrawTarget::GridSlice ? request.layout().shape().longest() : 1),
          grid_{makeSheets(request.layout()), request.layout(), request.box} {}

    void run(const DeviceMesh& mesh, gl::Profiler& profiler) override {
        gl::GpuScope scope(profiler, "voxelization");
        grid_.sheets.clearToZero();
        draw_.pass().use({{"sheet", grid_.sheets}});
        for (int slice = 0; slice < drawCount_; ++slice) {
            draw_.pass().setIfActive("slice", slice);
            for (Axis axis : kAxes) {
                if (slice < localFromVolume(axis, grid_.layout.shape().size).z) {
                    draw_.draw(mesh, axis);
                }
            }
        }
    }
    const VoxelGrid* grid() const override { return &grid_; }
    std::size_t sizeBytes() const override { return grid_.sheets.sizeBytes(); }

  private:
    MeshDraw draw_;
    int drawCount_;
    VoxelGrid grid_;
};

/// The yardstick of speed: the mesh's depth along z, a pixel a voxel.
class DepthOnlyMethod : public MeshMethod {
  public:
    DepthOnlyMethod(technique::SetupContext& context, const MeshRequest& request)
        : pass_(context.shaders, {"voxelization/depth_only.vert.glsl"},
                gpu_scene::attributeDefines()),
          depth_(gl::Texture::make2D(GL_DEPTH_COMPONENT32F,
                                     glm::ivec2(request.layout().shape().size))),
          framebuffer_({}, &depth_),
          boxCentreWorld_(request.box.centre()),
          clipFromWorldScale_(clipFromWorldScale(request.box, request.layout().shape())) {}

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
    std::size_t sizeBytes() const override { return depth_.sizeBytes(); }

  private:
    gl::Pass pass_;
    gl::Texture depth_;
    gl::Framebuffer framebuffer_;
    glm::vec3 boxCentreWorld_, clipFromWorldScale_;
};

std::unique_ptr<MeshMethod> makeMethod(technique::SetupContext& context, const MeshRequest& request,
                                       const DeviceMesh& mesh) {
    switch (request.settings.method) {
        case Method::Worksheet:
            break;
        case Method::Direct:
            if (request.isExact()) return makeExactMethod(context, request, mesh);
            return std::make_unique<GridMethod>(context, request, DrawTarget::Grid);
        case Method::Slices:
            return std::make_unique<GridMethod>(context, request, DrawTarget::GridSlice);
        case Method::DepthOnly:
            return std::make_unique<DepthOnlyMethod>(context, request);
    }
    return makeWorksheetMethod(context, request, mesh);
}

}  // namespace

MeshVoxelizer::MeshVoxelizer(const MeshVoxelizerSettings& settings, const scene::Mesh& mesh,
                             const scene::Box& box)
    : request_{mesh, box, settings} {}

void MeshVoxelizer::setup(technique::SetupContext& context) {
    {
        gl::CpuScope scope(context.profiler, "preprocess");
        splitByAxis(request_.mesh.positions, request_.mesh.triangles, split_);
    }
    deviceMesh_.emplace(request_, split_, context.device.limits());
    if (request_.settings.split == Split::Once) split_.triangles = {};
    method_ = makeMethod(context, request_, *deviceMesh_);
}

void MeshVoxelizer::render(gl::Profiler& profiler) {
    if (request_.settings.split == Split::EveryFrame) {
        gl::CpuScope scope(profiler, "preprocess");
        splitByAxis(request_.mesh.positions, request_.mesh.triangles, split_);
        deviceMesh_->update(split_);
    }
    method_->run(*deviceMesh_, profiler);
}

void MeshVoxelizer::record(technique::Recorder& recorder) {
    method_->record(recorder);
    recorder.metric("memory_bytes",
                    static_cast<double>(deviceMesh_->sizeBytes() + method_->sizeBytes()));
}

}  // namespace gfxrepro::voxelization
