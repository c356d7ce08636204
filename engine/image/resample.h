// Images of other sizes: means, parts, magnifications; and of three channels.
#pragma once

#include <cstdint>

#include "engine/image/exr_io.h"
#include "engine/image/image.h"

namespace gfxrepro::image {

/// The means of blocks of factor² pixels; both sides are multiples of `factor`.
ImageF averaged(const ImageF& image, int factor);
/// As many pixels as averaged() gives, each the mean around its block's middle weighted by a
/// Gaussian of this standard deviation, in pixels of `image`, a sixth or more; beyond three of
/// them, and beyond the border, nothing weighs.
ImageF gaussianAveraged(const ImageF& image, int factor, double sigma);

/// The part of an image, each pixel `scale` times as wide and high. Throws Error when the part is
/// empty or reaches beyond the image, the scale is below 1, or a side gets beyond 32768 pixels.
Image8 cropped(const Image8& image, const Rectangle& part, int scale = 1);
Image16 cropped(const Image16& image, const Rectangle& part, int scale = 1);
ImageF cropped(const ImageF& image, const Rectangle& part, int scale = 1);
/// All channels and attributes. The part is counted from the first stored pixel and becomes a
/// picture of its own: its display window is itself, and worldToNDC is that of the part.
ExrImage cropped(const ExrImage& image, const Rectangle& part, int scale = 1);

/// Three channels: a grey image's thrice, without alpha.
template <class T>
Image<T> rgbOf(const Image<T>& image) {
    Image<T> rgb(image.width(), image.height(), 3);
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) {
            for (int c = 0; c < 3; ++c) {
                rgb.at(x, y, c) = image.at(x, y, image.channels() < 3 ? 0 : c);
            }
        }
    }
    return rgb;
}

/// How high an image of that width is; at least 1.
std::int64_t heightAt(const Image8& image, int width);
/// As wide as that, and as high as its shape asks for: each pixel the mean of the light that falls
/// on it. Of sRGB values beside alpha. Throws Error beyond 32768 pixels a side.
Image8 resizedTo(const Image8& image, int width);

}  // namespace gfxrepro::image
