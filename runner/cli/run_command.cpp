#include <fmt/core.h>
#include <sys/ioctl.h>
#include <unistd.h>
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "engine/core/files.h"
#include "engine/core/hash.h"
#include "engine/core/processors.h"
#include "engine/gl/nvml.h"
#include "runner/cli/commands.h"
#include "runner/cli/console.h"
#include "runner/cli/experiments.h"
#include "runner/cli/forecast.h"
#include "runner/cli/reading_commands.h"
#include "runner/cluster/predictions.h"
#include "runner/cluster/shards.h"
#include "runner/outcome/import_run.h"
#include "runner/run/machine_state.h"
#include "runner/run/manifest.h"
#include "runner/run/run.h"
#include "runner/run/run_directory.h"
#include "runner/run/scheduler.h"
#include "runner/run/twins.h"

namespace gfxrepro::cli {

namespace fs = std::filesystem;

namespace {

/// Shows a run as it goes, on standard error. Quiet: failures only.
class Progress : public run::Observer {
  public:
    /// `unitTimesS`: predictions by case, for the time left; empty when nothing is known.
    Progress(const std::vector<run::Unit>& units,
             const std::map<const config::Case*, double>& unitTimesS, int jobs, bool isQuiet);

    void unitsAdded(const std::vector<run::Unit>& units) override;
    void unitBegan(const run::Unit& unit) override;
    void unitEnded(const run::Unit& unit, records::Status status,
                   const std::string& message) override;
    void tick(std::string_view phase) override;
    /// Takes the bar away.
    void clear();

  private:
    using Clock = std::chrono::steady_clock;
    /// How many units are known of a round, or of all that is in none, and how many have ended.
    struct Count {
        int ended = 0, known = 0;
        std::string text() const { return fmt::format("{}/{}", ended, known); }
    };
    Count& countOf(const run::Unit& unit);
    void add(const std::vector<run::Unit>& units);
    double timeS(const run::Unit& unit) const;
    std::string etaText() const;

