// The records of an experiment, ordered by case, with the values that each case has on the axes
// that a layout asks for.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "runner/config/case.h"
#include "runner/records/records.h"

namespace gfxrepro::tables {

/// One text for one value, however it is spelt: 64 and 64.0, or a scene as text or as a map.
std::string canonicalText(const Node& value);

/// The values of a case beside a list of axes; empty where the case has none.
using AxisValues = std::vector<std::optional<std::string>>;

/// In place of the value of an axis that does not apply to a case.
inline constexpr std::string_view kLeftOut = "–";

/// A case with the last attempt of each of its processes; without any where it was not run. Where
/// scenes are taken at several seeds, a seed is to a case what a process is to a time: cases that
/// differ by it alone are one, whose process k has the k-th seed.
struct CaseRecords {
    struct Place {
        std::string_view metric;
        std::string_view pass;
        int frame = 0;
        int repeat = 0;
        auto operator<=>(const Place&) const = default;
    };
    struct Attempt {
        std::map<Place, const records::Record*> rows;
        /// The values of a metric and pass: of its frames, or of set-up where no frame has one.
        std::vector<const records::Record*> values(std::string_view metric,
                                                   std::string_view pass) const;
        const records::Record* failure = nullptr;  // why the case has no rows
    };

    std::string id;
    AxisValues axes;
    std::map<int, Attempt> processes;
    std::string scene;  // Case::recordedScene()
    Node params;        // Case::recordedParams()
};

/// The cases of `table` in the order of the plan, with their records, which must outlive the
/// result. A later row of a case replaces an earlier one of the same place; a failure replaces all
/// before it. Beside cases at several seeds those without a seed count at each. On an axis that
/// `when` of the sweep leaves out of a case it has the value kLeftOut.
std::vector<CaseRecords> groupByCase(std::span<const config::Case> planned,
                                     const std::vector<records::Record>& records,
                                     std::string_view table, const std::vector<std::string>& axes,
                                     const Node* when = nullptr);

}  // namespace gfxrepro::tables
