#include "runner/tables/moved_clocks.h"

#include <fmt/format.h>

#include <algorithm>

namespace gfxrepro::tables {

namespace {

void widen(std::optional<ClockRange>& range, const ClockRange& by) {
    const ClockRange before = range.value_or(by);
    range = {std::min(before.lowHz, by.lowHz), std::max(before.highHz, by.highHz)};
}

}  // namespace

void markMovedClocks(const MovedClocks& moved, Table& table) {
    if (moved.empty()) return;
    for (TableRow& row : table.rows) {
        for (Cell& cell : row.cells) {
            if (!cell.isTime || cell.values.empty()) continue;
            for (const std::string& caseId : cell.caseIds) {
                const auto clock = moved.find(caseId);
                if (clock != moved.end()) widen(cell.movedClock, clock->second);
            }
        }
    }
}

std::optional<ClockRange> movedClock(const Table& table, std::size_t column) {
    std::optional<ClockRange> range;
    for (const TableRow& row : table.rows) {
        if (row.cells[column].movedClock) widen(range, *row.cells[column].movedClock);
    }
    return range;
}

std::optional<ClockRange> movedClock(const Table& table) {
    std::optional<ClockRange> range;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        if (const auto clock = movedClock(table, i)) widen(range, *clock);
    }
    return range;
}

std::string clockText(const ClockRange& clock) {
    return fmt::format("{:.3g} and {:.3g} GHz", 1e-9 * clock.lowHz, 1e-9 * clock.highHz);
}

std::string movedClockLegend(const ClockRange& clock) {
    return "timed while the GPU's clock moved between " + clockText(clock);
}

}  // namespace gfxrepro::tables
