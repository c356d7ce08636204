// How often the local search of Algorithm 9 ends beside the best match ([xie2017] Sec. 5.5.2: the
// first source of error).
#pragma once

#include <vector>

#include "techniques/reflection_reuse/pixel_matcher.h"

namespace gfxrepro::reflection_reuse {

bool isValid(const glm::vec2& offset);

struct MatchCheck {
    std::size_t checked = 0;
    std::size_t wrong = 0;  // another sample of the reflector, not next to the match, fits better
                            // than the match does where it is: between samples, of second order
};

/// At most `samples` of the valid matches, evenly spread over the image, against
/// matchExhaustively().
MatchCheck checkMatches(const HostReflectionDepthImage& key, const std::vector<glm::vec2>& offsets,
                        const glm::vec3& eyeWorld, const MatchingSettings& settings, int samples);

}  // namespace gfxrepro::reflection_reuse
