// The rows and columns of a table: which combinations of axis values it has, in which order.
#pragma once

#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "runner/config/experiment.h"
#include "runner/tables/case_records.h"

namespace gfxrepro::tables {

/// A row or a column: the label on each of its layout axes.
using Key = std::vector<std::string>;

/// Cases by their value on each axis, so that a cell asks those that may be its own, not each.
class CaseIndex {
  public:
    CaseIndex() = default;
    explicit CaseIndex(const std::vector<const AxisValues*>& cases);

    std::size_t caseCount() const { return caseCount_; }
    /// How many cases have one of the values on the axis.
    std::size_t countOf(std::size_t axis, const std::vector<std::string>& values) const;
    /// Their places, ascending.
    std::vector<std::size_t> placesOf(std::size_t axis,
                                      const std::vector<std::string>& values) const;

  private:
    using Axis = std::unordered_map<std::string, std::vector<std::size_t>>;  // places by value
    std::size_t caseCount_ = 0;
    std::vector<Axis> axes_;
};

/// The cases of a layout. `axes` names the sweep axes of its rows and columns and of all `where`
/// selections; cases carry their values beside it.
struct LayoutCases {
    std::vector<std::string> axes;
    std::vector<CaseRecords> cases;
    int frameCount = 1;
    CaseIndex index;

    /// The place of an axis in `axes`.
    std::size_t indexOf(const std::string& axis) const;
};

/// Which cases a layout asks for: axis → any of these values.
using Where = std::map<std::string, std::vector<std::string>>;
/// Those that lie there, run or not.
std::vector<const CaseRecords*> casesAt(const Where& where, const LayoutCases& cases);

LayoutCases gatherCases(const config::Experiment& experiment, std::span<const config::Case> planned,
                        const std::vector<records::Record>& records);

/// The combinations of `layoutAxes`: on sweep axes those that occur in the plan; on labelled axes
/// all. Sorted by axis, then by the order in which
/// values first occur.
std::vector<Key> collectKeys(const std::vector<config::LayoutAxis>& layoutAxes,
                             const LayoutCases& cases);

}  // namespace gfxrepro::tables
