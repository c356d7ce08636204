// From repeated measurements to one value with its uncertainty.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "runner/metrics/statistics.h"

namespace gfxrepro::report {

/// The measurements of one cell: for each process, for each unit (a frame of a case), its repeats.
/// A process need not have every unit.
struct Samples {
    std::vector<std::map<int, std::vector<double>>> processes;

    /// Whether there is more than one measurement of anything, so that an uncertainty can be told.
    bool isRepeated() const;
};

/// Bootstrap resamples behind every interval.
inline constexpr int kDrawCount = 1000;

/// The statistic over units, each reduced to the median of its repeats over all processes; with a
/// single unit, over the repeats themselves.
double summarize(const Samples& samples, metrics::Statistic statistic);

/// kDrawCount values of `summarize` on resampled measurements: processes with replacement, then in
/// each the repeats of each unit with replacement. Units are not resampled: a camera path is given,
/// not drawn. Empty when nothing is repeated.
std::vector<std::vector<double>> drawSummaries(const Samples& samples,
                                               const std::vector<metrics::Statistic>& statistics,
                                               std::uint64_t seed);

}  // namespace gfxrepro::report
