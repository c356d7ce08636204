// FLIP of images with more range than a display has.
#pragma once

#include "engine/image/image.h"
#include "engine/metrics/flip.h"

namespace gfxrepro::metrics {

/// The three channels that FLIP looks at: a grey image's thrice, without alpha.
image::ImageF coloursOf(const image::ImageF& image);
/// Whether a value is beyond 1, which HDR-FLIP is for.
bool exceedsDisplay(const image::ImageF& image);

/// The exposures, in stops, at which two images are compared: `count` of them at equal steps.
struct Exposures {
    double start = 0.0;
    double stop = 0.0;
    int count = 1;
};

/// From where the reference's brightest pixel is shown as 0.85 to where its median is, a stop apart
/// (at least two; one for a reference of one luminance, or a black one). Of a reference that is
/// half black or more, the median of what is not: the published implementation has no value there.
Exposures flipExposures(const image::ImageF& reference);

/// HDR-FLIP (Andersson et al. 2021) a pixel, in [0, 1]: the largest LDR-FLIP over the exposures,
/// each tone-mapped by the ACES curve. `reference` and `test` have 3 channels, linear, Rec. 709;
/// negative values count as 0. Throws Error as flipMap() does.
image::ImageF hdrFlipMap(const image::ImageF& reference, const image::ImageF& test,
                         double pixelsPerDegree = kFlipPixelsPerDegree);
/// Mean of the map.
double hdrFlip(const image::ImageF& reference, const image::ImageF& test,
               double pixelsPerDegree = kFlipPixelsPerDegree);

}  // namespace gfxrepro::metrics
