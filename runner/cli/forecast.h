// What earlier runs tell about the one at hand.
#pragma once

#include <string>
#include <vector>

#include "runner/cluster/predictions.h"

namespace gfxrepro::cli {

/// Predictions and where they come from.
struct History {
    cluster::Predictor predictor;
    std::vector<std::string> sources;  // run directories, or a file of predictions
};

/// From the named sources; for none, from the newest runs in runs/ on this class of device, of
/// which those that cannot be read are passed over.
History openHistory(const std::vector<std::string>& from, const std::string& deviceClass);

/// "3 h 20 min", "12 min", "1.3 s", "80 ms".
std::string durationText(double timeS);
/// "1.2 GiB", "310 MiB".
std::string memoryText(double bytes);

/// "expect about 12 min and at most 310 MiB a case, as runs/a tells" for the cases of the plan (of
/// its shard; twins are measured once), with `jobs` quality cases at once; rounds that a budget may
/// end count as far as it lasts. Empty where of any case no earlier run tells its time.
std::string forecastText(const run::Plan& plan, const History& history, int jobs);

}  // namespace gfxrepro::cli
