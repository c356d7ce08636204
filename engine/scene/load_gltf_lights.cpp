#include "engine/scene/load_gltf_lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace gfxrepro::scene::gltf {

namespace {

constexpr const char* kExtension = "KHR_lights_punctual";

}  // namespace

void Lights::add(const tinygltf::Node& node, int index, const glm::mat4& worldFromNode) {
    const auto extension = node.extensions.find(kExtension);
    if (extension == node.extensions.end() || !extension->second.Has("light")) return;
    const tinygltf::Value& number = extension->second.Get("light");
    const int light = number.IsInt() ? number.Get<int>() : -1;
    const std::vector<tinygltf::Light>& all = file_.model.lights;
    if (light < 0 || static_cast<std::size_t>(light) >= all.size()) {
        throw Error(fmt::format("{}: node {}: light {} does not exist; there are {}", file_.name,
                                index, light, all.size()));
    }
    const tinygltf::Light& from = all[static_cast<std::size_t>(light)];
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
    lights_.push_back({glm::vec3(worldFromNode[3]), candela});
}

void Lights::moveTo(Scene& scene) {
    if (spots_ > 0) {
        scene.warnings.push_back(fmt::format("{} spot lights shine in all directions", spots_));
    }
    if (directional_ > 0) {
        scene.warnings.push_back(fmt::format("{} directional lights are left out", directional_));
    }
    double sum = 0.0;
    for (const PointLight& light : lights_) {
        const glm::vec3& candela = light.intensity;
        sum += double{std::max({candela.r, candela.g, candela.b})};
    }
    if (sum == 0.0) return;
    const float radiusM = 0.5F * glm::length(scene.bounds().size());
    for (PointLight& light : lights_) {
        light.intensity *= static_cast<float>(double{kAllLights} / sum);
        light.radiusM = std::max(radiusM, 1e-6F);  // one point: no 0 / 0
    }
    scene.lights = std::move(lights_);
}

}  // namespace gfxrepro::scene::gltf
