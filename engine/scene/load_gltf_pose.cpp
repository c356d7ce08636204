#include "engine/scene/load_gltf_pose.h"

#include <algorithm>

#include "engine/scene/load_text.h"

namespace gfxrepro::scene::gltf {

void morph(Accessors& accessors, const UsedPart& part, std::span<const double> weights,
           Mesh& mesh) {
    const auto& targets = part.primitive.targets;
    const auto move = [&](const std::map<std::string, int>& target, const char* name, double weight,
                          std::vector<glm::vec3>& values) {
        const auto accessor = target.find(name);
        if (accessor == target.end() || values.empty()) return;
        accessors.charge(values.size(), sizeof(glm::vec3));
        const auto by = part.of(accessors.values<glm::vec3>(accessor->second), name);
        for (std::size_t i = 0; i < values.size(); ++i) {
            values[i] += static_cast<float>(weight) * by[i];
        }
    };
    bool isMoved = false;
    for (std::size_t i = 0; i < std::min(targets.size(), weights.size()); ++i) {
        if (weights[i] == 0.0) continue;
        isMoved = true;
        move(targets[i], "POSITION", weights[i], mesh.positions);
        move(targets[i], "NORMAL", weights[i], mesh.normals);
    }
    for (glm::vec3& normal : mesh.normals) normal = isMoved ? unitNormal(normal) : normal;
}

std::vector<glm::mat4> jointMatrices(const File& file, Accessors& accessors, int skin,
                                     std::span<const std::optional<glm::mat4>> worldFromNode) {
    const std::string where = fmt::format("{}: skin {}", file.name, skin);
    const tinygltf::Skin& from = elementOf(file.model.skins, skin, "{}", where);
    accessors.charge(from.joints.size(), sizeof(glm::mat4));
    std::vector<glm::mat4> inverseBinds;
    if (from.inverseBindMatrices >= 0) {
        inverseBinds = accessors.values<glm::mat4>(from.inverseBindMatrices);
    }
    if (!inverseBinds.empty() && inverseBinds.size() < from.joints.size()) {
        throw Error(fmt::format("{}: {} inverse bind matrices for {} joints", where,
                                inverseBinds.size(), from.joints.size()));
    }
    if (from.joints.empty()) throw Error(where + ": no joints; at least one is needed");
    std::vector<glm::mat4> matrices;
    for (std::size_t i = 0; i < from.joints.size(); ++i) {
        const int node = from.joints[i];
        const bool isNode = node >= 0 && static_cast<std::size_t>(node) < worldFromNode.size();
        if (!isNode || !worldFromNode[static_cast<std::size_t>(node)]) {
            throw Error(fmt::format("{}: its joint, node {}, is not in the scene", where, node));
        }
        matrices.push_back(*worldFromNode[static_cast<std::size_t>(node)] *
                           (inverseBinds.empty() ? glm::mat4(1.0F) : inverseBinds[i]));
    }
    return matrices;
}

std::size_t moveToJoints(Accessors& accessors, const UsedPart& part,
                         std::span<const glm::mat4> joints, Mesh& mesh) {
    accessors.charge(part.used.size(), sizeof(glm::mat4));
    std::vector<glm::mat4> sums(part.used.size(), glm::mat4(0.0F));
    std::vector<float> totals(part.used.size(), 0.0F);
    for (int set = 0;; ++set) {  // four joints each
        const std::string jointsName = fmt::format("JOINTS_{}", set);
        const std::string weightsName = fmt::format("WEIGHTS_{}", set);
        const auto joint = part.primitive.attributes.find(jointsName);
        const auto weight = part.primitive.attributes.find(weightsName);
        if (joint == part.primitive.attributes.end() || weight == part.primitive.attributes.end()) {
            break;
        }
        accessors.charge(part.used.size(), 2 * sizeof(glm::vec4));
        const auto numbers = part.of(accessors.values<glm::vec4>(joint->second), jointsName);
        const auto weights = part.of(accessors.values<glm::vec4>(weight->second), weightsName);
        for (std::size_t i = 0; i < sums.size(); ++i) {
            for (int c = 0; c < 4; ++c) {
                if (weights[i][c] == 0.0F) continue;
                if (!(numbers[i][c] >= 0.0F && numbers[i][c] < static_cast<float>(joints.size()))) {
                    throw Error(fmt::format("{}: joint {} is not one of the {} of its skin",
                                            part.where, numbers[i][c], joints.size()));
                }
                sums[i] += weights[i][c] * joints[static_cast<std::size_t>(numbers[i][c])];
                totals[i] += weights[i][c];
            }
        }
    }
    std::size_t unheldCount = 0;
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const bool isHeld = totals[i] > 0.0F;
        const glm::mat4 worldFromMesh = isHeld ? sums[i] / totals[i] : joints[0];
        unheldCount += isHeld ? 0 : 1;
        mesh.positions[i] = glm::vec3(worldFromMesh * glm::vec4(mesh.positions[i], 1.0F));
        if (mesh.normals.empty()) continue;
        mesh.normals[i] = unitNormal(normalMatrix(glm::mat3(worldFromMesh)) * mesh.normals[i]);
    }
    return unheldCount;
}

}  // namespace gfxrepro::scene::gltf
