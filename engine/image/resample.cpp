#include "engine/image/resample.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/error.h"
#include "engine/image/image.h"
#include "engine/image/srgb.h"

namespace gfxrepro::image {
namespace {

void check(int width, int height, const Rectangle& part, int scale) {
    const std::string found =
        fmt::format("{}x{} pixels from ({}, {})", part.width, part.height, part.left, part.top);
    if (part.left < 0 || part.top < 0 || part.width < 1 || part.height < 1 ||
        part.left > width - part.width || part.top > height - part.height) {
        throw Error(fmt::format("{} are no part of an image of {}x{}", found, width, height));
    }
    if (scale < 1 || scale > kMaxSidePx / std::max(part.width, part.height)) {
        throw Error(fmt::format("{} cannot be magnified {} times; 1 to {} times are allowed", found,
                                scale, kMaxSidePx / std::max(part.width, part.height)));
    }
}

template <class T>
Image<T> partOf(const Image<T>& image, const Rectangle& part, int scale) {
    check(image.width(), image.height(), part, scale);
    Image<T> result(part.width * scale, part.height * scale, image.channels());
    for (int y = 0; y < result.height(); ++y) {
        for (int x = 0; x < result.width(); ++x) {
            for (int c = 0; c < image.channels(); ++c) {
                result.at(x, y, c) = image.at(part.left + x / scale, part.top + y / scale, c);
            }
        }
    }
    return result;
}

/// How much each source pixel from `first` on gives to one pixel.
struct Shares {
    int first = 0;
    std::vector<float> weights;
};

/// The source pixels under pixel `i` of `to`, of `from` in all.
Shares sharesOf(int i, int from, int to) {
    const double begin = static_cast<double>(i) * from / to;
    const double end = static_cast<double>(i + 1) * from / to;
    Shares shares{static_cast<int>(begin), {}};
    for (int source = shares.first; source < from && source < end; ++source) {
        const double covered = std::min(end, source + 1.0) - std::max(begin, double(source));
        shares.weights.push_back(static_cast<float>(covered / (end - begin)));
    }
    return shares;
}

/// The source pixels, of `size` in all, within three `sigma` of `middle`.
Shares gaussianShares(double middle, double sigma, int size) {
    const int first = std::max(static_cast<int>(std::ceil(middle - 3.0 * sigma - 0.5)), 0);
    const int last = std::min(static_cast<int>(std::floor(middle + 3.0 * sigma - 0.5)), size - 1);
    Shares shares{first, {}};
    double sum = 0.0;
    for (int i = first; i <= last; ++i) {
        const double away = (i + 0.5 - middle) / sigma;
        shares.weights.push_back(static_cast<float>(std::exp(-0.5 * away * away)));
        sum += static_cast<double>(shares.weights.back());
    }
    for (float& weight : shares.weights) weight /= static_cast<float>(sum);
    return shares;
}

/// Each row made of the shares of columns, as an image on its side: twice is upright again.
ImageF weightedAcross(const ImageF& image, const std::vector<Shares>& columns) {
    ImageF result(image.height(), static_cast<int>(columns.size()), image.channels());
    const auto channels = static_cast<std::size_t>(image.channels());
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < result.height(); ++x) {
            const Shares& shares = columns[static_cast<std::size_t>(x)];
            const float* source = &image.at(shares.first, y);
            float* sum = &result.at(y, x);
            for (const float weight : shares.weights) {
                for (std::size_t c = 0; c < channels; ++c) sum[c] += weight * source[c];
                source += channels;
            }
        }
    }
    return result;
}

}  // namespace

ImageF averaged(const ImageF& image, int factor) {
    GFXREPRO_ASSERT(image.width() % factor == 0 && image.height() % factor == 0);
    ImageF result(image.width() / factor, image.height() / factor, image.channels());
    const float weight = 1.0F / static_cast<float>(factor * factor);
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) {
            for (int c = 0; c < image.channels(); ++c) {
                result.at(x / factor, y / factor, c) += weight * image.at(x, y, c);
            }
        }
    }
    return result;
}

