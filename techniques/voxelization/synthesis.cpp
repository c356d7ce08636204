#include "techniques/voxelization/synthesis.h"

#include <algorithm>

#include "techniques/voxelization/bindings.h"

namespace gfxrepro::voxelization {
namespace {

constexpr int kInvocationsPerGroup = 64;
constexpr int kFillGroupSize = 8;  // fill.comp.glsl: 8 × 8 columns

int tilesPerGroup(const WorksheetLayout& layout) {
    return std::min(kInvocationsPerGroup / layout.voxelsPerTexel(), layout.slabCount());
}

gl::Defines synthesisDefines(const MeshRequest& request) {
    gl::Defines defines = passDefines(request.settings.layout);
    defines["TILES"] = tilesPerGroup(request.settings.layout);
    defines[request.isSolid()     ? "COMBINE_MAJORITY"
            : request.hasValues() ? "COMBINE_MAX"
                                  : "COMBINE_OR"] = 1;
    return defines;
}

void finishImages() {
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT |
                    GL_TEXTURE_UPDATE_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT |
                    GL_BUFFER_UPDATE_BARRIER_BIT);
}

}  // namespace

SolidFill::SolidFill(const gl::ShaderLibrary& shaders, const WorksheetLayout& layout)
    : program_(shaders, {"voxelization/fill.comp.glsl"}, passDefines(layout)),
      groupsAcross_(static_cast<unsigned>(layout.resolution() / kFillGroupSize)) {}

void SolidFill::run(const Texelization& texelization, const DirectionalSheets& sheets,
                    const VoxelGrid& grid, gl::Buffer& statistics) {
    statistics.clear();
    statistics.bindStorage(kStatisticsBinding);
    program_.use();
    for (Axis axis : kAxes) {
        const gl::Texture& sheet = axis == Axis::X   ? sheets.x
                                   : axis == Axis::Y ? sheets.y
                                                     : grid.sheets;
        sheet.bindImage(kSheetUnit, GL_READ_WRITE);
        texelization.behind(axis).bindStorage(kBehindBinding);
        glDispatchCompute(groupsAcross_, groupsAcross_, 1);
    }
    finishImages();
}

Synthesis::Synthesis(const gl::ShaderLibrary& shaders, const MeshRequest& request)
    : program_(shaders, {"voxelization/synthesis.comp.glsl"}, synthesisDefines(request)) {}

void Synthesis::run(const DirectionalSheets& sheets, const VoxelGrid& grid,
                    const gl::Buffer& statistics) {
    sheets.x.bindImage(kSheetXUnit, GL_READ_ONLY);
    sheets.y.bindImage(kSheetYUnit, GL_READ_ONLY);
    grid.sheets.bindImage(kSheetUnit, GL_READ_WRITE);
    statistics.bindStorage(kStatisticsBinding);
    program_.use();
    const auto slabs = static_cast<unsigned>(grid.layout.slabCount());
    glDispatchCompute(slabs, slabs, slabs / static_cast<unsigned>(tilesPerGroup(grid.layout)));
    finishImages();
}

}  // namespace gfxrepro::voxelization
