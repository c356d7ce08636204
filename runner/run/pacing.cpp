#include "runner/run/pacing.h"

#include <algorithm>
#include <cmath>

namespace gfxrepro::run {

Pacing Pacing::of(const config::Measure& measure, bool isHardware) {
    Pacing pacing;
    pacing.repeatsAtMost = measure.repeats;
    if (!isHardware || measure.lane != config::Measure::Lane::Timing) return pacing;
    pacing.warmUpS = 0.2;
    pacing.warmUpAtMostS = 3.0;
    pacing.busyS = 0.01;
    pacing.repeatsS = 0.2 / measure.frames;
    pacing.repeatsAtMost = std::max(measure.repeats, 10);
    pacing.inFlightAtMost = 8;
    return pacing;
}

bool Pacing::areSettled(const std::vector<double>& timesMs) {
    constexpr std::size_t kFrames = 3;
    constexpr double kDifference = 0.02;
    if (timesMs.size() < kFrames) return false;
    const auto [least, most] = std::minmax_element(timesMs.end() - kFrames, timesMs.end());
    return *most - *least <= kDifference * *least;
}

int Pacing::inFlight(double frameTimeMs) const {
    constexpr double kTogetherMs = 50.0;
    if (inFlightAtMost == 1 || frameTimeMs >= kTogetherMs) return 1;
    return static_cast<int>(std::clamp(std::ceil(kTogetherMs / std::max(frameTimeMs, 1e-3)), 1.0,
                                       static_cast<double>(inFlightAtMost)));
}

}  // namespace gfxrepro::run
