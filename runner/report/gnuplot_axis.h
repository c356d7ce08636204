// The range and the tics of an axis.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace gfxrepro::report {

struct AxisRange {
    double low = 0.0;
    double high = 1.0;
};

/// Holds all values with a little room on both sides. `includesZero`: a linear axis begins at 0
/// unless all values are far from it. On a logarithmic axis values are positive.
AxisRange rangeOf(const std::vector<double>& values, bool isLog, bool includesZero);

/// Where tics stand and what is written there, "" for small ones.
using Tics = std::vector<std::pair<double, std::string>>;
/// Of a logarithmic axis, on which gnuplot marks powers of ten only; some, however short it is.
Tics logarithmicTics(const AxisRange& range);
/// Between the tics of a linear axis that has about `count` of them: 1, 2 or 5 times a power of
/// ten.
double linearStep(const AxisRange& range, int count);
/// At the values themselves, if they are few and leave room for what is written; else none.
Tics ticsAt(const std::vector<double>& values, const AxisRange& range, bool isLog);

}  // namespace gfxrepro::report
