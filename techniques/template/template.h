// The skeleton that scripts/new_technique copies, and the smallest thing that the runner can run.
#pragma once

#include "runner/technique/technique.h"

namespace gfxrepro::template_ {

extern const technique::TechniqueInfo kTemplate;

}  // namespace gfxrepro::template_
