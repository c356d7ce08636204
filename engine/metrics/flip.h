// FLIP: the difference that a person sees when flipping between two images.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

#include "engine/image/image.h"

namespace gfxrepro::metrics {

/// Pixels a degree of visual angle: 0.7 m before a 0.7 m wide display of 3840 pixels, as the
/// published reference implementation has it.
constexpr double kFlipPixelsPerDegree = 67.0206;

/// FLIP takes some 90 bytes of memory a pixel: of files that may come from anyone, no larger ones
/// (8192²) are compared by it.
constexpr std::int64_t kMaxFlipPixels = 1 << 26;
/// Throws Error for a larger image.
void requireFlipSize(const image::ImageF& image);
/// Calls `body` for the pictures 0 … count − 1, several at once; those of more than 2048² pixels
/// one after another, as FLIP and what it compares take gigabytes of memory for one.
void forEachPicture(std::size_t count, const std::function<std::int64_t(std::size_t)>& pixelsOf,
                    const std::function<void(std::size_t)>& body);

/// LDR-FLIP (Andersson et al. 2020) a pixel, in [0, 1]. `reference` and `test` have 3 channels,
/// linear, Rec. 709; what a display cannot show is clamped to [0, 1]. (The method takes sRGB and
/// begins with decoding it: linear images enter there.) Throws Error when sizes differ, channels
/// are not 3, a value is not finite, or pixelsPerDegree is outside of [1, 1000].
image::ImageF flipMap(const image::ImageF& reference, const image::ImageF& test,
                      double pixelsPerDegree = kFlipPixelsPerDegree);
/// A reference as the eye sees it, made once for all pictures that are compared with it.
class FlipReference {
  public:
    /// Throws Error as flipMap().
    explicit FlipReference(image::ImageF reference, double pixelsPerDegree = kFlipPixelsPerDegree);
    ~FlipReference();
    FlipReference(const FlipReference&) = delete;
    FlipReference& operator=(const FlipReference&) = delete;

    /// flipMap() of the two.
    image::ImageF mapOf(const image::ImageF& test) const;

  private:
    struct Seen;
    image::ImageF reference_;
    double pixelsPerDegree_;
    std::unique_ptr<const Seen> seen_;
};

/// The mean of such a map: what is printed.
double meanOfFlip(const image::ImageF& map);
/// Of the map of two images.
double flip(const image::ImageF& reference, const image::ImageF& test,
            double pixelsPerDegree = kFlipPixelsPerDegree);

// FLIP of images with more range than a display has.

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
