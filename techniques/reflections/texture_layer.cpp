#include "techniques/reflections/texture_layer.h"

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"
#include "engine/image/srgb.h"

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

/// 4 channels, with an alpha of 1 where there was none.
image::Image8 withAlpha(const image::Image8& image) {
    if (image.channels() == 4) return image;
    image::Image8 result(image.width(), image.height(), 4);
    const std::uint8_t* from = image.values().data();
    for (std::size_t i = 0; i < result.values().size(); i += 4, from += 3) {
        std::copy_n(from, 3, result.values().begin() + static_cast<std::ptrdiff_t>(i));
        result.values()[i + 3] = 255;
    }
    return result;
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
    if (image.width() == sizePx && image.height() == sizePx) return withAlpha(image);
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

image::Image8 halvedLayer(const image::Image8& layer, TexelKind kind) {
    GFXREPRO_ASSERT(layer.channels() == 4 && layer.width() % 2 == 0 && layer.height() % 2 == 0);
    const std::array<float, 256> decoding = decodingOf(kind);
    const std::array<float, 256> alphas = decodingOf(TexelKind::Values);
    image::ImageF half(layer.width() / 2, layer.height() / 2, 4);
    for (int y = 0; y < half.height(); ++y) {
        for (int x = 0; x < half.width(); ++x) {
            for (int channel = 0; channel < 4; ++channel) {
                const auto& decoded = channel < 3 ? decoding : alphas;
                const auto at = [&](int dx, int dy) {
                    return decoded[layer.at(2 * x + dx, 2 * y + dy, channel)];
                };
                half.at(x, y, channel) = 0.25F * (at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1));
            }
        }
    }
    return kind == TexelKind::Colours ? image::toSrgb8(half) : toBytes(half);
}

}  // namespace gfxrepro::reflections
