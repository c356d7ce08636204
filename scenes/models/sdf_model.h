// Generator of closed models from the shapes of shapes.h.
#pragma once

#include <cstdint>

#include "engine/core/params.h"
#include "engine/scene/scene.h"

namespace gfxrepro::scene {

/// A stand-in for a scanned model, or a body with known answers: one mesh with exactly `triangles`
/// and, where `vertices` is given, exactly as many vertices.
Scene sdfModel(Params& params, std::uint64_t seed);

}  // namespace gfxrepro::scene
