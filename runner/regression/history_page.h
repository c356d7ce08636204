// A history as a web page.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "runner/regression/history.h"

namespace gfxrepro::regression {

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
