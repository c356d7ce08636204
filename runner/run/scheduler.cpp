#include "runner/run/scheduler.h"

#include <poll.h>
#include <signal.h>
#include <sys/signalfd.h>
#include <unistd.h>
#include <algorithm>
#include <deque>
#include <iterator>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string_view>

#include "runner/run/twins.h"

namespace gfxrepro::run {

namespace {

using Lane = config::Measure::Lane;
using Clock = PhaseClock::Clock;
constexpr std::chrono::milliseconds kTickInterval{250};
constexpr std::chrono::seconds kSuspended{1};  // nothing but a suspended runner oversleeps so long

/// Ctrl-C, SIGTERM and the terminal's end (unless ignored: nohup) as a descriptor to poll.
class SignalWatch {
  public:
    SignalWatch() {
        sigset_t signals;
        sigemptyset(&signals);
        sigaddset(&signals, SIGINT);
        sigaddset(&signals, SIGTERM);
        struct sigaction hangUp = {};
        ::sigaction(SIGHUP, nullptr, &hangUp);
        if (hangUp.sa_handler != SIG_IGN) sigaddset(&signals, SIGHUP);
        ::sigprocmask(SIG_BLOCK, &signals, &before_);
        fd_ = ::signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK);
    }
    ~SignalWatch() {
        for (signalfd_siginfo ignored; ::read(fd_, &ignored, sizeof(ignored)) > 0;) {
        }
        ::close(fd_);
        ::sigprocmask(SIG_SETMASK, &before_, nullptr);
    }
    SignalWatch(const SignalWatch&) = delete;
    SignalWatch& operator=(const SignalWatch&) = delete;
    int fd() const { return fd_; }

  private:
    sigset_t before_;
    int fd_;
};

CaseResult notTried(const std::string& why) {
    CaseResult result;
    result.status = records::Status::Crash;
    result.message = why;
    return result;
}

/// The second try tells the result; the first one may still show in its status and message.
CaseResult inViewOfFirstTry(const Unit& unit, CaseResult result) {
    if (!unit.firstTry || unit.firstTry->isOutsideKill) return result;
    const std::string first = std::string(records::statusName(unit.firstTry->status)) +
                              (unit.firstTry->message.empty() ? "" : ": ") + unit.firstTry->message;
    if (result.status == records::Status::Ok) {
        result.status = records::Status::Flaky;
        result.message = "passed at the second try; the first: " + first;
    } else if (result.status != unit.firstTry->status) {
        result.message += "; the first try: " + first;
    }
    return result;
}

class Scheduler {
  public:
    Scheduler(const std::vector<Unit>& units, Rounds& rounds, const RunDirectory& directory,
              const SchedulerOptions& options, PhaseClock& phases, Observer& observer)
        : waiting_(units.begin(), units.end()),
          rounds_(rounds),
          directory_(directory),
          options_(options),
          phases_(phases),
          observer_(observer),
          images_(directory.path()),
          records_(directory.recordsFile(), options.mostRecords) {
        Cases cases;
        for (const Unit& unit : units) cases.insert(unit.item);
        workKeys_ = keysOfTwins(cases);
        // A table that takes another's times waits for them.
        const std::map<std::string, std::string> lenders = lendersOfTimes(cases);
        std::ranges::stable_partition(
            waiting_, [&](const Unit& unit) { return !lenders.contains(unit.item->experiment); });
    }

    RunOutcome run() {
        try {
            runAll();
        } catch (const records::FullError& error) {
            outcome_.stopReason = error.what();
            outcome_.isFull = true;
        } catch (const Error& error) {
            noteEndBy(error);
            throw;
        }
        workers_.clear();
        images_.requireOurs();
        records_.requireOurs();
        outcome_.timeWarnings = rounds_.warnings();
        return std::move(outcome_);
    }

  private:
    void runAll() {
        while (true) {
            dispatch();
            giveTurn();
            if (waiting_.empty() && busyCount() == 0) break;
            if (waitForEvents()) {
                outcome_.isInterrupted = true;
                break;
            }
            collect();
            const auto active = std::ranges::find_if(
                workers_, [](auto& w) { return w->isBusy() && !w->isPrepared(); });
            observer_.tick(active == workers_.end() ? "" : (*active)->phase());
            if (!outcome_.stopReason.empty()) break;
        }
    }

