#include "techniques/reflection_reuse/match_check.h"

#include <tbb/parallel_for.h>

#include <atomic>
#include <cstdlib>

namespace gfxrepro::reflection_reuse {

namespace {

bool isWrong(const HostReflectionDepthImage& key, glm::ivec2 sample, const glm::vec2& offset,
             const glm::vec3& eyeWorld, const MatchingSettings& settings) {
    // A search from the match ends there, and says its distance.
    const HostMatch found = matchOnHost(key, sample, eyeWorld, offset, settings);
    const HostMatch best = matchExhaustively(key, sample, eyeWorld);
    if (!found.offset || !best.offset) return false;
    const glm::ivec2 apart = glm::abs(found.end - best.end);
    return std::max(apart.x, apart.y) > 1 && best.distance < found.distance;
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
