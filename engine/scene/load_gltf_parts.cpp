#include "engine/scene/load_gltf_parts.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "engine/scene/gltf_extras.h"
#include "engine/scene/load_text.h"
#include "engine/scene/model_files.h"

namespace gfxrepro::scene::gltf {
namespace {

using Value = tinygltf::Value;

/// Null when the object or the key is not there.
const Value* findExtension(const tinygltf::ExtensionMap& extensions, const std::string& extension,
                           const std::string& key) {
    const auto found = extensions.find(extension);
    return found != extensions.end() && found->second.Has(key) ? &found->second.Get(key) : nullptr;
}

double gltfNumber(const Value* value, double fallback) {
    return value != nullptr && value->IsNumber() ? value->GetNumberAsDouble() : fallback;
}

glm::vec2 vec2(const Value* value, const glm::vec2& fallback) {
    if (value == nullptr || !value->IsArray() || value->ArrayLen() != 2) return fallback;
    return {gltfNumber(&value->Get(0), fallback.x), gltfNumber(&value->Get(1), fallback.y)};
}

/// Of tinygltf's TextureInfo, or NormalTextureInfo, which is a type of its own.
template <class Info>
TextureUse textureUse(const Info& info) {
    constexpr const char* kExtension = "KHR_texture_transform";
    TextureUse use;
    use.texcoordSet = info.texCoord;
    if (info.extensions.count(kExtension) == 0) return use;
    if (const Value* set = findExtension(info.extensions, kExtension, "texCoord");
        set && set->IsInt()) {
        use.texcoordSet = set->Get<int>();
    }
    const glm::vec2 offset =
        vec2(findExtension(info.extensions, kExtension, "offset"), glm::vec2(0.0F));
    const glm::vec2 scale =
        vec2(findExtension(info.extensions, kExtension, "scale"), glm::vec2(1.0F));
    const double angleRad = gltfNumber(findExtension(info.extensions, kExtension, "rotation"), 0.0);
    // Counter-clockwise as seen in the image, where v grows downwards.
    const auto c = static_cast<float>(std::cos(angleRad));
    const auto s = static_cast<float>(std::sin(angleRad));
    use.isTransformed = true;
    use.transform = glm::mat3x2(glm::vec2(c, -s) * scale.x, glm::vec2(s, c) * scale.y, offset);
    return use;
}

class TextureTable {
  public:
    TextureTable(const File& file, const Accessors& accessors, Scene& scene, LeftOut& leftOut)
        : file_(file), accessors_(accessors), scene_(scene), leftOut_(leftOut) {}

    /// Into Scene::textures; −1 when the material has none, or one that only an extension gives.
    int find(int texture) {
        if (texture < 0) return -1;
        const tinygltf::Texture& from =
            elementOf(file_.model.textures, texture, "{}: texture {}", file_.name, texture);
        if (from.source < 0) {
            leftOut_.add("a texture that only an extension gives");
            return -1;
        }
        const Sampling sampling = samplingOf(from);
        const auto [found, isNew] =
            textureOf_.try_emplace({from.source, sampling.u, sampling.v, sampling.isNearest},
                                   static_cast<int>(scene_.textures.size()));
        if (!isNew) return found->second;
        scene_.textures.push_back(decoded(from.source));
        if (sampling != Sampling{}) {
            scene_.samplings.resize(scene_.textures.size());
            scene_.samplings.back() = sampling;
        }
        return found->second;
    }

  private:
    Sampling samplingOf(const tinygltf::Texture& texture) {
        if (texture.sampler < 0) return {};
        const tinygltf::Sampler& from = elementOf(file_.model.samplers, texture.sampler,
                                                  "{}: sampler {}", file_.name, texture.sampler);
        const bool isTrilinear = from.minFilter == TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR;
        if (from.minFilter >= 0 && !isTrilinear) {
            leftOut_.add("a sampler's minFilter other than LINEAR_MIPMAP_LINEAR");
        }
        const auto wrap = [](int mode) {
            return mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE     ? Sampling::Wrap::Clamp
                   : mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Sampling::Wrap::Mirror
                                                                   : Sampling::Wrap::Repeat;
        };
        return {wrap(from.wrapS), wrap(from.wrapT),
                from.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST};
    }

    image::Image8 decoded(int index) {
        const std::string where = fmt::format("{}: image {}", file_.name, index);
        const tinygltf::Image& image = elementOf(file_.model.images, index, "{}", where);
        std::span<const unsigned char> bytes = image.image;
        if (image.bufferView >= 0) bytes = accessors_.view(image.bufferView);
        if (bytes.empty())
            throw Error(fmt::format("{}: {} cannot be read", where, inQuotes(image.uri)));
        return decodeTexture(std::as_bytes(bytes), where, leftOut_);
    }

