// The exact rules in one pass, beyond the thesis: no rasterizer rounds anything.
#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "techniques/kit/draws.h"
#include "techniques/voxelization/mesh_voxelizer.h"

namespace gfxrepro::voxelization {
namespace {

constexpr std::uint32_t kChunk = 256;  // triangles that a work group lists at a time
constexpr int kSmallPixels = 32;       // of a triangle that one invocation walks
constexpr int kPartPixels = 1024;      // of a part of a larger one
constexpr std::uint32_t kMostGroups = 65535;
constexpr unsigned kLinesPerGroup = 32;  // fill_crossings.comp.glsl
constexpr unsigned kMeanGroupSize = 64;  // mean_normal.comp.glsl

void requireBlock(const char* what, std::size_t count, std::size_t bytes,
                  const gl::DeviceLimits& limits) {
    if (static_cast<long long>(bytes) <= limits.maxStorageBlockBytes) return;
    throw UnsupportedError(fmt::format("{} {} take {} bytes; the device's storage blocks hold {}",
                                       count, what, bytes, limits.maxStorageBlockBytes));
}

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
    std::uint32_t openScanLines() const { return statistics_.read<std::uint32_t>(1).front(); }
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
    // llvmpipe runs a group's invocations by as many as a vector holds; what stays of a list when
    // these are dealt out is done by masked ones.
    defines["GROUP_SIZE"] = isSoftware ? 8 : 64;
    defines["CHUNK"] = static_cast<int>(kChunk);
    defines["SMALL_PIXELS"] = kSmallPixels;
    defines["PART_PIXELS"] = kPartPixels;
    if (isWide(request.mesh, request.box, request.layout().shape())) {
        defines["WIDE_LATTICE"] = 1;
    }
    return defines;
}

/// exact.comp.glsl by one rule: the triangles, and the parts of large ones.
class ExactWalk {
  public:
    /// Walks what is small, and counts the parts. Throws UnsupportedError where these would not fit
    /// a storage block.
    ExactWalk(technique::SetupContext& context, const MeshRequest& request, const DeviceMesh& mesh,
              const gl::Defines& rule, const gl::Resources& resources) {
        gl::Defines defines = exactDefines(request, context.device.info().isSoftware);
        defines.insert(rule.begin(), rule.end());
        pass_ = gl::Pass(context.shaders, {"voxelization/exact.comp.glsl"}, defines);
        defines["LARGE"] = 1;
        large_ = gl::Pass(context.shaders, {"voxelization/exact.comp.glsl"}, defines);
        run(mesh, resources);
        partCapacity_ = parts_.read<std::uint32_t>(1).front();
        const std::size_t bytes = (1 + std::size_t{partCapacity_}) * sizeof(glm::uvec2);
        requireBlock("parts of large triangles", partCapacity_, bytes, context.device.limits());
        parts_ = gl::Buffer(bytes);
    }

    void run(const DeviceMesh& mesh, const gl::Resources& target) {
        parts_.clear();
        const gl::Resources resources = target.with(mesh.resources()).with({{"Parts", parts_}});
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
    std::size_t sizeBytes() const { return parts_.sizeBytes(); }

  private:
    gl::Pass pass_, large_;
    gl::Buffer parts_ = gl::Buffer(sizeof(glm::uvec2));  // exact.comp.glsl; the count before them
    std::uint32_t partCapacity_ = 0;
};

/// The full voxels of a grid get the mean normal of the surface in them, nearly by area.
class MeanNormals {
  public:
    /// `grid` has the voxels of the mesh. Throws UnsupportedError where their sums would not fit a
    /// storage block.
    MeanNormals(technique::SetupContext& context, const MeshRequest& request,
                const DeviceMesh& mesh, const VoxelGrid& grid) {
        const std::size_t voxels = grid.read().countFull();
        const std::size_t slots = std::bit_ceil(std::max(2 * voxels, std::size_t{kMeanGroupSize}));
        const std::size_t bytes = slots * sizeof(glm::ivec4);
        requireBlock("normals of voxels", voxels, bytes, context.device.limits());
        sums_ = gl::Buffer(bytes);
        groups_ = kit::groupsFor(slots, kMeanGroupSize);
        const gl::Defines rule{{"RULE_CONSERVATIVE", 1},
                               {"SUM_NORMALS", 1},
                               {"SLOT_SHIFT", 32 - std::countr_zero(slots)}};
        sums_.clear();
        walk_.emplace(context, request, mesh, rule, resources(grid));
        gl::Defines defines = request.layout().defines();
        defines["GROUP_SIZE"] = static_cast<int>(kMeanGroupSize);
        mean_ = gl::Pass(context.shaders, {"voxelization/mean_normal.comp.glsl"}, defines);
    }

