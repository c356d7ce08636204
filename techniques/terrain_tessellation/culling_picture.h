// Figure 10 as a map: which tiles and patches of a view are drawn, and which were culled.
#pragma once

#include <span>

#include "engine/image/image.h"
#include "techniques/terrain_tessellation/factor_check.h"

namespace gfxrepro::terrain_tessellation {

/// North is up, `sizePx` along the map's longer side. Drawn patches are green, culled ones orange,
/// culled tiles grey; lines are the borders of patches and, white, of tiles. `tiles` cover the map,
/// `factors` are theirs as FactorReplay gives them; `isCulling`: whether tiles were culled.
image::ImageF cullingPicture(const scene::HeightMap& map, std::span<const Tile> tiles,
                             const TileSettings& settings, std::span<const PatchFactors> factors,
                             const glm::mat4& clipFromWorld, bool isCulling, int sizePx);

}  // namespace gfxrepro::terrain_tessellation
