// Tables of measurements: records gathered into the rows and columns that the experiment lays out.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runner/config/experiment.h"
#include "runner/records/records.h"
#include "runner/tables/case_records.h"
#include "runner/tables/sampling.h"

namespace gfxrepro::tables {

/// One statistic of a cell, in the unit that is shown (scaled).
struct Measured : Summary {
    std::string statistic;  // "median", "max", … as in the format
    std::string text;       // as the format writes the value
    std::string low, high;  // and the ends of its bounds; empty without any
};

/// What a metric does as all times double: 1 doubles, -1 halves (a rate), 0 stays.
int timePower(std::string_view metric);
/// Beside each calibrated cell, and what it says below the table.
inline constexpr const char* kCalibratedMark = "‡";
inline constexpr const char* kCalibratedLegend =
    "calibrated: an input of ours, at the value that its config gives, was fitted so that this "
    "comes out, which tells nothing of the method";

/// Whether a metric is a time or a number per time: what claims of a `kind` are about.
bool isTimeMetric(std::string_view metric);

/// A parameter at which a cell was measured otherwise than printed, with its values in the cases
/// behind it. `cases`, with their numbers, where each parameter has its printed values but not all
/// go together as printed.
struct Departure {
    std::string parameter;
    std::vector<std::string> measured;
    std::vector<std::string> printed;
    /// The document leaves the parameter open: `printed` is what the profile `paper` takes for it.
    bool isOpen = false;

    bool operator==(const Departure&) const = default;
};

/// By which clock a time is told: the one on the wall, or what all threads of the process spent.
enum class Clock { Wall, Process };

/// A GPU's lowest and highest clock, in Hz.
struct ClockRange {
    double lowHz = 0.0, highHz = 0.0;

    bool operator==(const ClockRange&) const = default;
};

/// What stands at a row and a column.
struct Cell {
    bool isPlanned = true;      // the sweep has such cases; if not, the cell is blank, not missing
    bool isUnrecorded = false;  // its cases ran, and none recorded it; blank where others did
    bool isPartial = false;  // some of the cases that it gathers failed; its values are the others'
    records::Status status = records::Status::Missing;  // the worst of its records
    std::string message;                                // why it is not ok
    std::vector<Measured> values;  // in the order of the format; empty without a measurement
    std::string measured;          // formatted; the status word without a measurement
    std::string low, high;         // the ends of the bounds, formatted likewise; or empty
    std::optional<std::string> printed;
    std::vector<std::optional<double>> printedValues;  // beside the format's statistics
    std::vector<std::string> caseIds;                  // whose records it takes
    std::string metric;   // what it shows; empty of a share, and, as its unit, where it is scaled
    bool isTime = false;  // a time, a rate of time, or a share of one
    int timePower = 0;    // of its metric; a share of times stays as they double
    std::string unit;     // of the records, if they agree; "%" of a share
    /// It was measured at what the paper measured at (printed_parameters.h). Never without a
    /// measurement, nor in a run whose plan does not know the printed parameters.
    bool isAtPrintedParameters = false;
    /// Of what it was measured at, beside departures: what the document does not give, by the name
    /// of its parameter; the profile `paper` has a value of ours for it. Its scene is told by its
    /// source.
    std::vector<std::string> openParameters;
    /// Why it was not; empty also for a cell that has no counterpart in the profile `paper`.
    std::vector<Departure> departures;
    /// An input was fitted so that it comes out (config::isCalibrated).
    bool isCalibrated = false;
    /// Of a frame's or a pass's time or rate: the same by the process's CPU time, not formatted.
    /// Empty where it was not recorded: on a GPU, or of a time that a technique tells itself.
    std::vector<Measured> byProcess;
    /// Of a time, where the GPU's clock moved while one of its cases was timed (moved_clocks.h).
    std::optional<ClockRange> movedClock;

