// What techniques ask of a scene.
#pragma once

#include <string_view>

#include "engine/scene/scene.h"

namespace gfxrepro::kit {

/// Throws Error for a scene without triangles, and for one all of whose points are one.
void requireTriangles(const scene::Scene& scene, std::string_view technique);

}  // namespace gfxrepro::kit
