// Pairs of images that are the same on every machine, for metrics that others have measured.
#pragma once

#include <algorithm>
#include <cmath>

#include "engine/core/random.h"
#include "engine/image/image.h"
#include "tests/support/grid.h"

namespace gfxrepro::metrics {

/// Ramps of colour, a bright disc, a dark square and a grid of lines, in [0, 1]; `shift` moves the
/// shapes to the right.
inline image::ImageF shapes(int width, int height, int shift) {
    image::ImageF image(width, height, 3);
    for (const auto [y, x] : test::grid(height, width)) {
        const float u = static_cast<float>(x) / static_cast<float>(width);
        const float v = static_cast<float>(y) / static_cast<float>(height);
        float colour[] = {0.1F + 0.6F * u, 0.2F + 0.5F * v, 0.5F - 0.4F * u * v};
        const int dx = x - shift - width / 3, dy = y - height / 2;
        if (dx * dx + dy * dy < height * height / 16) {
            colour[0] = 1.0F;
            colour[1] = 0.85F;
            colour[2] = 0.3F;
        }
        if (x - shift > 2 * width / 3 && x - shift < 5 * width / 6 && y > height / 4 &&
            y < height / 2) {
            std::fill(std::begin(colour), std::end(colour), 0.02F);
        }
        if ((x - shift) % 16 == 0 && y > 3 * height / 4) colour[1] = 1.0F;
        for (int c = 0; c < 3; ++c) image.at(x, y, c) = colour[c];
    }
    return image;
}

/// Plus `amount` times uniform noise around 0, kept in [0, 1].
inline image::ImageF noisy(image::ImageF image, float amount, std::uint64_t seed) {
    Random random(seed);
    for (float& value : image.values()) {
        value = std::clamp(value + random.uniform(-amount, amount), 0.0F, 1.0F);
    }
    return image;
}

/// Means of 3 × 3 pixels, fewer at the border.
inline image::ImageF blurred(const image::ImageF& image) {
    image::ImageF result(image.width(), image.height(), image.channels());
    for (const auto [y, x] : test::grid(image.height(), image.width())) {
        for (int c = 0; c < image.channels(); ++c) {
            float sum = 0.0F, count = 0.0F;
            for (int j = std::max(y - 1, 0); j <= std::min(y + 1, image.height() - 1); ++j) {
                for (int i = std::max(x - 1, 0); i <= std::min(x + 1, image.width() - 1); ++i) {
                    sum += image.at(i, j, c);
                    count += 1.0F;
                }
            }
            result.at(x, y, c) = sum / count;
        }
    }
    return result;
}

/// The same over ten stops, from dark on the left to bright on the right.
inline image::ImageF ranged(image::ImageF image) {
    for (const auto [y, x] : test::grid(image.height(), image.width())) {
        const int stop = 10 * x / image.width() - 5;
        for (int c = 0; c < image.channels(); ++c) {
            image.at(x, y, c) = std::ldexp(image.at(x, y, c), stop);
        }
    }
    return image;
}

inline image::ImageF cropped(const image::ImageF& image, int left, int top, int width, int height) {
    image::ImageF result(width, height, 3);
    for (const auto [y, x] : test::grid(height, width)) {
        for (int c = 0; c < 3; ++c) result.at(x, y, c) = image.at(left + x, top + y, c);
    }
    return result;
}

}  // namespace gfxrepro::metrics
