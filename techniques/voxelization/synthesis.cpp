#include "techniques/voxelization/synthesis.h"

#include <algorithm>

#include "techniques/kit/draws.h"
#include "techniques/voxelization/bindings.h"

namespace gfxrepro::voxelization {
namespace {

constexpr int kInvocationsPerGroup = 64;
constexpr int kFillGroupSize = 8;            // fill.comp.glsl: 8 × 8 columns
constexpr int kGroupEdge = 8;                // synthesis_per_voxel.comp.glsl: 8 × 8 texels
constexpr unsigned kMaxSparseGroups = 1024;  // beyond it a group takes several sets of tiles

int tilesPerGroup(const WorksheetLayout& layout) {
    return std::min(kInvocationsPerGroup / layout.voxelsPerTexel(), layout.slabCount());
}

gl::Defines synthesisDefines(const MeshRequest& request) {
    gl::Defines defines = passDefines(request.settings.layout);
    defines["TILES"] = tilesPerGroup(request.settings.layout);
    defines["GROUP_EDGE"] = kGroupEdge;
    if (request.merging == Merging::Sparse) defines["SPARSE"] = 1;
    if (request.addressing == Addressing::Tables) defines["TABLES"] = 1;
    defines[request.fillsByCrossings() ? "COMBINE_MAJORITY"
            : request.hasValues()      ? "COMBINE_MAX"
                                       : "COMBINE_OR"] = 1;
    return defines;
}

gl::Defines fillDefines(const MeshRequest& request) {
    gl::Defines defines = passDefines(request.settings.layout);
    if (!request.fillsByCrossings()) defines["FLIP_AT_VOXELS"] = 1;
    return defines;
}

std::vector<std::string> synthesisFiles(Merging merging) {
    return {merging == Merging::PerVoxel ? "voxelization/synthesis_per_voxel.comp.glsl"
                                         : "voxelization/synthesis.comp.glsl"};
}

void finishImages() {
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT |
                    GL_TEXTURE_UPDATE_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT |
                    GL_BUFFER_UPDATE_BARRIER_BIT);
}

}  // namespace

SolidFill::SolidFill(const gl::ShaderLibrary& shaders, const MeshRequest& request)
    : program_(shaders, {"voxelization/fill.comp.glsl"}, fillDefines(request)),
      groupsAcross_(static_cast<unsigned>(request.settings.layout.resolution() / kFillGroupSize)) {}

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
    : program_(shaders, synthesisFiles(request.merging), synthesisDefines(request)),
      merging_(request.merging) {}

void Synthesis::run(const DirectionalSheets& sheets, const VoxelGrid& grid, const TileList& tiles,
                    const gl::Buffer& statistics) {
    sheets.x.bindImage(kSheetXUnit, GL_READ_ONLY);
    sheets.y.bindImage(kSheetYUnit, GL_READ_ONLY);
    grid.sheets.bindImage(kSheetUnit, GL_READ_WRITE);
    statistics.bindStorage(kStatisticsBinding);
    program_.use();
    const auto perGroup = static_cast<unsigned>(tilesPerGroup(grid.layout));
    if (merging_ == Merging::PerVoxel) {
        const glm::uvec2 groups(grid.layout.sheetSizePx() / kGroupEdge);
        glDispatchCompute(groups.x, groups.y, static_cast<unsigned>(grid.layout.layers()));
    } else if (merging_ == Merging::Sparse) {
        tiles.buffer.bindStorage(kTileBinding);
        glDispatchCompute(std::min(kit::groupsFor(tiles.capacity, perGroup), kMaxSparseGroups), 1,
                          1);
    } else {
        const auto slabs = static_cast<unsigned>(grid.layout.slabCount());
        glDispatchCompute(slabs, slabs, slabs / perGroup);
    }
    finishImages();
}

}  // namespace gfxrepro::voxelization
