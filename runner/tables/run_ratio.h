// One number of two runs, held against each other.
#pragma once

#include <optional>

#include "engine/metrics/statistics.h"
#include "runner/tables/cell.h"

namespace gfxrepro::tables {

struct RunRatio {
    double ratio = 1.0;
    std::optional<metrics::Interval> interval;  // at 95 %, where both numbers have one
};

/// What a cell of a later run shows ÷ what that of an earlier one does; none where one of them
/// shows nothing, or what is not positive. The interval is made of those of both, as of independent
/// numbers, in logarithms [Zou and Donner 2008, Construction of confidence limits about effect
/// measures, Sec. 3]. What a machine does between two runs is in neither.
std::optional<RunRatio> ratioOfRuns(const Cell& later, const Cell& earlier);

}  // namespace gfxrepro::tables
