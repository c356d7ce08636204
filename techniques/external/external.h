// A program that is measured from outside, as the `program:` of a config describes it.
#pragma once

#include "runner/technique/technique.h"

namespace gfxrepro::external {

extern const technique::TechniqueInfo kExternal;

}  // namespace gfxrepro::external
