// Generators of the outdoor scenes of [xie2017] Fig. 8–12: none was published, these have the
// printed triangle counts, exactly. Their other numbers are free: what a scene consists of shares
// the triangles. Nothing is double-sided: thin sheets are two coincident polygons, as back faces
// are culled in all drawings ([xie2017] Sec. 2.2.2).
#pragma once

#include <cstdint>
#include <numbers>

#include "engine/core/params.h"
#include "engine/scene/scene.h"

namespace gfxrepro::scene {

inline constexpr float kPi = std::numbers::pi_v<float>;

/// Twigs woven into a bowl, eggs in it, a forked branch below. Exactly `triangles`; where `twigs`
/// says nothing their number follows from it, the bowl stays, and the twigs get thinner so that the
/// wood in it stays.
Scene birdNest(Params& params, std::uint64_t seed);

/// Bent blades on uneven ground. Exactly `triangles`; where `blades` says nothing their number
/// follows from it, field and blade lengths stay, and the blades' width keeps its ratio to the
/// distance between them.
Scene grass(Params& params, std::uint64_t seed);

/// A downtown: streets, sidewalks, towers, houses, trees and cars; a building under its centre.
/// Exactly `triangles`: windows, street furniture and, for the last few, the ground take them up.
Scene city(Params& params, std::uint64_t seed);
/// A deciduous tree with a crown of leaves on a disc of ground. Exactly `triangles`: the leaves
/// share what the wood leaves.
Scene tree(Params& params, std::uint64_t seed);

/// Four boxes and two views of which neither sees C ([xie2017] Fig. 11–12), for a baseline V₀V₁ of
/// half its box's diagonal.
Scene fourObjects(Params& params, std::uint64_t seed);

}  // namespace gfxrepro::scene
