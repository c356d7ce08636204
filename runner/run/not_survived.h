// What took a run with it: cases that were under way when the runner, or the machine, went down.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "runner/run/plan.h"
#include "runner/run/protocol.h"

namespace gfxrepro::run {

/// The cases that were under way at two ends of the runner, or more, that it did not say (no `end`,
/// no `interrupted`), with a message that says so; by id. What counts is the work, not its name:
/// a case in whichever of its processes, and a twin (workKey) in place of another. A unit that ends
/// after all clears what was counted of it; an interruption and a stop rule count nothing and clear
/// nothing.
std::map<std::string, std::string> casesNotSurvived(const Plan& plan,
                                                    const std::vector<Json>& journal);

}  // namespace gfxrepro::run