    std::map<std::pair<std::string, int>, Count> counts_;
    Count all_, shown_;               // of everything known; of what runs now
    std::string etaOf_;               // what the time left is of, where not of all
    std::set<std::string> toldOnce_;  // of what is not on this machine
    std::map<const config::Case*, double> unitTimesS_;
    int jobs_;
    double totalS_ = 0.0;  // predicted; units where there are no predictions
    double doneS_ = 0.0;
    bool isQuiet_;
    bool isTerminal_;
    Clock::time_point start_ = Clock::now();
    Clock::time_point lastDraw_{};
    std::string title_;
};

constexpr int kBarWidth = 24;
constexpr std::chrono::milliseconds kDrawInterval{100};

/// At most.
int roundsOf(const run::Unit& unit) {
    return unit.item->measure.mostRounds();
}

/// Whether further rounds may or may not follow.
bool hasOpenRounds(const run::Unit& unit) {
    return unit.item->measure.certainRounds() < roundsOf(unit);
}

std::string titleOf(const run::Unit& unit) {
    std::string title = unit.item->title();
    if (roundsOf(unit) > 1) {
        title += fmt::format(", round {} of {}{}", unit.process + 1,
                             hasOpenRounds(unit) ? "at most " : "", roundsOf(unit));
    }
    if (unit.measuredAs) title += " (as " + unit.measuredAs->title() + ")";
    return title;
}

std::size_t terminalWidth() {
    winsize size{};
    if (::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return 80;
    return size.ws_col;
}

Progress::Progress(const std::vector<run::Unit>& units,
                   const std::map<const config::Case*, double>& unitTimesS, int jobs, bool isQuiet)
    : unitTimesS_(unitTimesS),
      jobs_(jobs),
      isQuiet_(isQuiet),
      isTerminal_(::isatty(STDERR_FILENO) == 1) {
    add(units);
}

Progress::Count& Progress::countOf(const run::Unit& unit) {
    const bool isInRound = roundsOf(unit) > 1;
    return counts_[{isInRound ? unit.item->experiment : "", isInRound ? unit.process : 0}];
}

void Progress::add(const std::vector<run::Unit>& units) {
    for (const run::Unit& unit : units) {
        ++countOf(unit).known;
        ++all_.known;
        totalS_ += timeS(unit);
    }
}

double Progress::timeS(const run::Unit& unit) const {
    const auto found = unitTimesS_.find(unit.item);
    return found == unitTimesS_.end() ? 1.0 : found->second;
}

void Progress::unitsAdded(const std::vector<run::Unit>& units) {
    add(units);
}

void Progress::unitBegan(const run::Unit& unit) {
    title_ = titleOf(unit);
    shown_ = countOf(unit);
    etaOf_ = hasOpenRounds(unit) ? " of this round" : "";
    lastDraw_ = {};
    tick({});
}

void Progress::unitEnded(const run::Unit& unit, records::Status status,
                         const std::string& message) {
    Count& count = countOf(unit);
    ++count.ended;
    ++all_.ended;
    shown_ = count;
    doneS_ += timeS(unit);
    const bool isOk = status == records::Status::Ok;
    if (isOk && (isQuiet_ || isTerminal_)) return;
    const bool isAbsent = status == records::Status::Unsupported;
    if (isQuiet_ && isAbsent && !toldOnce_.insert(message).second) return;
    clear();
    constexpr std::size_t kMostTold = 300;
    const bool isLong = message.size() > kMostTold;
    std::size_t told = isLong ? kMostTold : message.size();
    while (isLong && told > 0 && (message[told] & 0xC0) == 0x80) --told;  // no half character
    tell("[{}] {} {}{}{}{}\n", count.text(), records::statusName(status), titleOf(unit),
         message.empty() ? "" : ": ", message.substr(0, told), isLong ? " … (journal.jsonl)" : "");
}

std::string Progress::etaText() const {
    if (all_.ended == 0) return "--:--";
    const double elapsedS = std::chrono::duration<double>(Clock::now() - start_).count();
    const auto leftS =
        static_cast<long long>(cluster::remainingS(totalS_, doneS_, elapsedS, jobs_) + 0.5);
    return fmt::format("{}:{:02}", leftS / 60, leftS % 60);
}

void Progress::tick(std::string_view) {
    if (isQuiet_ || !isTerminal_ || Clock::now() - lastDraw_ < kDrawInterval) return;
    lastDraw_ = Clock::now();
    const int filled =
        shown_.known == 0 ? kBarWidth : kBarWidth * shown_.ended / std::max(shown_.known, 1);
    std::string line =
        fmt::format("[{}{}] {}  ETA{} {}  {}", std::string(filled, '#'),
                    std::string(kBarWidth - filled, '.'), shown_.text(), etaOf_, etaText(), title_);
    line.resize(std::min(line.size(), terminalWidth() - 1));
    tell("\r\033[K{}", line);
    std::fflush(stderr);
}

void Progress::clear() {
    if (!isQuiet_ && isTerminal_) tell("\r\033[K");
}

int jobsOf(const RunOptions& options) {
    if (options.jobs > 0) return options.jobs;
    const int processors = usableProcessors();
    return processors <= 2 ? processors : processors / 2;
}

/// What a run goes by: its plan, its folder, and what is left to do.
struct Prepared {
    run::Plan plan;
    run::RunDirectory directory;
    run::Json manifest;
    run::SchedulerOptions scheduler;
    std::vector<run::Json> journal{};  // of a run that goes on
};

std::string deviceClassOf(const gl::DeviceInfo& device) {
    return device.isSoftware ? "software" : "gpu";
}

/// Where the state of the machine is read: another folder for tests.
fs::path machineRoot() {
    const char* root = std::getenv("GFXREPRO_MACHINE_ROOT");
    return root && *root != '\0' ? root : "/";
}

/// Says on what a run measures, and keeps its workers to that: "auto" could find another later.
gl::DeviceInfo settleDevice(run::SchedulerOptions& scheduler, run::PhaseClock& phases) {
    const gl::DeviceInfo device = run::probeDevice(scheduler, phases);
    if (device.platform == "none") return device;
    scheduler.device = std::to_string(device.index);
    tellDevice(device);
    return device;
}

/// Of a plan that was not cut before. The whole of it stays beside the shard's own for the merge:
/// shards that are cut by hand share no folder.
void cutByHand(const RunOptions& options, const std::string& device,
               const run::RunDirectory& directory, run::Plan& plan) {
    // By what was named alone: whatever else lies here may differ between the shards.
    const auto predictor = cluster::Predictor::from({options.from.begin(), options.from.end()});
    run::Shard shard = cluster::parseShard(options.shard);
    const fs::path file = directory.path() / cluster::kWholePlan;
    plan.writeFile(file);
    shard.whole = sha256OfFile(file);
    shard.device = device;
    const std::vector<double> timesS =
        run::withoutTwins(plan.cases, cluster::caseTimesS(plan, predictor));
    plan = cluster::shardPlan(plan, shard, cluster::cutShards(plan.cases, timesS, shard.count));
}

/// The manifest of a run that begins, on the disk.
run::Json begunManifest(const Context& context, const gl::DeviceInfo& device, const run::Plan& plan,
                        const run::RunDirectory& directory) {
    run::Json manifest = run::newManifest(plan, device);
    run::beginInvocation(manifest, context.commandLine);
    writeFileAtomic(directory.manifestFile(), manifest.dump(2) + '\n');
    return manifest;
}

Prepared prepareNew(const Context& context, const RunOptions& options, const run::Request& request,
                    run::PhaseClock& phases) {
    const Chosen& selection = options.selection;
    // Experiments are read first: what is wrong in a config is said before a device is asked for.
    const std::string choice =
        deviceFor(context, request.device, loadExperiments(request, selection.profile));
    run::SchedulerOptions scheduler{choice, fs::absolute(assetsFolder(selection.assets)),
                                    jobsOf(options), context.commandLine};
    const gl::DeviceInfo device = settleDevice(scheduler, phases);
    run::Plan plan =
        planFor(context, request, selection.profile, scheduler.assetsFolder, deviceClassOf(device));
    fs::path path = options.resume.empty() ? options.out : options.resume;
    if (path.empty()) path = run::defaultRunPath(runSlug(plan));
    run::RunDirectory directory = run::RunDirectory::create(path);
    if (!options.shard.empty()) cutByHand(options, choice, directory, plan);
    // The plan last: a folder with a plan has all that a resumed run needs.
    run::Json manifest = begunManifest(context, device, plan, directory);
    plan.writeFile(directory.planFile());
    return {std::move(plan), std::move(directory), std::move(manifest), scheduler};
}

/// Given configs beside --resume must be those of the run that is there.
void requireSameRequest(const RunOptions& options, const run::Request& request,
                        const run::Plan& stored) {
    if (request.configs.empty()) return;
    std::string other;
    if (request.configs != stored.request.configs) other = "configs";
    if (request.sets != stored.request.sets) other = "--set";
    if (request.sweeps != stored.request.sweeps) other = "--sweep";
    if (request.only != stored.request.only) other = "--only";
    if (request.device != stored.request.device) other = "--device";
    if (options.selection.profile != stored.profile) other = "--profile";
    if (options.shard != (stored.shard ? stored.shard->name() : "")) other = "--shard";
    if (!other.empty()) {
        throw Error(fmt::format("{}: holds a run with other {}; give another folder",
                                options.resume, other));
    }
}

/// Times of one table stay those of one machine, also where the run goes on on another.
void settleMachine(const std::string& commandLine, const gl::DeviceInfo& device, Prepared& run) {
    const std::string machine = run::machineName(run::newManifest(run.plan, device));
    const std::vector<std::string> again =
        run::replaceForeignTimes(run.plan, run.directory, run.journal, run.manifest, machine);
    const std::vector<std::string> machines = run::machinesOf(run.manifest);
    run::beginInvocation(run.manifest, commandLine);
    run::breakSeal(run.manifest);
    // One that measures nothing mixes nothing.
    if (!run::remainingUnits(run.plan, run.directory).empty()) {
        run.manifest["invocations"].back()["machine"] = machine;
        if (std::ranges::find(machines, machine) == machines.end()) {
            tell("warning: begun on {}, goes on on {}: tables will say so\n", machines.front(),
                 machine);
        }
    }
    run::noteMachines(run.manifest);
    writeFileAtomic(run.directory.manifestFile(), run.manifest.dump(2) + '\n');
    for (const std::string& experiment : again) {
        run.journal.push_back({{"event", "machine"}, {"table", experiment}, {"machine", machine}});
        run.directory.note(run.journal.back());
        tell("{}: begun on another machine; its times are measured again on {}\n", experiment,
             machine);
    }
}

/// Throws Error where the plan may not be measured here; warns where its configs have changed.
void requireMeasurable(const Context& context, const RunOptions& options, const run::Plan& plan,
                       const gl::DeviceInfo& device, bool isBegun) {
    const std::string reason = run::whyNotResumable(plan, deviceClassOf(device),
                                                    openCatalog(context, options.selection.assets));
    if (!reason.empty()) {
        throw Error(fmt::format(
            "{}: cannot be {}: {}; {}", options.resume, isBegun ? "resumed" : "measured", reason,
            isBegun ? "start a new run instead" : "submit again, to another folder"));
    }
    warnOfChangedConfigs(plan, isBegun
                                   ? "the run goes on with its configs as they were when it began"
                                   : "what was submitted is measured");
}

/// A run that was begun; or a shard of a submission, whose plan is there before its task begins.
Prepared prepareResumed(const Context& context, const RunOptions& options,
                        const run::Request& request, run::PhaseClock& phases) {
    run::RunDirectory directory = run::RunDirectory::open(options.resume);
    const bool isBegun = run::holdsRun(options.resume);
    run::StoredRun stored;
    if (isBegun) {
        stored = run::readRun(options.resume);
        stored.records = {};  // millions, and each step reads them for itself
        outcome::requireNotImported(stored.manifest, options.resume, "go on with");
    } else {
        stored.plan = run::Plan::fromJsonFile(directory.planFile());
    }
    requireSameRequest(options, request, stored.plan);
    run::SchedulerOptions scheduler{
        stored.plan.shard ? stored.plan.shard->device
                          : deviceFor(context, stored.plan.request.device, stored.plan.experiments),
        fs::absolute(assetsFolder(options.selection.assets)), jobsOf(options), context.commandLine};
    const gl::DeviceInfo device = settleDevice(scheduler, phases);
    const bool isRebound = !isBegun && stored.plan.deviceClass != deviceClassOf(device);
    if (isRebound) run::rebind(stored.plan, deviceClassOf(device));
    requireMeasurable(context, options, stored.plan, device, isBegun);
    Prepared run{std::move(stored.plan), std::move(directory), std::move(stored.manifest),
                 scheduler};
    if (!isBegun) {
        if (isRebound) run.plan.writeFile(run.directory.planFile());
        run.manifest = begunManifest(context, device, run.plan, run.directory);
        return run;
    }
    // Before anything is written: a journal that cannot be read leaves the folder as it is.
    run.journal = run::readJournal(run.directory.path() / "journal.jsonl");
    if (options.triesAgain) {
        run::forgetFlaky(run.directory);
    } else {
        run.scheduler.givenUp = run::casesNotSurvived(run.plan, run.journal);
    }
    settleMachine(context.commandLine, device, run);
    return run;
}

void saveManifest(const Context& context, Prepared& run, const run::PhaseClock& phases) {
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - context.start;
    run::endInvocation(run.manifest, phases, wall.count());
    run::sealRecords(run.manifest, run.directory.path());
    writeFileAtomic(run.directory.manifestFile(), run.manifest.dump(2) + '\n');
}

/// ", 3 failed"; nothing for none.
std::string countText(int count, std::string_view what) {
    return count > 0 ? fmt::format(", {} {}", count, what) : "";
}

/// Says what is ahead, and gives the predicted time of a unit of each case.
std::map<const config::Case*, double> forecast(const RunOptions& options, const Prepared& run) {
    if (options.isQuiet && options.from.empty()) return {};  // nobody sees what runs/ would tell
    const History history = openHistory(options.from, run.plan.deviceClass);
    std::map<const config::Case*, double> unitTimesS;
    const std::vector<std::size_t> firsts = run::firstTwins(run.plan.cases);
    for (std::size_t i = 0; i < firsts.size(); ++i) {
        const config::Case& item = run.plan.cases[i];
        const auto known = history.predictor.predict(item);
        if (known) unitTimesS[&item] = firsts[i] == i ? known->timeS : 0.0;
    }
    const std::string text = forecastText(run.plan, history, run.scheduler.jobs);
    if (!options.isQuiet && !text.empty()) tell("{}\n", text);
    return unitTimesS;
}

/// What failed in an earlier invocation goes last: else --max-failures would end each at the same.
void putFailedLast(const std::vector<run::Json>& journal, std::vector<run::Unit>& units) {
    std::set<run::UnitKey> failed;
    for (const run::Json& event : journal) {
        if (event.value("event", "") != "case") continue;
        const std::string status = event.value("status", "");
        if (status == records::statusName(records::Status::Ok) ||
            status == records::statusName(records::Status::Flaky)) {
            continue;
        }
        failed.emplace(event.value("case", ""), event.value("process", 0));
    }
    std::stable_partition(units.begin(), units.end(), [&](const run::Unit& unit) {
        return !failed.contains({unit.item->id, unit.process});
    });
}

/// Runs what is left; with `results`, makes tables, claims and report from it.
int execute(const Context& context, const RunOptions& options, const run::Request& request,
            bool results) {
    std::signal(SIGPIPE, SIG_IGN);  // a reader of the progress that is gone ends no run
    run::PhaseClock phases;
    const bool isNew =
        options.resume.empty() ||
        (!request.configs.empty() && !fs::exists(fs::path(options.resume) / "plan.json"));
    Prepared run = isNew ? prepareNew(context, options, request, phases)
                         : prepareResumed(context, options, request, phases);
    run.scheduler.failuresAtMost = options.failuresAtMost;
    // A device of its own is one, and has one memory.
    if (run.plan.deviceClass == "software") {
        run.scheduler.preparedInPairs = run::preparedInPairs(run.plan, context.techniques);
    }
    std::vector<run::Unit> units = run::remainingUnits(run.plan, run.directory);
    if (!isNew) run::noteChangedImages(run.manifest, run.directory.path(), units);
    if (options.failuresAtMost > 0) putFailedLast(run.journal, units);
    run::Rounds rounds = run::roundsOf(run.plan, run.directory, run.journal);
    std::map<std::string, run::MachineState> states = run::machineStatesIn(run.journal);
    run.journal.clear();
    run.directory.note({{"event", "begin"}, {"command", context.commandLine}});
    Progress progress(units, forecast(options, run), run.scheduler.jobs, options.isQuiet);
    run::MachineWatch watch(
        progress, run.directory, std::move(states), machineRoot(),
        [uuid = run.manifest.at("gl").value("uuid", "")] { return gl::readGpu(uuid); });
    const run::RunOutcome outcome =
        run::runUnits(units, rounds, run.directory, run.scheduler, phases, watch);
    progress.clear();
    run.directory.note({{"event", outcome.isInterrupted ? "interrupted" : "end"},
                        {"finished", outcome.finished},
                        {"failed", outcome.failed}});
    run.directory.removeScratch();
    run::addScenes(run.manifest, outcome.scenes);
    run::addPrograms(run.manifest, outcome.programs);
    run::addWarnings(run.manifest, outcome.warnings);
    run.manifest["rounds"] = rounds.endings();
    run.manifest["machine_states"] = watch.states();
    saveManifest(context, run, phases);
    const std::string path = run.directory.path().string();
    if (outcome.isInterrupted) {
        tell("interrupted; continue with: gfxrepro {} --resume {}\n", results ? "reproduce" : "run",
             path);
        return kExitInterrupted;
    }
    if (outcome.isFull) {
        tell("stopped: {}\n", outcome.stopReason);
    } else if (!outcome.stopReason.empty()) {
        tell("stopped: {}; continue with: gfxrepro {} --resume {}\n", outcome.stopReason,
             results ? "reproduce" : "run", path);
    }
    const run::StoredRun stored = run::readRun(path);
    const run::Completeness counts = run::completeness(stored);
    run::noteCompleteness(run.manifest, counts);
    writeFileAtomic(run.directory.manifestFile(), run.manifest.dump(2) + '\n');
    if (!isNew && !results) {  // conclude() says them
        for (const std::string& note : run::notesOf(stored.manifest)) tell("warning: {}\n", note);
    }
    for (const std::string& line : outcome.warnings) tell("warning: {}\n", line);
    for (const std::string& line : outcome.timeWarnings) tell("warning: {}\n", line);
    if (const std::string line = watch.warning(); !line.empty()) tell("warning: {}\n", line);
    say("{} of {} finished{}{}{}{}; records: {}\n", outcome.finished, outcome.begun,
        countText(outcome.shared, "as a twin"), countText(outcome.flaky, "flaky"),
        countText(outcome.voided, "with void times"), countText(outcome.failed, "failed"),
        run.directory.recordsFile().string());
    const bool isComplete = counts.isComplete() && outcome.stopReason.empty();
    if (!results) return isComplete ? kExitOk : kExitIncomplete;

    const int verdict = conclude(path);
    saveManifest(context, run, phases);
    // A case that is missing weighs more than a claim that fails.
    return isComplete ? verdict : kExitIncomplete;
}

/// The configs that were named; none for no name, which a resumed run gives.
std::vector<std::string> configsOf(const std::vector<std::string>& names) {
    return names.empty() ? names : findPaperConfigs(names);
}

void requireUsable(const RunOptions& options) {
    if (!options.resume.empty() && !options.out.empty()) {
        throw UsageError("--out and --resume exclude each other: both name the folder");
    }
    if (!options.shard.empty()) cluster::parseShard(options.shard);
}

}  // namespace

int run(const Context& context, const RunOptions& options) {
    const std::vector<std::string>& files = options.selection.names;
    if (options.resume.empty() && files.empty()) {
        throw UsageError("run: give PAPER, PAPER/TABLE or config files, or --resume RUN");
    }
    requireUsable(options);
    return execute(context, options, requestOf(options.selection, configsOf(files)), false);
}

int reproduce(const Context& context, const RunOptions& options) {
    requireUsable(options);
    const std::vector<std::string>& names = options.selection.names;
    const bool isAll = options.resume.empty() && names.empty();
    const std::vector<std::string> files = isAll ? findPaperConfigs({}) : configsOf(names);
    return execute(context, options, requestOf(options.selection, files), true);
}

}  // namespace gfxrepro::cli
