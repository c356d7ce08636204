// Runs the units of a plan in worker processes: timing units alone, quality units side by side. Two
// timing units may be loaded and set up side by side; then one draws its frames, and then the
// other.
#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runner/run/phase_clock.h"
#include "runner/run/protocol.h"
#include "runner/run/rounds.h"
#include "runner/run/run_directory.h"
#include "runner/run/worker_handle.h"
#include "runner/technique/technique.h"

namespace gfxrepro::run {

/// Told about progress; called from the thread that runs the scheduler.
class Observer {
  public:
    virtual ~Observer() = default;
    /// A further round was found to be needed.
    virtual void unitsAdded(const std::vector<Unit>&) {}
    virtual void unitBegan(const Unit& unit) = 0;
    /// Also for the unit of each twin that this one was measured for.
    virtual void unitEnded(const Unit& unit, records::Status status,
                           const std::string& message) = 0;
    /// Now and then, for a display that shows time; `phase` is the one that a unit is in, of
    /// several units the first's (protocol.h), empty between two.
    virtual void tick(std::string_view phase) = 0;
};

struct SchedulerOptions {
    std::string device = "auto";  // passed through to the workers
    std::string assetsFolder;
    int jobs = 1;              // quality units at once
    std::string command = {};  // as typed: images say what measured them
    /// Cases, by id, that are not tried (again), and are recorded as crashes with this message.
    std::map<std::string, std::string> givenUp = {};
    int failuresAtMost = 0;                  // with as many failed units the run stops; 0: never
    std::string program = "/proc/self/exe";  // of the workers
    std::size_t mostRecords = records::kMostRecords;
    /// Experiments whose timing units may be loaded and set up two at once: their times of frames
    /// are all that their tables show.
    std::set<std::string> preparedInPairs = {};
};

/// Those of the plan: each shows by a layout what it measures, and no time of set-up. None of a
/// program, whose run is its frame.
std::set<std::string> preparedInPairs(const Plan& plan,
                                      std::span<const technique::TechniqueInfo> techniques);

struct RunOutcome {
    int begun = 0;     // units, those of further rounds too
    int finished = 0;  // units that ended `ok` or `flaky`
    int flaky = 0;     // of these
    int shared = 0;    // of these: recorded from a twin's measurement
    int voided = 0;    // likewise, but their times are void: blank pictures or unequal work
    int failed = 0;    // others
    std::set<std::string> warnings;          // of units
    std::vector<std::string> timeWarnings;   // of tables
    bool isInterrupted = false;              // by SIGINT, SIGTERM or SIGHUP
    std::string stopReason;                  // of a stop before the end that nobody asked for then
    bool isFull = false;                     // of these: the run's files take no more
    std::map<std::string, SceneUse> scenes;  // by their references
    std::set<ProgramUse> programs;
};

/// The command of a worker process: this program, with `worker` and the options.
std::vector<std::string> workerCommand(const SchedulerOptions& options, config::Measure::Lane lane,
                                       const std::filesystem::path& runDir);

/// Starts a worker for a moment to ask what the device is; a driver that crashes does not take the
/// runner with it. Throws NoDeviceError.
gl::DeviceInfo probeDevice(const SchedulerOptions& options, PhaseClock& phases);

/// Runs `units` and the further rounds that `rounds` asks for, appending records, images and
/// journal lines as each ends. Of units that are twins the first is run and recorded for each. A
/// failure is tried once more, in a fresh worker; what passes then is `flaky`, unless the first
/// worker was killed from outside. Throws Error where a file of the run cannot be written, be it a
/// worker's: the unit has no rows then, and a run that goes on measures it as new.
RunOutcome runUnits(const std::vector<Unit>& units, Rounds& rounds, const RunDirectory& directory,
                    const SchedulerOptions& options, PhaseClock& phases, Observer& observer);

/// The rows of one unit: a row a sample, or one row with the status.
std::vector<records::Record> recordsOf(const Unit& unit, const CaseResult& result);

}  // namespace gfxrepro::run
