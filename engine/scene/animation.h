// Where cameras and objects are at a time between 0 and 1.
#pragma once

#include <vector>

#include "engine/scene/scene.h"

namespace gfxrepro::scene {

/// The camera at `time` (clamped to [0, 1]) of a path: position, target, up and field of view by
/// Catmull-Rom splines through the keys, near and far plane linearly. Throws Error for a path
/// without keys.
Camera cameraAt(const CameraPath& path, double time);

/// `worldFromMesh` of every instance at `time`; the rest pose for those that do not move.
std::vector<glm::mat4> posesAt(const Scene& scene, double time);

}  // namespace gfxrepro::scene
