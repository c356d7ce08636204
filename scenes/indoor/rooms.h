// Generators of rooms: those of [xie2017] chapters 4 and 5, of which none was published, with the
// printed counts of triangles and reflectors; and the Cornell box, whose data are.
#pragma once

#include <cstdint>

#include "engine/core/params.h"
#include "engine/scene/scene.h"

namespace gfxrepro::scene {

/// 280,000 triangles: 150,000 of diffuse and 130,000 of 25 reflective objects.
Scene livingRoom(Params& params, std::uint64_t seed);
/// 90,000 triangles: 44,000 of diffuse and 46,000 of 15 reflective objects.
Scene bathroom(Params& params, std::uint64_t seed);
/// 32 triangles. The open side is towards the camera; of the light only the colour is a guess.
Scene cornellBox(Params& params, std::uint64_t seed);

}  // namespace gfxrepro::scene
