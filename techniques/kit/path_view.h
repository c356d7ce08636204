// Which camera a frame of an experiment is seen with.
#pragma once

#include <optional>
#include <string>

#include "engine/scene/scene.h"

namespace gfxrepro::kit {

/// Where from the view "AZIMUTH ELEVATION" (in degrees) looks; none: `view` is something else.
std::optional<glm::vec3> towardsEyeOf(const std::string& view);

/// The middle of frame `frame` in a time of 0 … 1: (frame + 0.5) / frameCount. Objects are posed
/// for it, too.
double frameTime(int frame, int frameCount);

/// The camera at a time of 0 … 1. `view` names a path of the scene or, where none is called so, a
/// camera; "30 17" frames the scene from an azimuth of 30°, from +z towards +x, and an elevation of
/// 17°; "1 2 3 > 0 1 0" looks from a point of the world at another one, and several such, with ';'
/// between them, are the keys of a path; empty: the first path, else the first camera, else one
/// that frames the scene at `aspect` (width / height). Throws Error for a name that the scene does
/// not have.
scene::Camera cameraAtTime(const scene::Scene& scene, const std::string& view, double time,
                           float aspect);
/// The camera of a frame, at its frameTime().
scene::Camera cameraFor(const scene::Scene& scene, const std::string& view, int frame,
                        int frameCount, float aspect);

/// The camera of what stands still: `view` names a path of the scene, whose middle it is, or a
/// camera; empty: the first camera, else one that frames the scene. Throws as cameraAtTime().
scene::Camera stillCamera(const scene::Scene& scene, const std::string& view, float aspect);

}  // namespace gfxrepro::kit
