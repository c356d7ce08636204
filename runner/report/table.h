// Tables of measurements: records gathered into the rows and columns that the experiment lays out.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runner/config/experiment.h"
#include "runner/metrics/statistics.h"
#include "runner/report/records.h"

namespace gfxrepro::report {

/// Bootstrap resamples behind every interval.
inline constexpr int kDrawCount = 1000;

/// One statistic of a cell, in the unit that is shown (scaled).
struct Measured {
    std::string statistic;  // "median", "max", … as in the format
    double value = 0.0;
    metrics::Interval interval;  // 95 %
    std::vector<double> draws;   // kDrawCount resampled values; empty when there is one sample
};

/// What stands at a row and a column.
struct Cell {
    Status status = Status::Missing;
    std::string message;           // why it is not ok, or in what it is not whole
    bool isPartial = false;        // some of the cases that it gathers failed; it is of the others
    int sampleCount = 0;           // repeats, over processes and frames
    std::vector<Measured> values;  // in the order of the format; empty without a measurement
    std::string measured;          // formatted; the status word without a measurement
    std::optional<std::string> printed;

    bool isOk() const { return status == Status::Ok && !values.empty(); }
    /// The statistic of that name, the first if the name is empty; null when it is not there.
    const Measured* find(const std::string& statistic) const;
};

/// Where a row's scene comes from.
enum class SceneSource { Unknown, Real, StandIn, Generated };
/// "real", "stand-in", "generated"; empty for Unknown.
std::string_view sceneSourceName(SceneSource source);

struct TableRow {
    /// The value of each row axis, beside Table::rowAxes.
    std::vector<config::Node> keys;
    std::vector<std::string> labels;
    SceneSource source = SceneSource::Unknown;
    std::vector<Cell> cells;  // beside Table::columns
};

struct TableColumn {
    std::string label;  // "rasterization_ms"; several column axes are joined by " · "
    std::string unit;   // of the records, if they agree
};

struct Table {
    std::string id;  // "zju2005/2.1"
    std::string slug;
    std::string label;  // "Table 2.1"
    std::string title;
    std::string hardware;  // that the paper's numbers come from
    std::string remark;
    std::vector<std::string> rowAxes;
    std::vector<TableColumn> columns;
    std::vector<TableRow> rows;
    std::vector<std::string> notes;  // printed rows that found no place, and the like

    bool hasSources() const;
};

/// Gathers the records of one experiment (others are passed over).
///
/// Rows are the combinations of the row axes that the sweep contains, in its order; those without
/// any record stay, as `missing`. A cell takes the records that the selections of its row, column
/// and `cell` choose; repeats (over processes) are reduced to their median for each frame, then the
/// format's statistics are taken over frames. With a single frame they are taken over the repeats.
/// Intervals are from a bootstrap over processes, then repeats.
///
/// A cell whose metric is a time or a frame rate never shows a record of the quality lane. Throws
/// Error with the layout's place for an unknown statistic or axis.
Table buildTable(const config::Experiment& experiment, const std::vector<Record>& records);

}  // namespace gfxrepro::report
