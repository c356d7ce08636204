// Points of surfaces: what ReflectiveScene shows there.
#include <algorithm>
#include <array>
#include <cmath>

#include "techniques/reflections/surfaces.h"

namespace gfxrepro::reflections {

namespace {

constexpr float kLeastFacing = 1e-3F;  // as in texturedNormal() of shaders/shading.glsl

template <class T>
T interpolated(const std::vector<T>& values, const glm::uvec3& triangle,
               const glm::vec2& barycentric) {
    return (1.0F - barycentric.x - barycentric.y) * values[triangle.x] +
           barycentric.x * values[triangle.y] + barycentric.y * values[triangle.z];
}

glm::vec3 bilinear(const image::Image8& texels, TexelKind kind, const glm::vec2& texcoord) {
    static const std::array<float, 256> kColours = decodingOf(TexelKind::Colours);
    static const std::array<float, 256> kValues = decodingOf(TexelKind::Values);
    const std::array<float, 256>& decoding = kind == TexelKind::Colours ? kColours : kValues;
    const int sizePx = texels.width();
    const glm::vec2 place = (texcoord - glm::floor(texcoord)) * static_cast<float>(sizePx) - 0.5F;
    const glm::vec2 low = glm::floor(place);
    const glm::vec2 fraction = place - low;
    const auto texel = [&](int dx, int dy) {
        // place is in [−½, size − ½]: one texel out of the layer at most.
        const int x = (static_cast<int>(low.x) + dx + sizePx) % sizePx;
        const int y = (static_cast<int>(low.y) + dy + sizePx) % sizePx;
        return glm::vec3(decoding[texels.at(x, y, 0)], decoding[texels.at(x, y, 1)],
                         decoding[texels.at(x, y, 2)]);
    };
    return glm::mix(glm::mix(texel(0, 0), texel(1, 0), fraction.x),
                    glm::mix(texel(0, 1), texel(1, 1), fraction.x), fraction.y);
}

}  // namespace

float ReflectiveScene::footprintAt(std::uint32_t triangle, const glm::mat4& worldFromMesh,
                                   const glm::vec3& direction, float beamArea) const {
    if (filter_ == TextureFilter::FinestLevel) return 0.0F;
    const glm::uvec3 corners = geometry_.triangles[triangle];
    const auto edge = [&](const auto& values, int corner) {
        return values[corners[corner]] - values[corners.x];
    };
    const glm::mat3 turned(worldFromMesh);
    const glm::vec3 areaWorld =
        glm::cross(turned * edge(geometry_.positions, 1), turned * edge(geometry_.positions, 2));
    const glm::vec2 first = edge(geometry_.texcoords, 1), second = edge(geometry_.texcoords, 2);
    const float areaTexture = first.x * second.y - first.y * second.x;
    const float facing = std::max(std::abs(glm::dot(areaWorld, direction)), 1e-30F);
    return std::sqrt(beamArea * std::abs(areaTexture) * glm::length(areaWorld)) / facing;
}

glm::vec3 ReflectiveScene::texelsAt(const Layers& layers, int layer, const glm::vec2& texcoord,
                                    float footprint) {
    const auto last = static_cast<float>(layers.levels.size() - 1);
    const auto sizePx =
        static_cast<float>(layers.levels.front()[static_cast<std::size_t>(layer)].width());
    const float level = std::clamp(std::log2(std::max(footprint * sizePx, 1e-30F)), 0.0F, last);
    const auto finer = static_cast<std::size_t>(level);
    const auto at = [&](std::size_t ofLevel) {
        return bilinear(layers.levels[ofLevel][static_cast<std::size_t>(layer)], layers.kind,
                        texcoord);
    };
    const float fraction = level - static_cast<float>(finer);
    return fraction == 0.0F ? at(finer) : glm::mix(at(finer), at(finer + 1), fraction);
}

glm::vec3 ReflectiveScene::albedoAt(std::uint32_t triangle, const glm::vec2& barycentric,
                                    float footprint) const {
    const glm::uvec3 corners = geometry_.triangles[triangle];
    const Object& object = objects_[geometry_.objectOfTriangle[triangle]];
    const glm::vec3 albedo =
        object.baseColor * interpolated(geometry_.colors, corners, barycentric);
    if (object.textureLayer < 0) return albedo;
    return albedo * texelsAt(textureLayers_, object.textureLayer,
                             interpolated(geometry_.texcoords, corners, barycentric), footprint);
}

glm::vec3 ReflectiveScene::emissiveAt(std::uint32_t triangle, const glm::vec2& barycentric,
                                      float footprint) const {
    const Object& object = objects_[geometry_.objectOfTriangle[triangle]];
    if (object.emissiveLayer < 0) return object.emissive;
    return object.emissive *
           texelsAt(textureLayers_, object.emissiveLayer,
                    interpolated(geometry_.texcoords, geometry_.triangles[triangle], barycentric),
                    footprint);
}

glm::vec3 ReflectiveScene::texturedNormalAt(std::uint32_t triangle, const glm::vec2& barycentric,
                                            const glm::mat4& worldFromMesh,
                                            const glm::vec3& normalWorld, const glm::vec3& toViewer,
                                            float footprint) const {
    const Object& object = objects_[geometry_.objectOfTriangle[triangle]];
    const glm::uvec3 corners = geometry_.triangles[triangle];
    const auto edge = [&](int corner) {
        return glm::mat3(worldFromMesh) *
               (geometry_.positions[corners[corner]] - geometry_.positions[corners.x]);
    };
    const auto texcoordEdge = [&](int corner) {
        return geometry_.texcoords[corners[corner]] - geometry_.texcoords[corners.x];
    };
    const glm::vec3 first = edge(1), second = edge(2);
    const glm::vec2 uvFirst = texcoordEdge(1), uvSecond = texcoordEdge(2);
    const glm::vec3 texel =
        2.0F * texelsAt(valueLayers_, object.normalLayer,
                        interpolated(geometry_.texcoords, corners, barycentric), footprint) -
        1.0F;
    const glm::vec3 acrossSecond = glm::cross(second, normalWorld);
    const glm::vec3 acrossFirst = glm::cross(normalWorld, first);
    const glm::vec3 alongU = acrossSecond * uvFirst.x + acrossFirst * uvSecond.x;
    const glm::vec3 alongV = acrossSecond * uvFirst.y + acrossFirst * uvSecond.y;
    const float squared = std::max(glm::dot(alongU, alongU), glm::dot(alongV, alongV));
    glm::vec3 normal = normalWorld;
    if (squared > 0.0F) {
        const float side = glm::dot(glm::cross(first, second), normalWorld) < 0.0F ? -1.0F : 1.0F;
        const float scale = side * object.normalScale / std::sqrt(squared);
        normal = scale * (texel.x * alongU - texel.y * alongV) + texel.z * normalWorld;
        normal = glm::dot(normal, normal) > 0.0F ? glm::normalize(normal) : normalWorld;
    }
    if (glm::dot(normalWorld, toViewer) < 0.0F) normal = -normal;
    const float facing = glm::dot(normal, toViewer);
    if (facing < kLeastFacing) {
        normal = glm::normalize(normal + (kLeastFacing - facing) * toViewer);
    }
    return normal;
}

glm::vec3 ReflectiveScene::normalMeshAt(std::uint32_t triangle,
                                        const glm::vec2& barycentric) const {
    return interpolated(geometry_.normals, geometry_.triangles[triangle], barycentric);
}

glm::vec3 shadeDiffuse(std::span<const scene::PointLight> lights, const glm::vec3& positionWorld,
                       const glm::vec3& normalWorld, const glm::vec3& albedo,
                       const glm::vec3& emissive) {
    glm::vec3 irradiance(0.30F + 0.10F * normalWorld.y);
    for (const scene::PointLight& light : lights) {
        const glm::vec3 toLight = light.position - positionWorld;
        const float distance = glm::length(toLight);
        // A point at the light itself has no direction to it: no 0 / 0.
        const float cosine =
            std::max(glm::dot(normalWorld, toLight) / std::max(distance, 1e-6F), 0.0F);
        const float ratio = distance / light.radiusM;
        irradiance += light.intensity * (cosine / (1.0F + ratio * ratio));
    }
    return glm::clamp(albedo * irradiance + emissive, 0.0F, 1.0F);
}

}  // namespace gfxrepro::reflections
