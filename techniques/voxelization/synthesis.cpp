#include "techniques/voxelization/synthesis.h"

#include <algorithm>

#include "techniques/kit/draws.h"

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
    gl::Defines defines = request.settings.layout.defines();
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
    gl::Defines defines = request.settings.layout.defines();
    if (!request.fillsByCrossings()) defines["FLIP_AT_VOXELS"] = 1;
    return defines;
}

std::vector<std::string> synthesisFiles(Merging merging) {
    return {merging == Merging::PerVoxel ? "voxelization/synthesis_per_voxel.comp.glsl"
                                         : "voxelization/synthesis.comp.glsl"};
}

}  // namespace

SolidFill::SolidFill(const gl::ShaderLibrary& shaders, const MeshRequest& request)
    : pass_(shaders, {"voxelization/fill.comp.glsl"}, fillDefines(request)),
      groupsAcross_(static_cast<unsigned>(request.settings.layout.resolution() / kFillGroupSize)) {}

void SolidFill::run(const Texelization& texelization, const DirectionalSheets& sheets,
                    const VoxelGrid& grid, gl::Buffer& statistics) {
    statistics.clear();
    for (Axis axis : kAxes) {
        const gl::Texture& sheet = axis == Axis::X   ? sheets.x
                                   : axis == Axis::Y ? sheets.y
                                                     : grid.sheets;
        pass_.dispatch({groupsAcross_, groupsAcross_, 1},
                       {{"sheet", sheet},
                        {"Behind", texelization.behind(axis)},
                        gl::Resource("Statistics", statistics).unordered()});
    }
}

Synthesis::Synthesis(const gl::ShaderLibrary& shaders, const MeshRequest& request)
    : pass_(shaders, synthesisFiles(request.merging), synthesisDefines(request)),
      merging_(request.merging) {}

void Synthesis::run(const DirectionalSheets& sheets, const VoxelGrid& grid, const TileList& tiles,
                    const gl::Buffer& statistics, const gl::Resources& tables) {
    const auto perGroup = static_cast<unsigned>(tilesPerGroup(grid.layout));
    const auto slabs = static_cast<unsigned>(grid.layout.slabCount());
    glm::uvec3 groups(slabs, slabs, slabs / perGroup);
    if (merging_ == Merging::PerVoxel) {
        groups = {grid.layout.sheetSizePx() / kGroupEdge, grid.layout.layers()};
    } else if (merging_ == Merging::Sparse) {
        groups = {std::min(kit::groupsFor(tiles.capacity, perGroup), kMaxSparseGroups), 1, 1};
    }
    pass_.dispatch(groups, gl::Resources{{"sheetX", sheets.x},
                                         {"sheetY", sheets.y},
                                         {"sheet", grid.sheets},
                                         {"Statistics", statistics}}
                               .with({{"Tiles", tiles.buffer}})
                               .with(tables));
}

}  // namespace gfxrepro::voxelization
