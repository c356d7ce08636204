// The cases of a layout, and the rows and columns that it makes of them: which combinations of axis
// values there are, in which order.
#pragma once

#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

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

/// Whether a number is of memory, energy, power, heat or a rate in hertz: by its unit, of memory by
/// its name, too. They differ in any program, and tell nothing of what it computes.
bool isOfMachine(std::string_view metric, std::string_view unit);

/// The one rule of doubt, of claims and of comparisons: where no seed is declared and a number
/// differs when it is taken again, then it and all others of that program or import decide nothing
/// before six processes of a case (metrics::kFewestForInterval) are known.
struct Doubt {
    std::set<std::string> differing;  // metrics, in some case, whatever a layout shows of them
    bool isOfAll = false;             // of a program or an import
    bool isOfMachine = false;         // isOfMachine(), which differs in any

    void add(const Doubt& other);
    /// One of a program or an import that differs.
    void note(const std::string& metric, std::string_view unit);
    /// Whether it reaches numbers of the metric. Known without are what set-up recorded, and, of
    /// what is measured here, errors of a picture that each process is known to make alike.
    bool reaches(const std::string& metric, bool isMachine, bool isSetup, bool isOfElsewhere) const;
};

/// The cases of a layout. `axes` names the sweep axes of its rows and columns and of all `where`
/// selections, which are `namedAxes`, and behind them those that are swept beside; cases carry
/// their values beside it.
struct LayoutCases {
    std::vector<std::string> axes;
    std::size_t namedAxes = 0;
    std::vector<CaseRecords> cases;
    int frameCount = 1;
    std::set<int> frames;  // so many from 0, and what else was recorded; of what was measured
                           // elsewhere those that its file has
    /// Measured elsewhere: of what was measured once nobody knows whether it was looked at twice.
    bool isOfElsewhere = false;
    bool isOfProgram = false;  // config::goesByClock: a program's, or measured elsewhere
    CaseIndex index;
    std::set<std::string> recorded;  // metrics
    /// By id and picture the cases that are its truth themselves.
    std::set<std::pair<std::string, std::string>> ownTruths;
    Doubt doubt;

    /// Whether numbers of the metric are no surer than chance (Doubt).
    bool isInDoubt(const std::string& metric, bool isSetup, bool isMachine) const;

    /// What there is where nothing that was measured elsewhere is called so; else empty: of what
    /// is measured here `check` knows.
    std::string recordedInstead(const std::string& metric) const;

    /// The place of an axis in `axes`.
    std::size_t indexOf(const std::string& axis) const;
};

/// Which cases a layout asks for: axis → any of these values.
using Where = std::map<std::string, std::vector<std::string>>;
/// Those that lie there, run or not.
std::vector<const CaseRecords*> casesAt(const Where& where, const LayoutCases& cases);

LayoutCases gatherCases(const config::Experiment& experiment, std::span<const config::Case> planned,
                        const std::vector<records::Record>& records);

/// By experiment: what a program came to in any table of a run is in doubt in all tables of it.
std::map<std::string, Doubt> doubtsOf(std::span<const config::Experiment> experiments,
                                      std::span<const config::Case> planned,
                                      const std::vector<records::Record>& records);

/// The combinations of `layoutAxes`: on sweep axes those that occur in the plan; on labelled axes
/// all. Sorted by axis, then by the order in which
/// values first occur.
std::vector<Key> collectKeys(const std::vector<config::LayoutAxis>& layoutAxes,
                             const LayoutCases& cases);

}  // namespace gfxrepro::tables
