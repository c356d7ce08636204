#include "techniques/shared/reflections/texture_layer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "runner/core/error.h"
#include "runner/image/srgb.h"

namespace gfxrepro::reflections {

namespace {

/// How much of each of the texels first, first + 1, … a resampled one covers; the sum is 1.
struct Cover {
    int first = 0;
    std::vector<float> weights;
};

std::vector<Cover> coversOf(int fromSize, int toSize) {
    std::vector<Cover> covers(static_cast<std::size_t>(toSize));
    const double scale = static_cast<double>(fromSize) / toSize;
    for (int i = 0; i < toSize; ++i) {
        const double begin = i * scale;
        const double end = begin + scale;
        Cover& cover = covers[static_cast<std::size_t>(i)];
        cover.first = std::min(static_cast<int>(begin), fromSize - 1);
        for (int from = cover.first; from < fromSize && (from < end || from == cover.first);
             ++from) {
            const double overlap = std::min(end, from + 1.0) - std::max(begin, double(from));
            cover.weights.push_back(static_cast<float>(std::max(overlap, 0.0) / scale));
        }
    }
    return covers;
}

image::Image8 toBytes(const image::ImageF& values) {
    image::Image8 bytes(values.width(), values.height(), values.channels());
    std::transform(
        values.values().begin(), values.values().end(), bytes.values().begin(), [](float value) {
            return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(value, 0.0F, 1.0F)));
        });
    return bytes;
}

}  // namespace

std::array<float, 256> decodingOf(TexelKind kind) {
    if (kind == TexelKind::Colours) return image::srgbDecoding();
    std::array<float, 256> decoding{};
    for (std::size_t i = 0; i < decoding.size(); ++i) {
        decoding[i] = static_cast<float>(i) / 255.0F;
    }
    return decoding;
}

image::Image8 textureLayer(const image::Image8& image, int sizePx, TexelKind kind) {
    GFXREPRO_ASSERT(image.channels() >= 3 && !image.empty());
    const std::array<float, 256> decoding = decodingOf(kind);
    const auto value = [&](int x, int y, int channel) {
        if (channel < 3) return decoding[image.at(x, y, channel)];
        return image.channels() > 3 ? static_cast<float>(image.at(x, y, 3)) / 255.0F : 1.0F;
    };
    // Across first, then down.
    const std::vector<Cover> across = coversOf(image.width(), sizePx);
    image::ImageF rows(sizePx, image.height(), 4);
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < sizePx; ++x) {
            const Cover& cover = across[static_cast<std::size_t>(x)];
            for (int channel = 0; channel < 4; ++channel) {
                int from = cover.first;
                for (const float weight : cover.weights) {
                    rows.at(x, y, channel) += weight * value(from++, y, channel);
                }
            }
        }
    }
    const std::vector<Cover> down = coversOf(image.height(), sizePx);
    image::ImageF layer(sizePx, sizePx, 4);
    for (int y = 0; y < sizePx; ++y) {
        const Cover& cover = down[static_cast<std::size_t>(y)];
        int from = cover.first;
        for (const float weight : cover.weights) {
            const std::span<const float> source = rows.row(from++);
            std::transform(source.begin(), source.end(), layer.row(y).begin(), layer.row(y).begin(),
                           [&](float add, float sum) { return sum + weight * add; });
        }
    }
    return kind == TexelKind::Colours ? image::toSrgb8(layer) : toBytes(layer);
}

}  // namespace gfxrepro::reflections
