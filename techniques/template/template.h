// The skeleton that scripts/new_technique copies, and the smallest thing that the runner can run.
#pragma once

#include "runner/technique/technique.h"

namespace gfxrepro::technique {

extern const TechniqueInfo kTemplate;

}  // namespace gfxrepro::technique
