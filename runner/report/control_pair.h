// The A/A pair of a run: by how much two equal measurements differed.
#pragma once

#include <string>
#include <vector>

#include "runner/report/records.h"

namespace gfxrepro::report {

/// One sentence a pair: the case, its two median times and the smallest relative change that the
/// run could have told from none: the largest distance from 1 of the ratio of the medians' 95 %
/// interval (bootstrap over repeats). Merged runs have several pairs, runs without times none.
std::vector<std::string> controlNotes(const std::vector<Record>& records);

}  // namespace gfxrepro::report
