// The medians of every night, and the steps in them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
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

/// The values of `machine` by series, oldest first. A missing file has none; a torn last row is not
/// read. Throws Error with file and line for a row of another form.
SeriesMap readHistory(const std::filesystem::path& path, const std::string& machine);

/// A lasting change of level.
struct Step {
    std::size_t first = 0;  // the first night of the new level
    double ratio = 1.0;     // of the medians, after / before
    double chance = 1.0;    // that the same nights in another order show as clear a step
};

/// The clearest step of a series with at least five nights on either side: the largest rank-sum
/// score [Mann and Whitney 1947], its chance by 2000 permutations. None when the chance exceeds
/// `significance` or the change of level is below `effectFloor`.
std::optional<Step> findStep(const Series& nights, double significance = 0.01,
                             double effectFloor = 0.02);

}  // namespace gfxrepro::regression