ImageF gaussianAveraged(const ImageF& image, int factor, double sigma) {
    GFXREPRO_ASSERT(image.width() % factor == 0 && image.height() % factor == 0);
    // A block's own pixels are within reach.
    GFXREPRO_ASSERT(3.0 * sigma >= 0.5);
    const auto sharesAlong = [&](int size) {
        std::vector<Shares> shares;
        for (int i = 0; i < size / factor; ++i) {
            shares.push_back(gaussianShares((i + 0.5) * factor, sigma, size));
        }
        return shares;
    };
    return weightedAcross(weightedAcross(image, sharesAlong(image.width())),
                          sharesAlong(image.height()));
}

Image8 cropped(const Image8& image, const Rectangle& part, int scale) {
    return partOf(image, part, scale);
}

Image16 cropped(const Image16& image, const Rectangle& part, int scale) {
    return partOf(image, part, scale);
}

ImageF cropped(const ImageF& image, const Rectangle& part, int scale) {
    return partOf(image, part, scale);
}

ExrImage cropped(const ExrImage& image, const Rectangle& part, int scale) {
    ExrImage result = image;
    result.left = 0;
    result.top = 0;
    result.displayWindow.reset();
    for (ExrImage::Channel& channel : result.channels) {
        channel.values = partOf(channel.values, part, scale);
    }
    const auto ndc = result.matrices.find("worldToNDC");
    if (ndc == result.matrices.end()) return result;
    // x' = (x·width − left·w) / part.width for each of the four rows (x, y, z, w), y likewise;
    // width and left are the display window's.
    const Rectangle whole = image.shownWindow();
    const auto left = static_cast<float>(image.left + part.left - whole.left);
    const auto top = static_cast<float>(image.top + part.top - whole.top);
    for (std::size_t row = 0; row < 4; ++row) {
        float* values = &ndc->second[4 * row];
        const float w = values[3];
        values[0] = (values[0] * static_cast<float>(whole.width) - left * w) /
                    static_cast<float>(part.width);
        values[1] = (values[1] * static_cast<float>(whole.height) - top * w) /
                    static_cast<float>(part.height);
    }
    return result;
}

std::int64_t heightAt(const Image8& image, int width) {
    const double height = static_cast<double>(image.height()) * width / image.width();
    return std::max<std::int64_t>(1, std::llround(height));
}

Image8 resizedTo(const Image8& image, int width) {
    GFXREPRO_ASSERT(!image.empty() && width >= 1);
    if (width > kMaxSidePx || heightAt(image, width) > kMaxSidePx) {
        throw Error(fmt::format("an image of {}x{} would have {}x{} pixels; {} a side are allowed",
                                image.width(), image.height(), width, heightAt(image, width),
                                kMaxSidePx));
    }
    const auto height = static_cast<int>(heightAt(image, width));
    const std::array<float, 256> linear = srgbDecoding();
    const auto channels = static_cast<std::size_t>(image.channels());
    const auto lightOf = [&](std::uint8_t value, int channel) {
        return isAlpha(static_cast<std::size_t>(channel), channels)
                   ? static_cast<float>(value) / 255.0F
                   : linear[value];
    };
    ImageF result(width, height, image.channels());
    std::vector<Shares> columns;
    for (int x = 0; x < width; ++x) columns.push_back(sharesOf(x, image.width(), width));
    for (int y = 0; y < height; ++y) {
        const Shares rows = sharesOf(y, image.height(), height);
        for (int x = 0; x < width; ++x) {
            const Shares& across = columns[static_cast<std::size_t>(x)];
            for (std::size_t j = 0; j < rows.weights.size(); ++j) {
                for (std::size_t i = 0; i < across.weights.size(); ++i) {
                    for (int c = 0; c < image.channels(); ++c) {
                        result.at(x, y, c) += rows.weights[j] * across.weights[i] *
                                              lightOf(image.at(across.first + static_cast<int>(i),
                                                               rows.first + static_cast<int>(j), c),
                                                      c);
                    }
                }
            }
        }
    }
    return toSrgb8(result);
}

}  // namespace gfxrepro::image
