// From where terrain is seen: the scene's cameras and paths, or ones that any height map has.
#pragma once

#include <string>

#include "runner/scene/scene.h"

namespace gfxrepro::terrain_tessellation {

/// The camera of frame `frame` of `frameCount`. `view` names a path or a camera of the scene; where
/// none is called so, one of these, worked out from the heights alone:
/// `overview`: the whole map from high above its southern border;
/// `valley`: a low flight towards the highest summit;
/// `round_flight`: a low round flight about the map's centre, as a path.
/// Throws Error for other names.
scene::Camera terrainCamera(const scene::Scene& scene, const std::string& view, int frame,
                            int frameCount, float aspect);

/// The height of the terrain's surface, bilinear between samples, its border's beyond them.
float heightAt(const scene::HeightMap& map, float x, float z);

}  // namespace gfxrepro::terrain_tessellation
