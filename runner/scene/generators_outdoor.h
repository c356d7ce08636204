// Outdoor scenes of many small parts: much depth complexity, all diffuse.
#pragma once

#include <cstdint>

#include "runner/config/params.h"
#include "runner/scene/scene.h"

namespace gfxrepro::scene {

/// Twigs woven into a bowl, eggs in it, a forked branch below. Exactly `triangles`; the number of
/// twigs follows from it, the bowl stays, and the twigs get thinner so that the wood in it stays.
Scene birdNest(config::Params& params, std::uint64_t seed);

/// Bent blades on uneven ground. Exactly `triangles`; the number of blades follows from it, field
/// and blade lengths stay, and the blades' width keeps its ratio to the distance between them.
Scene grass(config::Params& params, std::uint64_t seed);

}  // namespace gfxrepro::scene
