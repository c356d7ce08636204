// From repeated measurements to one value with its uncertainty.
#pragma once

#include <map>
#include <string_view>
#include <vector>

#include "engine/metrics/statistics.h"

namespace gfxrepro::tables {

/// The measurements of one cell: of each process (by its number), of each unit (a frame of a case),
/// its repeats. A process need not have every unit.
struct Samples {
    std::map<int, std::map<int, std::vector<double>>> processes;
};

/// What the bounds beside a value are. An interval holds, with 95 %, the value that ever more
/// processes would come to. A range is what the few measurements happened to be, min … max, and
/// promises nothing.
enum class Bounds { None, Range, Interval };
/// "", "range", "95 % interval".
std::string_view boundsName(Bounds bounds);

/// One statistic of a cell.
struct Summary {
    double value = 0.0;
    Bounds bounds = Bounds::None;
    metrics::Interval interval;    // by `bounds`; of none the value itself
    std::map<int, double> rounds;  // the statistic in each process that has all units
    bool areDraws = false;         // instead, what a share could be in truth (share_draws.h)
};

/// In each process the statistic over units, each reduced to the median of its repeats; with a
/// single unit, over the repeats themselves. Of several processes their median.
///
/// The unit of uncertainty is the process: repeats within one share its memory layout, its hour
/// and its neighbours, and tell nothing of those (Kalibera and Jones 2013, "Rigorous benchmarking
/// in reasonable time"). With metrics::kFewestForInterval processes or more the bounds are
/// metrics::medianInterval() of them; with fewer their range; with one process the range of what
/// each repeat alone would give. Frames are given, not drawn: a camera path is what it is.
Summary summarize(const Samples& samples, metrics::Statistic statistic);

/// `of(a, b)`: in each process that has both, with bounds of what these come to. Without such a
/// process, or with one alone, no bounds: repeats of the two do not go together.
Summary together(const Summary& a, const Summary& b, double (*of)(double, double));

}  // namespace gfxrepro::tables
