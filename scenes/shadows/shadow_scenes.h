// Generators of the two scenes for [zju2005] Sec. 4.4, whose own were never published.
#pragma once

#include <cstdint>

#include "engine/core/params.h"
#include "engine/scene/scene.h"

namespace gfxrepro::scene {

/// A shape that stands on a square plane, and beside it plates that float at small heights: what a
/// shadow map's bias has to tell from contact.
Scene objectOnPlane(Params& params, std::uint64_t seed);

/// A paved square between houses, with what shadow maps find hard: railings, poles, wires and
/// leaves thinner than a texel, and plates and crates a few centimetres above the ground.
Scene townSquare(Params& params, std::uint64_t seed);

}  // namespace gfxrepro::scene