    /// What is under way did not take the runner with it, and is not held against its cases.
    void noteEndBy(const Error& error) const {
        try {
            directory_.note({{"event", "interrupted"}, {"message", error.what()}});
        } catch (const Error&) {  // the folder is gone: `error` says so
        }
    }

    int busyCount() const {
        return static_cast<int>(
            std::ranges::count_if(workers_, [](auto& w) { return w->isBusy(); }));
    }

    /// Whether a unit waits. When none does and none runs, another round of each table of times
    /// that still needs one.
    bool hasNext() {
        if (waiting_.empty() && busyCount() == 0) {
            for (const std::string& table : rounds_.undecided()) addRound(table);
        }
        return !waiting_.empty();
    }

    /// Puts the next round of a table last; or says in the journal why there is none.
    void addRound(const std::string& table) {
        const std::vector<Unit> more = rounds_.next(table);
        if (more.empty()) {
            Json event = {{"event", "rounds"}};
            event.update(rounds_.ending(table));
            directory_.note(event);
            return;
        }
        waiting_.insert(waiting_.end(), more.begin(), more.end());
        observer_.unitsAdded(more);
    }

    /// Gives out units in order, as far as the lanes allow.
    void dispatch() {
        while (hasNext()) {
            const auto next = nextUnit();
            const auto givenUp = options_.givenUp.find(next->item->id);
            if (givenUp != options_.givenUp.end()) {
                finish(*next, notTried(givenUp->second), "", "given_up");
                waiting_.erase(next);
                continue;
            }
            if (!mayStart(*next)) return;
            directory_.requireRoom();
            Unit unit = std::move(*next);
            waiting_.erase(next);
            takeTwins(unit);
            start(unit);
        }
    }

    static bool needsOwn(const Unit& unit) {
        return unit.item->measure.processes > 1 || unit.firstTry;
    }

    /// The first that waits. Of those side by side that wait next, rather one of the scene that the
    /// free worker had last, or of one that no other worker is on: cases of a scene share results,
    /// those of several tables, too.
    std::deque<Unit>::iterator nextUnit() {
        constexpr std::ptrdiff_t kMostLookedAt = 64;
        const auto front = waiting_.begin();
        const bool isAlone = options_.jobs == 1 || options_.failuresAtMost > 0;
        if (isAlone || front->item->measure.lane == Lane::Timing || needsOwn(*front)) return front;
        const auto end = std::find_if(
            front, front + std::min(std::ssize(waiting_), kMostLookedAt), [&](const Unit& unit) {
                return unit.item->measure.lane == Lane::Timing || needsOwn(unit);
            });
        std::set<std::string> others;
        const WorkerHandle* resting = nullptr;
        for (const auto& worker : workers_) {
            if (worker->isBusy()) others.insert(worker->scene());
            if (!worker->isBusy() && !resting) resting = worker.get();
        }
        const auto first = [&](const auto& suits) { return std::find_if(front, end, suits); };
        auto next = first([&](const Unit& unit) {
            return resting && unit.item->recordedScene() == resting->scene();
        });
        if (next == end) {
            next = first(
                [&](const Unit& unit) { return !others.contains(unit.item->recordedScene()); });
        }
        return next == end ? front : next;
    }

    bool mayStart(const Unit& unit) const {
        const int busy = busyCount();
        const auto isBusyTiming = [](auto& w) { return w->isBusy() && w->lane() == Lane::Timing; };
        const auto timing = std::ranges::find_if(workers_, isBusyTiming);
        if (unit.item->measure.lane == Lane::Quality) {
            return timing == workers_.end() && busy < options_.jobs;
        }
        const bool hasPartner = busy == 1 && timing != workers_.end() && (*timing)->isPreparing();
        return busy == 0 || (hasPartner && isPaired(unit));
    }

    /// A second try is alone: a first may have failed for the memory of two.
    bool isPaired(const Unit& unit) const {
        return unit.item->measure.lane == Lane::Timing && !unit.firstTry &&
               options_.preparedInPairs.contains(unit.item->experiment);
    }

    /// Of timing units that are prepared the first one draws its frames, when nothing else runs.
    void giveTurn() {
        const auto isRunning = [](auto& w) { return w->isBusy() && !w->isPrepared(); };
        if (std::ranges::any_of(workers_, isRunning)) return;
        const auto next = std::ranges::find_if(workers_, [](auto& w) { return w->isPrepared(); });
        if (next == workers_.end()) return;
        begin(*(*next)->unit());
        (*next)->mayRender();
    }

