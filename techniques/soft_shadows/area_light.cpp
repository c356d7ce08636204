#include "techniques/soft_shadows/area_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/error.h"

namespace gfxrepro::soft_shadows {
namespace {

/// Across `direction`; the world's up unless the direction is close to it.
glm::vec3 upFor(const glm::vec3& direction) {
    return std::abs(direction.y) < 0.99F ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, 1);
}

bool isInside(const scene::Box& box, const glm::vec3& point) {
    return glm::all(glm::greaterThanEqual(point, box.min)) &&
           glm::all(glm::lessThanEqual(point, box.max));
}

glm::vec3 cornerOf(const scene::Box& box, int index) {
    return {(index & 1) != 0 ? box.max.x : box.min.x, (index & 2) != 0 ? box.max.y : box.min.y,
            (index & 4) != 0 ? box.max.z : box.min.z};
}

}  // namespace

glm::vec3 AreaLight::corner(int index) const {
    constexpr glm::vec2 kSigns[] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    const glm::vec2 sign = kSigns[index];
    return centre + sign.x * right + sign.y * up;
}

glm::vec3 AreaLight::sample(int i, int j, int n) const {
    const glm::vec2 cell = (2.0F * glm::vec2(i, j) + 1.0F) / static_cast<float>(n) - 1.0F;
    return centre + cell.x * right + cell.y * up;
}

AreaLight makeAreaLight(const scene::Box& casters, const AreaLightSettings& settings) {
    const float diagonal = glm::length(casters.size());
    const glm::vec3 toLight(std::sin(settings.azimuthRad) * std::cos(settings.elevationRad),
                            std::sin(settings.elevationRad),
                            std::cos(settings.azimuthRad) * std::cos(settings.elevationRad));
    AreaLight light;
    light.casters = casters;
    light.centre = casters.centre() + settings.height * diagonal * toLight;
    const glm::vec3 right = glm::normalize(glm::cross(upFor(toLight), toLight));
    const glm::vec3 up = glm::cross(toLight, right);
    // A square of diagonal d has half edges of d / √8.
    const float halfEdge = settings.sizeRatio * diagonal / std::sqrt(8.0F);
    light.right = right * halfEdge;
    light.up = up * halfEdge;
    return light;
}

kit::View lightView(const AreaLight& light, const glm::vec3& point, int sizePx) {
    const scene::Box& box = light.casters;
    if (isInside(box, point)) {
        throw Error(fmt::format(
            "the light's point ({:.3g}, {:.3g}, {:.3g}) lies inside the scene's box ({:.3g}, "
            "{:.3g}, "
            "{:.3g}) … ({:.3g}, {:.3g}, {:.3g}): raise light_height or lower light_ratio",
            point.x, point.y, point.z, box.min.x, box.min.y, box.min.z, box.max.x, box.max.y,
            box.max.z));
    }
    const float diagonal = glm::length(box.size());
    scene::Camera camera;
    camera.position = point;
    camera.target = box.centre();
    const glm::vec3 forward = glm::normalize(camera.target - point);
    camera.up = upFor(forward);
    const glm::vec3 right = glm::normalize(glm::cross(forward, camera.up));
    const glm::vec3 up = glm::cross(right, forward);
    float nearest = std::numeric_limits<float>::infinity();
    float farthest = 0.0F;
    float tangent = 0.0F;  // of half the angle that holds every corner
    for (int index = 0; index < 8; ++index) {
        const glm::vec3 offset = cornerOf(box, index) - point;
        const float depth = glm::dot(offset, forward);
        // Corners beside the light (the light is not far above a flat scene) would need more than
        // half of space; what lies that far aside is cut off.
        const float bounded = std::max(depth, 0.05F * diagonal);
        nearest = std::min(nearest, depth);
        farthest = std::max(farthest, depth);
        tangent = std::max({tangent, std::abs(glm::dot(offset, right)) / bounded,
                            std::abs(glm::dot(offset, up)) / bounded});
    }
    tangent *= static_cast<float>(sizePx) / std::max(1.0F, static_cast<float>(sizePx) - 4.0F);
    camera.verticalFovRad = 2.0F * std::atan(tangent);
    camera.nearM = std::max(nearest - 0.01F * diagonal, 0.002F * diagonal);
    camera.farM = farthest + 0.01F * diagonal;
    return kit::viewOf(camera, glm::ivec2(sizePx));
}

}  // namespace gfxrepro::soft_shadows
