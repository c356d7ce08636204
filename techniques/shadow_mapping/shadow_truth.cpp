#include "techniques/shadow_mapping/shadow_truth.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"
#include "techniques/kit/picture.h"

namespace gfxrepro::shadow_mapping {

glm::vec3 TruthLight::directionFrom(const glm::vec3& point) const {
    return isDirectional ? toLight : glm::normalize(position - point);
}

float TruthLight::texelWidthAt(const glm::vec3& point) const {
    if (isDirectional) return texel;
    const glm::vec3 ray = point - position;
    const glm::vec3 sides = glm::abs(ray);
    const float depth = forward == glm::vec3(0.0F) ? std::max({sides.x, sides.y, sides.z})
                                                   : std::abs(glm::dot(ray, forward));
    return texel * depth;
}

std::vector<VisiblePoint> visiblePoints(const raycast::RayTracer& tracer, const kit::View& view) {
    const int width = view.sizePx.x;
    std::vector<VisiblePoint> points(static_cast<std::size_t>(width) *
                                     static_cast<std::size_t>(view.sizePx.y));
    const glm::vec3 forward = -glm::vec3(glm::transpose(view.viewFromWorld)[2]);
    tbb::parallel_for(tbb::blocked_range<int>(0, view.sizePx.y), [&](const auto& rows) {
        for (int y = rows.begin(); y < rows.end(); ++y) {
            for (int x = 0; x < width; ++x) {
                const glm::vec3 ray = kit::rayThrough(view, glm::vec2(x, y) + 0.5F);
                const float perDepth = 1.0F / glm::dot(ray, forward);
                const auto hit = tracer.closestHit(view.eyeWorld, ray, view.nearM * perDepth,
                                                   view.farM * perDepth, raycast::Faces::Drawn);
                if (!hit) continue;
                const float side = glm::dot(hit->geometricNormal, ray) > 0.0F ? -1.0F : 1.0F;
                points[static_cast<std::size_t>(y * width + x)] = {
                    hit->position, side * hit->geometricNormal, hit->flattenedTriangle};
            }
        }
    });
    return points;
}

bool ShadowTruth::isLit(const VisiblePoint& point, const TruthLight& light) const {
    const glm::vec3 direction = light.directionFrom(point.position);
    const float end = light.isDirectional ? std::numeric_limits<float>::infinity()
                                          : glm::length(light.position - point.position) - offsetM_;
    return !tracer_.isOccluded(point.position, direction, offsetM_, end, raycast::Faces::All,
                               point.triangle);
}

bool ShadowTruth::isNearEdge(const VisiblePoint& point, const TruthLight& light, bool isPointLit,
                             float edgeTexels) const {
    const glm::vec3 toLight = light.directionFrom(point.position);
    const glm::vec3 other = std::abs(toLight.y) < 0.9F ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    const glm::vec3 right = glm::normalize(glm::cross(other, toLight));
    const glm::vec3 up = glm::cross(toLight, right);
    const float reachM = edgeTexels * light.texelWidthAt(point.position);
    // 16 directions reach a straight edge at 98 % of the distance or more; the inner ring finds
    // casters thinner than the reach.
    constexpr int kDirections = 16;
    for (const float ring : {0.5F, 1.0F}) {
        for (int i = 0; i < kDirections; ++i) {
            const float angleRad = 6.2831853F * static_cast<float>(i) / kDirections;
            const glm::vec3 across =
                ring * reachM * (std::cos(angleRad) * right + std::sin(angleRad) * up);
            // The ray through the point moved across, met with the plane.
            const glm::vec3 moved = point.position + across;
            const glm::vec3 ray = light.directionFrom(moved);
            const float slope = glm::dot(ray, point.normal);
            if (slope <= 0.0F) continue;  // that ray does not see this side of the plane
            VisiblePoint neighbour = point;
            neighbour.position = moved - ray * (glm::dot(across, point.normal) / slope);
            if (isLit(neighbour, light) != isPointLit) return true;
        }
    }
    return false;
}

PixelClass ShadowTruth::classOf(const VisiblePoint& point, const TruthLight& light,
                                float shadowTerm, float edgeTexels) const {
    if (!point.isSurface()) return PixelClass::NotCompared;
    if (glm::dot(point.normal, light.directionFrom(point.position)) <= 0.0F) {
        return PixelClass::NotCompared;
    }
    const bool isTrulyLit = isLit(point, light);
    if (isTrulyLit == (shadowTerm >= 0.5F)) {
        return isTrulyLit ? PixelClass::Lit : PixelClass::Shadowed;
    }
    if (isNearEdge(point, light, isTrulyLit, edgeTexels)) return PixelClass::Edge;
    return isTrulyLit ? PixelClass::Acne : PixelClass::Leak;
}

ShadowErrors ShadowTruth::compare(const std::vector<VisiblePoint>& points, const TruthLight& light,
                                  const std::vector<float>& shadowTerms, float edgeTexels) const {
    GFXREPRO_ASSERT_EQ(points.size(), shadowTerms.size());
    ShadowErrors errors;
    errors.classes.resize(points.size());
    errors.truth.resize(points.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size()), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            const PixelClass pixel = classOf(points[i], light, shadowTerms[i], edgeTexels);
            errors.classes[i] = pixel;
            // The map's answer where it is right, else the other.
            const bool isRight = pixel == PixelClass::Lit || pixel == PixelClass::Shadowed;
            errors.truth[i] = (shadowTerms[i] >= 0.5F) == isRight ? 1 : 0;
        }
    });
    for (const PixelClass pixel : errors.classes) {
        errors.compared += pixel != PixelClass::NotCompared ? 1 : 0;
        errors.edge += pixel == PixelClass::Edge ? 1 : 0;
        errors.acne += pixel == PixelClass::Acne ? 1 : 0;
        errors.leak += pixel == PixelClass::Leak ? 1 : 0;
    }
    return errors;
}

image::ImageF classPicture(const ShadowErrors& errors, glm::ivec2 sizePx) {
    constexpr glm::vec3 kColours[] = {{0.02F, 0.03F, 0.10F}, {0.55F, 0.55F, 0.55F},
                                      {0.08F, 0.08F, 0.08F}, {0.90F, 0.70F, 0.05F},
                                      {0.85F, 0.03F, 0.03F}, {0.05F, 0.75F, 0.10F}};
    return kit::pictureOf(sizePx, [&](std::size_t pixel) {
        return kColours[static_cast<std::size_t>(errors.classes[pixel])];
    });
}

}  // namespace gfxrepro::shadow_mapping