    void begin(const Unit& unit) {
        rounds_.begin(unit.item->experiment, Clock::now());
        observer_.unitBegan(unit);
    }

    /// Moves the waiting twins of the unit into it.
    void takeTwins(Unit& unit) {
        const auto key = workKeys_.find(unit.item);
        if (key == workKeys_.end()) return;
        for (auto other = waiting_.begin(); other != waiting_.end();) {
            const auto otherKey = workKeys_.find(other->item);
            const bool isTwin = otherKey != workKeys_.end() && otherKey->second == key->second &&
                                other->process == unit.process;
            if (isTwin) unit.twins.push_back(other->item);
            other = isTwin ? waiting_.erase(other) : std::next(other);
        }
        const auto withPictures =
            std::ranges::find_if(unit.twins, [](const Case* twin) { return savesPictures(*twin); });
        if (!savesPictures(*unit.item) && withPictures != unit.twins.end()) {
            std::swap(unit.item, *withPictures);
        }
    }

    void start(const Unit& unit) {
        const Lane lane = unit.item->measure.lane;
        const bool isOwn = needsOwn(unit);
        if (busyCount() == 0) rounds_.begin(unit.item->experiment, Clock::now());
        // Nothing beside a timing unit, and no memory held by the other lane.
        std::erase_if(workers_, [&](auto& w) {
            return !w->isBusy() && (w->lane() != lane || (lane == Lane::Timing && isOwn));
        });
        auto worker = std::find_if(workers_.begin(), workers_.end(),
                                   [&](auto& w) { return !isOwn && !w->isBusy(); });
        if (worker == workers_.end()) {
            workers_.push_back(std::make_unique<WorkerHandle>(
                workerCommand(options_, lane, directory_.path()), lane, isOwn, phases_));
            worker = std::prev(workers_.end());
        }
        // On the disk before it runs: what takes the machine with it is known afterwards.
        directory_.noteFlushed(
            {{"event", "start"}, {"case", unit.item->id}, {"process", unit.process}});
        (*worker)->assign(unit, isPaired(unit));
        if (!isPaired(unit)) begin(unit);
    }

    /// Now. Limits move by the time since `due`, when it should have looked at its workers again,
    /// where that is long: the runner was suspended, or waited for a disk.
    Clock::time_point look(Clock::time_point due) {
        const Clock::time_point now = Clock::now();
        if (now - due > kSuspended) {
            for (const auto& worker : workers_) {
                if (worker) worker->postpone(now - due);
            }
        }
        return lastLook_ = now;
    }

    /// Sleeps until a worker says something or a limit is due; true on Ctrl-C.
    bool waitForEvents() {
        const Clock::time_point now = look(lastLook_);
        Clock::time_point until = now + kTickInterval;
        std::vector<pollfd> fds = {{signals_.fd(), POLLIN, 0}};
        for (const auto& worker : workers_) {
            until = std::min(until, worker->nextCheck(now));
            fds.push_back({worker->process().messageFd(), POLLIN, 0});
            fds.push_back({worker->process().outputFd(), POLLIN, 0});
        }
        const auto timeoutMs = std::chrono::ceil<std::chrono::milliseconds>(until - now).count();
        ::poll(fds.data(), fds.size(), static_cast<int>(std::max<long long>(timeoutMs, 0)));
        look(std::max(until, now));
        return (fds.front().revents & POLLIN) != 0;
    }

    void collect() {
        for (auto& worker : workers_) {
            std::optional<CaseResult> result = worker->receive();
            if (!result) result = worker->checkLimits(look(lastLook_));
            if (!result) continue;
            if (result->isUnwritable) throw WriteError(result->message);
            const Unit unit = *worker->unit();
            if (isTriedAgain(unit, *result)) {
                logCase("retry", unit, *result, worker->output());
                waiting_.push_front({unit.item, unit.process,
                                     std::make_shared<const CaseResult>(*result), unit.twins});
            } else {
                finish(unit, inViewOfFirstTry(unit, *result), worker->output());
            }
            if (!worker->release(*result)) worker.reset();
        }
        std::erase(workers_, nullptr);
        std::erase_if(workers_, [](auto& w) { return w->isGone(); });
    }

    static bool isTriedAgain(const Unit& unit, const CaseResult& result) {
        return !unit.firstTry && result.status != records::Status::Ok &&
               result.status != records::Status::Unsupported;
    }

