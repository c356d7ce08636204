// Exact tests that ask nothing of the noise but that it is the same on both sides.
#pragma once

#include <span>

#include "engine/metrics/statistics.h"
#include "runner/regression/series.h"

namespace gfxrepro::regression {

/// A shift between two sides [Hodges and Lehmann 1963], its exact two-sided chance under no shift
/// [Wilcoxon 1945], and where it lies at 95 %.
struct RankTest {
    double shift = 0.0;
    double chance = 1.0;
    /// The smallest chance that so many values can give.
    double attainable = 1.0;
    /// Unbounded where there are too few values for 95 %: below 6 pairs, or 4 and 4 values.
    metrics::Interval interval;
};

/// The differences of pairs against none: signed ranks. At least one.
RankTest signedRank(std::span<const double> differences);

/// `after` against `before`, which are no pairs: rank sums. At least one value each.
RankTest rankSum(std::span<const double> before, std::span<const double> after);

/// The exact two-sided chance that as many values as `first`, drawn from both, have a rank sum as
/// far from its mean as `first`'s.
double rankSumChance(std::span<const double> first, std::span<const double> rest);

/// 1 … n, the mean of their places where values are equal.
Series ranksOf(std::span<const double> values);

}  // namespace gfxrepro::regression
