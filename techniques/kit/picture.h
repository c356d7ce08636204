// Pictures of values as the device has them.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <type_traits>

#include "engine/image/image.h"

namespace gfxrepro::kit {

/// Behind scenes, linear.
constexpr glm::vec3 kBackground{0.18F, 0.20F, 0.24F};

/// A picture, rows from the top, of color(pixel), a vec3 or a float; pixels are counted from the
/// left end of the bottom row.
template <class Color>
image::ImageF pictureOf(glm::ivec2 sizePx, const Color& color) {
    constexpr bool isGrey = std::is_same_v<std::invoke_result_t<Color, std::size_t>, float>;
    constexpr int kChannels = isGrey ? 1 : 3;
    image::ImageF picture(sizePx.x, sizePx.y, kChannels);
    std::size_t pixel = 0;
    for (int y = sizePx.y - 1; y >= 0; --y) {
        for (int x = 0; x < sizePx.x; ++x, ++pixel) {
            const glm::vec3 value(color(pixel));
            for (int c = 0; c < kChannels; ++c) picture.at(x, y, c) = value[c];
        }
    }
    return picture;
}

}  // namespace gfxrepro::kit
