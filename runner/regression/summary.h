// A comparison for people and for other tools.
#pragma once

#include <string>
#include <vector>

#include "runner/regression/comparison.h"
#include "runner/regression/nightly_history.h"

namespace gfxrepro::regression {

/// One line: "2 slower, 1 faster, 40 same, 3 cannot tell".
std::string summaryLine(const std::vector<Difference>& differences);

/// "step in zju2005/2.1 …: × 1.102 since night 18 of 30 (chance 1e-07)".
std::string stepLine(const SeriesStep& step);

/// What was compared: differences, steps of the history, and what a reader must know of the runs.
struct Comparison {
    std::vector<Difference> differences;
    std::vector<SeriesStep> steps{};
    std::vector<std::string> notes{};

    /// Something got slower or changed, now or since some night.
    bool isAlarm() const;
};

/// A table of everything that is not the same, the summary line, steps and notes.
std::string markdown(const Comparison& comparison);

/// A test each, of a name of its own: alarms are failures; what could not be told is skipped.
std::string junitXml(const Comparison& comparison);

/// [{"name", "unit", "value", "range"}]: the times after, and the FLIP of each picture that
/// changed, in the form `customSmallerIsBetter` of GitHub's benchmark action.
std::string smallerIsBetterJson(const std::vector<Difference>& differences);

}  // namespace gfxrepro::regression
