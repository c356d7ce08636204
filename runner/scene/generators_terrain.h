// Generated height maps as scenes.
#pragma once

#include <cstdint>

#include "runner/config/params.h"
#include "runner/scene/scene.h"

namespace gfxrepro::scene {

/// Mountains and lowland of fractal noise (fractalTerrain), a height map without triangles.
Scene terrain(config::Params& params, std::uint64_t seed);

/// Two views of a height map: "overview" from the south-east above it, "flight" low over its middle
/// northwards. Their reach covers the whole map.
void addTerrainCameras(Scene& scene);

}  // namespace gfxrepro::scene
