// Differences of images.
#pragma once

#include <vector>

#include "engine/image/image.h"

namespace gfxrepro::metrics {

/// Throws Error when the images differ in size or channels, are empty, or hold a value that is not
/// finite.
void requireComparable(const image::ImageF& a, const image::ImageF& b);

/// Over all values of two images of equal size and channels; throws Error when they differ in
/// either, or when one holds a value that is not finite.
double meanSquaredError(const image::ImageF& a, const image::ImageF& b);
/// 10·log10(1 / MSE), for values in [0, 1]; infinity for equal images.
double peakSignalToNoiseDb(const image::ImageF& a, const image::ImageF& b);
/// The mean over all values of (truth − test)² ÷ (truth² + 0.01): an error in the dark counts as
/// much as one in the light, and the 0.01 keeps black from dividing by zero. Throws as
/// meanSquaredError().
double relativeMeanSquaredError(const image::ImageF& truth, const image::ImageF& test);
/// Of each pixel the largest absolute difference of a value; throws as meanSquaredError().
std::vector<double> largestDifferences(const image::ImageF& a, const image::ImageF& b);
/// Largest absolute difference.
double maxAbsoluteError(const image::ImageF& a, const image::ImageF& b);
/// Mean structural similarity of luminance (Wang et al. 2004: 11×11 Gaussian window, σ 1.5, K 0.01
/// and 0.03), for values in [0, 1].
double structuralSimilarity(const image::ImageF& a, const image::ImageF& b);
/// |a − b| a value, times `gain`.
image::ImageF absoluteDifference(const image::ImageF& a, const image::ImageF& b, float gain = 1.0F);

}  // namespace gfxrepro::metrics
