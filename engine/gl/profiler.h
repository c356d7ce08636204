// Times of passes: GL_TIMESTAMP pairs on the device, steady clock on the CPU.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/gl/device.h"
#include "engine/gl/gl.h"
#include "engine/gl/objects.h"

namespace gfxrepro::gl {

/// The measured time of one scope.
struct PassTime {
    enum class Clock { Gpu, Cpu };
    std::string pass;
    Clock clock = Clock::Gpu;
    std::optional<double> timeMs = 0.0;  // none by a device without a clock (DeviceTimer)
    double processTimeMs = 0.0;          // CPU time of all threads of the process meanwhile
};

/// CPU time, user and system, that all threads of this process have spent
/// (CLOCK_PROCESS_CPUTIME_ID, POSIX). On a software device it is the work that was done, whoever
/// else wants the cores.
double processTimeMs();

/// From one stamp of the device to the next, which are told modulo 2^bits.
std::uint64_t nsBetween(std::uint64_t first, std::uint64_t second, int bits);

/// Collects scopes of one iteration. On a software device everything is finished before and
/// after each stamp, so that no pass's work is counted with its neighbour (llvmpipe runs vertex
/// work when the draw is called, and rasterizes and takes the stamp at the next flush). So the CPU
/// time of a pass is its own, too.
class Profiler {
  public:
    explicit Profiler(bool isSoftwareDevice, const DeviceTimer& timer = {})
        : isSoftwareDevice_(isSoftwareDevice), timer_(timer) {}
    explicit Profiler(const DeviceInfo& device) : Profiler(device.isSoftware, device.timer) {}

    /// The scopes since the last call, in the order in which they began, scopes of one name and
    /// clock summed. Waits for the device. Throws Error, naming the pass, where the device's clock
    /// ran backwards, stood still, is ahead of the processor's, or, of a software device, behind
    /// it.
    std::vector<PassTime> collect();

  private:
    friend class GpuScope;
    friend class CpuScope;
    struct Entry {
        std::string pass;
        PassTime::Clock clock;
        detail::Name<detail::deleteQuery> begin, end;
        double cpuTimeMs = 0.0;
        double processTimeMs = 0.0;  // less what it was at the begin
        std::chrono::steady_clock::time_point begun = std::chrono::steady_clock::now();
        std::chrono::steady_clock::time_point stamped = {};  // when the first stamp was asked for
        double leastMs = 0.0;  // of a software device, between the stamps
    };
    double gpuTimeMs(const Entry& entry);
    std::size_t beginGpu(std::string_view pass);
    void endGpu(std::size_t entry);

    bool isSoftwareDevice_;
    DeviceTimer timer_;
    std::vector<Entry> entries_;
    std::optional<GLuint64> lastNs_;                  // the last stamp that was read,
    std::chrono::steady_clock::time_point lastRead_;  // and when
};

/// Times the commands issued in its life on the device. Scopes may nest.
class GpuScope {
  public:
    GpuScope(Profiler& profiler, std::string_view pass)
        : profiler_(profiler), entry_(profiler.beginGpu(pass)) {}
    ~GpuScope() { profiler_.endGpu(entry_); }
    GpuScope(const GpuScope&) = delete;
    GpuScope& operator=(const GpuScope&) = delete;

  private:
    Profiler& profiler_;
    std::size_t entry_;
};

/// Times its life on the CPU.
class CpuScope {
  public:
    CpuScope(Profiler& profiler, std::string_view pass);
    ~CpuScope();
    CpuScope(const CpuScope&) = delete;
    CpuScope& operator=(const CpuScope&) = delete;

  private:
    Profiler& profiler_;
    std::size_t entry_;
    std::chrono::steady_clock::time_point begin_;
};

// A name for what is drawn, in the tools that look at OpenGL's commands.

/// The commands issued in its life are a group of that name (KHR_debug); none without a device.
class DebugGroup {
  public:
    DebugGroup(const Device& device, const char* name) : isOn_(!device.isNone()) {
        if (isOn_) glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, -1, name);
    }
    ~DebugGroup() {
        if (isOn_) glPopDebugGroup();
    }
    DebugGroup(const DebugGroup&) = delete;
    DebugGroup& operator=(const DebugGroup&) = delete;

  private:
    bool isOn_;
};

}  // namespace gfxrepro::gl
