// What the kernel's drivers of AMD (amdgpu) and Intel (i915, xe) tell of a GPU in /sys: the same as
// NVIDIA's management library tells of one of theirs.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/gl/nvml.h"

namespace gfxrepro::run {

class KernelGpu {
  public:
    /// `node` as DeviceInfo's, "/dev/dri/renderD128"; empty: tells nothing. `root` stands for /, in
    /// tests another folder.
    KernelGpu(std::filesystem::path root, const std::string& node);

    /// At `nowS`, seconds of any clock that never stands. What a driver counts up (the time at
    /// rest, energy) is known from the second reading on; who else has it open is looked for every
    /// five seconds. Intel's drivers do not tell how much memory is used, AMD's does not tell what
    /// holds the clock down. Nothing where none of it is there.
    std::optional<gl::GpuReading> read(double nowS);

  private:
    /// By how much the count grew in a second since the last reading, then `last`.
    struct Counter {
        std::optional<double> rate(const std::optional<double>& count, double nowS);
        std::optional<double> last;
        double lastS = 0.0;
    };
    void readAmd(gl::GpuReading& reading) const;
    void readIntel(gl::GpuReading& reading, double nowS);
    void readSensors(gl::GpuReading& reading, double nowS);
    void findUsers(double nowS);

    std::filesystem::path root_, device_, card_;
    std::string node_;
    Counter restMs_, energyUj_;
    std::vector<int> users_;
    std::optional<double> usersAtS_;
};

}  // namespace gfxrepro::run