    bool isOk() const { return status == records::Status::Ok && !values.empty(); }
    /// What the bounds beside the cell's numbers are.
    Bounds bounds() const { return values.empty() ? Bounds::None : values[0].bounds; }
    /// Bounds that are apart, as the format writes them.
    bool hasShownBounds() const { return !low.empty() && low != high; }
    /// The statistic of that name, the first if the name is empty; null when it is not there.
    const Measured* find(const std::string& statistic, Clock clock = Clock::Wall) const;
};

/// Where a row's scene comes from: metric `scene_source` of its cases (0 real, 1 stand-in, 2
/// generated). Of several the last of these counts.
enum class SceneSource { Unknown, Real, Generated, StandIn };
/// "real", "stand-in", "generated"; empty for Unknown.
std::string_view sceneSourceName(SceneSource source);

struct TableRow {
    std::vector<std::string> labels;  // the value of each row axis, beside Table::rowAxes
    SceneSource source = SceneSource::Unknown;
    std::vector<Cell> cells;  // beside Table::columns
};

struct TableColumn {
    std::string label;  // "rasterization_ms"; several column axes are joined by "_"
    std::string unit;   // of the records, if they agree and are not scaled
    /// Of a table that nobody laid out: what the technique declares of the metric.
    std::string doc = {};
    config::Better better = config::Better::Neither;
    std::vector<std::string> parts = {};  // the label's, a column axis each
};

struct Table {
    std::string id;  // "zju2005/2.1"
    std::string slug;
    std::string label;  // "Table 2.1"
    std::string title;
    std::string hardware;  // that the paper's numbers come from
    std::string remark;
    bool isOnlyPrinted = false;  // nothing is measured for it
    bool isPublished = false;    // what is measured stands for something that a paper shows
    bool knowsPrintedParameters = false;  // not so in runs of before these were kept
    /// `labels:` of its config: what people read for the name of a parameter, axis, row or column.
    std::map<std::string, std::string> words;
    std::vector<std::string> rowAxes;
    std::vector<TableColumn> columns;
    std::vector<TableRow> rows;
    std::vector<TableRow> printedRows;  // printed, but not part of this run; no cell is planned
    /// "triangles 69,451": what a table that nobody laid out has in all rows alike.
    std::vector<std::string> constants;
    std::vector<std::string> notes;  // printed rows that found no place, and the like
    /// By how much two equal cases of this table would differ (frame_times.h), as a share; none
    /// with too few rounds.
    std::optional<double> wallNoise, processNoise;

    bool hasSources() const;
    /// Whether a measured cell is marked as calibrated.
    bool hasCalibrated() const;
    /// Whether a cell shows such bounds.
    bool hasShown(Bounds bounds) const;
    std::optional<double> noise(Clock clock) const {
        return clock == Clock::Wall ? wallNoise : processNoise;
    }
    /// "scene=models/duck, step=1"; "" for a table of one row.
    std::string rowName(std::size_t row) const;
};

/// The table with one of its row axes and its columns in each other's place: that axis's labels are
/// the columns, and a last row axis `column` (config::kColumnAxis) has the labels of the columns.
Table transposed(const Table& table, std::size_t rowAxis);

/// Gathers the records of one experiment (others are passed over).
///
/// Rows are the combinations of the row axes that the sweep contains, in its order; those without
/// any record stay, as `missing`. A cell takes the records that the selections of its row, column
/// and `cell` choose; summarize() (sampling.h) makes one number and its bounds of them.
///
/// An experiment of one's own without a layout gets the default one (default_layout.h).
///
/// Of an experiment without a technique the table is what was printed: the first column for the
/// rows, no cell planned.
///
/// A cell whose metric is a time or a frame rate never shows a record of the quality lane. Throws
/// Error with the layout's place for an unknown statistic or axis.
Table buildTable(const config::Experiment& experiment, std::span<const config::Case> planned,
                 const std::vector<records::Record>& records);

/// Sentences below a table that its records do not tell: of calibrations that read its printed
/// cells, of the machine while it was timed. By table.
using TableNotes = std::map<std::string, std::vector<std::string>>;

/// The tables of a run, beside `experiments`; `planned` are the cases of its plan.
std::vector<Table> buildTables(const std::vector<config::Experiment>& experiments,
                               std::span<const config::Case> planned,
                               const std::vector<records::Record>& records);

}  // namespace gfxrepro::tables
