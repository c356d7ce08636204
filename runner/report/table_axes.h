// The rows and columns of a table: which combinations of axis values it has, in which order.
#pragma once

#include <string>
#include <vector>

#include "runner/config/experiment.h"
#include "runner/report/case_records.h"

namespace gfxrepro::report {

/// A row or a column: the label on each of its layout axes.
using Key = std::vector<std::string>;

/// What is known of a layout's cases. `axes` names the sweep axes of its rows and columns and of
/// all `where` selections; planned and run cases carry their values beside it.
struct LayoutCases {
    std::vector<std::string> axes;
    std::vector<PlannedCase> planned;
    std::vector<CaseRecords> run;
    int frameCount = 1;

    /// The place of an axis in `axes`.
    std::size_t indexOf(const std::string& axis) const;
};
LayoutCases gatherCases(const config::Experiment& experiment, const std::vector<Record>& records);

/// The combinations of `layoutAxes`: on sweep axes those that occur in the plan or, where that does
/// not know them, in the records; on labelled axes all. Sorted by axis, then by the order in which
/// values first occur.
std::vector<Key> collectKeys(const std::vector<config::LayoutAxis>& layoutAxes,
                             const LayoutCases& cases);

}  // namespace gfxrepro::report
