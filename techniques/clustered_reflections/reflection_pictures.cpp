#include "techniques/clustered_reflections/reflection_pictures.h"

#include <algorithm>
#include <cmath>

#include "runner/image/srgb.h"

namespace gfxrepro::clustered_reflections {

using reflections::HostGBuffer;

namespace {

/// Mean colour of each output pixel's samples, rows from the top.
template <class Color>
image::ImageF averaged(const HostGBuffer& gbuffer, int supersampling, Color color) {
    const glm::ivec2 size = gbuffer.view.sizePx / supersampling;
    image::ImageF picture(size.x, size.y, 3);
    const float weight = 1.0F / static_cast<float>(supersampling * supersampling);
    for (int y = 0; y < size.y * supersampling; ++y) {
        for (int x = 0; x < size.x * supersampling; ++x) {
            const glm::vec3 value = weight * color(gbuffer.indexOf({x, y}));
            for (int c = 0; c < 3; ++c) {
                picture.at(x / supersampling, size.y - 1 - y / supersampling, c) += value[c];
            }
        }
    }
    return picture;
}

/// Neighbouring numbers get hues a golden section apart, and two strengths.
glm::vec3 colorOf(std::uint16_t number) {
    const float hue = 6.0F * std::fmod(0.61803399F * static_cast<float>(number), 1.0F);
    const glm::vec3 pure(std::abs(hue - 3.0F) - 1.0F, 2.0F - std::abs(hue - 2.0F),
                         2.0F - std::abs(hue - 4.0F));
    const float strength = number % 2 == 0 ? 0.95F : 0.6F;
    return strength * glm::mix(glm::vec3(1.0F), glm::clamp(pure, 0.0F, 1.0F), 0.8F);
}

}  // namespace

image::ImageF errorPicture(const image::ImageF& picture, const image::ImageF& truth, int gain) {
    const image::Image8 a = image::toSrgb8(picture);
    const image::Image8 b = image::toSrgb8(truth);
    const std::array<float, 256> linear = image::srgbDecoding();  // pictures are shown as sRGB
    image::ImageF error(picture.width(), picture.height(), picture.channels());
    for (std::size_t i = 0; i < error.values().size(); ++i) {
        const int difference = std::abs(int{a.values()[i]} - int{b.values()[i]});
        error.values()[i] = linear[static_cast<std::size_t>(std::min(gain * difference, 255))];
    }
    return error;
}

image::ImageF numbersPicture(const HostGBuffer& gbuffer, const std::vector<std::uint16_t>& numbers,
                             int supersampling) {
    return averaged(gbuffer, supersampling, [&](std::size_t i) {
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

image::ImageF markedPicture(const image::ImageF& picture, const std::vector<std::uint8_t>& marks,
                            const HostGBuffer& gbuffer, int supersampling) {
    const image::ImageF shares = averaged(gbuffer, supersampling, [&](std::size_t i) {
        return glm::vec3(marks[i] != 0 ? 1.0F : 0.0F);
    });
    image::ImageF marked = picture;
    for (int y = 0; y < marked.height(); ++y) {
        for (int x = 0; x < marked.width(); ++x) {
            const float share = shares.at(x, y);
            for (int c = 0; c < 3; ++c) {
                float& value = marked.at(x, y, c);
                value = glm::mix(0.6F * value, c == 0 ? 1.0F : 0.0F, share);
            }
        }
    }
    return marked;
}

}  // namespace gfxrepro::clustered_reflections
