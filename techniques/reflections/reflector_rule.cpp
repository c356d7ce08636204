#include "techniques/reflections/reflector_rule.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "engine/core/error.h"

namespace gfxrepro::reflections {

namespace {

constexpr float kTransmissive = 0.5F;

/// A channel of the texel at `texcoord`, 0 to 1; repeats.
float texelAt(const image::Image8& image, const glm::vec2& texcoord, int channel) {
    const glm::vec2 place =
        (texcoord - glm::floor(texcoord)) * glm::vec2(image.width(), image.height());
    const int x = std::clamp(static_cast<int>(place.x), 0, image.width() - 1);
    const int y = std::clamp(static_cast<int>(place.y), 0, image.height() - 1);
    return static_cast<float>(image.at(x, y, channel)) / 255.0F;
}

/// Whether some place of the mesh is as smooth as `maxRoughness`, and reflects, by the material's
/// texture. Looked at are the middles of a grid over each triangle.
bool reflectsByTexture(const scene::Mesh& mesh, const scene::Material& material,
                       const image::Image8& texture, float maxRoughness) {
    constexpr double kPlaces = 4096.0;
    const auto side = static_cast<int>(std::ceil(
        std::sqrt(kPlaces / static_cast<double>(std::max<std::size_t>(mesh.triangles.size(), 1)))));
    const auto reflectsAt = [&](const glm::vec2& texcoord) {
        const float roughness = material.roughness * texelAt(texture, texcoord, 1);
        return roughness <= maxRoughness &&
               reflectivityOf(material, material.metallic * texelAt(texture, texcoord, 2)) > 0.0F;
    };
    for (const glm::uvec3& corners : mesh.triangles) {
        // side² small triangles: the upright ones, and those between them.
        for (int i = 0; i < side; ++i) {
            for (int j = 0; j < 2 * (side - i) - 1; ++j) {
                const float third = j % 2 == 0 ? 1.0F / 3.0F : 2.0F / 3.0F;
                const glm::vec2 b = (glm::vec2(i, j / 2) + third) / static_cast<float>(side);
                if (reflectsAt((1.0F - b.x - b.y) * mesh.texcoords[corners.x] +
                               b.x * mesh.texcoords[corners.y] + b.y * mesh.texcoords[corners.z])) {
                    return true;
                }
            }
        }
    }
    return false;
}

/// What ReflectorRule says, of meshes that are not left out.
bool isReflector(const scene::Scene& scene, const scene::Mesh& mesh, float maxRoughness) {
    if (!isSmooth(scene, mesh, maxRoughness)) return false;
    const scene::Material material = materialOf(scene, mesh);
    return isTextured(mesh, material.metallicRoughnessTexture) ||
           reflectivityOf(material, material.metallic) > 0.0F;
}

}  // namespace

bool isTransmissive(const scene::Material& material) {
    return material.transmission > kTransmissive;
}

float headOnReflectivity(float indexOfRefraction) {
    const float ratio = (indexOfRefraction - 1.0F) / (indexOfRefraction + 1.0F);
    return ratio * ratio;
}

float in255ths(float value) {
    return std::round(255.0F * std::clamp(value, 0.0F, 1.0F)) / 255.0F;
}

bool isTextured(const scene::Mesh& mesh, int texture) {
    return texture >= 0 && !mesh.texcoords.empty();
}

float reflectivityOf(const scene::Material& material, float metallic) {
    return in255ths(std::max(metallic, headOnReflectivity(material.indexOfRefraction)));
}

bool isSmooth(const scene::Scene& scene, const scene::Mesh& mesh, float maxRoughness) {
    const scene::Material material = materialOf(scene, mesh);
    if (!isTextured(mesh, material.metallicRoughnessTexture)) {
        return material.roughness <= maxRoughness;
    }
    const auto texture = static_cast<std::size_t>(material.metallicRoughnessTexture);
    return reflectsByTexture(mesh, material, scene.textures[texture], maxRoughness);
}

std::set<std::string> reflectorNames(const scene::Scene& scene, const ReflectorRule& rule) {
    std::set<std::string> names;
    for (const scene::Instance& instance : scene.instances) {
        const scene::Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        if (isTransmissive(materialOf(scene, mesh)) || mesh.triangles.empty()) continue;
        if (isReflector(scene, mesh, rule.maxRoughness)) names.insert(mesh.name);
    }
    return names;
}

void requireReflectors(const scene::Scene& scene, const ReflectorRule& rule) {
    std::size_t triangles = 0, transmissive = 0;
    for (const scene::Instance& instance : scene.instances) {
        const scene::Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        if (isTransmissive(materialOf(scene, mesh))) {
            ++transmissive;
            continue;
        }
        triangles += mesh.triangles.size();
        if (triangles > 0 && isReflector(scene, mesh, rule.maxRoughness)) return;
    }
    const std::string leftOut =
        transmissive == 0 ? "" : fmt::format(" (transmissive objects left out: {})", transmissive);
    if (triangles == 0) {
        throw Error(fmt::format("scene '{}': reflections need triangles, it has none{}", scene.name,
                                leftOut));
    }
    throw Error(
        fmt::format("scene '{}' has no reflectors{}: no material's roughness is at most {}; "
                    "'reflector_roughness: 1' takes them all",
                    scene.name, leftOut, rule.maxRoughness));
}

}  // namespace gfxrepro::reflections
