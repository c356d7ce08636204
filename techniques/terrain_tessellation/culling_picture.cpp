#include "techniques/terrain_tessellation/culling_picture.h"

#include <algorithm>
#include <cmath>

namespace gfxrepro::terrain_tessellation {

namespace {

constexpr glm::vec3 kDrawn(0.35F, 0.75F, 0.3F), kCulledPatch(0.95F, 0.55F, 0.15F),
    kCulledTile(0.4F, 0.4F, 0.42F), kTileBorder(1.0F);

/// Lit from the north-west, so that the ground can be told.
float lightAt(const scene::HeightMap& map, glm::ivec2 at, int step) {
    const float rise =
        map.clampedHeightM(at.x - step, at.y - step) - map.clampedHeightM(at.x + step, at.y + step);
    const float slope = rise / (2.0F * std::sqrt(2.0F) * static_cast<float>(step) * map.spacingM);
    return std::clamp(0.8F - 1.5F * slope, 0.35F, 1.2F);
}

}  // namespace

image::ImageF cullingPicture(const scene::HeightMap& map, std::span<const Tile> tiles,
                             const TileSettings& settings, std::span<const PatchFactors> factors,
                             const glm::mat4& clipFromWorld, bool isCulling, int sizePx) {
    const glm::ivec2 cells = glm::max(map.sizeSamples - 1, 1);
    const float samplesPerPx =
        static_cast<float>(std::max(cells.x, cells.y)) / static_cast<float>(sizePx);
    const glm::ivec2 size = glm::max(glm::ivec2(glm::vec2(cells) / samplesPerPx), glm::ivec2(1));
    image::ImageF picture(size.x, size.y, 3);
    const int side = settings.patchesPerTile;
    const int step = std::max(1, static_cast<int>(samplesPerPx));
    for (std::size_t t = 0; t < tiles.size(); ++t) {
        const Tile& tile = tiles[t];
        const bool isTileCulled = isCulling && !mayBeVisible(tile.box, clipFromWorld);
        const glm::vec2 origin = glm::vec2(tile.originSample) / samplesPerPx;
        const float tilePx = static_cast<float>(tile.sizeSamples) / samplesPerPx;
        const float patchPx = tilePx / static_cast<float>(side);
        const glm::ivec2 from(glm::ceil(origin)),
            to = glm::min(glm::ivec2(glm::ceil(origin + tilePx)), size);
        for (int y = from.y; y < to.y; ++y) {
            for (int x = from.x; x < to.x; ++x) {
                const glm::vec2 inside = (glm::vec2(x, y) - origin) / patchPx;
                const glm::ivec2 cell = glm::clamp(glm::ivec2(inside), 0, side - 1);
                const glm::vec2 fromBorderPx = (inside - glm::vec2(cell)) * patchPx;
                const auto patch = t * static_cast<std::size_t>(side * side) +
                                   static_cast<std::size_t>(cell.y * side + cell.x);
                glm::vec3 colour = isTileCulled                    ? kCulledTile
                                   : factors[patch].outer.x < 0.0F ? kCulledPatch
                                                                   : kDrawn;
                colour *= lightAt(map, glm::ivec2(glm::vec2(x, y) * samplesPerPx), step);
                // Borders of patches only where patches are wider than lines.
                if (patchPx >= 4.0F && glm::any(glm::lessThan(fromBorderPx, glm::vec2(1.0F)))) {
                    colour *= 0.6F;
                }
                if (x == from.x || y == from.y) colour = kTileBorder;
                for (int c = 0; c < 3; ++c) picture.at(x, y, c) = colour[c];
            }
            map.release();
        }
    }
    return picture;
}

}  // namespace gfxrepro::terrain_tessellation
