// Cameras that hold a scene with a margin.
#pragma once

#include <glm/glm.hpp>

#include "engine/scene/scene.h"

namespace gfxrepro::scene {

/// Looks at `target` from `toCamera` (any length), with y up, at the least distance at which all
/// vertices stay within `fill` of a square picture (1: touches its border). Near and far planes
/// leave room for moving the camera by about the scene's diagonal. Only operations that IEEE 754
/// rounds exactly.
Camera fittedCamera(const Scene& scene, const glm::vec3& target, const glm::vec3& toCamera,
                    float verticalFovRad, float fill);

}  // namespace gfxrepro::scene
