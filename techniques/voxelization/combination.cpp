#include "techniques/voxelization/combination.h"

#include <algorithm>
#include <array>

#include "engine/core/error.h"
#include "techniques/kit/draws.h"

namespace gfxrepro::voxelization {
namespace {
constexpr int kCsgGroupSize = 8;
}  // namespace

CsgPass::CsgPass(const gl::ShaderLibrary& shaders, const WorksheetLayout& layout,
                 CsgOperation operation)
    : layout_(layout) {
    gl::Defines defines = layout.defines();
    defines["UNION"] = static_cast<int>(CsgOperation::Union);
    defines["INTERSECTION"] = static_cast<int>(CsgOperation::Intersection);
    defines["OPERATION"] = static_cast<int>(operation);
    pass_ = gl::Pass(shaders, {"voxelization/csg.comp.glsl"}, defines);
}

void CsgPass::run(const gl::Texture& left, const gl::Texture& right,
                  const gl::Texture& result) const {
    const glm::ivec3 size(layout_.sheetSizePx(), layout_.layers());
    GFXREPRO_ASSERT(left.size() == size && right.size() == size && result.size() == size);
    pass_.dispatch(
        {kit::groupsFor(size.x, kCsgGroupSize), kit::groupsFor(size.y, kCsgGroupSize), size.z},
        {{"left", left}, {"right", right}, {"result", result}});
}

namespace {
constexpr int kCollisionGroupSize = 8;
}  // namespace

CountPass::CountPass(const gl::ShaderLibrary& shaders, const WorksheetLayout& layout)
    : layout_(layout),
      pass_(shaders, {"voxelization/collision.comp.glsl"}, layout.defines()),
      count_(sizeof(std::uint32_t)) {}

void CountPass::run(const gl::Texture& sheets) {
    GFXREPRO_ASSERT(sheets.size() == glm::ivec3(layout_.sheetSizePx(), layout_.layers()));
    constexpr std::array kNothing{0U};
    count_.write(std::span<const std::uint32_t>(kNothing));
    const glm::ivec3& size = layout_.shape().size;
    pass_.dispatch({kit::groupsFor(size.x, kCollisionGroupSize),
                    kit::groupsFor(size.y, kCollisionGroupSize), layout_.slabCount()},
                   {{"sheets", sheets}, {"Count", count_}});
}

namespace {

using OptionalOperation = std::optional<CsgOperation>;
constexpr Choice<OptionalOperation> kOperations[] = {
    {std::nullopt, "none", "the first model alone"},
    {CsgOperation::Union, "union", "voxels of either model"},
    {CsgOperation::Intersection, "intersection", "voxels of both models"},
    {CsgOperation::Difference, "difference", "voxels of the first model without the second"},
};

}  // namespace

CombinationSettings::CombinationSettings(Params& params)
    : csg(params.getEnum("csg", OptionalOperation(), kOperations,
                         {"boolean operation with the second model"})),
      findsCollision(params.getBool("collision", false,
                                    {"count the voxels that both models fill, and show them red"})),
      sceneB(params.getText("scene_b", "", {"the second model, of csg and collision"})) {
    constexpr double kNowhere[] = {0.0, 0.0, 0.0};
    const std::vector<double> offset =
        params.getVector("offset_b", kNowhere,
                         {"where the second model is put", "longest edges of the first one's box"});
    offsetB = {static_cast<float>(offset[0]), static_cast<float>(offset[1]),
               static_cast<float>(offset[2])};
    if (needsSecond() && sceneB.empty()) {
        throw Error(params.locationOf(csg ? "csg" : "collision"),
                    "'csg' and 'collision' need a second model, 'scene_b'");
    }
    if (!needsSecond() && !sceneB.empty()) {
        throw Error(params.locationOf("scene_b"),
                    "'scene_b' is used by 'csg' and 'collision' only, and neither is on");
    }
}

scene::Box Combination::loadSecond(technique::SetupContext& context,
                                   const scene::Box& firstBounds) {
    const scene::Scene& second = context.scenes.load(settings_.sceneB);
    requireVoxelizable(second);
    secondInput_.emplace(second);
    const scene::Box bounds = secondInput_->mesh().bounds();
    const glm::vec3 size = firstBounds.size();
    offsetWorld_ = settings_.offsetB * std::max({size.x, size.y, size.z});
    return {bounds.min + offsetWorld_, bounds.max + offsetWorld_};
}

void Combination::setup(technique::SetupContext& context, const MeshVoxelizerSettings& voxelizer,
                        const scene::Box& box) {
    // Moving the grid's box instead of the model saves a copy of it.
    const scene::Box shifted{box.min - offsetWorld_, box.max - offsetWorld_};
    secondSource_.emplace(voxelizer, secondInput_->mesh(), shifted);
    secondSource_->setup(context);
    const WorksheetLayout& layout = voxelizer.grid.layout;
    if (settings_.csg) {
        csgPass_.emplace(context.shaders, layout, *settings_.csg);
        result_ = {makeSheets(layout), layout, box};
    }
    if (settings_.findsCollision) {
        intersectionPass_.emplace(context.shaders, layout, CsgOperation::Intersection);
        countPass_.emplace(context.shaders, layout);
        common_ = {makeSheets(layout), layout, box};
    }
}

void Combination::render(gl::Profiler& profiler, const VoxelGrid& first) {
    secondSource_->render(profiler);
    const gl::Texture& second = secondSource_->grid()->sheets;
    if (csgPass_) {
        const gl::GpuScope scope(profiler, "csg");
        csgPass_->run(first.sheets, second, result_.sheets);
    }
    if (intersectionPass_) {
        const gl::GpuScope scope(profiler, "collision");
        intersectionPass_->run(first.sheets, second, common_.sheets);
        countPass_->run(common_.sheets);
    }
}

void Combination::record(technique::Recorder& recorder) const {
    if (countPass_) recorder.metric("collision_voxels", countPass_->read());
}

}  // namespace gfxrepro::voxelization