    const File& file_;
    const Accessors& accessors_;
    Scene& scene_;
    LeftOut& leftOut_;
    std::map<std::tuple<int, Sampling::Wrap, Sampling::Wrap, bool>, int> textureOf_;
};

Material gltfMaterial(const tinygltf::Material& from) {
    const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
    Material material;
    material.name = from.name;
    material.baseColor = glm::vec4(1.0F);
    for (std::size_t c = 0; c < 4 && pbr.baseColorFactor.size() == 4; ++c) {
        material.baseColor[static_cast<int>(c)] = static_cast<float>(pbr.baseColorFactor[c]);
    }
    material.metallic = static_cast<float>(pbr.metallicFactor);
    material.roughness = static_cast<float>(pbr.roughnessFactor);
    const double strength = gltfNumber(
        findExtension(from.extensions, "KHR_materials_emissive_strength", "emissiveStrength"), 1.0);
    for (std::size_t c = 0; c < 3 && from.emissiveFactor.size() == 3; ++c) {
        material.emissive[static_cast<int>(c)] =
            static_cast<float>(from.emissiveFactor[c] * strength);
    }
    if (from.alphaMode == "MASK") material.alphaCutoff = static_cast<float>(from.alphaCutoff);
    material.normalScale = static_cast<float>(from.normalTexture.scale);
    material.isDoubleSided = from.doubleSided;
    material.isUnlit = from.extensions.count("KHR_materials_unlit") != 0;
    material.transmission = static_cast<float>(gltfNumber(
        findExtension(from.extensions, "KHR_materials_transmission", "transmissionFactor"), 0.0));
    material.indexOfRefraction = static_cast<float>(
        gltfNumber(findExtension(from.extensions, "KHR_materials_ior", "ior"), 1.5));
    return material;
}

/// One of a material's textures.
struct Slot {
    const char* name;
    int texture;  // into Scene::textures; −1: none
    TextureUse use;
    int* to;  // of the material
};

/// Sets the material's textures; returns how it reads them.
TextureUse addTextures(const tinygltf::Material& from, TextureTable& textures, Material& material,
                       std::vector<std::string>& warnings) {
    const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
    const auto slot = [&](const char* name, const auto& info, int& to) {
        return Slot{name, textures.find(info.index), textureUse(info), &to};
    };
    const std::array<Slot, 4> slots{
        slot("base colour", pbr.baseColorTexture, material.baseColorTexture),
        slot("metallic-roughness", pbr.metallicRoughnessTexture, material.metallicRoughnessTexture),
        slot("normal", from.normalTexture, material.normalTexture),
        slot("emissive", from.emissiveTexture, material.emissiveTexture)};
    std::optional<TextureUse> shared;
    for (const Slot& s : slots) {
        if (s.texture < 0) continue;
        if (!shared) shared = s.use;
        if (s.use == *shared) {
            *s.to = s.texture;
        } else {
            warnings.push_back(
                fmt::format("material '{}': its {} texture is left out, as it reads other texture "
                            "coordinates than those before it",
                            from.name, s.name));
        }
    }
    return shared.value_or(slots[0].use);
}

}  // namespace

std::vector<TextureUse> addMaterials(const File& file, const Accessors& accessors, Scene& scene,
                                     LeftOut& leftOut) {
    TextureTable textures(file, accessors, scene, leftOut);
    std::vector<TextureUse> uses;
    for (const tinygltf::Material& from : file.model.materials) {
        scene.materials.push_back(gltfMaterial(from));
        if (from.alphaMode == "BLEND") leftOut.add("a material's alphaMode BLEND, drawn as solid");
        uses.push_back(addTextures(from, textures, scene.materials.back(), scene.warnings));
    }
    return uses;
}

std::size_t textureCount(const Material& material) {
    const int textures[] = {material.baseColorTexture, material.metallicRoughnessTexture,
                            material.normalTexture, material.emissiveTexture};
    return std::ranges::count_if(textures, [](int texture) { return texture >= 0; });
}

void Lights::add(const tinygltf::Node& node, int index, const glm::mat4& worldFromNode) {
    const auto extension = node.extensions.find("KHR_lights_punctual");
    if (extension == node.extensions.end() || !extension->second.Has("light")) return;
    const tinygltf::Value& number = extension->second.Get("light");
    const int light = number.IsInt() ? number.Get<int>() : -1;
    const tinygltf::Light& from =
        elementOf(file_.model.lights, light, "{}: node {}: light {}", file_.name, index, light);
    if (from.type == "directional") {
        ++directional_;
        return;
    }
    spots_ += from.type == "spot" ? 1 : 0;
    glm::vec3 candela(static_cast<float>(from.intensity));
    for (int channel = 0; channel < 3 && from.color.size() == 3; ++channel) {
        candela[channel] *= static_cast<float>(from.color[static_cast<std::size_t>(channel)]);
    }
    for (int channel = 0; channel < 3; ++channel) {
        if (candela[channel] >= 0.0F && std::isfinite(candela[channel])) continue;
        throw Error(fmt::format("{}: light {}: intensity {} of a channel; 0 and more is allowed",
                                file_.name, light, candela[channel]));
    }
    if (const auto radiusM = lengthExtra(from.extras, kRadiusM)) {
        ours_.push_back({worldFromNode[3], candela, static_cast<float>(*radiusM)});
    } else {
        lights_.push_back({worldFromNode[3], candela});
    }
}

void Lights::moveTo(Scene& scene) {
    if (spots_ > 0) {
        scene.warnings.push_back(fmt::format(
            "{} in all directions",
            spots_ == 1 ? "1 spot light shines" : fmt::format("{} spot lights shine", spots_)));
    }
    if (directional_ > 0) {
        scene.warnings.push_back(fmt::format(
            "{} left out", directional_ == 1
                               ? "1 directional light is"
                               : fmt::format("{} directional lights are", directional_)));
    }
    double sum = 0.0;
    for (const PointLight& light : lights_) {
        const glm::vec3& candela = light.intensity;
        sum += double{std::max({candela.r, candela.g, candela.b})};
    }
    if (sum == 0.0) lights_.clear();
    const float radiusM = 0.5F * glm::length(scene.bounds().size());
    for (PointLight& light : lights_) {
        light.intensity *= static_cast<float>(double{kAllLights} / sum);
        light.radiusM = std::max(radiusM, 1e-6F);  // one point: no 0 / 0
    }
    scene.lights = std::move(ours_);
    scene.lights.insert(scene.lights.end(), lights_.begin(), lights_.end());
}

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
                           (inverseBinds.empty()
                                ? glm::mat4(1.0F)
                                : affine(inverseBinds[i], fmt::format("{}: joint {}", where, i))));
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
