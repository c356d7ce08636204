// How often a frame is drawn, so that its time is that of a device at work: as a config says on a
// software device; on hardware, whose clock falls while it rests, by time as well.
#pragma once

#include <vector>

#include "runner/config/experiment.h"

namespace gfxrepro::run {

/// On hardware a frame can take a hundredth of the time in which a clock rises (an H100 was seen to
/// go from 345 to 1,980 MHz). Once it has, times scatter little: the standard deviation of an
/// H100's is 0.05 % of a frame of 2 ms, within a process as between processes.
struct Pacing {
    double warmUpS = 0.0;        // before the first frame: at least this long,
    double warmUpAtMostS = 0.0;  // until times have settled, or this long
    double busyS = 0.0;          // before each repeat of less than 50 ms, for the device has waited
                                 // for the last one's picture
    double repeatsS = 0.0;       // repeats of a frame go on until they took this together,
    int repeatsAtMost = 1;       // or are as many
    int inFlightAtMost = 1;      // frames that are on their way at once for a frame rate

    /// Only the timing lane is paced, and only where the device that draws is hardware.
    static Pacing of(const config::Measure& measure, bool isHardware);

    /// Whether the last three differ by no more than 2 %.
    static bool areSettled(const std::vector<double>& timesMs);
    /// So many frames that they take 50 ms, at most `inFlightAtMost`.
    int inFlight(double frameTimeMs) const;
};

}  // namespace gfxrepro::run
