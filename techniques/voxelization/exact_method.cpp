// The exact rules in one pass, beyond the thesis: no rasterizer rounds anything.
#include <fmt/format.h>

#include <algorithm>

#include "techniques/kit/draws.h"
#include "techniques/voxelization/mesh_voxelizer.h"

namespace gfxrepro::voxelization {
namespace {

constexpr std::uint32_t kChunk = 256;  // triangles that a work group lists at a time
constexpr int kSmallPixels = 32;       // of a triangle that one invocation walks
constexpr int kPartPixels = 1024;      // of a part of a larger one
constexpr std::uint32_t kMostGroups = 65535;
constexpr unsigned kLinesPerGroup = 32;  // fill_crossings.comp.glsl

/// A solid's crossings along each axis, all in the grid's layout, become inside flags and these the
/// grid. [zju2005] Sec. 2.2.3.
class CrossingFill {
  public:
    CrossingFill(const gl::ShaderLibrary& shaders, const WorksheetLayout& layout)
        : layout_(layout), x_(makeSheets(layout)), y_(makeSheets(layout)) {
        gl::Defines defines = layout.defines();
        defines["GROUP_SIZE"] = static_cast<int>(kLinesPerGroup);
        for (int axis = 0; axis < 3; ++axis) {
            defines["AXIS"] = axis;
            passes_.emplace_back(shaders,
                                 std::vector<std::string>{"voxelization/fill_crossings.comp.glsl"},
                                 defines);
        }
        const glm::uvec3 size(layout.shape().size);
        const auto slabs = static_cast<unsigned>(layout.slabCount());
        const unsigned words = slabs * (size.x + size.y) + size.y * kit::groupsFor(size.x, 32);
        behind_ = gl::Buffer(words * sizeof(std::uint32_t));
    }

    void clear() {
        x_.clearToZero();
        y_.clearToZero();
        behind_.clear();
    }
    /// Of exact.comp.glsl, beside the grid, which takes the crossings along z.
    gl::Resources resources() const {
        return {{"sheetX", x_}, {"sheetY", y_}, {"Behind", behind_}};
    }
    void run(const gl::Texture& grid) {
        statistics_.clear();
        const glm::uvec3 size(layout_.shape().size);
        const auto slabs = static_cast<unsigned>(layout_.slabCount());
        const gl::Texture* const sheets[] = {&x_, &y_, &grid};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            passes_[axis].dispatch(
                {kit::groupsFor(axis == 0 ? size.y : size.x, kLinesPerGroup),
                 axis == 2 ? size.y : slabs, 1},
                gl::Resources{
                    {"sheet", *sheets[axis]}, {"Behind", behind_}, {"Statistics", statistics_}}
                    .with({{"sheetX", x_}, {"sheetY", y_}}));
        }
    }
    void record(technique::Recorder& recorder) const {
        const auto found = statistics_.read<std::uint32_t>(2);
        recorder.metric("ambiguous_scan_lines", found[0]);
        recorder.metric("disagreeing_voxels", found[1]);
    }
    std::size_t sizeBytes() const {
        return x_.sizeBytes() + y_.sizeBytes() + behind_.sizeBytes() + statistics_.sizeBytes();
    }

