// A comparison for people and for other tools.
#pragma once

#include <string>
#include <vector>

#include "runner/regression/comparison.h"

namespace gfxrepro::regression {

/// One line: "2 slower, 1 faster, 40 same, 3 cannot tell".
std::string summaryLine(const std::vector<Difference>& differences);

/// A table of everything that is not the same, and the summary line.
std::string markdown(const std::vector<Difference>& differences);

/// Alarms are failures; what could not be told is skipped.
std::string junitXml(const std::vector<Difference>& differences);

/// [{"name", "unit", "value", "range"}]: the times after, in the form `customSmallerIsBetter` of
/// GitHub's benchmark action.
std::string smallerIsBetterJson(const std::vector<Difference>& differences);

}  // namespace gfxrepro::regression
