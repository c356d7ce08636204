#include "techniques/reflection_reuse/reuse_pictures.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "techniques/reflection_reuse/match_check.h"
#include "techniques/reflections/surface_pictures.h"

namespace gfxrepro::reflection_reuse {

using reflections::HostGBuffer;

namespace {

glm::vec3 dimmed(const HostGBuffer& gbuffer, std::size_t index) {
    constexpr glm::vec3 kLuminance{0.2126F, 0.7152F, 0.0722F};
    return glm::vec3(0.05F + 0.3F * glm::dot(gbuffer.diffuse[index], kLuminance));
}

/// White where `strength` is 0, the pure hue of a direction where it is 1.
glm::vec3 colorOf(const glm::vec2& direction, float strength) {
    const float turn = std::atan2(direction.y, direction.x) / glm::two_pi<float>();
    const float hue = 6.0F * (turn < 0.0F ? turn + 1.0F : turn);
    const glm::vec3 pure(std::abs(hue - 3.0F) - 1.0F, 2.0F - std::abs(hue - 2.0F),
                         2.0F - std::abs(hue - 4.0F));
    return glm::mix(glm::vec3(1.0F), glm::clamp(pure, 0.0F, 1.0F), strength);
}

}  // namespace

image::ImageF offsetsPicture(const HostGBuffer& key, const std::vector<glm::vec2>& offsets,
                             int supersampling) {
    std::vector<float> lengthsPx;
    for (std::size_t i = 0; i < offsets.size(); ++i) {
        if (!key.isReflective(i) || !isValid(offsets[i])) continue;
        lengthsPx.push_back(glm::length(offsets[i]));
    }
    const auto middle = lengthsPx.begin() + static_cast<std::ptrdiff_t>(lengthsPx.size() / 2);
    std::nth_element(lengthsPx.begin(), middle, lengthsPx.end());
    const float medianPx = middle == lengthsPx.end() ? 1.0F : std::max(*middle, 1.0F);
    return reflections::averagedPicture(key, supersampling, [&](std::size_t i) {
        if (!key.isReflective(i)) return dimmed(key, i);
        if (!isValid(offsets[i])) return glm::vec3(0.0F);
        // Half of the hue at the median: few samples go far, and neither do they clip nor do they
        // leave the others white.
        const float lengthPx = glm::length(offsets[i]);
        return colorOf(offsets[i], lengthPx / (lengthPx + medianPx));
    });
}

image::ImageF shiftedPicture(const HostGBuffer& key, const std::vector<glm::vec4>& radiance,
                             int supersampling) {
    return reflections::averagedPicture(key, supersampling, [&](std::size_t i) {
        if (!key.isReflective(i)) return dimmed(key, i);
        return radiance[i].a > 0.5F ? glm::vec3(radiance[i]) : glm::vec3(1.0F, 0.0F, 0.0F);
    });
}

}  // namespace gfxrepro::reflection_reuse
