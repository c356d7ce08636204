// The numbers of a run that can be compared with another run's.
#pragma once

#include <compare>
#include <map>
#include <string>
#include <vector>

#include "runner/report/records.h"

namespace gfxrepro::regression {

/// One metric of one case. Two builds have the same key where they were asked the same.
struct SeriesKey {
    std::string table;
    std::string technique;
    std::string method;
    std::string scene;
    std::string params;  // one-line JSON of the resolved parameters
    std::string pass;
    std::string metric;
    std::string unit;

    auto operator<=>(const SeriesKey&) const = default;

    bool isTime() const { return metric.ends_with("_time_ms"); }
    bool isRate() const { return metric.ends_with("frame_rate"); }
    /// "zju2005/2.1 TECHNIQUE worksheet models/duck gpu_time_ms/synthesis"; parameters are left
    /// away.
    std::string title() const;
};

/// A value a process: the mean over frames of the median over repeats.
using Series = std::vector<double>;
using SeriesMap = std::map<SeriesKey, Series>;

/// The series of `ok` rows. Times and rates of the quality lane are left out, and so is what is
/// about the machine (memory of the process).
SeriesMap seriesOf(const std::vector<report::Record>& records);

/// Puts `more`'s processes behind those of `series`: rounds of alternating runs.
void append(SeriesMap& series, const SeriesMap& more);

/// Takes parameters that only one side's build knows out of both sides' keys, so that a build with
/// a new parameter can be compared with the one before. Not where keys of a side would fall
/// together: then the new parameter was varied.
void matchParams(SeriesMap& before, SeriesMap& after);

}  // namespace gfxrepro::regression
