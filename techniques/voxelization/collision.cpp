#include "techniques/voxelization/collision.h"

#include <array>

namespace gfxrepro::voxelization {

namespace {
constexpr int kCollisionGroupSize = 8;

// The block Extent of collision.comp.glsl (std430).
using Words = std::array<std::uint32_t, 7>;
constexpr Words kNothing{0, ~0U, ~0U, ~0U, 0, 0, 0};
static_assert(sizeof(Words) == 28);
}  // namespace

scene::Box GridExtent::bounds(const VoxelGrid& grid) const {
    scene::Box bounds;
    if (count == 0) return bounds;
    bounds.min = grid.box.min + grid.voxelSize() * glm::vec3(lowest);
    bounds.max = grid.box.min + grid.voxelSize() * glm::vec3(highest + 1);
    return bounds;
}

ExtentPass::ExtentPass(const gl::ShaderLibrary& shaders, const WorksheetLayout& layout)
    : layout_(layout),
      pass_(shaders, {"voxelization/collision.comp.glsl"}, layout.defines()),
      extent_(sizeof(Words)) {}

void ExtentPass::run(const gl::Texture& sheets) {
    GFXREPRO_ASSERT(sheets.size() == glm::ivec3(layout_.sheetSizePx(), layout_.layers()));
    extent_.write(std::span<const std::uint32_t>(kNothing));
    const auto groups = static_cast<GLuint>(layout_.resolution() / kCollisionGroupSize);
    pass_.dispatch({groups, groups, layout_.slabCount()},
                   {{"sheets", sheets}, {"Extent", extent_}});
}

GridExtent ExtentPass::read() const {
    const std::vector<std::uint32_t> words = extent_.read<std::uint32_t>(kNothing.size());
    return {words[0], glm::ivec3(words[1], words[2], words[3]),
            glm::ivec3(words[4], words[5], words[6])};
}

}  // namespace gfxrepro::voxelization
