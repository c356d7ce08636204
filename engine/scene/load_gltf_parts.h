// Materials, lights, morph targets and skins of glTF files.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/core/error.h"
#include "engine/scene/load_gltf_file.h"
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
std::vector<TextureUse> addMaterials(const File& file, const Accessors& accessors, Scene& scene,
                                     LeftOut& leftOut);

/// How many a material has.
std::size_t textureCount(const Material& material);

// KHR_lights_punctual of glTF files.

/// The lights of the nodes that are visited. Point lights are taken; spot lights shine in all
/// directions, and directional ones, which have no place, are left out: a line each in
/// Scene::warnings.
class Lights {
  public:
    explicit Lights(const File& file) : file_(file) {}
    /// Nothing where the node has none. Throws Error for lights that are not there or broken.
    void add(const tinygltf::Node& node, int index, const glm::mat4& worldFromNode);
    /// How bright a candela is depends on the exposure, which only files of ours say. All other
    /// lights together get the intensity kAllLights, each its share, and a radius of half the
    /// scene's diagonal.
    void moveTo(Scene& scene);

  private:
    const File& file_;
    std::vector<PointLight> lights_;  // intensities in candela
    std::vector<PointLight> ours_;    // of files of ours, as they were saved
    int spots_ = 0, directional_ = 0;
};

/// As much as reflections' light has that is made up where a scene has none.
constexpr float kAllLights = 0.9F;

// Morph targets and skins: where vertices stand in the file's default pose.

/// A primitive whose mesh holds those of its vertices that `used` numbers.
struct UsedPart {
    const tinygltf::Primitive& primitive;
    std::size_t vertexCount;  // of its accessors
    std::span<const std::uint32_t> used;
    std::string where;  // for messages

    /// Of what an accessor holds for all vertices, that for those used. Throws Error where it holds
    /// another number of values.
    template <class T>
    std::vector<T> of(const std::vector<T>& all, const std::string& name) const {
        if (all.size() != vertexCount) {
            throw Error(fmt::format("{}: {} values of {} for {} vertices", where, all.size(), name,
                                    vertexCount));
        }
        std::vector<T> values;
        values.reserve(used.size());
        for (const std::uint32_t vertex : used) values.push_back(all[vertex]);
        return values;
    }
};

/// Moves positions and normals towards each target, by its weight; missing weights are 0.
void morph(Accessors& accessors, const UsedPart& part, std::span<const double> weights, Mesh& mesh);

/// Of a matrix that files write in decimals: its last row is 0, 0, 0, 1. Throws Error, which begins
/// with `where`, for another one, as it is no rotation, scale and translation.
template <class Matrix>
Matrix affine(Matrix matrix, const std::string& where) {
    for (int column = 0; column < 4; ++column) {
        const double usual = column == 3 ? 1.0 : 0.0;
        if (!(std::abs(matrix[column][3] - usual) <= 1e-5)) {
            throw Error(
                fmt::format("{}: the last row of its matrix is {}, {}, {}, {}; 0, 0, 0, 1 "
                            "is allowed",
                            where, matrix[0][3], matrix[1][3], matrix[2][3], matrix[3][3]));
        }
        matrix[column][3] = static_cast<typename Matrix::value_type>(usual);
    }
    return matrix;
}

/// One matrix a joint, from the space of the mesh into the world. `worldFromNode` is empty for
/// nodes that are not in the scene. Throws Error for joints that are not.
std::vector<glm::mat4> jointMatrices(const File& file, Accessors& accessors, int skin,
                                     std::span<const std::optional<glm::mat4>> worldFromNode);

/// Moves positions and normals into the world, as their joints hold them. The first joint holds
/// vertices without weights; returns how many.
std::size_t moveToJoints(Accessors& accessors, const UsedPart& part,
                         std::span<const glm::mat4> joints, Mesh& mesh);

}  // namespace gfxrepro::scene::gltf
