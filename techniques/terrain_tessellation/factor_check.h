// The control stage's factors in the open: replayed in a compute shader, and compared over edges.
#pragma once

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
    std::vector<PatchFactors> run(std::span<const Tile> tiles, const depth_images::View& view);

  private:
    const DeviceTerrain* terrain_;
    RenderSettings settings_;
    gl::Program program_;
};

struct EdgeAgreement {
    int sharedEdges = 0;   // between two patches of one level, neither culled
    int unequalEdges = 0;  // of these, with factors that differ in any bit
};
EdgeAgreement compareEdges(std::span<const Tile> tiles, const TileSettings& settings,
                           std::span<const PatchFactors> factors);

}  // namespace gfxrepro::terrain_tessellation
