// A table and its plots for whoever laid out none.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "runner/config/experiment.h"
#include "runner/records/records.h"
#include "runner/tables/against_first.h"
#include "runner/tables/table.h"

namespace gfxrepro::tables {

struct DefaultLayout {
    config::Layout layout;               // not given where nothing was recorded
    std::vector<std::string> constants;  // "triangles 69451": alike in all cases, so no column
    /// Of one frame alone, where the technique declares a number of frames, which no case recorded.
    std::vector<std::string> notes;
    Rivals rivals;
    std::vector<std::string> against;  // the columns that compare them
};

/// For an experiment of one's own without a `layout`: a row a point of its sweep; columns are the
/// times that a program says of itself, those of a frame and its passes, then the metrics in the
/// order in which the technique declares them (Experiment::outputs), without details. Of plans that
/// do not know what was declared: all, as recorded. A MiB and more is shown in MiB. A metric is
/// called METRIC_PASS; where one picture alone has errors, they are called by the metric.
DefaultLayout defaultLayout(const config::Experiment& experiment,
                            std::span<const config::Case> planned,
                            const std::vector<records::Record>& records);

/// What the technique declares of each metric, beside the table's columns.
void describeColumns(const config::Experiment& experiment, const config::Layout& layout,
                     Table& table);

}  // namespace gfxrepro::tables
