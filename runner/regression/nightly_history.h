// The history of many nights: the medians of each, the steps in them, and the page that shows them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runner/regression/series.h"

namespace gfxrepro::regression {

/// One night of one machine.
struct Night {
    std::string time;     // UTC, ISO 8601
    std::string commit;   // of the build that was measured
    std::string machine;  // processor, device and driver: series of two machines are never joined
    SeriesMap series;
};

/// Appends a row a series (median over processes) to the CSV file `path`, made where it is missing:
/// time,commit,machine,table,technique,method,scene,params,pass,metric,unit,value. Throws Error.
void appendNight(const std::filesystem::path& path, const Night& night);

/// One number of a history.
struct HistoryRow {
    std::string time, commit, machine;  // as Night has them
    SeriesKey key;
    double value = 0.0;
};
/// All rows, as they stand in the file; a torn last row is not read. Throws Error with file and
/// line for a row of another form, and where the header is not that of a history.
std::vector<HistoryRow> readHistoryRows(const std::filesystem::path& path);

/// The values of `machine` by series, oldest first. A missing file has none. Throws as
/// readHistoryRows().
SeriesMap readHistory(const std::filesystem::path& path, const std::string& machine);

/// A lasting change of level.
struct Step {
    std::size_t first = 0;  // the first night of the new level
    double ratio = 1.0;     // of the medians, after / before
    double chance = 1.0;    // of as clear a step there or elsewhere without a change: a bound
};

/// What a step must pass.
struct StepRules {
    /// Chance of one false alarm a year, among all series and nights.
    double familyError = 0.05;
    int nightsAYear = 365;
    double effectFloor = 0.05;  // nights differ by more than the rounds of one
};
inline constexpr StepRules kStepRules{};

/// The clearest step of the last 100 nights with at least five on either side: the largest rank-sum
/// score [Mann and Whitney 1947]. Its chance is the exact one of that split times the number of
/// splits. None where it exceeds `significance`, or the change of level is below `effectFloor`.
/// Assumes nights without a change to be exchangeable.
std::optional<Step> findStep(const Series& nights, double significance, double effectFloor);

/// Every lasting change of level, oldest first: where the last nights have no further step, the
/// nights before them are looked at, as they were when they were the last; what lies before and
/// behind a step is looked at by itself. Ratios are of the levels on either side.
std::vector<Step> findAllSteps(const Series& nights, double significance, double effectFloor);

/// The chance of a false alarm that each of `timeSeries` series may have at each night.
double significanceOf(std::size_t timeSeries);

/// The nights on which a value that is no time is another than the night before: whole numbers
/// exactly, others by more than 1e-4 of the larger.
std::vector<std::size_t> findChanges(const Series& nights);

struct SeriesStep {
    SeriesKey key;
    std::size_t nights = 0;
    Step step;

    bool isAlarm() const { return step.ratio > 1.0; }
};

/// The steps of all times, at familyError / (series × nightsAYear) each: of 20 series 7e-6, which
/// nights of 13 and 13 without an overlap attain, and no 24 nights can.
std::vector<SeriesStep> findSteps(const SeriesMap& history);

/// A change of a series: of a time its level, of another value the value.
struct SeriesChange {
    std::size_t night = 0;   // of the machine's: the first with the new one
    std::size_t before = 0;  // the series' last night before
    double ratio = 1.0;      // after / before
    double chance = 0.0;     // of a step: of one as clear without a change; 0 of a value
};

/// A series of one machine, beside its nights.
struct SeriesHistory {
    SeriesKey key;
    std::vector<std::size_t> nights;  // that have a value, ascending
    Series values;                    // beside them
    std::vector<SeriesChange> changes;
};

/// What one machine measured. Nights are in the order of their time.
struct MachineHistory {
    std::string machine;
    struct NightOf {
        std::string time, commit;
    };
    std::vector<NightOf> nights;
    std::vector<SeriesHistory> series;  // in the order of their keys
};

/// The rows by machine, with every change: steps of times as findAllSteps() has them at the
/// nightly's significance, changes of other values as findChanges(). Rows may come from several
/// files; of two of one night and series the last counts.
std::vector<MachineHistory> historiesOf(std::span<const HistoryRow> rows);

/// One file without scripts: of each machine its changes with the commits between which they lie, a
/// curve for each time and for each value that changed, and its nights. Throws Error.
void writeHistoryPage(const std::filesystem::path& file, const std::string& title,
                      std::span<const MachineHistory> histories);

}  // namespace gfxrepro::regression
