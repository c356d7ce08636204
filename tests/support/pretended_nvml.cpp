// In the place of NVIDIA's libnvidia-ml.so.1 (LD_LIBRARY_PATH): a machine of two GPUs of which the
// second is that of pretended_gpu.cpp. Its clock takes turns of PRETENDED_CLOCKS_MHZ ("1980 1410"),
// PRETENDED_THROTTLE are the bits that hold it down; the process with id 1 uses it, too.
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <vector>

namespace {

using Count = unsigned int;
constexpr int kSuccess = 0;
constexpr int kTooSmall = 7;

Count environment(const char* name, Count otherwise) {
    const char* text = std::getenv(name);
    return text ? static_cast<Count>(std::strtoul(text, nullptr, 0)) : otherwise;
}

Count nextClock() {
    static std::size_t turn = 0;
    const char* text = std::getenv("PRETENDED_CLOCKS_MHZ");
    std::istringstream stream(text ? text : "1980");
    std::vector<Count> clocks;
    for (Count clock = 0; stream >> clock;) clocks.push_back(clock);
    return clocks[turn++ % clocks.size()];
}

}  // namespace

#define EXPORTED extern "C" __attribute__((visibility("default"))) int

EXPORTED nvmlInit_v2() {
    return kSuccess;
}

EXPORTED nvmlDeviceGetCount_v2(Count* count) {
    *count = 2;
    return kSuccess;
}

EXPORTED nvmlDeviceGetHandleByIndex_v2(Count index, void** device) {
    static int devices[2];
    *device = &devices[index];
    devices[index] = static_cast<int>(index);
    return kSuccess;
}

EXPORTED nvmlDeviceGetUUID(void* device, char* text, Count size) {
    const bool isFirst = *static_cast<int*>(device) == 0;
    std::strncpy(text,
                 isFirst ? "GPU-ffffffff-4455-6677-8899-AABBCCDDEEFF"
                         : "GPU-00112233-4455-6677-8899-aabbccddeeff",
                 size);
    return kSuccess;
}

EXPORTED nvmlDeviceGetClockInfo(void*, Count, Count* megahertz) {
    *megahertz = nextClock();
    return kSuccess;
}

EXPORTED nvmlDeviceGetMaxClockInfo(void*, Count, Count* megahertz) {
    *megahertz = 2100;
    return kSuccess;
}

EXPORTED nvmlDeviceGetPowerUsage(void*, Count* milliwatts) {
    *milliwatts = 210'000;
    return kSuccess;
}

EXPORTED nvmlDeviceGetTemperature(void*, Count, Count* celsius) {
    *celsius = 64;
    return kSuccess;
}

struct Utilization {
    Count gpuPercent, memoryPercent;
};
EXPORTED nvmlDeviceGetUtilizationRates(void*, Utilization* use) {
    *use = {98, 40};
    return kSuccess;
}

EXPORTED nvmlDeviceGetCurrentClocksThrottleReasons(void*, unsigned long long* reasons) {
    *reasons = environment("PRETENDED_THROTTLE", 0);
    return kSuccess;
}

struct Process {
    Count id;
    unsigned long long usedBytes;
    Count gpuInstance, computeInstance;
};
EXPORTED nvmlDeviceGetComputeRunningProcesses_v3(void*, Count* count, Process* processes) {
    const Count wanted = environment("PRETENDED_USERS", 0);
    const bool fits = *count >= wanted;
    if (wanted > 0 && (!processes || !fits)) {
        *count = wanted;
        return kTooSmall;
    }
    for (Count i = 0; i < wanted; ++i) processes[i] = {i + 1, 1 << 20, 0, 0};
    *count = wanted;
    return kSuccess;
}
