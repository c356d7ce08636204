// One worker, seen from the runner: what it is doing and how it ended.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runner/run/child_process.h"
#include "runner/run/phase_clock.h"
#include "runner/run/plan.h"
#include "runner/run/protocol.h"

namespace gfxrepro::run {

using UnitKey = std::pair<std::string, int>;  // case id, process

/// One execution of a case: the unit of work. With `processes: n` a case has n of them.
struct Unit {
    const Case* item = nullptr;
    int process = 0;
    /// How the first try ended, when this is the second. There may be a million units.
    std::shared_ptr<const CaseResult> firstTry;
    /// Twins of the case (twins.h) for which its rows are recorded, too.
    std::vector<const Case*> twins = {};
    /// In the unit of a twin, which no worker gets: the case that was measured.
    const Case* measuredAs = nullptr;
};

/// A worker process and the unit that it is on.
class WorkerHandle {
  public:
    using Clock = PhaseClock::Clock;

    /// Starts the process; `isSingleUse` workers are not given a second unit.
    WorkerHandle(const std::vector<std::string>& command, config::Measure::Lane lane,
                 bool isSingleUse, PhaseClock& phases);
    ~WorkerHandle();
    WorkerHandle(const WorkerHandle&) = delete;
    WorkerHandle& operator=(const WorkerHandle&) = delete;

    const ChildProcess& process() const { return process_; }
    config::Measure::Lane lane() const { return lane_; }
    bool isSingleUse() const { return isSingleUse_; }
    /// For opening a device: 60 s, or the environment's GFXREPRO_START_LIMIT_S. Throws UsageError
    /// when that is no number of seconds.
    static std::chrono::seconds startLimit();
    /// The process has ended.
    bool isGone() const { return !isAlive_; }
    /// Why it ended before it was ready.
    std::string startProblem() const;
    bool isBusy() const { return unit_.has_value(); }
    const std::optional<Unit>& unit() const { return unit_; }
    /// Of the unit that it is on, or had last; empty for none.
    const std::string& scene() const { return scene_; }
    /// What it does of it: "load", "render"; empty between two.
    const std::string& phase() const { return phase_; }
    const std::optional<gl::DeviceInfo>& device() const { return device_; }
    /// What the present case wrote to standard output and error (the last 64 KiB).
    const std::string& output() const { return output_; }

    /// The unit is sent as soon as the worker is ready; its time limit runs from there. One that
    /// waits draws no frame before mayRender(), and the limit does not run while it waits.
    void assign(const Unit& unit, bool waits = false);
    /// Whether its case is loaded and set up, and waits for mayRender().
    bool isPrepared() const { return preparedSince_.has_value(); }
    /// Whether it is on a unit that has not come to its frames yet, as it has to wait for them.
    bool isPreparing() const { return isBusy() && waits_ && !isPrepared(); }
    void mayRender();

    /// Reads what has arrived. A result when the unit is over — done, or failed because the worker
    /// is gone.
    std::optional<CaseResult> receive();
    /// Kills the worker when the unit broke its time limit, and gives that result.
    std::optional<CaseResult> checkLimits(Clock::time_point now);
    /// For a time in which the runner itself did not run: nor, most likely, did the worker.
    void postpone(Clock::duration gap);
    /// When checkLimits() should be called again.
    Clock::time_point nextCheck(Clock::time_point now) const;

    /// Takes the unit away after its result; false when the worker can take no more.
    bool release(const CaseResult& result);

  private:
    std::optional<CaseResult> handleLines();
    std::optional<CaseResult> handle(const Json& message);
    CaseResult endAsBroken(const std::string& why);
    void begin(const std::string& phase);
    void endPhase();
    void sendUnit();
    void allowForSuspension(Clock::time_point now);
    CaseResult resultOfDeath() const;
    std::string lastOutputLine() const;

    PhaseClock& phases_;
    ChildProcess process_;
    config::Measure::Lane lane_;
    bool isSingleUse_;
    std::optional<Unit> unit_;
    std::string scene_;
    std::optional<gl::DeviceInfo> device_;
    std::string unavailable_;  // why there is no device
    bool isAlive_ = true;
    bool isSent_ = true;  // to the end of the unit
    bool waits_ = false;  // until mayRender()
    std::optional<Clock::time_point> preparedSince_ = {};
    long long oomKillsBefore_;  // of the system, when the process began
    int waitStatus_ = 0;        // once it is not alive
    bool isStuck_ = false;      // likewise: it could not be killed
    bool isEndless_ = false;    // likewise: its answer was longer than any
    std::chrono::seconds startLimit_;
    Clock::time_point limit_;                    // of the start, then of the unit
    Clock::time_point lastLook_ = Clock::now();  // of checkLimits()
    bool isSuspended_ = false;                   // the worker alone, at the last look
    Clock::duration suspended_{};                // by which the limit has moved for it
    std::string phase_;                          // empty between phases
    Clock::time_point phaseBegin_;
    std::string messages_;           // what has come of lines without their end
    std::size_t searchedBytes_ = 0;  // of them, without a line's end
    std::string output_;
};

}  // namespace gfxrepro::run
