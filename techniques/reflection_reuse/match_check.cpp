#include "techniques/reflection_reuse/match_check.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <optional>

namespace gfxrepro::reflection_reuse {

namespace {

/// How far the eye is missed between samples: position and normal are linear between the four
/// around. Nothing where one of them is not of the reflector.
std::optional<float> distanceBetween(const HostReflectionDepthImage& key, const glm::vec2& place,
                                     glm::ivec2 sample, const glm::vec3& eyeWorld) {
    const reflections::HostGBuffer& gbuffer = key.gbuffer;
    const glm::vec2 low = glm::floor(place), fraction = place - low;
    glm::vec3 position(0.0F), normal(0.0F);
    for (const glm::ivec2 corner : {glm::ivec2(0, 0), {1, 0}, {0, 1}, {1, 1}}) {
        const glm::vec2 near = glm::mix(1.0F - fraction, fraction, glm::vec2(corner));
        if (near.x * near.y == 0.0F) continue;
        const glm::ivec2 pixel = glm::ivec2(low) + corner;
        if (glm::any(glm::lessThan(pixel, glm::ivec2(0))) ||
            glm::any(glm::greaterThanEqual(pixel, gbuffer.view.sizePx))) {
            return std::nullopt;
        }
        const std::size_t index = gbuffer.indexOf(pixel);
        if (gbuffer.reflector(index) != gbuffer.reflector(gbuffer.indexOf(sample))) {
            return std::nullopt;
        }
        position += near.x * near.y * gbuffer.positionWorld(pixel);
        normal += near.x * near.y * gbuffer.normalWorld[index];
    }
    return matchingDistance(position, normal, key.reflectedPositionWorld(sample), eyeWorld);
}

bool isWrong(const HostReflectionDepthImage& key, glm::ivec2 sample, const glm::vec2& offset,
             const glm::vec3& eyeWorld, const MatchingSettings& settings) {
    // A search from the match ends there, and says its distance.
    const HostMatch found = matchOnHost(key, sample, eyeWorld, offset, settings);
    const HostMatch best = matchExhaustively(key, sample, eyeWorld);
    if (!found.offset || !best.offset) return false;
    const glm::ivec2 apart = glm::abs(found.end - best.end);
    // A match of second order lies between samples, and so is measured there.
    const float distance = std::min(
        found.distance, distanceBetween(key, glm::vec2(sample) + *found.offset, sample, eyeWorld)
                            .value_or(found.distance));
    return std::max(apart.x, apart.y) > 1 && best.distance < distance;
}

}  // namespace

bool isValid(const glm::vec2& offset) {
    return offset.x != kInvalidOffset;
}

MatchCheck checkMatches(const HostReflectionDepthImage& key, const std::vector<glm::vec2>& offsets,
                        const glm::vec3& eyeWorld, const MatchingSettings& settings, int samples) {
    std::vector<std::size_t> valid;
    for (std::size_t i = 0; i < offsets.size(); ++i) {
        if (key.gbuffer.isReflective(i) && isValid(offsets[i])) valid.push_back(i);
    }
    MatchCheck check;
    check.checked = std::min(valid.size(), static_cast<std::size_t>(samples));
    const auto width = static_cast<std::size_t>(key.gbuffer.view.sizePx.x);
    std::atomic<std::size_t> wrong = 0;
    tbb::parallel_for(std::size_t{0}, check.checked, [&](std::size_t i) {
        const std::size_t index = valid[i * valid.size() / check.checked];
        const glm::ivec2 sample(static_cast<int>(index % width), static_cast<int>(index / width));
        if (isWrong(key, sample, offsets[index], eyeWorld, settings)) ++wrong;
    });
    check.wrong = wrong;
    return check;
}

}  // namespace gfxrepro::reflection_reuse
