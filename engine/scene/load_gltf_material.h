// Materials and textures of glTF files.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "engine/scene/load_gltf_accessor.h"
#include "engine/scene/scene.h"

namespace gfxrepro::scene::gltf {

/// Which texture coordinates a material reads, and KHR_texture_transform's uv' = matrix · (uv, 1).
struct TextureUse {
    int texcoordSet = 0;
    bool isTransformed = false;
    glm::mat3x2 transform{1.0F};

    bool operator==(const TextureUse&) const = default;
};

/// Adds all materials to `scene`, and the textures that they use: base colour, metallic-roughness,
/// normal and emissive, not occlusion. Returns how each reads them: as its first texture in this
/// order does. One that reads other coordinates is left out, with a line in Scene::warnings. Throws
/// Error for textures and images that are not there or broken.
std::vector<TextureUse> addMaterials(const File& file, const Accessors& accessors, Scene& scene);

}  // namespace gfxrepro::scene::gltf
