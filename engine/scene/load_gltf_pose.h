// Morph targets and skins of glTF files: where vertices stand in the file's default pose.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/scene/load_gltf_file.h"
#include "engine/scene/scene.h"

namespace gfxrepro::scene::gltf {

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

/// One matrix a joint, from the space of the mesh into the world. `worldFromNode` is empty for
/// nodes that are not in the scene. Throws Error for joints that are not.
std::vector<glm::mat4> jointMatrices(const File& file, Accessors& accessors, int skin,
                                     std::span<const std::optional<glm::mat4>> worldFromNode);

/// Moves positions and normals into the world, as their joints hold them. The first joint holds
/// vertices without weights; returns how many.
std::size_t moveToJoints(Accessors& accessors, const UsedPart& part,
                         std::span<const glm::mat4> joints, Mesh& mesh);

}  // namespace gfxrepro::scene::gltf
