// One cell of a table: which records it takes, and the value and the bounds that they give. The
// median over processes and its interval are made here, and nowhere else.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/metrics/statistics.h"
#include "runner/config/experiment.h"
#include "runner/records/records.h"
#include "runner/tables/case_records.h"
#include "runner/tables/cell_format.h"

namespace gfxrepro::tables {

/// What the bounds beside a value are. An interval holds, with 95 %, the value that ever more
/// processes would come to. A range is what the few measurements happened to be, min … max, and
/// promises nothing.
enum class Bounds { None, Range, Interval };
/// "", "range", "95 % interval".
std::string_view boundsName(Bounds bounds);

/// One statistic of a cell.
struct Summary {
    double value = 0.0;
    Bounds bounds = Bounds::None;
    metrics::Interval interval;    // by `bounds`; of none the value itself
    std::map<int, double> rounds;  // the statistic in each process that has all units
    bool areDraws = false;         // instead, what a share could be in truth (shareDraws)
};

/// One statistic of a cell, in the unit that is shown (scaled).
struct Measured : Summary {
    std::string statistic;  // "median", "max", … as in the format
    std::string text;       // as the format writes the value
    std::string low, high;  // and the ends of its bounds; empty without any
};

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
    /// is of. 0 of what has none, and of what differs between processes of one seed.
    std::size_t seedCount = 0;
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
    std::string_view boundsWord(const Measured& measured) const {
        return isOfOneSeed() ? "one seed" : boundsName(measured.bounds);
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

/// Which cases the cell shows.
Where whereOf(const config::Layout& layout, const Key& row, const Key& column);

/// What a cell shows, after the parts of its column, its row and `cell` are laid over one another.
struct CellQuery {
    std::string metric;
    std::string pass;
    CellFormat format;
    double scale = 1.0;
    bool isScaled = false;
    std::optional<config::Against> against;
    bool isRateOfTime = false;  // the records are ms, the cell shows how many a second
    Where where;
};

/// Throws Error at the selection's place when no part gives a metric, or for a bad format.
CellQuery makeQuery(const config::Layout& layout, const Key& row, const Key& column);

Cell buildCell(const CellQuery& query, const LayoutCases& cases);

/// Of a time the same by the process's CPU time, formatted likewise; nothing is planned where it
/// has none.
Cell processCell(const Cell& cell);

/// Where a row's scene comes from: metric `scene_source` of its cases (0 real, 1 stand-in, 2
/// generated). Of several the last of these counts.
enum class SceneSource { Unknown, Real, Generated, StandIn };
/// "real", "stand-in", "generated"; empty for Unknown.
std::string_view sceneSourceName(SceneSource source);

/// Where the scenes come from of the cases that a row takes.
SceneSource sceneSourceOf(const config::Layout& layout, const Key& row, const LayoutCases& cases);

/// The measurements of one cell: of each process (by its number), of each unit (a frame of a case),
/// its repeats. A process need not have every unit.
struct Samples {
    std::map<int, std::map<int, std::vector<double>>> processes;
};

/// In each process the statistic over units, each reduced to the median of its repeats; with a
/// single unit, over the repeats themselves. Of several processes their median.
///
/// The unit of uncertainty is the process: repeats within one share its memory layout, its hour
/// and its neighbours, and tell nothing of those (Kalibera and Jones 2013, "Rigorous benchmarking
/// in reasonable time"). With metrics::kFewestForInterval processes or more the bounds are
/// metrics::medianInterval() of them; with fewer their range; with one process the range of what
/// each repeat alone would give. Frames are given, not drawn: a camera path is what it is.
Summary summarize(const Samples& samples, metrics::Statistic statistic);

/// `of(a, b)`: in each process that has both, with bounds of what these come to. Without such a
/// process, or with one alone, no bounds: repeats of the two do not go together.
Summary together(const Summary& a, const Summary& b, double (*of)(double, double));

/// What else a share that was counted once could be in truth: as many draws as metrics' quantiles
/// need from its posterior under Jeffreys' prior, Beta(k + ½, n − k + ½), which has an interval for
/// shares of 0 and 100 % too (Brown, Cai and DasGupta 2001, "Interval estimation for a binomial
/// proportion"). `count` is n, `name` says whose share it is: another name, independent draws; the
/// same name, the same ones. The samples of an image are taken as independent; where neighbours are
/// alike, they tell less than their number.
std::map<int, double> shareDraws(double percent, double count, std::string_view name);

/// Gives a percentage times `scale`, counted once, its draws and their interval.
void boundByDraws(Summary& share, double scale, double count, std::string_view name);

/// From the 2.5th to the 97.5th percentile.
metrics::Interval drawsInterval(std::vector<double> draws);

}  // namespace gfxrepro::tables
