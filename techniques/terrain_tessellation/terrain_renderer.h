// Draws tiles of terrain: tessellated to the screen, as plain grids, and as morphing grids.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "engine/gl/objects.h"
#include "engine/gl/pass.h"
#include "engine/scene/height_map.h"
#include "techniques/terrain_tessellation/patches.h"
#include "techniques/terrain_tessellation/terrain_metadata.h"
#include "techniques/terrain_tessellation/tile_selection.h"

namespace gfxrepro::terrain_tessellation {

/// A page is a layer of a texture array: every 2^level-th sample of a tile of that level, one more
/// to the west and north, two more beyond the eastern and southern rim. That is what normals at the
/// rim reach, so that neighbours agree there. Beyond the map the border's heights go on.
class HeightPages {
  public:
    /// Texel (i, j) is the sample at origin + (i − 1, j − 1) · 2^level.
    static constexpr int kBorder = 1, kMoreTexels = 4;

    /// `map` must outlive it. `tileCount`: how many there are at all, no more pages are made.
    /// Throws Error where the budget holds no page.
    HeightPages(const scene::HeightMap& map, std::size_t budgetBytes, int tileSegments,
                int tileCount);

    int capacity() const { return texture_.size().z; }
    /// The layers of at most capacity() tiles; those that are not there are loaded, in the place of
    /// those that were asked for longest ago.
    std::vector<int> load(std::span<const Tile> tiles);
    /// Since the beginning.
    std::uint64_t loadedCount() const { return loadedCount_; }
    const gl::Texture& texture() const { return texture_; }

  private:
    using Key = std::tuple<int, int, int>;  // level, origin

    int leastRecentlyUsed() const;
    void fill(int layer, const Tile& tile);

    const scene::HeightMap* map_;
    gl::Texture texture_;
    std::map<Key, int> layers_;
    std::vector<Key> keys_;               // by layer
    std::vector<std::uint64_t> lastUse_;  // by layer, in calls of load(); 0: empty
    std::uint64_t clock_ = 0, loadedCount_ = 0;
};

/// The map must be the one that the metadata was built from; both must outlive this.
class DeviceTerrain {
  public:
    /// Throws UnsupportedError beyond the device's texture or buffer size, Error for a map whose
    /// size is not the metadata's or a budget that holds no tile.
    DeviceTerrain(const scene::HeightMap& map, const TerrainMetadata& metadata,
                  std::size_t budgetBytes = std::size_t{256} << 20);

    const TerrainMetadata& metadata() const { return *metadata_; }
    HeightPages& pages() { return pages_; }
    const HeightPages& pages() const { return pages_; }
    /// Of terrain.glsl and factors.glsl.
    gl::Resources resources() const;
    float lowestM() const { return lowestM_; }
    float highestM() const { return highestM_; }
    std::size_t sizeBytes() const;