    /// What a technique, a loader or a driver warned of while the unit ran.
    void noteWarnings(const std::string& output) {
        constexpr std::string_view kMark = "warning: ";
        std::istringstream lines(output);
        for (std::string line; std::getline(lines, line);) {
            if (line.starts_with(kMark)) outcome_.warnings.insert(line.substr(kMark.size()));
        }
    }

    void logCase(const char* name, const Unit& unit, const CaseResult& result,
                 const std::string& output) const {
        Json event = {{"event", name},
                      {"case", unit.item->id},
                      {"title", unit.item->title()},
                      {"process", unit.process},
                      {"status", records::statusName(result.status)}};
        if (unit.measuredAs) event["as"] = unit.measuredAs->title();
        if (unit.measuredAs && unit.item->measure.lane == Lane::Timing) {
            event["times_of"] = unit.measuredAs->experiment;
        }
        if (result.status == records::Status::Ok || result.status == records::Status::Flaky) {
            event["cost"] = toJson(result.cost);
        }
        if (!result.message.empty()) event["message"] = result.message;
        if (!output.empty()) event["output"] = output;
        directory_.note(event);
    }

    void finish(const Unit& unit, const CaseResult& result, const std::string& output,
                const char* event = "case") {
        rounds_.end(unit.item->experiment, Clock::now(), result.cost.onceS);
        noteWarnings(output);
        record(unit, result, output, event);
        for (const Case* twin : unit.twins) {
            record({twin, unit.process, {}, {}, unit.item}, result, "", event);
        }
        noteFailure(result.status);
        outcome_.voided += result.voidReason.empty() ? 0 : 1;
        for (const SceneUse& use : result.scenes)
            outcome_.scenes.insert_or_assign(use.reference, use);
        outcome_.programs.insert(result.programs.begin(), result.programs.end());
    }

    /// Stops the run where the machine cannot be trusted any more, or as often as was asked for.
    void noteFailure(records::Status status) {
        lostInARow_ = status == records::Status::DeviceLost ? lostInARow_ + 1 : 0;
        if (lostInARow_ >= 2) {
            outcome_.stopReason = "the device was lost in two cases in a row";
        } else if (options_.failuresAtMost > 0 && outcome_.failed >= options_.failuresAtMost) {
            outcome_.stopReason = std::to_string(outcome_.failed) + " failed";
        }
    }

    /// Images first: a unit whose rows are there is complete.
    void record(const Unit& unit, const CaseResult& result, const std::string& output,
                const char* event) {
        directory_.requireOurs();
        const bool hasValues =
            result.status == records::Status::Ok || result.status == records::Status::Flaky;
        const std::vector<records::ImageEntry> images =
            unit.measuredAs && hasValues
                ? shareFiles(directory_.path(), *unit.measuredAs, *unit.item, result.images)
                : result.images;
        const std::vector<records::Record> rows = recordsOf(unit, result);
        images_.requireRoom(images);
        records_.requireRoom(rows);
        images_.append(images);
        records_.append(rows);
        rounds_.add(rows);
        rounds_.takenFrom(*unit.item, unit.measuredAs ? unit.measuredAs->experiment : "");
        logCase(event, unit, result, output);
        count(unit, result.status);
        observer_.unitEnded(unit, result.status, result.message);
    }

    void count(const Unit& unit, records::Status status) {
        ++outcome_.begun;
        if (status == records::Status::Ok || status == records::Status::Flaky) {
            ++outcome_.finished;
            if (unit.measuredAs) ++outcome_.shared;
            if (status == records::Status::Flaky) ++outcome_.flaky;
        } else {
            ++outcome_.failed;
        }
    }

    SignalWatch signals_;
    std::deque<Unit> waiting_;
    std::map<const Case*, std::string> workKeys_;  // of cases that have twins
    Rounds& rounds_;
    const RunDirectory& directory_;
    const SchedulerOptions& options_;
    PhaseClock& phases_;
    Observer& observer_;
    records::ImageWriter images_;
    records::RecordWriter records_;
    std::vector<std::unique_ptr<WorkerHandle>> workers_;
    Clock::time_point lastLook_ = Clock::now();
    int lostInARow_ = 0;  // units that ended device-lost
    RunOutcome outcome_;
};

}  // namespace

