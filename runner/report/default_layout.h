// A table for whoever wrote none.
#pragma once

#include <vector>

#include "runner/config/experiment.h"
#include "runner/report/records.h"

namespace gfxrepro::report {

/// For an experiment of one's own without a `layout`: a row a point of its sweep, a column a metric
/// and pass in the order in which they were recorded. Not given where nothing was recorded.
config::Layout defaultLayout(const config::Experiment& experiment,
                             const std::vector<Record>& records);

}  // namespace gfxrepro::report
