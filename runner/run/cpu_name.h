// The processor, as results name it.
#pragma once

#include <istream>
#include <string>

namespace gfxrepro::run {

/// From /proc/cpuinfo: the model's name or, on ARM, which has none there, the numbers of its
/// designer and of the part ("ARM 0x41 0xd0c"). "unknown" where neither is there.
std::string cpuName(std::istream& cpuinfo);

}  // namespace gfxrepro::run
