// Whether patches fit together. The control stage's factors, replayed in a compute shader, are
// compared over edges; tessellated triangles by the vertices that the rasterizer gets. No pixel,
// and so no view, decides it.
#pragma once

#include <cstddef>
#include <span>

#include "techniques/terrain_tessellation/terrain_renderer.h"

namespace gfxrepro::terrain_tessellation {

struct PatchFactors {
    glm::vec4 outer{0.0F};  // u = 0, v = 0, u = 1, v = 1; −1: culled
};

/// One a patch without skirts, tile by tile, row by row; the same GLSL as the control stage.
class FactorReplay {
  public:
    FactorReplay(const gl::ShaderLibrary& shaders, const DeviceTerrain& terrain,
                 const RenderSettings& settings);
    std::vector<PatchFactors> run(std::span<const Tile> tiles, const kit::View& view);
    void setSegmentPx(float deltaS) { settings_.factors.segmentPx = deltaS; }

  private:
    const DeviceTerrain* terrain_;
    RenderSettings settings_;
    gl::Pass pass_;
};

struct EdgeAgreement {
    int sharedEdges = 0;   // between two patches of one level, neither culled
    int unequalEdges = 0;  // of these, with factors that differ in any bit
};
/// Sec. 6 of [zhang2012]: twice the ΔS halves the factors.
struct FactorHalving {
    int edges = 0;           // of patches that are not culled
    int greatestEdges = 0;   // of these, at the greatest factor
    int unclampedEdges = 0;  // … at neither limit at ΔS and at 2 ΔS
    int unhalvedEdges = 0;   // of these, not halved to the bit
};
/// Of the same patches at ΔS and at 2 ΔS.
FactorHalving compareHalving(const FactorSettings& settings, std::span<const PatchFactors> factors,
                             std::span<const PatchFactors> coarser);

/// How many times as large an edge's factor is as that of its patch's inside along it, over edges
/// where it is larger: how suddenly vertices thin out.
struct EdgeJumps {
    double mean = 1.0, greatest = 1.0;
};
EdgeJumps edgeJumps(std::span<const PatchFactors> factors, InnerFactors inner);

EdgeAgreement compareEdges(std::span<const Tile> tiles, const TileSettings& settings,
                           std::span<const PatchFactors> factors);

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
