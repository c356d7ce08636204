// Times that are not of one clock: a GPU whose clock moved while a case was timed.
#pragma once

#include <map>
#include <string>

#include "runner/tables/table.h"

namespace gfxrepro::tables {

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
