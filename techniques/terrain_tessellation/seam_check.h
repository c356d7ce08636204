// Whether tessellated patches fit together, by the vertices that the rasterizer gets: no pixel, and
// so no view, decides it.
#pragma once

#include <cstddef>
#include <span>

#include "techniques/terrain_tessellation/factor_check.h"

namespace gfxrepro::terrain_tessellation {

/// An edge of a triangle fits where another one runs from the same place to the same place, in clip
/// space and bit by bit, the other way round: there is nothing between the two triangles. On a rim
/// with no patch of its level beyond, or a culled one, there is nothing to fit; skirts hang there.
struct Seams {
    std::size_t edges = 0;         // of triangles, but for those on such rims
    std::size_t openEdges = 0;     // of these, without a partner
    std::size_t patchEdges = 0;    // of all, on a border between two patches of a tile
    std::size_t tileEdges = 0;     // of all, on a border between two tiles
    std::size_t mostVertices = 0;  // of a patch
    std::size_t largestFan = 0;    // triangles about one vertex inside of a patch
};

/// `factors`: those replayed, by which patches are culled; `vertices`: TerrainRenderer::capture().
Seams checkSeams(std::span<const Tile> tiles, const TileSettings& settings,
                 std::span<const PatchFactors> factors, std::span<const CapturedVertex> vertices);

}  // namespace gfxrepro::terrain_tessellation
