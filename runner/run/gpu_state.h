// What the GPU did while cases were timed: its clock, power and temperature, what held it down, who
// else used it.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "engine/gl/nvml.h"
#include "runner/run/protocol.h"
#include "runner/tables/table.h"

namespace gfxrepro::run {

class GpuState {
  public:
    /// A moment of a unit, in which frames were timed or not; `own` are the runner's processes.
    void add(const gl::GpuReading& reading, const std::set<int>& own, bool isTimed);
    void add(const GpuState& other);

    bool isKnown() const { return samples_ > 0; }
    /// {"samples", "lowest_clock_hz", "highest_clock_hz", "max_clock_hz", "highest_power_w",
    /// "power_limit_w", "hottest_c", "most_memory_bytes", "other_processes", "throttled_by"}: of
    /// these what is known. Clocks, and what held them down, are those of moments at which it
    /// worked on timed frames: it warms up while others are drawn, and rests while a case loads.
    Json json() const;
    static GpuState fromJson(const Json& json);

    /// Its lowest and highest clock, where these are so far apart that they move times.
    std::optional<tables::ClockRange> movedClock() const;
    /// "the GPU's clock moved between 1.2 and 1.98 GHz": how its times are not those of one clock.
    std::vector<std::string> problems() const;
    /// "the GPU ran at 1.98 GHz, up to 64 °C and 210 W"; empty where nothing is known.
    std::string text() const;

  private:
    int samples_ = 0;
    std::optional<double> lowestHz_, highestHz_, maxHz_;
    std::optional<double> highestPowerW_, powerLimitW_, hottestC_, mostMemoryBytes_;
    int others_ = 0;  // the most at one moment
    std::set<std::string> throttledBy_;
};

}  // namespace gfxrepro::run
