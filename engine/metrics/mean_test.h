// Are two noisy pictures the same in expectation? A test on several independent samples of each.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "engine/image/image.h"

namespace gfxrepro::metrics {

/// Sides of the smallest tiles.
inline constexpr int kMeanTilePx = 8;

/// The mean of each channel over each tile of the picture: squares of kMeanTilePx pixels and, as a
/// bias may be narrow or wide, of twice that, and so on up to the whole picture. Those of the
/// smallest tiles come first.
std::vector<double> tileMeans(const image::ImageF& picture);

/// Where pictures differ from others of their expectation, and which way: the mean of the colours
/// over each of the smallest tiles of `a` less that of `b`, in standard errors of the difference,
/// at all pixels of the tile. Both as tileMeans() of pictures of that size; two or more on either
/// side. Where nothing scatters a difference is as large as a float can be.
image::ImageF tileDifferences(std::span<const std::vector<double>> a,
                              std::span<const std::vector<double>> b, int width, int height,
                              int channels);
/// Ends the name of a picture of these differences, and the end of its scale.
inline constexpr std::string_view kDifferencesSuffix = "_mean_difference";
inline constexpr float kShownErrors = 5.0F;

/// What testMeans() found.
struct MeanTest {
    /// The chance that two such sets differ as much or more while their expectations are the same:
    /// in a share `a` of such comparisons it is `a` or less.
    double p = 1.0;
    /// Differences of a tile's mean of this size are found more often than not at 1 % of false
    /// alarms: 1.5 × the statistic that it takes × the standard error of the median tile, ÷ the
    /// mean of all values. +∞ where none could be found so, or the mean is 0.
    double seen = 0.0;
    /// The noise of a ÷ that of b: standard deviations, added up over all tiles.
    double noiseRatio = 1.0;
    /// The two have unlike noise: it differs by more than kMostNoiseRatio, and not by chance. Then
    /// p may be small too often, and says nothing.
    bool isUnlike = false;
};

/// The metrics that `p` and `seen` are recorded as.
inline constexpr std::string_view kSameMeanP = "same_mean_p", kBiasSeen = "bias_seen";

inline constexpr double kMostNoiseRatio = 2.0;

/// Compares the pictures of `a` with those of `b`, each by its tileMeans(): independent samples
/// (each of another seed), two or more on either side. Of the side that has more, so many at a time
/// are averaged that both have equally many: pictures of a quarter of the samples are held against
/// others of as much noise by taking four times as many.
///
/// By Welch's t of each tile [Subr and Arvo 2007, Statistical hypothesis testing for assessing
/// Monte Carlo estimators, Sec. 3; Jung, Hanika and Dachsbacher 2020, Detecting bias in Monte Carlo
/// renderers using Welch's t-test, Sec. 3], of which the largest counts. What it is worth is told
/// in two ways, of which the larger p is taken, so that it is right where either is:
/// - by Student's distribution over all tiles (Bonferroni): right for tiles of many samples,
/// whatever
///   the two sides' noise; not where it has heavy tails, as a path tracer's fireflies;
/// - by the pictures dealt out to the two sides in every other way [Westfall and Young 1993,
///   Resampling-based multiple testing, Sec. 2.3; Janssen 1997, Studentized permutation tests for
///   non-i.i.d. hypotheses]: exact whatever the noise, where it is the same on both sides.
/// tests/unit/metrics/mean_test_test.cpp simulates both. Beyond kMostDeals ways so many are drawn,
/// always the same ones.
MeanTest testMeans(std::span<const std::vector<double>> a, std::span<const std::vector<double>> b);

inline constexpr std::size_t kMostDeals = 20'000;

/// The least p that so many samples can come to: fewer than that share of false alarms cannot be
/// asked for.
double leastP(std::size_t aCount, std::size_t bCount);

/// The chance of a Student's t of that size or more, either way, with whole degrees of freedom
/// [Abramowitz and Stegun 1964, Eqs. 26.7.3 and 26.7.4].
double studentP(double t, int freedom);

}  // namespace gfxrepro::metrics
