// A few cases of a plan, chosen by what they have: how one case is run again.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "runner/run/plan.h"

namespace gfxrepro::run {

/// Leaves the cases that have all of `only`, each "key=value" as written on the command line; of a
/// key that is written several times, any. A key is a sweep's axis, a parameter, `scene`,
/// `output.width`, `output.height`, or `case` with the beginning of an id. The plan's hash stays
/// that of the whole plan. Throws UsageError when no case has the key, or the value, with those
/// that there are.
void keepOnly(Plan& plan, const std::vector<std::string>& only);

/// What leaves one case of a plan alone. The plan must outlive it.
class CaseNames {
  public:
    explicit CaseNames(const Plan& plan) : plan_(plan) {}

    /// The shortest `only` that does: its axes; where other cases have them too, its id, which
    /// lasts as long as the build.
    std::vector<std::string> onlyOf(const Case& item);

  private:
    using Keys = std::vector<std::string>;
    using Counts = std::map<Keys, int>;

    const Plan& plan_;
    /// By experiment and keys, how many of its cases have each combination of values there.
    std::map<std::pair<std::string, Keys>, Counts> counts_;
};

}  // namespace gfxrepro::run
