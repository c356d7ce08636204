// FLIP: the difference that a person sees when flipping between two images.
#pragma once

#include "runner/image/image.h"

namespace gfxrepro::metrics {

/// Pixels a degree of visual angle: 0.7 m before a 0.7 m wide display of 3840 pixels, as the
/// published reference implementation has it.
constexpr double kFlipPixelsPerDegree = 67.0206;

/// LDR-FLIP (Andersson et al. 2020) a pixel, in [0, 1]. `reference` and `test` have 3 channels in
/// [0, 1], linear; they are encoded to sRGB as the method wants. Throws Error when sizes or
/// channels differ or a value is not finite.
image::ImageF flipMap(const image::ImageF& reference, const image::ImageF& test,
                      double pixelsPerDegree = kFlipPixelsPerDegree);
/// Mean of the map.
double flip(const image::ImageF& reference, const image::ImageF& test,
            double pixelsPerDegree = kFlipPixelsPerDegree);

}  // namespace gfxrepro::metrics
