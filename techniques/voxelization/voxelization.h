// The technique `voxelization`: chapter 2 of zju2005. See README.md.
#pragma once

#include "runner/technique/technique.h"

namespace gfxrepro::voxelization {

extern const technique::TechniqueInfo kVoxelization;

}  // namespace gfxrepro::voxelization
