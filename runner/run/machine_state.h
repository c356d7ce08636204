// What Linux tells of the machine at one moment (machine_reading.cpp), and what else the machine
// did while cases were timed: the work of others, processor time that a virtual machine's host
// took, throttling, heat; and what the GPU did.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/gl/nvml.h"
#include "runner/run/protocol.h"
#include "runner/run/run_directory.h"
#include "runner/run/scheduler.h"
#include "runner/tables/table.h"

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
    std::optional<long long> throttleCount;  // times that a core was slowed for its heat
    std::optional<double> limitedS;          // that our control group was held by its limit
    std::optional<Heat> heat;
};

/// `root` stands for /, in tests another folder. Reads some small files: a fraction of a
/// millisecond.
MachineReading readMachine(const std::filesystem::path& root = "/");

/// Whether the other is nearer to its limit, or further beyond it; anything is hotter than nothing.
bool isHotter(const std::optional<Heat>& one, const Heat& other);

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

/// What the machine did over stretches of time. Shares are of the time of all processors.
class MachineState {
  public:
    void add(const MachineReading& before, const MachineReading& after);
    void add(const MachineState& other);
    void add(const GpuState& gpu) { gpu_.add(gpu); }
    /// Of a unit of that case.
    void add(const std::string& caseId, const MachineState& unit);

    bool isKnown() const {
        return processorS_ > 0.0 || throttleCount_ || limitedS_ || heat_ || gpu_.isKnown();
    }
    /// {"processors", "processor_s", "busy_s", "own_s", "stolen_s", "throttle_count", "limited_s",
    /// "hottest_c", "hot_from_c", "gpu", "gpu_clock_moved": {case: {"lowest_clock_hz",
    /// "highest_clock_hz"}}}: of these what is known.
    Json json() const;
    static MachineState fromJson(const Json& json);

    /// "other processes took 38 % of 2 processors": how the machine was no quiet one; empty where
    /// it was. Others are counted from 5 % on, stolen time from 1 % on (less is what any system
    /// does of itself), each from 0.2 s on, as the kernel counts by ticks.
    std::vector<std::string> problems() const;
    /// One sentence of it, with numbers also where nothing was wrong; empty where nothing is known.
    std::string sentence() const;

  private:
    double othersS() const;
    friend tables::MovedClocks movedClocks(const Json& manifest);

    int processorCount_ = 0;
    double processorS_ = 0.0, busyS_ = 0.0, ownS_ = 0.0, stolenS_ = 0.0;
    std::optional<double> limitedS_;
    std::optional<long long> throttleCount_;
    std::optional<Heat> heat_;
    GpuState gpu_;
    std::map<std::string, GpuState> cases_;  // of each case alone
};

/// Watches the machine around each unit of the timing lane, and passes on what a run tells. The
/// state of each unit is a line of journal.jsonl (event `machine_state`), the states of a table's
/// units together are its state.
class MachineWatch : public Observer {
  public:
    /// Of a run with these states so far (machineStatesIn). `next` and the folder must outlive it;
    /// `root` as readMachine's; `gpu` reads the GPU, where it can be read.
    MachineWatch(Observer& next, const RunDirectory& directory,
                 std::map<std::string, MachineState> states, std::filesystem::path root,
                 std::function<std::optional<gl::GpuReading>()> gpu)
        : next_(next),
          directory_(directory),
          root_(std::move(root)),
          gpu_(std::move(gpu)),
          tables_(std::move(states)) {}

    void unitsAdded(const std::vector<Unit>& units) override { next_.unitsAdded(units); }
    void unitBegan(const Unit& unit) override;
    void unitEnded(const Unit& unit, records::Status status, const std::string& message) override;
    /// The GPU is read while a unit runs: behind it, it rests.
    void tick(std::string_view phase) override;

    /// By table, of those that are known: for the manifest.
    Json states() const;
    /// One sentence of what was wrong, table by table; empty where nothing was.
    std::string warning() const;

  private:
    void readGpu(bool isTimed);

    Observer& next_;
    const RunDirectory& directory_;
    std::filesystem::path root_;
    std::function<std::optional<gl::GpuReading>()> gpu_;
    std::optional<MachineReading> before_;
    GpuState gpuState_;      // of the unit that runs
    bool wasTimed_ = false;  // what ran when the GPU was read last
    MachineState state_;     // of the unit that ended last
    std::map<std::string, MachineState> tables_;
};

/// By table, from the lines of journal.jsonl; of a table that was measured again on another machine
/// what came after.
std::map<std::string, MachineState> machineStatesIn(const std::vector<Json>& journal);

/// Of which cases, by the manifest, the GPU's clock moved while they were timed.
tables::MovedClocks movedClocks(const Json& manifest);

/// What the manifest tells of the machine while the table was timed; empty for none.
std::string machineStateNote(const Json& manifest, const std::string& table);

}  // namespace gfxrepro::run
