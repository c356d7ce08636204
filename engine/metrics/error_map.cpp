#include "engine/metrics/error_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/image/colour_map.h"
#include "engine/image/srgb.h"
#include "engine/metrics/image_error.h"

namespace gfxrepro::metrics {
namespace {

using image::Image8;
using image::ImageF;

void check(const ImageF& reference, const ImageF& test, float gain) {
    requireComparable(reference, test);
    if (!(gain > 0.0F) || !std::isfinite(gain)) {
        throw Error(fmt::format("a gain is positive and finite, found {:g}", gain));
    }
}

int colourCount(const ImageF& image) {
    return image.channels() < 3 ? 1 : 3;
}

/// What is compared of a linear value.
float comparedOf(float linear, ErrorOf values) {
    return values == ErrorOf::Linear ? linear : image::srgbOf(std::clamp(linear, 0.0F, 1.0F));
}

}  // namespace

Image8 signedErrorPicture(const ImageF& reference, const ImageF& test, float gain, ErrorOf values) {
    check(reference, test, gain);
    const int channels = colourCount(reference);
    ImageF difference(reference.width(), reference.height(), 1);
    for (int y = 0; y < reference.height(); ++y) {
        for (int x = 0; x < reference.width(); ++x) {
            float sum = 0.0F;
            for (int c = 0; c < channels; ++c) {
                sum += comparedOf(reference.at(x, y, c), values) -
                       comparedOf(test.at(x, y, c), values);
            }
            difference.at(x, y) = gain * sum / static_cast<float>(channels);
        }
    }
    return image::coloured(difference, image::ColourMap::CoolWarm, -1.0F, 1.0F);
}

Image8 absoluteErrorPicture(const ImageF& reference, const ImageF& test, float gain,
                            ErrorOf values) {
    check(reference, test, gain);
    Image8 picture(reference.width(), reference.height(), colourCount(reference));
    for (int y = 0; y < picture.height(); ++y) {
        for (int x = 0; x < picture.width(); ++x) {
            for (int c = 0; c < picture.channels(); ++c) {
                const float difference = comparedOf(reference.at(x, y, c), values) -
                                         comparedOf(test.at(x, y, c), values);
                const float shown = std::min(gain * std::abs(difference), 1.0F);
                picture.at(x, y, c) = static_cast<std::uint8_t>(255.0F * shown + 0.5F);
            }
        }
    }
    return picture;
}

Image8 flipPicture(const ImageF& map) {
    return image::coloured(map, image::ColourMap::Magma, 0.0F, 1.0F);
}

}  // namespace gfxrepro::metrics
