#include "techniques/point_splatting/model_picture.h"

#include <algorithm>
#include <glm/glm.hpp>
#include <span>

#include "engine/core/error.h"
#include "engine/image/resample.h"

namespace gfxrepro::point_splatting {

ModelPicture::ModelPicture(const image::ImageF& rgba)
    : color(rgba.width(), rgba.height(), 3), coverage(rgba.width(), rgba.height(), 1) {
    GFXREPRO_ASSERT_EQ(rgba.channels(), 4);
    for (int y = 0; y < rgba.height(); ++y) {
        for (int x = 0; x < rgba.width(); ++x) {
            for (int c = 0; c < 3; ++c) color.at(x, y, c) = rgba.at(x, y, c);
            coverage.at(x, y) = rgba.at(x, y, 3);
        }
    }
}

std::optional<image::ImageF> ModelPicture::enlarged() const {
    const glm::ivec2 whole(color.width(), color.height());
    glm::ivec2 needed(0);  // of a part in the middle
    for (int y = 0; y < whole.y; ++y) {
        for (int x = 0; x < whole.x; ++x) {
            if (coverage.at(x, y) <= 0.0F) continue;
            const glm::ivec2 pixel(x, y);
            needed = glm::max(needed, glm::max(whole - 2 * pixel, 2 * pixel + 2 - whole));
        }
    }
    if (needed.x == 0) return std::nullopt;
    const int scale = std::min(whole.x / needed.x, whole.y / needed.y);
    if (scale < 2) return std::nullopt;
    const glm::ivec2 size = whole / scale, first = (whole - size) / 2;
    return image::cropped(color, {first.x, first.y, size.x, size.y}, scale);
}

ModelPixels::ModelPixels(const ModelPicture& a, const ModelPicture& b) {
    const std::span<const float> inA = a.coverage.values(), inB = b.coverage.values();
    GFXREPRO_ASSERT_EQ(inA.size(), inB.size());
    for (std::size_t i = 0; i < inA.size(); ++i) {
        if (inA[i] > 0.0F || inB[i] > 0.0F) pixels_.push_back(i);
    }
}

image::ImageF ModelPixels::of(const image::ImageF& image) const {
    const auto channels = static_cast<std::size_t>(image.channels());
    image::ImageF row(std::max(static_cast<int>(pixels_.size()), 1), 1, image.channels());
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        const std::span<const float> pixel =
            image.values().subspan(pixels_[i] * channels, channels);
        std::copy(pixel.begin(), pixel.end(), row.values().subspan(i * channels).begin());
    }
    return row;
}

}  // namespace gfxrepro::point_splatting
