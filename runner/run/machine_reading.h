// What Linux tells of the machine at one moment: who used the processors, how hot they are, and
// whether they were slowed.
#pragma once

#include <filesystem>
#include <optional>

namespace gfxrepro::run {

/// The hottest part of the machine, as far as it is from where the kernel begins to slow it.
struct Heat {
    double temperatureC = 0.0;
    double limitC = 0.0;  // the lowest trip point, or 5 °C below the critical one, or 95 °C
};

/// What the kernel tells at one moment. All seconds are since it began to count; what it does not
/// tell (in a container, say) is not there.
struct MachineReading {
    struct Processors {
        int count = 0;
        double timeS = 0.0;  // of all together, idle or not
        double busyS = 0.0;
        double stolenS = 0.0;  // that the host of a virtual machine gave to others
    };
    std::optional<Processors> processors;  // /proc/stat
    double ownS = 0.0;  // processor time of this process and its workers, with what these ran
    std::optional<double> waitedS;  // in which some task, ours too, waited for a processor
    std::optional<double> load;     // tasks that run or wait, ours too: mean of the last minute
    std::optional<long long> throttleCount;  // times that a core was slowed for its heat
    std::optional<double> limitedS;          // that our control group was held by its limit
    std::optional<Heat> heat;
    std::optional<double> clockHz;  // of the fastest core
};

/// `root` stands for /, in tests another folder. Reads some small files: a fraction of a
/// millisecond.
MachineReading readMachine(const std::filesystem::path& root = "/");

/// Whether the other is nearer to its limit, or further beyond it; anything is hotter than nothing.
bool isHotter(const std::optional<Heat>& one, const Heat& other);

}  // namespace gfxrepro::run
