// Memory of a process, and what it started, as Linux's /proc tells it.
#pragma once

#include <sys/types.h>

#include <vector>

namespace gfxrepro::run {

/// The process, all that it started, and what these started in turn.
std::vector<pid_t> processTree(pid_t pid);

/// Resident bytes of any process; 0 when it is gone.
long long residentBytes(pid_t pid);

/// Highest resident size of this process since the last reset.
long long peakResidentBytes();
/// Gives unused heap back and starts the peak at the present size.
void resetPeakResident();

}  // namespace gfxrepro::run
