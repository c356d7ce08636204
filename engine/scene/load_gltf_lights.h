// KHR_lights_punctual of glTF files.
#pragma once

#include <glm/glm.hpp>

#include "engine/scene/load_gltf_accessor.h"
#include "engine/scene/scene.h"

namespace gfxrepro::scene::gltf {

/// The lights of the nodes that are visited. Point lights are taken; spot lights shine in all
/// directions, and directional ones, which have no place, are left out: a line each in
/// Scene::warnings.
class Lights {
  public:
    explicit Lights(const File& file) : file_(file) {}
    /// Nothing where the node has none. Throws Error for lights that are not there or broken.
    void add(const tinygltf::Node& node, int index, const glm::mat4& worldFromNode);
    /// How bright a candela is depends on the exposure, which a file does not say. All lights
    /// together get the intensity kAllLights, each its share, and a radius of half the scene's
    /// diagonal.
    void moveTo(Scene& scene);

  private:
    const File& file_;
    std::vector<PointLight> lights_;  // intensities in candela
    int spots_ = 0, directional_ = 0;
};

/// As much as reflections' light has that is made up where a scene has none.
constexpr float kAllLights = 0.9F;

}  // namespace gfxrepro::scene::gltf
