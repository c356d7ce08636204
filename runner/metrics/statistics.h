// Summaries of repeated measurements.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace gfxrepro::metrics {

/// A closed interval.
struct Interval {
    double low = 0.0;
    double high = 0.0;
};

/// median | mean | min | max | sum | count.
enum class Statistic { Median, Mean, Min, Max, Sum, Count };
/// Throws Error for other names, listing these.
Statistic statisticFromName(std::string_view name);

/// Of at least one value; Count of none is 0. Median of an even count is the mean of the middle
/// two.
double summarize(std::span<const double> values, Statistic statistic);

/// `draws` bootstrap resamples of `values`, each summarized, unsorted; the same seed gives the same
/// draws. One value (or equal ones) gives equal draws. Efron 1979, percentile bootstrap.
std::vector<double> bootstrap(std::span<const double> values, Statistic statistic, int draws,
                              std::uint64_t seed);

/// The central interval that holds `confidence` of the values (linear interpolation between order
/// statistics).
Interval centralInterval(std::vector<double> values, double confidence = 0.95);

}  // namespace gfxrepro::metrics
