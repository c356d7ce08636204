// The records of an experiment, ordered by case, with the values that each case has on the axes
// that a layout asks for.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "runner/config/experiment.h"
#include "runner/report/records.h"

namespace gfxrepro::report {

/// In a record's params: the scene of the table whose place the record's scene takes, and which of
/// the seeds of a generated scene it has, from 0.
inline constexpr const char* kStandsFor = "stands_for";
inline constexpr const char* kSceneSample = "scene_sample";
inline constexpr int kMostSceneSample = 999;      // of `measure.scene_seeds`
inline constexpr int kMostProcesses = 1'000'000;  // of a case: config::readMeasure

/// One text for one value, however it is spelt: 64 and 64.0, or a scene as text or as a map.
std::string canonicalText(const config::Node& value);

/// The values of a case beside a list of axes; empty where the case has none, or it is not known.
using AxisValues = std::vector<std::optional<std::string>>;

/// A case that was run, with the last attempt of each of its processes. Where scenes were taken at
/// several seeds, a seed is to a case what a process is to a time: cases that differ by it alone
/// are one, whose process k has the k-th seed.
struct CaseRecords {
    struct Place {
        std::string_view metric;
        std::string_view pass;
        int frame = 0;
        int repeat = 0;
        auto operator<=>(const Place&) const = default;
    };
    struct Attempt {
        std::map<Place, const Record*> rows;
        /// The values of a metric and pass: of its frames, or of set-up where no frame has one.
        std::vector<const Record*> values(std::string_view metric, std::string_view pass) const;
        const Record* failure = nullptr;  // why the case has no rows
    };

    std::string id;
    AxisValues axes;
    std::map<int, Attempt> processes;
    std::string scene;   // as its records say it
    std::string params;  // likewise: JSON
};

/// The cases of `table` in the order of their first records, which must outlive the result. A later
/// row of a case replaces an earlier one of the same place; a failure replaces all before it.
/// Beside cases at several seeds those without a seed count at each.
std::vector<CaseRecords> groupByCase(const std::vector<Record>& records, std::string_view table,
                                     const std::vector<std::string>& axes);

/// A case of the profile `paper` as if it had been run, without an attempt.
CaseRecords unmeasured(const config::PaperCase& item, const std::vector<std::string>& axes);

/// A case of the sweep, run or not.
struct PlannedCase {
    AxisValues axes;  // empty also where the technique's default decides
    std::string identity;
};
std::vector<PlannedCase> planCases(const config::Experiment& experiment,
                                   const std::vector<std::string>& axes);

}  // namespace gfxrepro::report
