// NVIDIA's management library (NVML), where the driver brings it: which GPUs there are, and what
// one of them does. Opened at run time; nothing is linked.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace gfxrepro::gl {

/// What one GPU does at a moment; what the driver does not tell is not there.
struct GpuReading {
    std::optional<double> clockHz;     // of its multiprocessors
    std::optional<double> maxClockHz;  // the highest that it can be asked for
    std::optional<double> powerW, powerLimitW;
    std::optional<double> temperatureC;
    std::optional<double> memoryUsedBytes;
    std::optional<double> busyShare;     // of the last fraction of a second, by anyone
    std::vector<std::string> throttled;  // what keeps its clock down, but for idleness
    std::vector<int> processes;          // ids of those that use it, as far as they are seen
};

/// UUIDs, as DeviceInfo has them, in the order of `nvidia-smi -L`; empty without the library.
std::vector<std::string> nvidiaGpus();

/// Nothing for a UUID of no GPU of NVIDIA's, or without the library.
std::optional<GpuReading> readGpu(const std::string& uuid);

}  // namespace gfxrepro::gl
