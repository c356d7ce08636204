#include "engine/image/image.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

#include "engine/core/error.h"
#include "engine/image/srgb.h"

namespace gfxrepro::image {

void checkDeclaredSize(std::int64_t width, std::int64_t height, std::size_t bytesPerPixel,
                       std::size_t fileBytes, const std::string& name, std::int64_t maxSidePx,
                       ImageUse use) {
    const std::string declared =
        name + ": the header declares " + std::to_string(width) + " x " + std::to_string(height);
    if (width < 1 || height < 1 || width > maxSidePx || height > maxSidePx) {
        throw Error(declared + " pixels; 1 to " + std::to_string(maxSidePx) +
                    " a side are allowed");
    }
    constexpr std::size_t kAlwaysAllowedBytes = std::size_t{128} << 20;
    constexpr std::size_t kMaxExpansion = 500;
    constexpr std::size_t kMaxPictureBytes = std::size_t{1} << 30;
    constexpr std::size_t kMaxPictureExpansion = 4200;  // deflate: 1,030, grey counted as RGBA
    const std::size_t bytes = static_cast<std::size_t>(width * height) * bytesPerPixel;
    const bool isEvenPicture = use == ImageUse::Picture && bytes <= kMaxPictureBytes &&
                               bytes <= kMaxPictureExpansion * fileBytes;
    if (!isEvenPicture && bytes > std::max(kAlwaysAllowedBytes, kMaxExpansion * fileBytes)) {
        throw Error(declared + " pixels of " + std::to_string(bytesPerPixel) +
                    " bytes, too many for a file of " + std::to_string(fileBytes) + " bytes");
    }
}

Rectangle intersection(const Rectangle& a, const Rectangle& b) {
    const auto common = [](std::int64_t from, std::int64_t size, std::int64_t otherFrom,
                           std::int64_t otherSize) {
        const std::int64_t begin = std::max(from, otherFrom);
        const std::int64_t end = std::min(from + size, otherFrom + otherSize);
        return std::pair(static_cast<int>(begin),
                         static_cast<int>(std::max<std::int64_t>(0, end - begin)));
    };
    const auto [left, width] = common(a.left, a.width, b.left, b.width);
    const auto [top, height] = common(a.top, a.height, b.top, b.height);
    return {left, top, width, height};
}

namespace {

std::uint8_t quantized(float unit) {
    return static_cast<std::uint8_t>(unit * 255.0F + 0.5F);
}

/// NaN fails both comparisons' opposites and so becomes 0.
float clampedToUnit(float value) {
    return value > 0.0F ? (value < 1.0F ? value : 1.0F) : 0.0F;
}

std::uint8_t srgb8Of(float unit) {
    return quantized(srgbOf(unit));
}

/// srgb8Of() without a power for most values: a range of floats that differ in their lowest bits
/// alone has one value, except where the next one begins.
class SrgbRanges {
  public:
    SrgbRanges() {
        // Far more than a power is rounded by, far less than the step from one value to the next.
        constexpr float kMargin = 1e-3F;
        for (std::uint32_t i = 0; i < values_.size(); ++i) {
            const float least = std::bit_cast<float>((kFirst + i) << kLowestBits);
            const float most = std::bit_cast<float>(((kFirst + i + 1) << kLowestBits) - 1);
            const float from = std::floor(srgbOf(least) * 255.0F + 0.5F - kMargin);
            const float to = std::floor(srgbOf(most) * 255.0F + 0.5F + kMargin);
            values_[i] = from == to ? static_cast<std::int16_t>(from) : kSeveral;
        }
    }
    std::uint8_t encode(float unit) const {
        if (unit < kLeast) return srgb8Of(unit);  // no power there
        const std::int16_t value =
            values_[(std::bit_cast<std::uint32_t>(unit) >> kLowestBits) - kFirst];
        return value == kSeveral ? srgb8Of(unit) : static_cast<std::uint8_t>(value);
    }

  private:
    static constexpr std::int16_t kSeveral = -1;
    static constexpr int kLowestBits = 12;  // 2,048 ranges an octave: one of twenty has two values
    static constexpr float kLeast = 0x1p-9F;
    static constexpr std::uint32_t kFirst = std::bit_cast<std::uint32_t>(kLeast) >> kLowestBits;
    static constexpr std::uint32_t kLast = std::bit_cast<std::uint32_t>(1.0F) >> kLowestBits;

    std::array<std::int16_t, kLast - kFirst + 1> values_{};
};

}  // namespace

Image8 toSrgb8(const ImageF& linear) {
    Image8 result(linear.width(), linear.height(), linear.channels());
    const auto channels = static_cast<std::size_t>(linear.channels());
    const std::span<const float> from = linear.values();
    const std::span<std::uint8_t> to = result.values();
    static const SrgbRanges kRanges;
    for (std::size_t i = 0; i < from.size(); i += channels) {
        for (std::size_t c = 0; c < channels; ++c) {
            const float value = clampedToUnit(from[i + c]);
            to[i + c] = isAlpha(c, channels) ? quantized(value) : kRanges.encode(value);
        }
    }
    return result;
}

}  // namespace gfxrepro::image
