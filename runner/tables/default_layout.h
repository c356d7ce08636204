// A table and its plots for whoever laid out none.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "runner/config/experiment.h"
#include "runner/records/records.h"
#include "runner/tables/table.h"

namespace gfxrepro::tables {

/// An axis whose values are methods, patterns, variants: words, of which there are two or more, or
/// else off and on. The first is what the others are held against. Scenes are none.
struct Rivals {
    std::string axis;
    std::vector<std::string> values;
    bool isThere() const { return !axis.empty(); }
};

struct DefaultLayout {
    config::Layout layout;               // not given where nothing was recorded
    std::vector<std::string> constants;  // "triangles 69451": alike in all cases, so no column
    /// Of one frame alone, where the technique declares a number of frames, which no case recorded.
    std::vector<std::string> notes;
    Rivals rivals;
    std::vector<std::string> against;  // the columns that compare them
};

/// For an experiment of one's own without a `layout`: a row a point of its sweep; columns are the
/// times that a program says of itself, that of a frame, memory, errors of pictures, then the
/// metrics in the order in which the technique declares them (Experiment::outputs), without
/// details, and last the passes of a frame. Of plans that
/// do not know what was declared: all, as recorded. A MiB and more is shown in MiB. A metric is
/// called METRIC_PASS; where one picture alone has errors, they are called by the metric.
DefaultLayout defaultLayout(const config::Experiment& experiment,
                            std::span<const config::Case> planned,
                            const std::vector<records::Record>& records);

/// What the technique declares of each metric, beside the table's columns.
void describeColumns(const config::Experiment& experiment, const config::Layout& layout,
                     Table& table);

/// Puts before the notes which rivals are faster or slower, nearer to their truth or farther from
/// it, than the first, in how many rows and by how much: by the intervals of those columns, all
/// rows together (metrics::jointChances), a time only beyond the noise of what is divided, and by
/// the CPU time of the process where that was recorded (Table::judgedByProcess); of what is known
/// as it is. Behind what is told (Table::toldNotes) stands what cannot be. Marks the cells that are
/// not apart. Nothing where a column has neither.
void compareRivals(const Rivals& rivals, const std::vector<std::string>& columns, Table& table);

}  // namespace gfxrepro::tables
