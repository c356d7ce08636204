// What the technique records: each metric with its unit, each pass with its meaning.
#pragma once

#include "runner/config/outputs.h"

namespace gfxrepro::terrain_tessellation {

config::Outputs outputs();

}  // namespace gfxrepro::terrain_tessellation
