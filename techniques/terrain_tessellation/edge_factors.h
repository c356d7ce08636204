// Tiles, patches and their tessellation factors, on the CPU in double precision: the reference for
// shaders/factors.glsl, and what draws are split by.
#pragma once

#include <array>
#include <span>

#include "techniques/shared/view.h"
#include "techniques/terrain_tessellation/height_textures.h"

namespace gfxrepro::terrain_tessellation {

/// M × M patches of one level, each N × N blocks of blockCells × blockCells cells, where a cell of
/// level l spans 2^l samples. [zhang2012] Sec. 2.1
struct TileShape {
    int patchesPerTile = 8;  // M
    int blocksPerPatch = 2;  // N
    int blockCells = 32;     // N · blockCells is at most 64, the greatest factor
    int patchCells() const { return blocksPerPatch * blockCells; }
};

struct TerrainTile {
    glm::ivec2 origin{0};  // sample with the smallest x and z; a multiple of a patch's span
    int level = 0;
};

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
    TileShape shape;
    Segment segment = Segment::Vertical;
    InnerFactors inner = InnerFactors::Mean;
    EdgeRule edges = EdgeRule::Shared;
    float segmentPx = 5.0F;  // ΔS
    float smallest = 2.0F, greatest = 64.0F;
};

/// The terrain's frame and bounds without a device.
struct BoundsGrid {
    std::span<const LevelBounds> levels;
    float spacingM = 1.0F;
    glm::vec2 originWorld{0.0F};
};

/// Eq. (2) to (4) for the edge that begins at sample `start` and goes along x or z.
double edgeFactor(const BoundsGrid& terrain, const FactorSettings& settings,
                  const depth_images::View& view, glm::ivec2 start, bool isAlongX, int level);

/// Sides u = 0, v = 0, u = 1, v = 1 (u along x, v along z), as GL numbers the outer factors.
std::array<double, 4> outerFactors(const BoundsGrid& terrain, const FactorSettings& settings,
                                   const depth_images::View& view, glm::ivec2 origin, int level);

/// No fewer triangles than a patch of these outer factors is cut into, whatever the spacing.
double triangleBound(const std::array<double, 4>& outer, InnerFactors inner);

}  // namespace gfxrepro::terrain_tessellation
