// Memory of a process, as Linux's /proc tells it.
#pragma once

#include <sys/types.h>

namespace gfxrepro::batch {

/// Resident bytes of any process; 0 when it is gone.
long long residentBytes(pid_t pid);

/// Highest resident size of this process since the last reset.
long long peakResidentBytes();
/// Gives unused heap back and starts the peak at the present size.
void resetPeakResident();

}  // namespace gfxrepro::batch
