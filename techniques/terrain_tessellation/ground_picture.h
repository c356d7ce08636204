// A picture of the ground, made from its heights: no aerial picture of the papers' map is at hand.
#pragma once

#include "engine/image/image.h"
#include "engine/scene/height_map.h"

namespace gfxrepro::terrain_tessellation {

/// sRGB, north on top, `sidePx` along the map's longer side: water, fields and woods in patches,
/// bare rock on slopes, snow on summits, each mottled. Seeded by nothing: a map has one picture.
image::Image8 groundPicture(const scene::HeightMap& map, int sidePx);

}  // namespace gfxrepro::terrain_tessellation
