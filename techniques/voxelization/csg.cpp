#include "techniques/voxelization/csg.h"

#include "runner/core/error.h"

namespace gfxrepro::voxelization {

namespace {
enum ImageUnit { kLeft = 0, kRight = 1, kResult = 2 };
constexpr int kGroupSize = 8;
}  // namespace

CsgPass::CsgPass(const gl::ShaderLibrary& shaders, const WorksheetLayout& layout,
                 CsgOperation operation)
    : layout_(layout) {
    gl::Defines defines = layout.defines();
    defines["LEFT_IMAGE"] = kLeft;
    defines["RIGHT_IMAGE"] = kRight;
    defines["RESULT_IMAGE"] = kResult;
    defines["UNION"] = static_cast<int>(CsgOperation::Union);
    defines["INTERSECTION"] = static_cast<int>(CsgOperation::Intersection);
    defines["OPERATION"] = static_cast<int>(operation);
    program_ = gl::Program(shaders, {"voxelization/csg.comp.glsl"}, defines);
}

void CsgPass::run(const gl::Texture& left, const gl::Texture& right,
                  const gl::Texture& result) const {
    const glm::ivec3 size(layout_.sheetSizePx(), layout_.layers());
    GFXREPRO_ASSERT(left.size() == size && right.size() == size && result.size() == size);
    program_.use();
    left.bindImage(kLeft, GL_READ_ONLY);
    right.bindImage(kRight, GL_READ_ONLY);
    result.bindImage(kResult, GL_WRITE_ONLY);
    glDispatchCompute(static_cast<GLuint>(size.x / kGroupSize),
                      static_cast<GLuint>(size.y / kGroupSize), static_cast<GLuint>(size.z));
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
}

}  // namespace gfxrepro::voxelization
