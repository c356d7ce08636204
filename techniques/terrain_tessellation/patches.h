// Patches of tiles and their tessellation factors, on the CPU in double precision: the reference
// for shaders/factors.glsl, and what draw calls for a software rasterizer are split by.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "techniques/kit/view.h"
#include "techniques/terrain_tessellation/tile_selection.h"

namespace gfxrepro::terrain_tessellation {

/// Which way the segment AB of Eq. (4) points.
enum class Segment {
    Vertical,    // along the world's up, as printed
    ViewFacing,  // parallel to the image plane
    Sphere,      // the apparent diameter of the sphere of diameter L_AB
};
enum class InnerFactors { Mean, Minimum, Maximum };
enum class EdgeRule {
    Shared,    // Eq. (4): both patches of an edge take the same factor
    OwnPatch,  // every edge takes its patch's mean: cracks (figure 9's negative control)
};

struct FactorSettings {
    TileSettings tile;
    Segment segment = Segment::Vertical;
    InnerFactors inner = InnerFactors::Mean;
    EdgeRule edges = EdgeRule::Shared;
    float segmentPx = 5.0F;  // ΔS
    float smallest = 2.0F, greatest = 64.0F;
};

/// A patch of a tile: N × N blocks.
struct Patch {
    int level = 0;
    glm::ivec2 firstBlock{0};  // column and row at its level
};
Patch patchOf(const Tile& tile, const TileSettings& settings, int index);
/// Of the tile's, those that do not lie beyond the map's last sample.
int patchesOnMap(const Tile& tile, const TileSettings& settings, glm::ivec2 mapSizeSamples);

/// Eq. (2): over the blocks along the patch's edge.
HeightRange edgeRange(const TerrainMetadata& metadata, const TileSettings& settings,
                      const Patch& patch, Edge edge);

/// The heights of the ends of the patch's edge, the northern or western one first.
glm::vec2 edgeEndsM(const TerrainMetadata& metadata, const TileSettings& settings,
                    const Patch& patch, Edge edge);

/// Eq. (3) and (4).
double edgeFactor(const TerrainMetadata& metadata, const FactorSettings& settings,
                  const kit::View& view, const Patch& patch, Edge edge);
/// The same for many edges of one view, whose matrix is multiplied out once.
double edgeFactor(const TerrainMetadata& metadata, const FactorSettings& settings,
                  const kit::View& view, const glm::dmat4& clipFromWorld, const Patch& patch,
                  Edge edge);

/// A patch's factor along a pair of opposite edges, from theirs.
double innerFactor(InnerFactors inner, double a, double b);

/// The vertices that a patch of these outer factors is cut into by fractional even spacing.
int patchVertices(const std::array<double, 4>& outer, InnerFactors inner);

/// No fewer triangles than a patch of these outer factors is cut into, whatever the spacing.
double triangleBound(const std::array<double, 4>& outer, InnerFactors inner);

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
