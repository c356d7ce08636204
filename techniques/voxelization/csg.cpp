#include "techniques/voxelization/csg.h"

#include "engine/core/error.h"

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
    pass_.dispatch({size.x / kCsgGroupSize, size.y / kCsgGroupSize, size.z},
                   {{"left", left}, {"right", right}, {"result", result}});
}

}  // namespace gfxrepro::voxelization
