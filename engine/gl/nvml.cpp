#include "engine/gl/nvml.h"

#include <dlfcn.h>

#include <algorithm>
#include <array>

#include "engine/core/text.h"

namespace gfxrepro::gl {
namespace {

// What is used of nvml.h, whose binary interface is stable: functions by their versioned names.
using NvmlDevice = void*;
using Count = unsigned int;
constexpr int kSuccess = 0;
constexpr int kTooSmall = 7;  // NVML_ERROR_INSUFFICIENT_SIZE
constexpr Count kClockOfMultiprocessors = 1;
constexpr Count kTemperatureOfGpu = 0;

struct Memory {
    unsigned long long totalBytes, freeBytes, usedBytes;
};
struct Utilization {
    Count gpuPercent, memoryPercent;
};
struct Process {
    Count id;
    unsigned long long usedBytes;
    Count gpuInstance, computeInstance;
};

/// Bits of nvmlDeviceGetCurrentClocksThrottleReasons, but for that of idleness (1).
struct ThrottleReason {
    unsigned long long bit;
    const char* name;
};
constexpr std::array<ThrottleReason, 7> kThrottleReasons = {{
    {0x2, "the clocks that applications are set to"},
    {0x4, "its power limit"},
    {0x8, "the hardware"},
    {0x10, "synchronous boost"},
    {0x20, "heat"},
    {0x40, "heat"},
    {0x80, "the power brake"},
}};

/// The library, opened once.
class Nvml {
  public:
    Nvml() : library_(::dlopen("libnvidia-ml.so.1", RTLD_LAZY | RTLD_LOCAL)) {
        if (library_ && call("nvmlInit_v2") != kSuccess) library_ = nullptr;
    }

    /// The function's answer; an error where the library has it not.
    template <class... Arguments>
    int call(const char* name, Arguments... arguments) const {
        if (!library_) return -1;
        const auto function = reinterpret_cast<int (*)(Arguments...)>(::dlsym(library_, name));
        return function ? function(arguments...) : -1;
    }

    /// Of a number that a function writes behind these arguments, in `unit`.
    template <class... Arguments>
    std::optional<double> number(double unit, const char* name, Arguments... arguments) const {
        Count value = 0;
        if (call(name, arguments..., &value) != kSuccess) return std::nullopt;
        return unit * value;
    }

    std::vector<NvmlDevice> devices() const {
        Count count = 0;
        if (call("nvmlDeviceGetCount_v2", &count) != kSuccess) return {};
        std::vector<NvmlDevice> devices;
        for (Count i = 0; i < count; ++i) {
            NvmlDevice device = nullptr;
            if (call("nvmlDeviceGetHandleByIndex_v2", i, &device) == kSuccess) {
                devices.push_back(device);
            }
        }
        return devices;
    }

    /// "GPU-00112233-…" without its beginning, in lower case.
    std::string uuid(NvmlDevice device) const {
        std::array<char, 96> text{};
        const int status =
            call("nvmlDeviceGetUUID", device, text.data(), static_cast<Count>(text.size()));
        std::string uuid = lowerCase(status == kSuccess ? text.data() : "");
        if (uuid.starts_with("gpu-")) uuid.erase(0, 4);
        return uuid;
    }

    void addProcesses(const char* name, NvmlDevice device, std::vector<int>& ids) const {
        Count count = 0;
        if (call(name, device, &count, static_cast<Process*>(nullptr)) != kTooSmall) return;
        std::vector<Process> processes(count + 8);  // some may have begun since
        count = static_cast<Count>(processes.size());
        if (call(name, device, &count, processes.data()) != kSuccess) return;
        for (Count i = 0; i < count; ++i) {
            const int id = static_cast<int>(processes[i].id);
            if (std::ranges::find(ids, id) == ids.end()) ids.push_back(id);
        }
    }

  private:
    void* library_;
};

const Nvml& nvml() {
    static const Nvml library;
    return library;
}

}  // namespace

std::vector<std::string> nvidiaGpus() {
    std::vector<std::string> uuids;
    for (NvmlDevice device : nvml().devices()) uuids.push_back(nvml().uuid(device));
    return uuids;
}

std::optional<GpuReading> readGpu(const std::string& uuid) {
    for (NvmlDevice device : nvml().devices()) {
        if (nvml().uuid(device) != uuid) continue;
        const Nvml& library = nvml();
        GpuReading reading;
        reading.clockHz =
            library.number(1e6, "nvmlDeviceGetClockInfo", device, kClockOfMultiprocessors);
        reading.maxClockHz =
            library.number(1e6, "nvmlDeviceGetMaxClockInfo", device, kClockOfMultiprocessors);
        reading.powerW = library.number(1e-3, "nvmlDeviceGetPowerUsage", device);
        reading.powerLimitW = library.number(1e-3, "nvmlDeviceGetEnforcedPowerLimit", device);
        reading.temperatureC =
            library.number(1.0, "nvmlDeviceGetTemperature", device, kTemperatureOfGpu);
        if (Memory memory{}; library.call("nvmlDeviceGetMemoryInfo", device, &memory) == kSuccess) {
            reading.memoryUsedBytes = static_cast<double>(memory.usedBytes);
        }
        if (Utilization use{};
            library.call("nvmlDeviceGetUtilizationRates", device, &use) == kSuccess) {
            reading.busyShare = 0.01 * use.gpuPercent;
        }
        unsigned long long reasons = 0;
        library.call("nvmlDeviceGetCurrentClocksThrottleReasons", device, &reasons);
        for (const ThrottleReason& reason : kThrottleReasons) {
            if ((reasons & reason.bit) == 0) continue;
            if (std::ranges::find(reading.throttled, reason.name) == reading.throttled.end()) {
                reading.throttled.emplace_back(reason.name);
            }
        }
        library.addProcesses("nvmlDeviceGetComputeRunningProcesses_v3", device, reading.processes);
        library.addProcesses("nvmlDeviceGetGraphicsRunningProcesses_v3", device, reading.processes);
        return reading;
    }
    return std::nullopt;
}

}  // namespace gfxrepro::gl
