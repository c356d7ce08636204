// A technique in miniature: three methods, a truth on the CPU, a metric of each.
#pragma once

#include "runner/technique/technique.h"

namespace gfxrepro::template_ {

extern const technique::TechniqueInfo kTemplate;

}  // namespace gfxrepro::template_
