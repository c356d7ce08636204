// The technique `depth_sampling`: chapter 2 of xie2017. See README.md.
#pragma once

#include "runner/technique/technique.h"

namespace gfxrepro::depth_sampling {

extern const technique::TechniqueInfo kDepthSampling;

}  // namespace gfxrepro::depth_sampling
