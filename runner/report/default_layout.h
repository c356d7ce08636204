// A table for whoever wrote none.
#pragma once

#include <span>
#include <vector>

#include "runner/config/experiment.h"
#include "runner/report/case_records.h"

namespace gfxrepro::report {

/// For an experiment of one's own without a `layout`: a row a point of its sweep, a column a metric
/// and pass in the order in which they were recorded. Not given where nothing was recorded.
config::Layout defaultLayout(const config::Experiment& experiment,
                             std::span<const PlannedCase> planned,
                             const std::vector<Record>& records);

}  // namespace gfxrepro::report