    void run(const DeviceMesh& mesh, const VoxelGrid& grid) {
        sums_.clear();
        walk_->run(mesh, resources(grid));
        mean_.dispatch({groups_, 1, 1}, resources(grid));
    }
    std::size_t sizeBytes() const { return sums_.sizeBytes() + walk_->sizeBytes(); }

  private:
    gl::Resources resources(const VoxelGrid& grid) const {
        return {{"sheet", grid.sheets}, {"Sums", sums_}};
    }
    std::optional<ExactWalk> walk_;
    gl::Pass mean_;
    gl::Buffer sums_;
    GLuint groups_ = 0;
};

gl::Defines ruleDefines(const MeshRequest& request) {
    if (request.isSolid()) return {{"RULE_TOGGLE", 1}};
    const bool isThin = request.settings.rule == Rule::Thin;
    return {{isThin ? "RULE_THIN" : "RULE_CONSERVATIVE", 1}, {"ACCUMULATE_OR", 1}};
}

class ExactMethod : public MeshMethod {
  public:
    ExactMethod(technique::SetupContext& context, const MeshRequest& request,
                const DeviceMesh& mesh)
        : grid_{makeSheets(request.layout()), request.layout(), request.box} {
        if (request.isSolid()) fill_.emplace(context.shaders, request.layout());
        walk_.emplace(context, request, mesh, ruleDefines(request), resources());
        if (!request.hasValues()) return;
        walk_->run(mesh, resources());
        normals_.emplace(context, request, mesh, grid_);
    }

    void run(const DeviceMesh& mesh, gl::Profiler& profiler) override {
        gl::GpuScope whole(profiler, "voxelization");
        grid_.sheets.clearToZero();
        if (fill_) fill_->clear();
        walk_->run(mesh, resources());
        if (normals_) normals_->run(mesh, grid_);
        if (!fill_) return;
        gl::GpuScope scope(profiler, "fill");
        fill_->run(grid_.sheets);
    }
    const VoxelGrid* grid() const override { return &grid_; }
    void record(technique::Recorder& recorder) override {
        if (fill_) fill_->record(recorder);
    }
    std::uint32_t openScanLines() const override { return fill_ ? fill_->openScanLines() : 0; }
    std::size_t sizeBytes() const override {
        return grid_.sheets.sizeBytes() + walk_->sizeBytes() + (fill_ ? fill_->sizeBytes() : 0) +
               (normals_ ? normals_->sizeBytes() : 0);
    }

  private:
    gl::Resources resources() const {
        const gl::Resources grid{{"sheet", grid_.sheets}};
        return fill_ ? grid.with(fill_->resources()) : grid;
    }

    VoxelGrid grid_;
    std::optional<CrossingFill> fill_;
    std::optional<ExactWalk> walk_;
    std::optional<MeanNormals> normals_;
};

}  // namespace

std::unique_ptr<MeshMethod> makeExactMethod(technique::SetupContext& context,
                                            const MeshRequest& request, const DeviceMesh& mesh) {
    return std::make_unique<ExactMethod>(context, request, mesh);
}

}  // namespace gfxrepro::voxelization
