// Tables of measurements: records gathered into the rows and columns that the experiment lays out.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runner/config/experiment.h"
#include "runner/records/records.h"
#include "runner/tables/cell.h"

namespace gfxrepro::tables {

/// Beside each calibrated cell, and what it says below the table.
inline constexpr const char* kCalibratedMark = "‡";
inline constexpr const char* kCalibratedLegend =
    "calibrated: an input of ours, at the value that its config gives, was fitted so that this "
    "comes out, which tells nothing of the method";

struct TableRow {
    std::vector<std::string> labels;  // the value of each row axis, beside Table::rowAxes
    SceneSource source = SceneSource::Unknown;
    std::vector<Cell> cells;  // beside Table::columns
    /// Of a scene that could not be fitted to what is printed (`printed.unfit`).
    bool isUnfit = false;
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
    bool goesByClock = false;             // config::goesByClock
    /// Its config says of no parameter that it is printed (`printed.at`) or left open
    /// (`assumptions`): then nobody said that all are the document's.
    bool isPrintUnsaid = false;
    /// `labels:` of its config: what people read for the name of a parameter, axis, row or column.
    std::map<std::string, std::string> words;
    std::vector<std::string> rowAxes;
    std::vector<TableColumn> columns;
    std::vector<TableRow> rows;
    std::vector<TableRow> printedRows;  // printed, but not part of this run; no cell is planned
    /// "triangles 69,451": what a table that nobody laid out has in all rows alike.
    std::vector<std::string> constants;
    std::vector<std::string> notes;  // printed rows that found no place, and the like
    std::size_t toldNotes = 0;       // of these the first, which tell methods apart (compareRivals)
    /// Columns that are told apart by the CPU time of the process (compareRivals): shown beside.
    std::vector<std::string> judgedByProcess = {};
    std::string timesOf;  // where its times are another table's: a sentence without its end
    /// By how much two equal cases of this table would differ (frame_times.h), as a share; none
    /// with too few rounds.
    std::optional<double> wallNoise, processNoise;

    bool hasSources() const;
    /// Whether it has such a cell.
    bool hasCell(const std::function<bool(const Cell&)>& isSuch) const;
    /// Whether a measured cell is marked as calibrated.
    bool hasCalibrated() const;
    /// Whether a cell shows such bounds.
    bool hasShown(Bounds bounds) const;
    bool hasPrinted() const;
    /// The place of the column of that label.
    std::optional<std::size_t> findColumn(std::string_view label) const;
    std::optional<double> noise(Clock clock) const {
        return clock == Clock::Wall ? wallNoise : processNoise;
    }
    /// "scene=models/duck, step=1"; "" for a table of one row.
    std::string rowName(std::size_t row) const;
};

/// What to know of columns of random numbers of one seed, and of such as scatter without any
/// (Cell::scatters); empty where there is none.
std::string seedNote(const Table& table);

/// Numbers compare as numbers: "64.0" is 64. As labels of rows are.
std::string canonicalCell(std::string_view text);

/// The table with one of its row axes and its columns in each other's place: that axis's labels are
/// the columns, and a last row axis `column` (config::kColumnAxis) has the labels of the columns.
Table transposed(const Table& table, std::size_t rowAxis);

/// Gathers the records of one experiment (others are passed over).
///
/// Rows are the combinations of the row axes that the sweep contains, in its order; those without
/// any record stay, as `missing`. A cell takes the records that the selections of its row, column
/// and `cell` choose; summarize() (cell.h) makes one number and its bounds of them.
///
/// An experiment of one's own without a layout gets a default one: a row a point of its sweep, a
/// column a time or metric.
///
/// Of an experiment without a technique the table is what was printed: the first column for the
/// rows, no cell planned.
///
/// A cell whose metric is a time or a frame rate never shows a record of the quality lane. Throws
/// Error with the layout's place for an unknown statistic or axis. `doubt` is of the other tables
/// of the run (doubtsOf).
Table buildTable(const config::Experiment& experiment, std::span<const config::Case> planned,
                 const std::vector<records::Record>& records, const Doubt& doubt = {});

/// Puts the CPU times of these columns into columns of their own beside them: "cpu_draw_ms" behind
/// "draw_ms".
void showProcessTimes(const std::vector<std::string>& labels, Table& table);

/// The plots of a table that nobody laid out: its times, and the first of its metrics that is
/// better one way, over the axis of numbers that has most of them. None without such an axis.
std::vector<config::PlotSpec> defaultPlots(const Table& table);

/// Sentences below a table that its records do not tell: of calibrations that read its printed
/// cells, of the machine while it was timed. By table.
using TableNotes = std::map<std::string, std::vector<std::string>>;

/// The tables of a run, beside `experiments`; `planned` are the cases of its plan, `measured` what
/// it has measured, where these are some of it.
std::vector<Table> buildTables(const std::vector<config::Experiment>& experiments,
                               std::span<const config::Case> planned,
                               const std::vector<records::Record>& records,
                               std::span<const config::Experiment> measured = {});

// What is said of cells, below their table.

/// Sentences: "Each number of row average is taken over scene (a, b)."; and of which statistics
/// numbers are that are not medians of processes.
std::vector<std::string> cellNotes(const Table& table);

/// "scene=a|b; light=1|2" of a cell; empty where it is of one case.
std::string pooledText(const Cell& cell);

// What `check` refuses of a layout; `table` may have been built from no records.

/// Throws Error for a `where` that is met by no case of any profile, and for a row or a column
/// without a case. `profiles` are gatherCases() of this layout.
void requireCases(const config::Experiment& experiment, std::span<const LayoutCases> profiles);

/// Throws Error, at the layout, where a cell would take cases together that differ along an axis
/// which the layout does not name, and where those of a column with `equal` have no curve.
void requireToldApart(const config::Experiment& experiment, const Table& table);

/// Of an import a column of its file that tells rows apart and that the sweep does not name, as a
/// message ends that refuses it; empty where there is none.
std::string unnamedColumn(const config::Experiment& experiment, const Table& table);

/// Throws Error for a sum, a count or a deviation of what has one value.
void requireStatistics(const config::Experiment& experiment, std::span<const config::Case> planned,
                       const Table& table);

// Times that are not of one clock: a GPU whose clock moved while a case was timed.

/// By case: those whose GPU's clock moved while they were timed.
using MovedClocks = std::map<std::string, ClockRange>;

/// Gives the times and rates of these cases their Cell::movedClock.
void markMovedClocks(const MovedClocks& moved, Table& table);

/// Beside each of them.
inline constexpr const char* kMovedClockMark = "§";

/// From the lowest to the highest clock of all marked cells; none where no cell is.
std::optional<ClockRange> movedClock(const Table& table);
/// Of one column.
std::optional<ClockRange> movedClock(const Table& table, std::size_t column);

/// "0.345 and 1.98 GHz".
std::string clockText(const ClockRange& clock);
/// "timed while the GPU's clock moved between 0.345 and 1.98 GHz": below a table.
std::string movedClockLegend(const ClockRange& clock);

}  // namespace gfxrepro::tables
