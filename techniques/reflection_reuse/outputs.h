// What the technique records: each metric with its unit, each pass with its meaning.
#pragma once

#include "runner/config/outputs.h"

namespace gfxrepro::reflection_reuse {

config::Outputs outputs();

}  // namespace gfxrepro::reflection_reuse
