// What the technique records: each metric with its unit, each pass with its meaning.
#pragma once

#include "runner/config/outputs.h"

namespace gfxrepro::soft_shadows {

config::Outputs outputs();

}  // namespace gfxrepro::soft_shadows
