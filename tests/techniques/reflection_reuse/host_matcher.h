// Algorithm 9 of [xie2017] on the host, operation by operation as pixel_matching.comp.glsl has it.
#pragma once

#include <optional>
#include <vector>

#include "techniques/reflection_reuse/pixel_matcher.h"

namespace gfxrepro::reflection_reuse {

struct HostMatch {
    std::optional<glm::vec2> offset;  // whole pixels in first order; nothing: invalid
    int steps = 0;
    float distance = 0.0F;      // of the last candidate
    glm::ivec2 end{0};          // the last candidate
    std::vector<float> passed;  // distances of all candidates that the search stood on
};
/// Algorithm 9 for one sample, line by line; the search stops on equality, too, where the printed
/// one can cycle.
HostMatch matchOnHost(const HostReflectionDepthImage& key, glm::ivec2 sample,
                      const glm::vec3& eyeWorld, std::optional<glm::vec2> previous,
                      const MatchingSettings& settings);

}  // namespace gfxrepro::reflection_reuse
