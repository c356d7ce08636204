#include "techniques/clustered_reflections/reflection_errors.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"
#include "techniques/kit/percent.h"

namespace gfxrepro::clustered_reflections {

using reflections::HostGBuffer;

namespace {

/// Sides of a planar cluster's image are the boxes of what its samples see, so that points that the
/// outermost samples see lie on them; as much as single precision may throw them out.
constexpr float kFrustumMargin = 1e-3F;

/// Seen, BeforeNear or Beside.
Sight sightOfFrustum(const ClusterCamera& camera, const glm::vec3& point, float toleranceM) {
    const float depth = glm::dot(point - glm::vec3(camera.eyeWorld), glm::vec3(camera.planeNormal));
    if (depth < camera.eyeWorld.w - toleranceM) return Sight::BeforeNear;
    if (depth > (1.0F + kFrustumMargin) * camera.planeNormal.w + toleranceM) return Sight::Beside;
    const glm::vec4 clip = camera.clipFromWorld * glm::vec4(point, 1.0F);
    const float limit = (1.0F + kFrustumMargin) * clip.w;
    return std::abs(clip.x) > limit || std::abs(clip.y) > limit ? Sight::Beside : Sight::Seen;
}

bool leavesOut(const ClusterCamera& camera, std::uint32_t reflector, const OcclusionInput& input) {
    if (reflector == camera.reflector) return (camera.flags & kShowsOwn) == 0;
    return !input.families.empty() &&
           areBackToBack(input.families[reflector], input.families[camera.reflector]);
}

/// Whether a surface is seen from the side that its normals point to.
bool isFacing(const raycast::Hit& hit, const glm::vec3& direction,
              const reflections::ReflectiveScene& scene) {
    // By winding in the world, and by whether normals and winding agree in the mesh.
    const reflections::ObjectGeometry& geometry = scene.geometry();
    const glm::uvec3 corners = geometry.triangles[hit.flattenedTriangle];
    const glm::vec3 a = geometry.positions[corners.x];
    const glm::vec3 winding =
        glm::cross(geometry.positions[corners.y] - a, geometry.positions[corners.z] - a);
    const glm::vec3 normal = scene.normalMeshAt(hit.flattenedTriangle, hit.barycentric);
    return glm::dot(winding, normal) * glm::dot(hit.geometricNormal, direction) <= 0.0F;
}

/// Whether nothing that the cluster's image has lies between its near plane and `target`.
bool isClear(const ClusterCamera& camera, const glm::vec3& target, float toleranceM,
             const OcclusionInput& input) {
    const glm::vec3 eye(camera.eyeWorld);
    const float length = glm::length(target - eye);
    const glm::vec3 direction = (target - eye) / length;
    const float cosine = glm::dot(direction, glm::vec3(camera.planeNormal));
    if (cosine <= 0.0F) return false;  // beside the camera: not in its frustum either
    float start = camera.eyeWorld.w / cosine + toleranceM;
    const float end = length - toleranceM;
    while (start < end) {
        const auto hit = input.rays.closestHit(eye, direction, start, end);
        if (!hit) return true;
        const auto reflector =
            static_cast<std::uint32_t>(input.scene.objects()[hit->instance].reflector);
        const bool isBackLeftOut = reflector == camera.reflector &&
                                   (camera.flags & kShowsOwnBack) == 0 &&
                                   !isFacing(*hit, direction, input.scene);
        if (!leavesOut(camera, reflector, input) && !isBackLeftOut) return false;
        // On behind what is not drawn; at least to the next number, so that
        // this ends.
        start = std::max(hit->distance * (1.0F + 1e-6F), std::nextafter(hit->distance, end));
    }
    return true;
}

}  // namespace

Sight sightOf(const ClusterCamera& camera, const glm::vec3& pointWorld, std::uint32_t reflector,
              const OcclusionInput& input) {
    if (leavesOut(camera, reflector, input)) return Sight::Self;
    const float toleranceM = kOcclusionTolerance * input.scene.diagonalM();
    const Sight inFrustum = sightOfFrustum(camera, pointWorld, toleranceM);
    if (inFrustum != Sight::Seen) return inFrustum;
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
    std::vector<Sight> sights(count, Sight::Seen);
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
        const std::uint32_t object = input.truth[i].object;
        const int reflector = object == 0 ? 0 : input.scene.objects()[object - 1U].reflector;
        const ClusterCamera& camera = input.cameras[input.clusterOfSample[i] - 1U];
        sights[i] = sightOf(camera, hit, static_cast<std::uint32_t>(reflector), input);
    });
    errors.isMissing.assign(count, 0);
    for (std::size_t i = 0; i < count; ++i) {
        if (input.clusterOfSample[i] == 0) continue;
        const bool isPlanar =
            (input.cameras[input.clusterOfSample[i] - 1U].flags & kPlanarCluster) != 0;
        const bool isMissing = sights[i] != Sight::Seen;
        errors.isMissing[i] = isMissing ? 1 : 0;
        ++errors.reflective;
        ++errors.ofSight[static_cast<std::size_t>(sights[i])];
        errors.planar += isPlanar ? 1 : 0;
        errors.planarMissing += isPlanar && isMissing ? 1 : 0;
    }
    return errors;
}

std::optional<double> wrongHitPct(const HostGBuffer& gbuffer,
                                  const std::vector<reflections::TracedSample>& truth,
                                  const std::vector<float>& distancesM, float diagonalM) {
    std::size_t mirrors = 0, wrong = 0;
    for (std::size_t i = 0; i < distancesM.size(); ++i) {
        if (!gbuffer.isReflective(i) || gbuffer.glossiness(i) > 0.0F) continue;
        const float truthM = truth[i].distanceM;
        ++mirrors;
        const bool isWrong = (truthM > 0.0F) != (distancesM[i] > 0.0F) ||
                             std::abs(truthM - distancesM[i]) > 0.01F * diagonalM;
        wrong += isWrong ? 1 : 0;
    }
    if (mirrors == 0) return std::nullopt;
    return kit::percent(wrong, mirrors);
}

}  // namespace gfxrepro::clustered_reflections
