#include "techniques/shadow_mapping/lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/core/error.h"

namespace gfxrepro::shadow_mapping {
namespace {

struct Face {
    glm::vec3 forward;
    glm::vec3 up;
};
/// +x −x +y −y +z −z; cubeFace() of shadow_lookup.glsl numbers them alike.
constexpr Face kFaces[] = {{{1, 0, 0}, {0, 1, 0}}, {{-1, 0, 0}, {0, 1, 0}},
                           {{0, 1, 0}, {0, 0, 1}}, {{0, -1, 0}, {0, 0, 1}},
                           {{0, 0, 1}, {0, 1, 0}}, {{0, 0, -1}, {0, 1, 0}}};

bool isFinite(const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Any direction that is not along `forward` (unit).
glm::vec3 upFor(const glm::vec3& forward) {
    return std::abs(forward.y) < 0.99F ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, 1);
}

void checkPlanes(const Light& light) {
    if (!isFinite(light.positionWorld)) throw Error("a light's position is not finite");
    // Written so that not-a-number fails, too.
    if (!(light.nearM > 0.0F && light.nearM < light.farM && std::isfinite(light.farM))) {
        throw Error(
            fmt::format("a light's near plane at {} m and far plane at {} m: 0 < near < far",
                        light.nearM, light.farM));
    }
}

LightView perspectiveView(const Light& light, const Face& face, float tangent) {
    LightView view;
    const float fov = 2.0F * std::atan(tangent);
    view.clipFromWorld =
        glm::perspective(fov, 1.0F, light.nearM, light.farM) *
        glm::lookAt(light.positionWorld, light.positionWorld + face.forward, face.up);
    view.nearM = light.nearM;
    view.farM = light.farM;
    return view;
}

LightView spotView(const Light& light, int sizePx) {
    checkPlanes(light);
    const glm::vec3 forward = light.targetWorld - light.positionWorld;
    if (!isFinite(forward) || !(glm::length(forward) > 0.0F)) {
        throw Error("a spot light's target is its position: it looks nowhere");
    }
    if (!(light.fovRad > 0.0F && light.fovRad < glm::pi<float>())) {
        throw Error(fmt::format("a spot light's angle of {} degrees: more than 0, less than 180",
                                glm::degrees(light.fovRad)));
    }
    const glm::vec3 unit = glm::normalize(forward);
    const float tangent = std::tan(0.5F * light.fovRad);
    LightView view = perspectiveView(light, {unit, upFor(unit)}, tangent);
    view.texelPerDistance = 2.0F * tangent / static_cast<float>(sizePx);
    return view;
}

LightView directionalView(const Light& light, const scene::Box& bounds, int sizePx) {
    if (!isFinite(light.directionWorld) || !(glm::length(light.directionWorld) > 0.0F)) {
        throw Error("a directional light has no direction");
    }
    if (bounds.isEmpty()) throw Error("a directional light is fitted to a scene: it is empty");
    const glm::vec3 forward = glm::normalize(light.directionWorld);
    const glm::vec3 centre = bounds.centre();
    const glm::mat4 lightFromWorld = glm::lookAt(centre, centre + forward, upFor(forward));
    glm::vec3 half(0.0F);  // of the box in the light's frame, about its centre
    for (int i = 0; i < 8; ++i) {
        const glm::vec4 corner = lightFromWorld * glm::vec4(bounds.corner(i), 1.0F);
        half = glm::max(half, glm::abs(glm::vec3(corner)));
    }
    // Two texels around the box, so that its outline is not cut off; 1 % before and behind it, so
    // that surfaces on its sides are not at the planes. A box without extent gets some.
    const float smallest = 1e-3F * std::max(glm::length(half), 1e-3F);
    const float size = static_cast<float>(sizePx);
    const float width = std::max({half.x, half.y, smallest}) * (1.0F + 4.0F / size);
    const float depth = std::max(half.z, smallest) * 1.01F;
    LightView view;
    view.clipFromWorld = glm::ortho(-width, width, -width, width, -depth, depth) * lightFromWorld;
    view.texelPerDistance = 2.0F * width / size;  // w is 1 everywhere
    view.farM = 2.0F * depth;
    view.isPerspective = false;
    return view;
}

std::vector<LightView> cubeViews(const Light& light, int sizePx) {
    checkPlanes(light);
    if (sizePx <= 2 * kCubeBorderTexels) {
        throw Error(fmt::format("a point light's faces of {} pixels: more than {}, their border",
                                sizePx, 2 * kCubeBorderTexels));
    }
    const float size = static_cast<float>(sizePx);
    const float tangent = size / (size - 2.0F * static_cast<float>(kCubeBorderTexels));
    std::vector<LightView> views;
    for (int i = 0; i < 6; ++i) {
        LightView view = perspectiveView(light, kFaces[i], tangent);
        view.texelPerDistance = 2.0F * tangent / size;
        view.tilePx = glm::ivec2(i % 3, i / 3) * sizePx;
        views.push_back(view);
    }
    return views;
}

}  // namespace

glm::mat4 LightView::lookupFromWorld(glm::ivec2 mapSizePx) const {
    // tex = (0.5·x/w + 0.5, …), [zju2005] Sec. 4.2.1, then into the tile. Departure [zju2005]
    // Sec. 4.2.1: GL's clip z lies in −w … w, so that z takes the same step as x and y.
    const glm::vec2 scale = glm::vec2(tileSizePx) / glm::vec2(mapSizePx);
    const glm::vec2 offset = glm::vec2(tilePx) / glm::vec2(mapSizePx);
    glm::mat4 lookupFromClip(1.0F);
    lookupFromClip[0].x = 0.5F * scale.x;
    lookupFromClip[1].y = 0.5F * scale.y;
    lookupFromClip[2].z = 0.5F;
    lookupFromClip[3] = {0.5F * scale + offset, 0.5F, 1.0F};
    return lookupFromClip * clipFromWorld;
}

glm::ivec2 tileCountOf(LightKind kind) {
    return kind == LightKind::Point ? glm::ivec2(3, 2) : glm::ivec2(1);
}

std::vector<LightView> viewsOf(const Light& light, const scene::Box& bounds, int sizePx) {
    std::vector<LightView> views;
    switch (light.kind) {
        case LightKind::Spot:
            views = {spotView(light, sizePx)};
            break;
        case LightKind::Directional:
            views = {directionalView(light, bounds, sizePx)};
            break;
        case LightKind::Point:
            views = cubeViews(light, sizePx);
            break;
    }
    for (LightView& view : views) view.tileSizePx = glm::ivec2(sizePx);
    return views;
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

}  // namespace gfxrepro::shadow_mapping
