// From where terrain is seen: the scene's cameras and paths, or ones that any height map has.
#pragma once

#include <string>

#include "engine/scene/scene.h"

namespace gfxrepro::terrain_tessellation {

/// A path or a camera of the scene; where none has the name, one of these, worked out once from the
/// heights alone:
/// `overview`: the whole map from high above its southern border;
/// `valley`: a low flight towards the highest summit;
/// `steep`: down at the ground that the valley is seen from, a few patches wide;
/// `round_flight`: a low round flight about the map's centre, as a path;
/// or one by places or directions, as kit::cameraAtTime() takes it.
class TerrainView {
  public:
    /// `scene` must outlive it. Throws Error for other names, and for places under the ground.
    TerrainView(const scene::Scene& scene, const std::string& name);
    /// Of frame `frame` of `frameCount`.
    scene::Camera camera(int frame, int frameCount, float aspect) const;

  private:
    const scene::HeightMap* map_;
    std::string name_;
    scene::Scene views_;  // cameras and paths, and the corners of what they see
    bool isByPlaces_ = false;
};

/// Along x and z, of a map's picture true to scale, `longerSidePx` along its longer side.
glm::vec2 samplesPerPixel(const scene::HeightMap& map, int longerSidePx);
/// The height of the terrain's surface, bilinear between samples, its border's beyond them.
float heightAt(const scene::HeightMap& map, float x, float z);
/// Of the truth's triangles: a cell is cut from its south-western to its north-eastern sample.
float drawnHeightAt(const scene::HeightMap& map, float x, float z);

}  // namespace gfxrepro::terrain_tessellation