  private:
    const TerrainMetadata* metadata_;
    float lowestM_, highestM_;
    HeightPages pages_;
    gl::Buffer blocks_;
    gl::Buffer firstBlocks_;  // by level
};

enum class Spacing { FractionalEven, FractionalOdd, Equal };
enum class Shading {
    SlopeAltitude,
    Height,        // the height in metres as drawn, in red: for tests and errors
    ColourMap,     // RenderSettings::colourMap, lit likewise
    GeneratedMap,  // … with groundPicture()
    Patches,       // a chequer of the tessellated patches, lit likewise
};

inline bool hasColourMap(Shading shading) {
    return shading == Shading::ColourMap || shading == Shading::GeneratedMap;
}

struct RenderSettings {
    FactorSettings factors;
    Spacing spacing = Spacing::FractionalEven;
    bool cullsPatches = true;
    bool hasSkirts = true;
    bool isWireframe = false;
    Shading shading = Shading::SlopeAltitude;
    /// Over the whole height map, north at v = 0; outlives the renderer. Of Shading::ColourMap and
    /// GeneratedMap.
    const gl::Texture* colourMap = nullptr;
    bool showsUnderside = false;    // of terrain, with an alpha of 0; to find cracks
    bool capturesVertices = false;  // for TerrainRenderer::capture()
    /// For a software rasterizer; without, one call draws all.
    std::optional<BatchLimits> batches;
};

struct DrawCounts {
    std::uint64_t triangles = 0;  // GL_PRIMITIVES_GENERATED, skirts included
    int tiles = 0;
    int patches = 0;        // given to the control stage, without skirts
    int culledPatches = 0;  // of these, dropped by it
    int drawCalls = 0;
};

/// A vertex of a triangle of a tessellated patch, as the rasterizer gets it.
struct CapturedVertex {
    glm::vec2 at{0.0F};      // samples
    std::int32_t patch = 0;  // M² a tile, row by row
    std::int32_t rim = 0;    // −1: of the surface
    glm::vec4 positionClip{0.0F};
};
static_assert(sizeof(CapturedVertex) == 32);

/// Sets of the morphing grid: level l is drawn unmorphed up to rangesM[l]·startShare from the eye
/// and as level l + 1 from rangesM[l] on. [strugar2009]
struct MorphRanges {
    std::vector<float> rangesM;  // one a level, at most 16
    float startShare = 0.7F;
};

/// What terrain.glsl and factors.glsl read beside DeviceTerrain::resources(): the block Tiles,
/// uniforms, defines.
gl::Buffer tileRecords(std::span<const Tile> tiles, std::span<const int> layers);
void setTerrain(const gl::Pass& pass, const DeviceTerrain& terrain, const kit::View& view);
void setFactors(const gl::Pass& pass, const RenderSettings& settings, const kit::View& view);
gl::Defines terrainDefines(const DeviceTerrain& terrain, const RenderSettings& settings);

/// `terrain` must outlive it. Draws go into `target`, which the caller has cleared. Heights that
/// are not on the device are loaded; more tiles than there are pages are drawn in turns.
class TerrainRenderer {
  public:
    TerrainRenderer(const gl::ShaderLibrary& shaders, DeviceTerrain& terrain,
                    const RenderSettings& settings);

    /// [zhang2012] Sec. 3.2, 4.2 and 5.
    void drawTessellated(std::span<const Tile> tiles, const kit::View& view,
                         const gl::Framebuffer& target);
    /// Every sample of each tile's level: of level 0, the full resolution (the truth). Morphed
    /// where ranges are given.
    void drawGrid(std::span<const Tile> tiles, const kit::View& view, const gl::Framebuffer& target,
                  const MorphRanges* morph = nullptr);
    /// Of the last draw; waits for the device.
    DrawCounts counts() const;

    /// Of what drawTessellated() draws, the triangles of skirts; draws nothing.
    std::uint64_t countSkirtTriangles(std::span<const Tile> tiles, const kit::View& view);
    /// Three vertices a triangle of what drawTessellated() draws, without skirts; draws nothing.
    /// Needs RenderSettings::capturesVertices.
    std::vector<CapturedVertex> capture(std::span<const Tile> tiles, const kit::View& view);

    const RenderSettings& settings() const { return settings_; }
    void setShowsUnderside(bool isShown) { settings_.showsUnderside = isShown; }
    void setSegmentPx(float deltaS) { settings_.factors.segmentPx = deltaS; }

  private:
    /// draw(tiles) of as many tiles as there are pages at a time, which `pass` is given.
    template <class Draw>
    void inTurns(const gl::Pass& pass, std::span<const Tile> tiles, const Draw& draw);
    /// The same, counted: by draw(), and primitives and tiles.
    template <class Draw>
    void drawInTurns(const gl::Pass& pass, std::span<const Tile> tiles, const Draw& draw);
    enum class Parts { AsSet, Surface, Skirts };
    DrawCounts drawPatches(std::span<const Tile> tiles, const kit::View& view,
                           Parts parts = Parts::AsSet) const;
    void setTessellated(const kit::View& view);
    void bindNothing() const;
    int drawBatches(const PatchBatches& patches) const;
    int drawGridTile(const gl::Pass& pass, int index, const Tile& tile) const;
    void setShading(const gl::Pass& pass) const;

    DeviceTerrain* terrain_;
    RenderSettings settings_;
    gl::Pass tessellated_, grid_, morphed_;
    gl::Buffer counters_;
    gl::Texture nothing_ = gl::Texture::make2D(GL_R8, {1, 1});
    gl::Framebuffer nowhere_;
    gl::VertexArray noAttributes_;
    gl::PrimitiveQuery primitives_;
    DrawCounts drawn_;  // without what the device counts
};

}  // namespace gfxrepro::terrain_tessellation
