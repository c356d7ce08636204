// The technique `shadow_mapping`: chapter 4 of zju2005. See README.md.
#pragma once

#include "runner/technique/technique.h"

namespace gfxrepro::shadow_mapping {

extern const technique::TechniqueInfo kShadowMapping;

}  // namespace gfxrepro::shadow_mapping
