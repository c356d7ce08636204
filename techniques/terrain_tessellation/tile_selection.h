// Which tiles are drawn, and at which level: [zhang2012] Sec. 3.1, on the CPU.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "engine/scene/scene.h"
#include "techniques/terrain_tessellation/terrain_metadata.h"

namespace gfxrepro::terrain_tessellation {

struct TileSettings {
    int patchesPerTile = 8;  // M, a side
    int blocksPerPatch = 2;  // N, a side

    int blocksPerTile() const { return patchesPerTile * blocksPerPatch; }
};

/// patchesPerTile² patches of one level.
struct Tile {
    int level = 0;               // of its blocks
    glm::ivec2 originSample{0};  // north-western corner, in full-resolution samples (column, row)
    int sizeSamples = 0;         // a side, in full-resolution samples; may reach beyond the map
    glm::ivec2 firstBlock{0};    // column and row at its level; blocksPerTile() a side
    scene::Box box;              // world, of the samples within the map
    float errorM = 0.0F;         // ε_max: the greatest of its blocks
    float distanceM = 0.0F;      // d: from the eye to the box, 0 inside
    float screenErrorPx = 0.0F;  // ρ of Eq. (1); infinite where d is 0 and ε is not
};

struct TileSelection {
    std::vector<Tile> tiles;
    int culledCount = 0;  // tiles that the walk dropped as outside the frustum
};

struct TileView {
    glm::vec3 eye{0.0F};            // world
    glm::mat4 clipFromWorld{1.0F};  // OpenGL's: −w ≤ x, y, z ≤ w is inside
    float pixelsPerTangent = 1.0F;  // k = W / (2 tan(θ/2)), θ horizontal, of Eq. (1)
};

/// k of Eq. (1).
float pixelsPerTangent(int widthPx, float horizontalFovRad);

/// False only where the box is wholly outside one of the frustum's planes.
bool mayBeVisible(const scene::Box& box, const glm::mat4& clipFromWorld);

/// The tiles of all levels. A tile of level l is blocksPerTile() blocks of level l wide; four tiles
/// of level l − 1 cover it.
class TileTree {
  public:
    /// `metadata.settings().tileBlocks` must be settings.blocksPerTile().
    TileTree(const TerrainMetadata& metadata, const TileSettings& settings);

    int levelCount() const { return static_cast<int>(levels_.size()); }
    const TileSettings& settings() const { return settings_; }

    /// [zhang2012] Sec. 3.1: from the root down until ρ < τ or the finest level is reached. The
    /// frustum test comes first, in the same walk. The tiles cover the map (what of it is visible)
    /// without overlap; the nearest come first.
    TileSelection select(const TileView& view, float maxErrorPx, bool isCulling = true) const;
    /// For comparison, as CDLOD (Strugar 2010): a tile of level l > 0 is divided where the eye is
    /// nearer than finestRangeM · 2^(l − 1), whatever its error.
    TileSelection selectByDistance(const TileView& view, float finestRangeM,
                                   bool isCulling = true) const;

  private:
    struct Level {
        int tilesPerSide = 1;
        std::vector<HeightRange> ranges;
    };
    Tile tileAt(int level, glm::ivec2 place) const;
    template <class IsFineEnough>
    void walk(int level, glm::ivec2 place, const TileView& view, bool isCulling,
              const IsFineEnough& isFineEnough, TileSelection& selection) const;
    template <class IsFineEnough>
    TileSelection selectWhere(const TileView& view, bool isCulling,
                              const IsFineEnough& isFineEnough) const;

    TileSettings settings_;
    int blockSegments_ = 32;
    glm::ivec2 sizeSamples_{0};
    glm::vec2 spacingM_{1.0F};
    std::vector<Level> levels_;
};

}  // namespace gfxrepro::terrain_tessellation
