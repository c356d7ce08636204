#include "techniques/voxelization/mesh_voxelizer.h"

#include <fmt/format.h>

namespace gfxrepro::voxelization {
namespace {

/// [zju2005] Sec. 2.2.1: three stages over three directional sheets.
class WorksheetMethod : public MeshMethod {
  public:
    WorksheetMethod(technique::SetupContext& context, const MeshRequest& request,
                    const DeviceMesh& mesh, OpenMesh openMesh)
        : rasterization_(context, request, mesh),
          texelization_(context.shaders, request, rasterization_.fragments()),
          synthesis_(context.shaders, request),
          sheets_(request.settings.layout),
          grid_{makeSheets(request.settings.layout), request.settings.layout, request.box},
          openMesh_(openMesh),
          takesMajority_(request.fillsByCrossings()) {
        if (request.addressing == Addressing::Tables) tables_.emplace(request.settings.layout);
        if (request.isSolid()) solidFill_.emplace(context.shaders, request);
    }

    void run(const DeviceMesh& mesh, gl::Profiler& profiler) override {
        gl::GpuScope whole(profiler, "voxelization");
        const gl::Resources tables = tables_ ? tables_->resources() : gl::Resources{};
        {
            gl::GpuScope scope(profiler, "rasterization");
            rasterization_.run(mesh);
        }
        {
            gl::GpuScope scope(profiler, "texelization");
            texelization_.run(rasterization_.fragments(), sheets_, grid_, tables);
        }
        if (solidFill_) {
            gl::GpuScope scope(profiler, "fill");
            solidFill_->run(texelization_, sheets_, grid_, statistics_);
        }
        gl::GpuScope scope(profiler, "synthesis");
        synthesis_.run(sheets_, grid_, texelization_.tiles(), statistics_, tables);
    }

    const VoxelGrid* grid() const override { return &grid_; }

    void record(technique::Recorder& recorder) override {
        const std::size_t fragments = rasterization_.checkedCount();
        recorder.metric("fragments", static_cast<double>(fragments), "fragment");
        if (!solidFill_) return;
        const SolidStatistics found = statistics_.read<SolidStatistics>(1).front();
        if (openMesh_ == OpenMesh::Refuse && found.ambiguousScanLines > 0) {
            throw Error(
                fmt::format("the mesh is not closed: {} of {} scan lines end inside; "
                            "'open_mesh: report' fills what two of three axes agree on",
                            found.ambiguousScanLines,
                            3 * grid_.layout.resolution() * grid_.layout.resolution()));
        }
        recorder.metric("ambiguous_scan_lines", found.ambiguousScanLines, "scan line");
        if (takesMajority_) {
            recorder.metric("disagreeing_voxels", found.disagreeingVoxels, "voxel");
        }
    }

    std::size_t sizeBytes() const override {
        return 3 * grid_.layout.sizeBytes() + rasterization_.fragments().sizeBytes() +
               texelization_.sizeBytes() + statistics_.sizeBytes() +
               (tables_ ? tables_->sizeBytes() : 0);
    }

  private:
    Rasterization rasterization_;
    Texelization texelization_;
    std::optional<LookupTables> tables_;
    std::optional<SolidFill> solidFill_;
    Synthesis synthesis_;
    DirectionalSheets sheets_;
    VoxelGrid grid_;
    gl::Buffer statistics_ = gl::Buffer(sizeof(SolidStatistics));
    OpenMesh openMesh_;
    bool takesMajority_;
};

}  // namespace

MeshVoxelizer::MeshVoxelizer(const MeshVoxelizerSettings& settings, const scene::Mesh& mesh,
                             const scene::Box& box)
    : settings_(settings),
      request_{.mesh = mesh,
               .box = box,
               .settings = settings.grid,
               .rule = settings.rule,
               .merging = settings.merging,
               .addressing = settings.addressing,
               .fillRule = settings.fillRule} {}

void MeshVoxelizer::setup(technique::SetupContext& context) {
    {
        gl::CpuScope scope(context.profiler, "preprocess");
        splitByAxis(request_.mesh.positions, request_.mesh.triangles, split_);
    }
    deviceMesh_.emplace(request_, split_, context.device.limits());
    if (settings_.split == Split::Once) split_.triangles = {};
    if (settings_.method == Method::Worksheet) {
        method_ =
            std::make_unique<WorksheetMethod>(context, request_, *deviceMesh_, settings_.openMesh);
    } else {
        method_ = makeBaseline(context, request_, settings_.method);
    }
}

void MeshVoxelizer::render(gl::Profiler& profiler) {
    if (settings_.split == Split::EveryFrame) {
        gl::CpuScope scope(profiler, "preprocess");
        splitByAxis(request_.mesh.positions, request_.mesh.triangles, split_);
        deviceMesh_->update(split_);
    }
    method_->run(*deviceMesh_, profiler);
}

void MeshVoxelizer::record(technique::Recorder& recorder) {
    method_->record(recorder);
    recorder.metric("memory_bytes",
                    static_cast<double>(deviceMesh_->sizeBytes() + method_->sizeBytes()), "byte");
}

}  // namespace gfxrepro::voxelization
