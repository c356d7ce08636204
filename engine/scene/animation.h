// Where cameras and objects are at a time between 0 and 1.
#pragma once

#include <vector>

#include "engine/scene/scene.h"

namespace gfxrepro::scene {

/// The uniform Catmull-Rom spline between p1 and p2.
template <class T>
T catmullRom(const T& p0, const T& p1, const T& p2, const T& p3, float u) {
    return 0.5F * (2.0F * p1 + (p2 - p0) * u + (2.0F * p0 - 5.0F * p1 + 4.0F * p2 - p3) * (u * u) +
                   (3.0F * p1 - p0 - 3.0F * p2 + p3) * (u * u * u));
}

/// The camera at `time` (clamped to [0, 1]) of a path: position, target, up and field of view by
/// Catmull-Rom splines through the keys, near and far plane linearly. Throws Error for a path
/// without keys.
Camera cameraAt(const CameraPath& path, double time);

/// `worldFromMesh` of every instance at `time`; the rest pose for those that do not move.
std::vector<glm::mat4> posesAt(const Scene& scene, double time);

}  // namespace gfxrepro::scene
