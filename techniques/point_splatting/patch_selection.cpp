#include "techniques/point_splatting/patch_selection.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace gfxrepro::point_splatting {

namespace {

/// Whether the box, grown by the radius of its splats, is outside of one plane.
bool isOutside(const std::array<glm::vec4, 6>& planes, const scene::Box& box, float radius) {
    const glm::vec3 centre = box.centre(), half = 0.5F * box.size();
    return std::any_of(planes.begin(), planes.end(), [&](const glm::vec4& plane) {
        const glm::vec3 normal(plane);
        const float reach = glm::dot(glm::abs(normal), half) + radius;
        return glm::dot(normal, centre) + plane.w < -reach;
    });
}

/// Whether no normal of the patch faces the eye. A disc does where its centre does, however large
/// it is.
bool isTurnedAway(const Patch& patch, const glm::vec3& eye) {
    const glm::vec3 toEye = eye - patch.bounds.centre();
    const float distance = glm::length(toEye);
    const float reach = 0.5F * glm::length(patch.bounds.size());
    if (distance <= reach) return false;  // the eye is among the points
    // The ray to any point is within asin(sinSpread) of that to the centre: normals lie within that
    // and the cone of an angle of cosine `facing` to it. All by sines, without arcs.
    const float sinSpread = reach / distance;
    const float cosSpread = std::sqrt(1.0F - sinSpread * sinSpread);
    const float sinCone = std::sin(patch.coneRad), cosCone = std::cos(patch.coneRad);
    if (cosCone * cosSpread - sinCone * sinSpread <= 0.0F || cosCone <= 0.0F) {
        return false;  // together 90° or more
    }
    const float sinBoth = sinCone * cosSpread + cosCone * sinSpread;
    return glm::dot(patch.meanNormal, toEye) < -sinBoth * distance;
}

/// Of the angle between the view ray to the patch's middle and its mean normal.
float facingCosine(const Patch& patch, const glm::vec3& eye) {
    const glm::vec3 toEye = eye - patch.bounds.centre();
    const float distance = glm::length(toEye);
    return distance > 0.0F ? std::abs(glm::dot(patch.meanNormal, toEye)) / distance : 0.0F;
}

/// Of the nearest of the box's eight corners, at least the near plane's.
float nearestCornerDistance(const scene::Box& box, const PatchView& view) {
    const glm::vec3 toMin = glm::abs(box.min - view.eyeWorld);
    const glm::vec3 toMax = glm::abs(box.max - view.eyeWorld);
    return std::max(glm::length(glm::min(toMin, toMax)), view.nearM);
}

std::uint32_t levelFor(const Patch& patch, std::span<const Level> levels, float distance,
                       float targetPx, const PatchView& view) {
    const float largest = targetPx * distance / view.focalPx;
    for (std::uint32_t l = 0; l < patch.levelCount; ++l) {
        if (levels[patch.firstLevel + l].maxRadius <= largest) return l;
    }
    return patch.levelCount - 1;
}

}  // namespace

float nearestDepth(const scene::Box& box, const PatchView& view) {
    const glm::vec4 row = -glm::transpose(view.viewFromWorld)[2];
    const glm::vec3 axis(row);
    const float centre = glm::dot(axis, box.centre()) + row.w;
    return std::max(centre - glm::dot(glm::abs(axis), 0.5F * box.size()), view.nearM);
}

PatchView patchViewOf(const scene::Camera& camera, glm::ivec2 sizePx) {
    PatchView view{kit::viewOf(camera, sizePx)};
    view.fovRad = camera.verticalFovRad;
    view.focalPx = 0.5F * static_cast<float>(sizePx.y) / std::tan(0.5F * camera.verticalFovRad);
    return view;
}

std::uint32_t arrivedLevel(const Patch& patch, std::span<const Level> levels, float share) {
    // Counts are exact in double precision.
    const double arrived = static_cast<double>(share) * static_cast<double>(patch.pointCount);
    std::uint32_t level = patch.levelCount - 1;
    while (level > 0 && static_cast<double>(levels[patch.firstLevel + level].count) > arrived) {
        --level;
    }
    return level;
}

double cEta(double fovRad) {
    const double tangent = std::tan(0.5 * fovRad);
    return std::sqrt(2.0 * tangent * tangent + 1.0);
}

SplatMode modeFor(float ratio, float cEta, const SelectionSettings& settings) {
    if (ratio > settings.cMax) return SplatMode::Reconstruction;
    if (cEta * ratio < settings.cMin) return SplatMode::LowPass;
    return SplatMode::FullEwa;
}

SelectionCounts selectPatches(std::span<const Patch> patches, std::span<const Level> levels,
                              const PatchView& view, const SelectionSettings& settings,
                              std::vector<DrawnPatch>& drawn) {
    drawn.clear();
    SelectionCounts counts;
    const std::array<glm::vec4, 6> planes = frustumPlanes(view);
    const auto cEtaOfView = static_cast<float>(cEta(static_cast<double>(view.fovRad)));
    const float sinSilhouette = std::sin(settings.silhouetteRad);
    for (std::uint32_t p = 0; p < patches.size(); ++p) {
        const Patch& patch = patches[p];
        // The first level's discs are the largest.
        const float reach = levels[patch.firstLevel].maxRadius;
        if (settings.cullsFrustum && isOutside(planes, patch.bounds, reach)) {
            ++counts.outside;
            continue;
        }
        if (settings.cullsCones && isTurnedAway(patch, view.eyeWorld)) {
            ++counts.turnedAway;
            continue;
        }
        const float distance = nearestCornerDistance(patch.bounds, view);
        const float cosine = facingCosine(patch, view.eyeWorld);
        const bool isSilhouette = cosine < sinSilhouette;
        DrawnPatch item;
        item.patch = p;
        item.level = arrivedLevel(patch, levels, settings.prefixShare);
        if (settings.choosesLevels) {
            const bool isFine = isSilhouette || patch.curvature > settings.curvedAbove ||
                                patch.coneRad > settings.wideAboveRad;
            const float target = isFine ? settings.fineRadiusPx : settings.targetRadiusPx;
            item.level = std::min(item.level, levelFor(patch, levels, distance, target, view));
        }
        const Level& level = levels[patch.firstLevel + item.level];
        item.mode = settings.mode.value_or(SplatMode::FullEwa);
        if (!settings.mode && !isSilhouette) {
            // S_proj of the level's mean radius, as it faces the eye, by S_h.
            const float radii =
                level.meanRadius * view.focalPx / (distance * settings.lowPassRadiusPx);
            item.mode = modeFor(radii * radii * cosine, cEtaOfView, settings);
        }
        drawn.push_back(item);
        ++counts.drawn;
        counts.points += level.count;
    }
    return counts;
}

}  // namespace gfxrepro::point_splatting
