// Images in memory: rows from the top, channels interleaved.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/core/error.h"

namespace gfxrepro::image {

// The bound on memory that every image decoder keeps to.

/// Of images that are decoded whole.
constexpr std::int64_t kMaxSidePx = 32768;

/// What a file is for: a picture, which a run may have recorded, or a texture or map of somebody's.
enum class ImageUse { Picture, Texture };

/// Throws Error when a header declares more than `maxSidePx` pixels a side, none at all, or an
/// image of more than 128 MiB that is also more than 500 times the file's size. Of a picture
/// 4,200 times pass up to 1 GiB (16,384²): an even one, black, is as small as deflate makes it, and
/// what was recorded is read again. `name` stands in the message.
void checkDeclaredSize(std::int64_t width, std::int64_t height, std::size_t bytesPerPixel,
                       std::size_t fileBytes, const std::string& name,
                       std::int64_t maxSidePx = kMaxSidePx, ImageUse use = ImageUse::Texture);

/// width × height pixels of `channels` values; pixel (x, y) counts from the top-left corner.
template <class T>
class Image {
  public:
    Image() = default;
    Image(int width, int height, int channels, T fill = T{})
        : width_(width), height_(height), channels_(channels) {
        GFXREPRO_ASSERT(width >= 0 && height >= 0 && channels >= 1);
        values_.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                           static_cast<std::size_t>(channels),
                       fill);
    }

    int width() const { return width_; }
    int height() const { return height_; }
    int channels() const { return channels_; }
    bool empty() const { return values_.empty(); }

    T& at(int x, int y, int channel = 0) { return values_[index(x, y, channel)]; }
    const T& at(int x, int y, int channel = 0) const { return values_[index(x, y, channel)]; }

    std::span<T> values() { return values_; }
    std::span<const T> values() const { return values_; }
    std::span<T> row(int y) {
        const auto rowValues =
            static_cast<std::size_t>(width_) * static_cast<std::size_t>(channels_);
        return std::span<T>(values_).subspan(static_cast<std::size_t>(y) * rowValues, rowValues);
    }

    bool operator==(const Image&) const = default;

  private:
    std::size_t index(int x, int y, int channel) const {
        return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                static_cast<std::size_t>(x)) *
                   static_cast<std::size_t>(channels_) +
               static_cast<std::size_t>(channel);
    }

    int width_ = 0;
    int height_ = 0;
    int channels_ = 1;
    std::vector<T> values_;
};

/// Pixels from (left, top) on.
struct Rectangle {
    int left = 0;
    int top = 0;
    int width = 0;
    int height = 0;

    bool operator==(const Rectangle&) const = default;
};
/// What is in both; of no width or height where nothing is.
Rectangle intersection(const Rectangle& a, const Rectangle& b);

using Image8 = Image<std::uint8_t>;
using Image16 = Image<std::uint16_t>;
using ImageF = Image<float>;

/// The second of two channels and the fourth of four.
constexpr bool isAlpha(std::size_t channel, std::size_t channels) {
    return channels % 2 == 0 && channel == channels - 1;
}

/// Linear to sRGB (IEC 61966-2-1), clamped to [0, 1] and rounded to 8 bits. Alpha stays linear.
/// Not-a-number becomes 0.
Image8 toSrgb8(const ImageF& linear);

}  // namespace gfxrepro::image
