// What a metric is where another one has a value: at equal time, at equal error.
#pragma once

#include <span>
#include <string>

#include "runner/tables/expression.h"
#include "runner/tables/summary.h"

namespace gfxrepro::tables {

/// A case on the curve: the other metric, and the cell's own.
struct CurvePoint {
    Sampled x, y;
};

/// The curve's value where x is `at`, in the order of the points: interpolated between the two
/// beside it, on logarithmic scales where all are positive, and so in each round. Not-a-number
/// where the curve does not come by in each round, or does so at several places, as which is meant
/// nobody can tell.
Summary readCurve(std::span<const CurvePoint> curve, double at);

/// Why it has none there; `metric` is that of x.
std::string whyNoValue(std::span<const CurvePoint> curve, const std::string& metric, double at);

}  // namespace gfxrepro::tables
