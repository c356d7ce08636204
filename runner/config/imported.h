// Experiments whose numbers were measured elsewhere.
#pragma once

#include "runner/config/experiment.h"

namespace gfxrepro::config {

/// What such an experiment has in place of a technique.
inline constexpr const char* kImported = "imported";

/// Whether this program measures it: it is neither only printed nor imported.
inline bool isMeasuredHere(const Experiment& experiment) {
    return !experiment.technique.empty() && experiment.technique != kImported;
}

}  // namespace gfxrepro::config
