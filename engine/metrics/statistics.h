// Summaries of repeated measurements.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace gfxrepro::metrics {

/// A closed interval.
struct Interval {
    double low = 0.0;
    double high = 0.0;
};

/// median | mean | min | max | sum | count | rate | stddev | p95 | p99. The rate is the harmonic
/// mean: of frame rates, the frames divided by their total time. The standard deviation is that of
/// a sample (n − 1). Percentiles are interpolated between the two nearest values (Hyndman and Fan
/// 1996, type 7).
enum class Statistic { Median, Mean, Min, Max, Sum, Count, Rate, StdDev, P95, P99 };
inline constexpr std::array<std::string_view, 10> kStatistics = {
    "median", "mean", "min", "max", "sum", "count", "rate", "stddev", "p95", "p99"};
/// Throws Error for other names, listing these.
Statistic statisticFromName(std::string_view name);

/// Of at least one value; Count of none is 0. Median of an even count is the mean of the middle
/// two. The rate of values of which one is zero is 0; the standard deviation of one value is NaN.
double summarize(std::span<const double> values, Statistic statistic);
double median(std::span<const double> values);

/// The fewest independent values of which a 95 % interval can be made by ranks: the range of five
/// misses the median in 2 · 2⁻⁵ = 6 %, that of six in 3 %.
inline constexpr std::size_t kFewestForInterval = 6;

/// A 95 % interval for the median of the distribution of independent values, whatever its shape:
/// the narrowest pair of order statistics, as far from either end, that holds it with 95 % or more
/// (sign test; Conover 1999, Practical Nonparametric Statistics, Sec. 3.2). None for fewer than
/// kFewestForInterval values. Infinite values are values.
std::optional<Interval> medianInterval(std::span<const double> values);
/// How far from either end of so many sorted values its ends stand: 1 of 6 to 8, 2 of 9 to 11.
/// At least kFewestForInterval.
std::size_t medianIntervalDepth(std::size_t count);

/// The middle of a symmetric distribution: the median of the means of all pairs of values, each
/// with itself too (Hodges and Lehmann 1963). Robust: one value in four may be anything.
double centre(std::span<const double> values);
/// Its 95 % interval by Wilcoxon's signed ranks, exact (Hollander, Wolfe and Chicken 2014,
/// Nonparametric Statistical Methods, Sec. 3.3); for differences of two equally noisy things, whose
/// distribution is symmetric. None for fewer than kFewestForInterval values, which must be finite.
std::optional<Interval> centreInterval(std::span<const double> values);

/// Series of values in rounds that they share, each by its round: of each the chance that one of
/// all, were they symmetric about 0, came out so far above it (`isTwoSided`: from it). The series
/// are looked at together: their largest mean, under changes of the sign of whole rounds, is exact
/// however they hang together (Westfall and Young 1993, "Resampling-based multiple testing": maxT,
/// step down). A mean is taken in units of how far its own values and, by the median, those of all
/// lie from 0: six values alone say little of their scatter. All changes of sign up to 10 rounds,
/// of more 1023 that are drawn.
std::vector<double> jointChances(std::span<const std::map<int, double>> series, bool isTwoSided);

/// The chance of each sum, from 0 on, of scores that fair coins choose: with ranks for scores that
/// of signed ranks. No number of scores overflows.
std::vector<double> coinSums(std::span<const std::size_t> scores);

/// Rank correlation of y with x, −1 … 1: concordant less discordant pairs over all pairs of unlike
/// x (Kendall 1938; a tie in y counts for neither, and what is areAlike is one). 0 without such a
/// pair.
double kendall(std::span<const double> x, std::span<const double> y);

}  // namespace gfxrepro::metrics
