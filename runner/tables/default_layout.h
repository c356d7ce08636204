// A table and its curves for whoever laid out none.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "runner/config/experiment.h"
#include "runner/tables/case_records.h"
#include "runner/tables/table.h"

namespace gfxrepro::tables {

struct DefaultLayout {
    config::Layout layout;               // not given where nothing was recorded
    std::vector<std::string> constants;  // "triangles 69451": alike in all cases, so no column
    /// Of one frame alone, where the technique declares a number of frames, which no case recorded.
    std::vector<std::string> notes;
};

/// For an experiment of one's own without a `layout`: a row a point of its sweep; columns are the
/// times of a frame and its passes, then the metrics in the order in which the technique declares
/// them (Experiment::outputs), without details. Of plans that do not know what was declared: all,
/// as recorded. A MiB and more is shown in MiB.
DefaultLayout defaultLayout(const config::Experiment& experiment,
                            std::span<const config::Case> planned,
                            const std::vector<records::Record>& records);

/// What the technique declares of each metric, beside the table's columns.
void describeColumns(const config::Experiment& experiment, const config::Layout& layout,
                     Table& table);

/// The plots of such a table: its times, and the first of its metrics that is better one way, over
/// the axis of numbers that has most of them. None without such an axis.
std::vector<config::PlotSpec> defaultPlots(const Table& table);

}  // namespace gfxrepro::tables