  private:
    WorksheetLayout layout_;
    gl::Texture x_, y_;
    gl::Buffer behind_, statistics_ = gl::Buffer(2 * sizeof(std::uint32_t));
    std::vector<gl::Pass> passes_;
};

gl::Defines exactDefines(const MeshRequest& request, bool isSoftware) {
    gl::Defines defines = request.layout().defines();
    defines["VALUE"] = static_cast<int>(request.settings.grid.value);
    // llvmpipe runs a group's invocations by as many as a vector holds; what stays of a list when
    // these are dealt out is done by masked ones.
    defines["GROUP_SIZE"] = isSoftware ? 8 : 64;
    defines["CHUNK"] = static_cast<int>(kChunk);
    defines["SMALL_PIXELS"] = kSmallPixels;
    defines["PART_PIXELS"] = kPartPixels;
    if (isWide(request.mesh, request.box, request.layout().shape())) {
        defines["WIDE_LATTICE"] = 1;
    }
    if (request.isSolid()) {
        defines["RULE_TOGGLE"] = 1;
        return defines;
    }
    defines[request.settings.rule == Rule::Thin ? "RULE_THIN" : "RULE_CONSERVATIVE"] = 1;
    defines[request.hasValues() ? "ACCUMULATE_MAX" : "ACCUMULATE_OR"] = 1;
    return defines;
}

class ExactMethod : public MeshMethod {
  public:
    /// Throws UnsupportedError where the parts of large triangles would not fit a storage block.
    ExactMethod(technique::SetupContext& context, const MeshRequest& request,
                const DeviceMesh& mesh)
        : grid_{makeSheets(request.layout()), request.layout(), request.box} {
        gl::Defines defines = exactDefines(request, context.device.info().isSoftware);
        pass_ = gl::Pass(context.shaders, {"voxelization/exact.comp.glsl"}, defines);
        defines["LARGE"] = 1;
        large_ = gl::Pass(context.shaders, {"voxelization/exact.comp.glsl"}, defines);
        if (request.isSolid()) fill_.emplace(context.shaders, request.layout());
        voxelize(mesh);  // capacity 0: counts the parts only
        partCapacity_ = parts_.read<std::uint32_t>(1).front();
        const std::size_t bytes = (1 + std::size_t{partCapacity_}) * sizeof(glm::uvec2);
        if (static_cast<long long>(bytes) > context.device.limits().maxStorageBlockBytes) {
            throw UnsupportedError(
                fmt::format("{} parts of large triangles take {} bytes; the device's storage "
                            "blocks hold {}",
                            partCapacity_, bytes, context.device.limits().maxStorageBlockBytes));
        }
        parts_ = gl::Buffer(bytes);
    }

    void run(const DeviceMesh& mesh, gl::Profiler& profiler) override {
        gl::GpuScope whole(profiler, "voxelization");
        voxelize(mesh);
        if (!fill_) return;
        gl::GpuScope scope(profiler, "fill");
        fill_->run(grid_.sheets);
    }
    const VoxelGrid* grid() const override { return &grid_; }
    void record(technique::Recorder& recorder) override {
        if (fill_) fill_->record(recorder);
    }
    std::size_t sizeBytes() const override {
        return grid_.sheets.sizeBytes() + parts_.sizeBytes() + (fill_ ? fill_->sizeBytes() : 0);
    }

  private:
    void voxelize(const DeviceMesh& mesh) {
        grid_.sheets.clearToZero();
        parts_.clear();
        gl::Resources resources =
            gl::Resources{{"sheet", grid_.sheets}, {"Parts", parts_}}.with(mesh.resources());
        if (fill_) {
            fill_->clear();
            resources = resources.with(fill_->resources());
        }
        const auto count = static_cast<std::uint32_t>(mesh.allTriangles().count);
        pass_.set("triangleCount", count);
        pass_.set("partCapacity", partCapacity_);
        pass_.setIfActive("firstOfY", static_cast<std::uint32_t>(mesh.ranges[1].first));
        pass_.setIfActive("firstOfZ", static_cast<std::uint32_t>(mesh.ranges[2].first));
        pass_.dispatch({std::min(kit::groupsFor(count, kChunk), kMostGroups), 1, 1}, resources);
        if (partCapacity_ == 0) return;
        large_.set("partCapacity", partCapacity_);
        large_.dispatch({std::min(partCapacity_, kMostGroups), 1, 1}, resources);
    }

    VoxelGrid grid_;
    gl::Pass pass_, large_;
    std::optional<CrossingFill> fill_;
    gl::Buffer parts_ = gl::Buffer(sizeof(glm::uvec2));  // exact.comp.glsl; the count before them
    std::uint32_t partCapacity_ = 0;
};

}  // namespace

std::unique_ptr<MeshMethod> makeExactMethod(technique::SetupContext& context,
                                            const MeshRequest& request, const DeviceMesh& mesh) {
    return std::make_unique<ExactMethod>(context, request, mesh);
}

}  // namespace gfxrepro::voxelization
