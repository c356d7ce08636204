// Generated height maps as scenes.
#pragma once

#include <cstdint>

#include "runner/config/params.h"
#include "runner/scene/scene.h"

namespace gfxrepro::scene {

/// Mountains and lowland of fractal noise (fractalTerrain), a height map without triangles.
Scene terrain(config::Params& params, std::uint64_t seed);

}  // namespace gfxrepro::scene