std::vector<std::string> workerCommand(const SchedulerOptions& options, Lane lane,
                                       const std::filesystem::path& runDir) {
    return {options.program, "worker",
            "--device",      options.device,
            "--assets",      options.assetsFolder,
            "--lane",        lane == Lane::Timing ? "timing" : "quality",
            "--run",         runDir.string(),
            "--command",     options.command,
            "--jobs",        std::to_string(options.jobs)};
}

namespace {

/// Whether a cell of the table may show a time of set-up.
bool showsSetup(const config::Layout& layout, const config::Outputs& outputs) {
    const auto isOfSetup = [](const auto& infos, const std::string& name) {
        return std::ranges::any_of(
            infos, [&](const auto& info) { return info.isOfSetup && info.name == name; });
    };
    const auto shows = [&](const config::Selection& selection) {
        std::vector<std::string> metrics = {selection.metric.value_or("")};
        if (selection.equal) metrics.push_back(selection.equal->metric);
        return std::ranges::any_of(metrics, std::bind_front(isOfSetup, outputs.metrics)) ||
               isOfSetup(outputs.passes, selection.pass.value_or(""));
    };
    if (shows(layout.cell)) return true;
    for (const auto* axes : {&layout.rows, &layout.columns}) {
        for (const config::LayoutAxis& axis : *axes) {
            for (const auto& [label, selection] : axis.labels) {
                if (shows(selection)) return true;
            }
        }
    }
    return false;
}

}  // namespace

std::set<std::string> preparedInPairs(const Plan& plan,
                                      std::span<const technique::TechniqueInfo> techniques) {
    std::set<std::string> programs, pairs;
    for (const Case& item : plan.cases) {
        if (!item.program.isNull()) programs.insert(item.experiment);
    }
    for (const config::Experiment& experiment : plan.experiments) {
        if (!experiment.layout.isGiven || programs.contains(experiment.id)) continue;
        if (!config::isMeasuredHere(experiment)) continue;
        const technique::TechniqueInfo& info =
            technique::findTechnique(techniques, experiment.technique, {});
        const bool isShown = showsSetup(experiment.layout, technique::outputsOf(info));
        if (!isShown) pairs.insert(experiment.id);
    }
    return pairs;
}

gl::DeviceInfo probeDevice(const SchedulerOptions& options, PhaseClock& phases) {
    WorkerHandle worker(workerCommand(options, Lane::Quality, "."), Lane::Quality, true, phases);
    const Clock::time_point limit = Clock::now() + WorkerHandle::startLimit();
    while (!worker.device() && !worker.isGone()) {
        pollfd fds[] = {{worker.process().messageFd(), POLLIN, 0},
                        {worker.process().outputFd(), POLLIN, 0}};
        const auto leftMs =
            std::chrono::ceil<std::chrono::milliseconds>(limit - Clock::now()).count();
        if (leftMs <= 0) {
            throw NoDeviceError("the driver did not open a device within " +
                                std::to_string(WorkerHandle::startLimit().count()) + " s");
        }
        ::poll(fds, 2, static_cast<int>(leftMs));
        worker.receive();
    }
    if (worker.device()) return *worker.device();
    throw NoDeviceError(worker.startProblem());
}

RunOutcome runUnits(const std::vector<Unit>& units, Rounds& rounds, const RunDirectory& directory,
                    const SchedulerOptions& options, PhaseClock& phases, Observer& observer) {
    return Scheduler(units, rounds, directory, options, phases, observer).run();
}

std::vector<records::Record> recordsOf(const Unit& unit, const CaseResult& result) {
    const Case& item = *unit.item;
    records::Record row;
    row.caseId = item.id;
    row.table = item.experiment;
    row.technique = item.technique;
    row.method = item.method();
    row.scene = item.recordedScene();
    row.process = unit.process;
    row.lane = item.measure.lane == config::Measure::Lane::Timing ? "timing" : "quality";
    row.status = result.status;
    row.message = result.message;
    if (result.status != records::Status::Ok && result.status != records::Status::Flaky) {
        row.value = std::numeric_limits<double>::quiet_NaN();
        return {row};
    }
    std::vector<records::Record> rows;
    for (const Sample& sample : result.samples) {
        row.frame = sample.frame;
        row.repeat = sample.repeat;
        row.pass = sample.pass;
        row.metric = sample.metric;
        row.unit = sample.unit;
        row.value = sample.value;
        rows.push_back(row);
        if (sample.isVoid) {
            rows.back().status = records::Status::Ambiguous;
            rows.back().message = result.voidReason;
        }
    }
    return rows;
}

}  // namespace gfxrepro::run
