#include "techniques/terrain_tessellation/tile_selection.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/error.h"

namespace gfxrepro::terrain_tessellation {

float pixelsPerTangent(int widthPx, float horizontalFovRad) {
    return static_cast<float>(widthPx) / (2.0F * std::tan(0.5F * horizontalFovRad));
}

bool mayBeVisible(const scene::Box& box, const glm::mat4& clipFromWorld) {
    glm::bvec3 isAllBelow(true);
    glm::bvec3 isAllAbove(true);
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec4 clip =
            clipFromWorld * glm::vec4((corner & 1) != 0 ? box.max.x : box.min.x,
                                      (corner & 2) != 0 ? box.max.y : box.min.y,
                                      (corner & 4) != 0 ? box.max.z : box.min.z, 1.0F);
        for (int axis = 0; axis < 3; ++axis) {
            isAllBelow[axis] = isAllBelow[axis] && clip[axis] < -clip.w;
            isAllAbove[axis] = isAllAbove[axis] && clip[axis] > clip.w;
        }
    }
    return !glm::any(isAllBelow) && !glm::any(isAllAbove);
}

TileTree::TileTree(const TerrainMetadata& metadata, const TileSettings& settings)
    : settings_(settings),
      blockSegments_(metadata.settings().blockSegments),
      sizeSamples_(metadata.sizeSamples()),
      spacingM_(metadata.spacingM()) {
    const int perTile = settings.blocksPerTile();
    GFXREPRO_ASSERT_EQ(metadata.settings().tileBlocks, perTile);
    for (int level = 0; level < metadata.levelCount() && metadata.blocksPerSide(level) >= perTile;
         ++level) {
        Level tiles;
        tiles.tilesPerSide = metadata.blocksPerSide(level) / perTile;
        const auto side = static_cast<std::size_t>(tiles.tilesPerSide);
        tiles.ranges.resize(side * side, {std::numeric_limits<float>::infinity(),
                                          -std::numeric_limits<float>::infinity(), 0.0F});
        for (int row = 0; row < metadata.blocksPerSide(level); ++row) {
            for (int column = 0; column < metadata.blocksPerSide(level); ++column) {
                const auto tile = static_cast<std::size_t>(row / perTile) * side +
                                  static_cast<std::size_t>(column / perTile);
                tiles.ranges[tile].add(metadata.block(level, column, row).whole);
            }
        }
        levels_.push_back(std::move(tiles));
    }
}

Tile TileTree::tileAt(int level, glm::ivec2 place) const {
    const Level& tiles = levels_[static_cast<std::size_t>(level)];
    const HeightRange& range = tiles.ranges[static_cast<std::size_t>(place.y) *
                                                static_cast<std::size_t>(tiles.tilesPerSide) +
                                            static_cast<std::size_t>(place.x)];
    Tile tile;
    tile.level = level;
    tile.sizeSamples = settings_.blocksPerTile() * blockSegments_ << level;
    tile.originSample = place * tile.sizeSamples;
    tile.firstBlock = place * settings_.blocksPerTile();
    const glm::ivec2 last = glm::min(tile.originSample + tile.sizeSamples, sizeSamples_ - 1);
    const glm::vec2 from = glm::vec2(tile.originSample) * spacingM_;
    const glm::vec2 to = glm::vec2(last) * spacingM_;
    tile.box.add(glm::vec3(from.x, range.minM, from.y));
    tile.box.add(glm::vec3(to.x, range.maxM, to.y));
    tile.errorM = range.errorM;
    return tile;
}

template <class IsFineEnough>
void TileTree::walk(int level, glm::ivec2 place, const TileView& view, bool isCulling,
                    const IsFineEnough& isFineEnough, TileSelection& selection) const {
    Tile tile = tileAt(level, place);
    // A tile that begins at the last sample or after it has no ground; a map of one sample keeps
    // its only tile.
    if (glm::any(glm::greaterThanEqual(tile.originSample, glm::max(sizeSamples_ - 1, 1)))) return;
    if (isCulling && !mayBeVisible(tile.box, view.clipFromWorld)) {
        ++selection.culledCount;
        return;
    }
    tile.distanceM = glm::distance(view.eye, glm::clamp(view.eye, tile.box.min, tile.box.max));
    // [zhang2012] Eq. (1)
    if (tile.errorM > 0.0F) {
        tile.screenErrorPx = tile.distanceM > 0.0F
                                 ? tile.errorM * view.pixelsPerTangent / tile.distanceM
                                 : std::numeric_limits<float>::infinity();
    }
    if (level == 0 || isFineEnough(tile)) {
        selection.tiles.push_back(tile);
        return;
    }
    for (const glm::ivec2 child : {glm::ivec2(0, 0), {1, 0}, {0, 1}, {1, 1}}) {
        walk(level - 1, 2 * place + child, view, isCulling, isFineEnough, selection);
    }
}

template <class IsFineEnough>
TileSelection TileTree::selectWhere(const TileView& view, bool isCulling,
                                    const IsFineEnough& isFineEnough) const {
    TileSelection selection;
    walk(levelCount() - 1, {0, 0}, view, isCulling, isFineEnough, selection);
    // The nearest first: hidden fragments fail the depth test before they are shaded.
    std::stable_sort(selection.tiles.begin(), selection.tiles.end(),
                     [](const Tile& a, const Tile& b) { return a.distanceM < b.distanceM; });
    return selection;
}

TileSelection TileTree::select(const TileView& view, float maxErrorPx, bool isCulling) const {
    return selectWhere(view, isCulling,
                       [&](const Tile& tile) { return tile.screenErrorPx < maxErrorPx; });
}

TileSelection TileTree::selectByDistance(const TileView& view, float finestRangeM,
                                         bool isCulling) const {
    return selectWhere(view, isCulling, [&](const Tile& tile) {
        return tile.distanceM >= std::ldexp(finestRangeM, tile.level - 1);
    });
}

}  // namespace gfxrepro::terrain_tessellation
