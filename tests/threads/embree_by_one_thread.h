// Embree builds its trees by threads of TBB's library, into which ThreadSanitizer does not see:
// every handing over of their memory looks like a race. For GFXREPRO_SANITIZE_THREADS the thread
// that asks for a tree builds it alone; rays are traced by ours, as everywhere.
#pragma once

#define rtcNewDevice(config) rtcNewDevice("threads=1")
