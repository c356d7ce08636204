// Draws tiles of terrain: tessellated to the screen, as plain grids, and as morphing grids.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "runner/gl/program.h"
#include "techniques/terrain_tessellation/edge_factors.h"
#include "techniques/terrain_tessellation/height_textures.h"

namespace gfxrepro::terrain_tessellation {

enum class Spacing { FractionalEven, FractionalOdd, Equal };
enum class Shading {
    SlopeAltitude,
    Height,  // the height in metres as drawn, in red: for tests and errors
};

struct RenderSettings {
    FactorSettings factors;
    Spacing spacing = Spacing::FractionalEven;
    bool cullsPatches = true;
    bool hasSkirts = true;
    bool isWireframe = false;
    Shading shading = Shading::SlopeAltitude;
    /// One draw call generates no more than about this; 0: no limit. See splitPrimitivesFor().
    int splitPrimitives = 0;
};

/// llvmpipe's tessellated draws take a time that grows with the square of what one generates.
/// Calls of 2^14 triangles were 2.5 times as fast as of 2^16, at ΔS = 1 on two cores.
int splitPrimitivesFor(bool isSoftwareDevice);

struct DrawCounts {
    std::uint64_t triangles = 0;  // GL_PRIMITIVES_GENERATED, skirts included
    int tiles = 0;
    int patches = 0;        // given to the control stage, without skirts
    int culledPatches = 0;  // of these, dropped by it
    int drawCalls = 0;
};

/// Sets of the morphing grid: level l is drawn unmorphed up to rangesM[l]·startShare from the eye
/// and as level l + 1 from rangesM[l] on. [strugar2009]
struct MorphRanges {
    std::vector<float> rangesM;  // one a level, at most 16
    float startShare = 0.7F;
};

/// Sets up what terrain.glsl and factors.glsl read; the buffers must live until the draw is done.
gl::Buffer bindTiles(std::span<const Tile> tiles, int stepSamples);
void bindTerrain(const gl::Program& program, const DeviceTerrain& terrain,
                 const depth_images::View& view);
void bindFactors(const gl::Program& program, const DeviceTerrain& terrain,
                 const RenderSettings& settings, const depth_images::View& view);
gl::Defines terrainDefines(const DeviceTerrain& terrain, const RenderSettings& settings);
constexpr unsigned kCounterBinding = 3;

/// `terrain` must outlive it. Draws go into `target`, which the caller has cleared.
class TerrainRenderer {
  public:
    TerrainRenderer(const gl::ShaderLibrary& shaders, const DeviceTerrain& terrain,
                    const RenderSettings& settings);

    /// [zhang2012] Sec. 2.2 to 2.4.
    DrawCounts drawTessellated(std::span<const Tile> tiles, const depth_images::View& view,
                               const gl::Framebuffer& target);
    /// Every tile as a grid of `stepSamples`: 1 is the full resolution (the truth); a patch's span
    /// is what is drawn without tessellation.
    DrawCounts drawGrid(std::span<const Tile> tiles, int stepSamples,
                        const depth_images::View& view, const gl::Framebuffer& target);
    DrawCounts drawMorphed(std::span<const Tile> tiles, const MorphRanges& ranges,
                           const depth_images::View& view, const gl::Framebuffer& target);

    const RenderSettings& settings() const { return settings_; }
    void setSegmentPx(float deltaS) { settings_.factors.segmentPx = deltaS; }

  private:
    std::array<double, 4> outerFactors(const Patch& patch, const depth_images::View& view,
                                       const glm::dmat4& clipFromWorld) const;
    int drawPatches(std::span<const Tile> tiles, const depth_images::View& view,
                    int patchesPerTile) const;
    int drawGridTile(const gl::Program& program, int tile, int cellsPerSide) const;
    void bindShading(const gl::Program& program) const;

    const DeviceTerrain* terrain_;
    RenderSettings settings_;
    gl::Program tessellated_, grid_, morphed_;
    gl::Buffer counters_;
    gl::VertexArray noAttributes_;
    gl::PrimitiveQuery primitives_;
};

}  // namespace gfxrepro::terrain_tessellation
