// Lights for a scene, and what can be wrong with them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "techniques/shadow_mapping/shadow_mapping.h"

namespace gfxrepro::shadow_mapping {
namespace {

/// Lights of several get their share of the brightness.
Light lightAt(const ShadowMappingParams& params, const scene::Box& box, const glm::vec3& position,
              const glm::vec3& color) {
    const float diagonal = glm::length(box.size());
    const float radius = 0.5F * diagonal;
    const glm::vec3 towards = box.centre() - position;
    const float distance = glm::length(towards);
    Light light;
    light.kind = params.lightKind;
    light.positionWorld = position;
    light.targetWorld = box.centre();
    light.directionWorld = towards;
    light.color = color / static_cast<float>(params.lightCount);
    const bool isDirectional = params.lightKind == LightKind::Directional;
    light.size = params.lightSize * (isDirectional ? 1.0F : diagonal);
    // The planes hold the ball around the box, the near one at least 1/500 of its diagonal away:
    // window depth is spent near the light.
    light.nearM = std::max(distance - radius, 0.002F * diagonal);
    light.farM = distance + radius;
    // As wide as the ball; where the light stands near it, no wider than 120°, and what lies
    // outside of the cone is lit.
    constexpr float kWidestRad = glm::pi<float>() * 2.0F / 3.0F;
    light.fovRad =
        distance > radius ? std::min(2.0F * std::asin(radius / distance), kWidestRad) : kWidestRad;
    return light;
}

}  // namespace

std::vector<Light> makeLights(const ShadowMappingParams& params, const scene::Scene& scene) {
    const scene::Box box = scene.bounds();
    const float diagonal = glm::length(box.size());
    std::vector<Light> lights;
    if (params.lightPlace == LightPlace::Scene) {
        if (scene.lights.size() < static_cast<std::size_t>(params.lightCount)) {
            throw Error(fmt::format("'light_place: scene' with {} lights: the scene has {}",
                                    params.lightCount, scene.lights.size()));
        }
        for (int i = 0; i < params.lightCount; ++i) {
            const scene::PointLight& light = scene.lights[static_cast<std::size_t>(i)];
            lights.push_back(lightAt(params, box, light.position, light.intensity));
        }
        return lights;
    }
    for (int i = 0; i < params.lightCount; ++i) {
        const float azimuth = params.azimuthRad + glm::two_pi<float>() * static_cast<float>(i) /
                                                      static_cast<float>(params.lightCount);
        const float flat = std::cos(params.elevationRad);
        const glm::vec3 direction(flat * std::sin(azimuth), std::sin(params.elevationRad),
                                  flat * std::cos(azimuth));
        // Of a directional light only the direction counts.
        const float distance =
            (params.lightKind == LightKind::Directional ? 1.0F : params.lightDistance) * diagonal;
        lights.push_back(
            lightAt(params, box, box.centre() + distance * direction, glm::vec3(1.0F)));
    }
    return lights;
}

void requireOutside(const raycast::RayTracer& tracer, const std::vector<Light>& lights) {
    for (std::size_t i = 0; i < lights.size(); ++i) {
        if (lights[i].kind == LightKind::Directional) continue;
        // The 26 neighbours of a cube: a light over an open floor escapes by some of them.
        bool isInside = true;
        for (int n = 0; n < 27 && isInside; ++n) {
            const glm::vec3 direction(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
            if (direction == glm::vec3(0.0F)) continue;
            const auto hit = tracer.closestHit(lights[i].positionWorld, direction);
            isInside = hit && glm::dot(hit->geometricNormal, direction) > 0.0F;
        }
        if (!isInside) continue;
        const glm::vec3 p = lights[i].positionWorld;
        throw Error(
            fmt::format("light {} at ({:.3f}, {:.3f}, {:.3f}) lies inside of geometry: every ray "
                        "from it meets a surface from behind",
                        i, p.x, p.y, p.z));
    }
}

int lightsWithoutCaster(const std::vector<Light>& lights, const scene::Scene& scene, int sizePx) {
    const scene::Mesh mesh = scene::flattened(scene);
    const scene::Box bounds = scene.bounds();
    return static_cast<int>(std::count_if(lights.begin(), lights.end(), [&](const Light& light) {
        const std::vector<LightView> views = viewsOf(light, bounds, sizePx);
        return std::none_of(views.begin(), views.end(), [&](const LightView& view) {
            return std::any_of(
                mesh.positions.begin(), mesh.positions.end(), [&](const glm::vec3& p) {
                    const glm::vec4 clip = view.clipFromWorld * glm::vec4(p, 1.0F);
                    return glm::all(
                        glm::lessThanEqual(glm::abs(glm::vec3(clip)), glm::vec3(clip.w)));
                });
        });
    }));
}

TruthLight truthLight(const Light& light, const scene::Box& bounds, int sizePx) {
    TruthLight truth;
    truth.isDirectional = light.kind == LightKind::Directional;
    truth.position = light.positionWorld;
    if (truth.isDirectional) truth.toLight = -glm::normalize(light.directionWorld);
    truth.texel = viewsOf(light, bounds, sizePx).front().texelPerDistance;
    if (light.kind == LightKind::Spot) {
        truth.forward = glm::normalize(light.targetWorld - light.positionWorld);
    }
    return truth;
}

}  // namespace gfxrepro::shadow_mapping
