// The generator `sdf_model`, and its shapes: y up, within about [−1, 1]³, facing +z.
#pragma once

#include <cstdint>

#include "engine/core/params.h"
#include "engine/scene/scene.h"
#include "scenes/shared/sdf.h"

namespace gfxrepro::scene {

/// A stand-in for a scanned model, or a body with known answers: one mesh with exactly `triangles`
/// and, where `vertices` is given, exactly as many vertices.
Scene sdfModel(Params& params, std::uint64_t seed);

namespace shapes {

// Models; `seed` moves their relief.
sdf::Shape blade(std::uint32_t seed);
sdf::Shape brain(std::uint32_t seed);
sdf::Shape buddha(std::uint32_t seed);
sdf::Shape bunny(std::uint32_t seed);
sdf::Shape dragon(std::uint32_t seed);
sdf::Shape duck(std::uint32_t seed);
sdf::Shape hand(std::uint32_t seed);
sdf::Shape head(std::uint32_t seed);
sdf::Shape hip(std::uint32_t seed);
sdf::Shape hugo(std::uint32_t seed);
sdf::Shape lion(std::uint32_t seed);
sdf::Shape wagner(std::uint32_t seed);

// Bodies with known answers.
sdf::Shape sphere(std::uint32_t seed);      // radius 1
sdf::Shape torus(std::uint32_t seed);       // around y, radius 0.7, tube 0.3
sdf::Shape linkedTori(std::uint32_t seed);  // radius 0.5, tube 0.12, through each other's hole

}  // namespace shapes
}  // namespace gfxrepro::scene
