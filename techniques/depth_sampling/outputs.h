// What the technique records: each metric with its unit, each pass with its meaning.
#pragma once

#include "runner/config/outputs.h"

namespace gfxrepro::depth_sampling {

config::Outputs outputs();

}  // namespace gfxrepro::depth_sampling
