// One cell of a table: which records it takes, and what is written of the values that they give.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runner/config/experiment.h"
#include "runner/records/records.h"
#include "runner/tables/cell_format.h"
#include "runner/tables/layout_cases.h"
#include "runner/tables/summary.h"

namespace gfxrepro::tables {

/// One statistic of a cell, in the unit that is shown (scaled).
struct Measured : Summary {
    std::string statistic;  // "median", "max", … as in the format
    std::string text;       // as the format writes the value
    std::string low, high;  // and the ends of its bounds; empty without any
};

/// A parameter at which a cell was measured otherwise than printed, or than its config says, with
/// its values in the cases behind it. `cases`, with their numbers, where each parameter has its
/// printed values but not all go together as printed.
struct Departure {
    std::string parameter;
    std::vector<std::string> measured;
    std::vector<std::string> printed;
    /// No `printed.at` has it: `printed` is what its config takes for it in the profile `paper`.
    bool isOfConfig = false;

    bool operator==(const Departure&) const = default;
};

/// An axis of which a cell takes several values together: swept, `frame`, or `scene_seed`.
struct Pooled {
    std::string axis;
    std::vector<std::string> values;
    bool isAsked = false;  // the layout names the axis

    bool operator==(const Pooled&) const = default;
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
    bool isMisnamed = false;    // what it asks for has other passes, or, of an import, is nowhere
    bool isPartial = false;  // some of the cases that it gathers failed; its values are the others'
    records::Status status = records::Status::Missing;  // the worst of its records
    std::string message;                                // why it is not ok
    std::vector<Measured> values;  // in the order of the format; empty without a measurement
    std::string measured;          // formatted; the status word without a measurement
    std::string low, high;         // the ends of the bounds, formatted likewise; or empty
    std::optional<std::string> printed;
    std::vector<std::optional<double>> printedValues;  // beside the format's statistics
    std::vector<std::string> caseIds;                  // whose records it takes
    std::vector<Pooled> pooled;                        // of several cases: along which axes
    bool lacksCurve = false;     // it has `equal`, and no axis of numbers along which its cases lie
    bool isWithinNoise = false;  // of a column "÷ A": from 1 it cannot be told apart
    std::string metric;   // what it shows; empty of a share, and, as its unit, where it is scaled
    bool isTime = false;  // a time, a rate of time, or a share of one
    int timePower = 0;    // as timePower() of its metric; a share of times stays as they double
    std::string unit;     // of the records, if they agree; "%" of a share
    /// It was measured at what the paper measured at (printed.h). Never without a measurement, nor
    /// in a run whose plan does not know the printed parameters.
    bool isAtPrintedParameters = false;
    /// Of what it was measured at, beside departures: what the document does not give, by the name
    /// of its parameter; the profile `paper` has a value of ours for it. Its scene is told by its
    /// source.
    std::vector<std::string> openParameters;
    /// Why it was not; empty also for a cell that has no counterpart in the profile `paper`.
    std::vector<Departure> departures;
    /// Of random numbers, other ones of which would give another value: how many different seeds it
    /// is of. 0 of what has none, as a time.
    std::size_t seedCount = 0;
    /// Of no declared seed, and no surer than chance (LayoutCases::isInDoubt): an unseeded
    /// program, an import.
    bool scatters = false;
    bool isRunOnce = false;  // of these: it took CaseRecords::isRunOnce
    /// Of a program or an import: the axis along which it takes together what was measured once
    /// each. Whether they repeat one, as trials do, or are others, as scenes are, nobody
    /// knows.
    std::string onceAlong;
    bool isNowhere = false;   // no measurement gives it: it reads a row that is not there
    bool isOwnTruth = false;  // an error, 0 whatever the program does: LayoutCases::ownTruths
    /// An input was fitted so that it comes out (config::isCalibrated).
    bool isCalibrated = false;
    /// Of a frame's or a pass's time or rate: the same by the process's CPU time, and as
    /// `measured`, `low` and `high` are. Empty where it was not recorded: on a GPU, or of a time
    /// that a technique tells itself.
    std::vector<Measured> byProcess;
    std::string measuredByProcess, lowByProcess, highByProcess;
    /// Of a time, where the GPU's clock moved while one of its cases was timed (markMovedClocks).
    std::optional<ClockRange> movedClock;

    /// Several processes of it are one sample.
    bool isOfOneSeed() const { return seedCount == 1; }
    /// What stands beside a number of it: "95 % interval", "range", "one seed"; or nothing.
    std::string_view boundsWord(const Measured& number) const {
        return isOfOneSeed() ? "one seed" : boundsName(number.bounds);
    }
    bool isOk() const { return status == records::Status::Ok && !values.empty(); }
    /// What the bounds beside the cell's numbers are.
    Bounds bounds() const { return values.empty() ? Bounds::None : values[0].bounds; }
    /// Bounds that are apart, as the format writes them.
    bool hasShownBounds() const { return !low.empty() && low != high; }
    bool hasInterval() const { return hasShownBounds() && bounds() == Bounds::Interval; }
    /// A share whose interval is that of its count.
    bool isCountedShare() const { return hasInterval() && !isTime && unit == "%"; }
    /// The statistic of that name, the first if the name is empty; null when it is not there.
    const Measured* find(const std::string& statistic, Clock clock = Clock::Wall) const;
};

/// The seeds of what is computed of two numbers: one of a part is one of the whole. 0: not random.
std::size_t fewerSeeds(std::size_t a, std::size_t b);

/// Which cases the cell shows.
Where whereOf(const config::Layout& layout, const Key& row, const Key& column);

/// What a cell shows, after the parts of its column, its row and `cell` are laid over one another.
struct CellQuery {
    std::string metric;
    std::string pass;
    CellFormat format;
    double scale = 1.0;
    bool isScaled = false;
    std::optional<config::Equal> equal;
    bool isRateOfTime = false;  // the records are ms, the cell shows how many a second
    Where where;
    SourceLocation location;  // of the last selection that is laid over the others
};

/// Throws Error at the selection's place when no part gives a metric, or for a bad format.
CellQuery makeQuery(const config::Layout& layout, const Key& row, const Key& column);

/// The axes along which the cases differ that it takes together.
std::vector<Pooled> pooledAt(const CellQuery& query, const LayoutCases& cases);
/// Of these the one along which they were measured once each (Cell::onceAlong), or none.
std::string onceAlong(const CellQuery& query, const LayoutCases& cases,
                      std::span<const Pooled> pooled);

/// With `equal`: in each process a curve through the cell's cases, of its metric over the other
/// one, read at the value. On logarithmic scales where both are positive, so that what falls as a
/// power is a line; between the two nearest cases, and missing beyond them all.
Cell buildCell(const CellQuery& query, const LayoutCases& cases);

/// Where a row's scene comes from: metric `scene_source` of its cases (0 real, 1 stand-in, 2
/// generated). Of several the last of these counts.
enum class SceneSource { Unknown, Real, Generated, StandIn };
/// "real", "stand-in", "generated"; empty for Unknown.
std::string_view sceneSourceName(SceneSource source);

/// Where the scenes come from of the cases that a row takes.
SceneSource sceneSourceOf(const config::Layout& layout, const Key& row, const LayoutCases& cases);

/// Writes the texts of a cell's values and of their bounds, by both clocks.
void writeValues(const CellFormat& format, Cell& cell);
/// Writes what is to be said of its status, by this word, when its values are there.
void writeStatus(std::string_view word, Cell& cell);

}  // namespace gfxrepro::tables
