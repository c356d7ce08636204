// Draw calls for a software rasterizer: which patches each gets, and in which order.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "techniques/terrain_tessellation/edge_factors.h"

namespace gfxrepro::terrain_tessellation {

/// llvmpipe (Mesa 22.3) sends a call's triangles through its slow path as soon as one of the call's
/// vertices needs clipping, and there visits all vertices of the call once for every 64 of them: a
/// time that grows with the square. Patches that may need it go into small calls of their own.
struct BatchLimits {
    int triangles = 1 << 14;         // of a call without clipping
    int clippedTriangles = 1 << 11;  // of one that may have some
};

struct PatchesToDraw {
    std::span<const Tile> tiles;
    bool hasSkirts = true;  // numbered after the tile's patches, as patches.glsl does
    float footM = 0.0F;     // of the skirts
    bool isCulling = true;  // the control stage drops patches outside the frustum
    bool hasSurface = true;
};

/// Patches of one call. No more triangles than the limits, unless a patch alone has more.
struct PatchBatch {
    std::uint32_t count = 0;
    double triangles = 0.0;  // an upper bound
};

struct PatchBatches {
    /// The numbers of the patches and skirts to draw, once each, the nearest first as far as calls
    /// allow.
    std::vector<std::uint32_t> order;
    std::vector<PatchBatch> batches;
};
PatchBatches batchPatches(const TerrainMetadata& metadata, const FactorSettings& settings,
                          const kit::View& view, const PatchesToDraw& patches,
                          const BatchLimits& limits);

}  // namespace gfxrepro::terrain_tessellation
