#include "techniques/clustered_reflections/reflection_pictures.h"

#include <cmath>

#include "techniques/reflections/surface_pictures.h"

namespace gfxrepro::clustered_reflections {

using reflections::HostGBuffer;

namespace {

/// Neighbouring numbers get hues a golden section apart, and two strengths.
glm::vec3 colorOf(std::uint16_t number) {
    const float hue = 6.0F * std::fmod(0.61803399F * static_cast<float>(number), 1.0F);
    const glm::vec3 pure(std::abs(hue - 3.0F) - 1.0F, 2.0F - std::abs(hue - 2.0F),
                         2.0F - std::abs(hue - 4.0F));
    const float strength = number % 2 == 0 ? 0.95F : 0.6F;
    return strength * glm::mix(glm::vec3(1.0F), glm::clamp(pure, 0.0F, 1.0F), 0.8F);
}

}  // namespace

image::ImageF numbersPicture(const HostGBuffer& gbuffer, const std::vector<std::uint16_t>& numbers,
                             int supersampling) {
    return reflections::averagedPicture(gbuffer, supersampling, [&](std::size_t i) {
        constexpr glm::vec3 kLuminance{0.2126F, 0.7152F, 0.0722F};
        const float luminance = glm::dot(gbuffer.diffuse[i], kLuminance);
        return numbers[i] == 0 ? glm::vec3(0.05F + 0.3F * luminance) : colorOf(numbers[i]);
    });
}

std::vector<std::uint16_t> reflectorNumbers(const HostGBuffer& gbuffer) {
    std::vector<std::uint16_t> numbers(gbuffer.surface.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        numbers[i] = static_cast<std::uint16_t>(gbuffer.reflector(i));
    }
    return numbers;
}

}  // namespace gfxrepro::clustered_reflections
