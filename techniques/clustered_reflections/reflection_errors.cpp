#include "techniques/clustered_reflections/reflection_errors.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "runner/core/error.h"

namespace gfxrepro::clustered_reflections {

using reflections::HostGBuffer;

namespace {

/// Sides of a planar cluster's image are the boxes of what its samples see, so that points that the
/// outermost samples see lie on them; as much as single precision may throw them out.
constexpr float kFrustumMargin = 1e-3F;

bool isInFrustum(const ClusterCamera& camera, const glm::vec3& point, float toleranceM) {
    const glm::vec4 clip = camera.clipFromWorld * glm::vec4(point, 1.0F);
    const float limit = (1.0F + kFrustumMargin) * clip.w;
    if (clip.w <= 0.0F || std::abs(clip.x) > limit || std::abs(clip.y) > limit) return false;
    const float depth = glm::dot(point - glm::vec3(camera.eyeWorld), glm::vec3(camera.planeNormal));
    return depth >= camera.eyeWorld.w - toleranceM &&
           depth <= (1.0F + kFrustumMargin) * camera.planeNormal.w + toleranceM;
}

/// Whether nothing that the cluster's image has lies between its near plane and `target`.
bool isClear(const ClusterCamera& camera, const glm::vec3& target, float toleranceM,
             const OcclusionInput& input) {
    const glm::vec3 eye(camera.eyeWorld);
    const float length = glm::length(target - eye);
    const glm::vec3 direction = (target - eye) / length;
    const float cosine = glm::dot(direction, glm::vec3(camera.planeNormal));
    if (cosine <= 0.0F) return false;  // beside the camera: not in its frustum either
    // The truth's rays meet nothing nearer to their surface, either.
    float start = camera.eyeWorld.w / cosine + toleranceM;
    const float end = length - toleranceM;
    while (start < end) {
        const auto hit = input.rays.closestHit(eye, direction, start, end);
        if (!hit) return true;
        const int reflector = input.scene.objects()[hit->instance].reflector;
        if (reflector != static_cast<int>(camera.reflector)) return false;
        // On behind the own reflector; at least to the next number, so that this ends.
        start = std::max(hit->distance * (1.0F + 1e-6F), std::nextafter(hit->distance, end));
    }
    return true;
}

}  // namespace

Sight sightOf(const ClusterCamera& camera, const glm::vec3& pointWorld,
              const OcclusionInput& input) {
    const float toleranceM = kOcclusionTolerance * input.scene.diagonalM();
    if (!isInFrustum(camera, pointWorld, toleranceM)) return Sight::OutOfFrustum;
    if (isClear(camera, pointWorld, toleranceM, input)) return Sight::Seen;
    // Past the edge that hides it by less than the tolerance: four lines beside it.
    const glm::vec3 axis = glm::normalize(pointWorld - glm::vec3(camera.eyeWorld));
    const glm::vec3 other = std::abs(axis.y) < 0.9F ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    const glm::vec3 right = toleranceM * glm::normalize(glm::cross(axis, other));
    const glm::vec3 up = glm::cross(right, axis);
    for (const glm::vec3& offset : {right, -right, up, -up}) {
        if (isClear(camera, pointWorld + offset, toleranceM, input)) return Sight::Seen;
    }
    return Sight::Hidden;
}

OcclusionErrors occlusionErrors(const OcclusionInput& input) {
    const HostGBuffer& gbuffer = input.gbuffer;
    const auto width = static_cast<std::size_t>(gbuffer.view.sizePx.x);
    const std::size_t count = gbuffer.surface.size();
    GFXREPRO_ASSERT_EQ(input.truth.size(), count);
    GFXREPRO_ASSERT_EQ(input.clusterOfSample.size(), count);
    OcclusionErrors errors;
    errors.isMissing.assign(count, 0);
    std::vector<std::uint8_t> isHidden(count, 0);
    const float diagonalM = input.scene.diagonalM();
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        const float distanceM = input.truth[i].distanceM;
        if (input.clusterOfSample[i] == 0 || distanceM <= 0.0F) return;
        const float glossiness = gbuffer.glossiness(i);
        if (glossiness > 0.0F &&
            distanceM >= reflections::farPlaneM(input.lobe, glossiness, diagonalM)) {
            return;
        }
        const glm::ivec2 pixel(static_cast<int>(i % width), static_cast<int>(i / width));
        const glm::vec3 hit =
            gbuffer.positionWorld(pixel) + distanceM * gbuffer.mirrorDirection(pixel);
        const ClusterCamera& camera = input.cameras[input.clusterOfSample[i] - 1U];
        const Sight sight = sightOf(camera, hit, input);
        errors.isMissing[i] = sight == Sight::Seen ? 0 : 1;
        isHidden[i] = sight == Sight::Hidden ? 1 : 0;
    });
    for (std::size_t i = 0; i < count; ++i) {
        if (input.clusterOfSample[i] == 0) continue;
        const bool isPlanar =
            (input.cameras[input.clusterOfSample[i] - 1U].flags & kPlanarCluster) != 0;
        ++errors.reflective;
        errors.missing += errors.isMissing[i];
        errors.hidden += isHidden[i];
        errors.planar += isPlanar ? 1 : 0;
        errors.planarMissing += isPlanar ? errors.isMissing[i] : 0;
    }
    return errors;
}

}  // namespace gfxrepro::clustered_reflections
