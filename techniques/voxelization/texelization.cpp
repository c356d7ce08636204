#include "techniques/voxelization/texelization.h"

#include <algorithm>

#include "techniques/kit/draws.h"

namespace gfxrepro::voxelization {
namespace {

constexpr int kGroupSize = 64;
constexpr unsigned kMaxGroups = 4096;  // beyond it an invocation takes several fragments

gl::Defines texelizeDefines(const MeshRequest& request) {
    gl::Defines defines = request.settings.layout.defines();
    defines["GROUP_SIZE"] = kGroupSize;
    defines["RECORD_WORDS"] = request.hasValues() ? 2 : 1;
    defines[request.fillsByCrossings() ? "ACCUMULATE_XOR"
            : request.hasValues()      ? "ACCUMULATE_MAX"
                                       : "ACCUMULATE_OR"] = 1;
    if (request.merging == Merging::Sparse) defines["LIST_TILES"] = 1;
    if (request.addressing == Addressing::Tables) defines["TABLES"] = 1;
    return defines;
}

/// A tile is listed by one of its fragments.
TileList makeTileList(const WorksheetLayout& layout, const FragmentList& fragments) {
    const auto across = static_cast<std::size_t>(layout.slabCount());
    const std::size_t tiles = across * across * across;
    std::size_t listed = 0;
    for (std::uint32_t capacity : fragments.capacities) listed += capacity;
    listed = std::max<std::size_t>(std::min(tiles, listed), 1);
    const std::size_t flagWords = (tiles + 31) / 32;
    return {gl::Buffer((1 + flagWords + listed) * sizeof(std::uint32_t)), listed};
}

}  // namespace

Texelization::Texelization(const gl::ShaderLibrary& shaders, const MeshRequest& request,
                           const FragmentList& fragments)
    : pass_(shaders, {"voxelization/texelize.comp.glsl"}, texelizeDefines(request)) {
    const auto n = static_cast<std::size_t>(request.settings.layout.resolution());
    for (gl::Buffer& lines : behind_) lines = gl::Buffer(request.isSolid() ? n * n / 8 : 4);
    if (request.merging == Merging::Sparse) {
        tiles_ = makeTileList(request.settings.layout, fragments);
    }
}

void Texelization::run(const FragmentList& fragments, DirectionalSheets& sheets, VoxelGrid& grid,
                       const gl::Resources& tables) {
    if (tiles_.capacity > 0) tiles_.buffer.clear();
    for (Axis axis : kAxes) {
        const auto index = static_cast<std::size_t>(axis);
        gl::Texture& sheet = axis == Axis::X ? sheets.x : axis == Axis::Y ? sheets.y : grid.sheets;
        sheet.clearToZero();
        behind_[index].clear();
        const std::uint32_t capacity = fragments.capacities[index];
        pass_.set("axis", static_cast<int>(axis));
        pass_.set("fragmentCapacity", capacity);
        pass_.dispatch({std::min(kit::groupsFor(capacity, kGroupSize), kMaxGroups), 1, 1},
                       gl::Resources{{"sheet", sheet},
                                     {"Records", fragments.records[index]},
                                     {"Counters", fragments.counters},
                                     {"Behind", behind_[index]},
                                     gl::Resource("Tiles", tiles_.buffer).unordered()}
                           .with(tables));
    }
}

std::size_t Texelization::sizeBytes() const {
    return 3 * behind_[0].sizeBytes() + tiles_.buffer.sizeBytes();
}

}  // namespace gfxrepro::voxelization
