// Two runs, or two builds measured alternately: which is faster.
#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "engine/core/files.h"
#include "engine/core/near_file.h"
#include "runner/cli/commands.h"
#include "runner/cli/console.h"
#include "runner/cli/experiments.h"
#include "runner/cli/reading_commands.h"
#include "runner/config/external_program.h"
#include "runner/outcome/results.h"
#include "runner/regression/comparison.h"
#include "runner/regression/nightly_history.h"
#include "runner/regression/picture_comparison.h"
#include "runner/report/report.h"
#include "runner/run/child_process.h"
#include "runner/run/manifest.h"
#include "runner/run/run.h"

namespace gfxrepro::cli {

namespace fs = std::filesystem;

namespace {

using regression::Difference;
using regression::Pairing;

/// Of a whole run; its cases have limits of their own.
constexpr std::chrono::hours kRunLimit{24};

/// A run's series with what they were measured on.
struct Measured {
    regression::SeriesMap series;
    regression::CaseTexts failures, voidTimes, once;  // the latter without a seed
    std::size_t untimedCases = 0;
    std::string machine;
    std::string commit;
    regression::Tables byProcess;                 // chooseTimes
    std::map<std::string, std::string> unseeded;  // Rules
    regression::MetricsOfTables ofSetup;
    std::map<std::string, std::string> configs;  // absolute path by table
    std::vector<std::string> notes;
    regression::PictureMap pictures;
    std::string buildId;
    std::string madeFrom;                              // its line of made-from.txt
    std::map<std::string, std::string> programs = {};  // hash and version by file
    std::string started = {};
    bool isImported = false;
};

Measured readMeasured(const fs::path& runDir) {
    const run::StoredRun run = run::readRun(runDir);
    regression::CaseParams params;
    regression::Tables byClock, byProcess, seeded;
    std::map<std::string, std::string> unseeded;
    for (const config::Experiment& experiment : run.plan.experiments) {
        if (!config::goesByClock(experiment)) continue;
        unseeded[experiment.id] =
            config::isMeasuredHere(experiment) ? config::programText(experiment) : "";
    }
    std::set<std::string> unseededCases;
    for (const config::Case& item : run.plan.cases) {
        params[item.id] = item.recordedParams().toJson().dump();
        const bool isSeeded = item.measure.seeds != config::Measure::Seeds::None;
        if (!unseeded.contains(item.experiment)) continue;
        if (isSeeded) seeded.insert(item.experiment);
        if (!isSeeded) unseededCases.insert(item.id);
    }
    for (const std::string& table : seeded) unseeded.erase(table);
    const bool isSoftware = run.plan.deviceClass == "software";
    for (const config::Experiment& experiment : run.plan.experiments) {
        if (config::goesByClock(experiment)) {
            byClock.insert(experiment.id);
        } else if (isSoftware) {
            byProcess.insert(experiment.id);
        }
    }
    Measured measured{regression::seriesOf(run.records, params, byClock),
                      regression::failuresOf(run.records, params),
                      regression::voidTimesOf(run.records, params),
                      regression::onceOf(run.records, params, unseededCases),
                      regression::untimedCases(run.records),
                      run::machineName(run.manifest),
                      run.manifest.at("commit").get<std::string>(),
                      std::move(byProcess),
                      std::move(unseeded),
                      regression::setupMetricsOf(run.records),
                      {},
                      run::notesOf(run.manifest),
                      regression::picturesOf(runDir, run.records, params, unseededCases),
                      run.plan.buildId,
                      outcome::madeFromLine(runDir, run.manifest)};
    measured.isImported = run.manifest.contains("imported");
    for (const run::ProgramUse& use : run::programsOf(run.manifest)) {
        measured.programs[use.file] =
            use.sha256.substr(0, 12) + (use.version.empty() ? "" : " (" + use.version + ")");
    }
    measured.started = run.manifest.value("started", "");
    const std::vector<std::string>& configs = run.plan.request.configs;
    for (std::size_t i = 0; i < std::min(configs.size(), run.plan.experiments.size()); ++i) {
        measured.configs[run.plan.experiments[i].id] = configs[i];
    }
    return measured;
}

void requireSameMachine(const Measured& a, const Measured& b) {
    if (a.machine == b.machine) return;
    throw Error(fmt::format("measured on different machines, whose times are not compared: {}; {}",
                            a.machine, b.machine));
}

std::vector<Difference> comparePictures(const Measured& older, const Measured& newer,
                                        const fs::path& folder) {
    return regression::comparePictures(
        older.pictures, newer.pictures,
        {.isOneBuild = older.buildId == newer.buildId && older.programs == newer.programs,
         .folder = folder});
}

/// Runs a program to its end; its output is shown when it fails. Exit code 4 (a case did not
/// finish) passes: the records tell how.
void runProgram(const std::vector<std::string>& arguments) {
    const run::ProgramEnd end = run::runToEnd(arguments, kRunLimit);
    if (end.exitCode == kExitOk || end.exitCode == kExitIncomplete) return;
    const std::string problem =
        fmt::format("{}: exit code {}: {}", arguments.front(), end.exitCode, end.output);
    if (end.exitCode == kExitNoDevice) throw NoDeviceError(problem);
    throw Error(problem);
}

/// Whether a folder has the file, or bin/ in it.
bool hasProgram(const fs::path& folder, const std::string& name) {
    return fs::is_regular_file(folder / name) || fs::is_regular_file(folder / "bin" / name);
}

/// Whether {here} must be the folder of a build: the command calls by its name alone nothing that
/// is there. Throws Error where it has not what the command names.
bool isNamedFromHere(const config::ExternalProgram& program, const std::string& file,
                     const fs::path& folder) {
    const std::string& called = program.command.front();
    if (called.find('/') == std::string::npos && hasProgram(folder, called)) return false;
    const std::string here = fmt::format("{{{}}}/", config::placeholder::kHere);
    bool isNamed = false;
    for (const std::string& word : program.command) {
        const std::size_t at = word.find(here);
        if (at == std::string::npos) continue;
        const std::string name = word.substr(at + here.size());
        const bool isThere = fs::is_regular_file(folder / name);
        isNamed = isNamed || isThere;
        if (isThere || !fs::is_regular_file(fs::path(program.here) / name)) continue;
        throw Error(fmt::format("{} has no {}, which the command of {} names from {} on",
                                folder.string(), name, file, here));
    }
    if (isNamed) return true;
    throw Error(
        fmt::format("{} has no {}, which {} calls; a build's program is called by its name "
                    "alone, and lies in its folder or in bin/ there, or by {}",
                    folder.string(), called, file, here));
}

/// The beginning of a command line that measures the configs' programs as a build's folder has
/// them. Rounds are the processes; without a seed two of one tell whether they differ.
std::vector<std::string> runOfBuild(const CompareOptions& options, const fs::path& folder) {
    if (!fs::is_directory(folder)) {
        throw Error(folder.string() + " is no folder" + suggestedFile(folder));
    }
    const std::vector<std::string> names(options.inputs.begin() + 2, options.inputs.end());
    std::vector<std::string> calledByName, namedFromHere;
    bool areSeeded = true;
    for (const config::Experiment& experiment :
         loadExperiments(requestOf({}, findPaperConfigs(names)), options.profile)) {
        const Node& node = config::programOf(experiment);
        const std::string file = experiment.file.string();
        if (node.isNull()) {
            throw Error(file + ": has no 'program', of which two builds could be compared");
        }
        const config::ExternalProgram program = config::readProgram(node);
        areSeeded = areSeeded && program.uses(config::placeholder::kSeed);
        (isNamedFromHere(program, file, folder) ? namedFromHere : calledByName).push_back(file);
    }
    if (!calledByName.empty() && !namedFromHere.empty()) {
        throw Error(
            fmt::format("{} calls its program by name, and {} from {{{}}} on: compare them "
                        "one by one",
                        calledByName.front(), namedFromHere.front(), config::placeholder::kHere));
    }
    const char* path = std::getenv("PATH");
    std::vector<std::string> arguments = {
        "/usr/bin/env",
        fmt::format("PATH={0}:{0}/bin:{1}", folder.string(), path ? path : "/usr/bin:/bin"),
        fs::read_symlink("/proc/self/exe").string(),
        "run",
        "--quiet",
        "--set",
        fmt::format("measure.processes={}", areSeeded ? 1 : 2)};
    if (!namedFromHere.empty()) {
        arguments.insert(arguments.end(), {"--set", "program.here=" + folder.string()});
    }
    return arguments;
}

/// What a history calls a build: hash and version of the first program of its folder.
std::string buildName(const Measured& measured, const fs::path& folder) {
    for (const auto& [file, name] : measured.programs) {
        if (hasProgram(folder, file)) return name;
    }
    return measured.commit;
}

/// Alternating rounds of both programs, in fresh processes: OLD NEW, NEW OLD, OLD NEW, …
class Turns {
  public:
    Turns(const CompareOptions& options, fs::path folder)
        : options_(options), folder_(std::move(folder)) {
        for (std::size_t side = 0; side < 2; ++side) {
            const fs::path build = fs::absolute(options.inputs[side]).lexically_normal();
            starts_[side] = options.arePrograms ? runOfBuild(options, build)
                                                : std::vector<std::string>{build, "run", "--quiet"};
        }
    }

    /// Measures until all is decided, and alarms once more.
    std::vector<Difference> compare() {
        return regression::compareByTurns(
            [&](regression::Sides& sides, const std::set<std::string>& tables) {
                const bool isFirst = sides.before.empty() && sides.after.empty();
                if (!tables.empty() && isFirst) say("alarm; measuring again\n");
                for (int i = 0; i < options_.rounds; ++i) {
                    takeRound(sides, tables, isFirst && i == 0);
                }
            });
    }
    /// The newer program's rounds, without those that confirm.
    const Measured& newer() const { return newer_; }
    /// Cases of the newer program that failed in any round.
    const regression::CaseTexts& failures() const { return failures_; }

  private:
    void takeRound(regression::Sides& sides, const std::set<std::string>& tables,
                   bool comparesPictures) {
        const std::size_t first = static_cast<std::size_t>(roundCount_ % 2);
        Measured measured[2];
        for (const std::size_t side : {first, 1 - first}) measured[side] = take(side, tables);
        requireSameMachine(measured[0], measured[1]);
        ++roundCount_;
        for (const Measured& one : measured)
            configs_.insert(one.configs.begin(), one.configs.end());
        if (comparesPictures) sides.pictures = comparePictures(measured[0], measured[1], folder_);
        sides.byProcess = measured[1].byProcess;
        regression::append(sides.before, measured[0].series);
        regression::append(sides.after, measured[1].series);
        sides.failuresBefore.merge(measured[0].failures);
        failures_.insert(measured[1].failures.begin(), measured[1].failures.end());
        sides.failuresAfter.merge(measured[1].failures);
        sides.voidBefore.merge(measured[0].voidTimes);
        sides.voidAfter.merge(measured[1].voidTimes);
        if (!tables.empty()) return;
        regression::append(newer_.series, measured[1].series);
        measured[1].series = std::move(newer_.series);
        newer_ = std::move(measured[1]);
    }

    /// One run of a side's program, of `tables` alone where there are some.
    Measured take(std::size_t side, const std::set<std::string>& tables) const {
        const std::string dir =
            folder_ / fmt::format("{}-{:02}", side == 0 ? "old" : "new", roundCount_);
        std::vector<std::string> arguments = starts_[side];
        for (const auto& [option, value] :
             {std::pair{"--out", dir}, std::pair{"--profile", options_.profile},
              std::pair{"--device", options_.device}, std::pair{"--assets", options_.assets}}) {
            if (!value.empty()) arguments.insert(arguments.end(), {option, value});
        }
        if (tables.empty()) {
            arguments.insert(arguments.end(), options_.inputs.begin() + 2, options_.inputs.end());
        }
        for (const std::string& table : tables) arguments.push_back(configs_.at(table));
        runProgram(arguments);
        return readMeasured(dir);
    }

    const CompareOptions& options_;
    fs::path folder_;
    std::vector<std::string> starts_[2];
    int roundCount_ = 0;
    regression::CaseTexts failures_;
    std::map<std::string, std::string> configs_;  // also of tables that one side has lost
    Measured newer_;
};

/// Appends to the history, and gives the steps in the series of this machine.
std::vector<regression::SeriesStep> keepHistory(const std::string& path, const Measured& measured) {
    regression::SeriesMap night = measured.series, same = measured.series;
    regression::chooseTimes(night, same, measured.byProcess);
    regression::appendNight(path, {run::utcTime(), measured.commit, measured.machine, night});
    return regression::findSteps(regression::readHistory(path, measured.machine));
}

/// What times of two runs cannot say, where they leave one undecided, and what would say it.
void noteApart(const std::vector<Difference>& differences, const Measured& measured,
               std::vector<std::string>& notes) {
    const bool isUndecided = std::ranges::any_of(differences, [](const Difference& one) {
        return one.key.isTime() && one.verdict == regression::SeriesVerdict::CannotTell;
    });
    if (!isUndecided || measured.isImported) return;
    const regression::Rules rules;
    notes.push_back(fmt::format(
        "of two runs only times that differ by more than × {:.1f} are told, as a machine drifts "
        "between them; by turns {:.0f} % are: gfxrepro compare {}",
        1.0 + rules.driftApart, 100.0 * rules.effectFloor,
        measured.programs.empty() ? "--binaries OLD NEW CONFIG"
                                  : "--programs OLD_DIR NEW_DIR CONFIG"));
}

/// What two runs say that were measured for themselves. Where the older has no pictures (kept
/// results do not have), none is compared: a note tells it instead.
std::vector<Difference> compareRuns(const Measured& older, const Measured& newer,
                                    const fs::path& folder, std::vector<std::string>& notes) {
    requireSameMachine(older, newer);
    std::vector<Difference> differences = regression::compare(
        older.series, newer.series, Pairing::Apart,
        {.byProcess = newer.byProcess, .unseeded = newer.unseeded, .ofSetup = newer.ofSetup});
    regression::noteFailures(differences, older.failures, newer.failures);
    regression::noteVoidTimes(differences, older.voidTimes, newer.voidTimes);
    regression::noteOnce(differences, older.once, newer.once);
    noteApart(differences, newer, notes);
    for (const auto& [file, now] : newer.programs) {
        const auto then = older.programs.find(file);
        if (then == older.programs.end() || then->second == now) continue;
        notes.push_back(fmt::format("{} is another: {} before, {} after", file, then->second, now));
    }
    if (older.pictures.empty() && !newer.pictures.empty()) {
        notes.emplace_back("the older run has no pictures: none are compared");
    } else {
        regression::addPictures(differences, comparePictures(older, newer, folder));
    }
    return differences;
}

/// The kept results of results/reference, or a whole run, for a page; a run's exit code beside it.
report::ReportRun shownRun(const std::string& dir) {
    if (!fs::exists(fs::path(dir) / "plan.json")) return outcome::keptRun(dir);
    const run::StoredRun run = run::readRun(dir);
    return outcome::reportRun(dir, run, outcome::resultsOf(run));
}

/// Both runs side by side, what differs first.
void writePage(const CompareOptions& options, const regression::Comparison& comparison,
               const fs::path& folder) {
    std::vector<report::ReportRun> runs = {shownRun(options.inputs[0]),
                                           shownRun(options.inputs[1])};
    noteOtherMachines(runs);
    report::ReportOptions shown = outcome::reportOptions();
    const std::vector<std::string> titles =
        regression::titlesOf(regression::keysOf(comparison.differences));
    for (std::size_t i = 0; i < titles.size(); ++i) {
        const Difference& difference = comparison.differences[i];
        std::string says = difference.reason;
        if (says.empty() && difference.key.isTime()) {
            says = fmt::format("{:.3f} [{:.3f}, {:.3f}]", difference.ratio, difference.interval.low,
                               difference.interval.high);
        } else if (says.empty() && !difference.isPicture()) {
            says = fmt::format("{:.6g} → {:.6g}", difference.before, difference.after);
        }
        shown.compared.push_back({titles[i],
                                  std::string(regression::verdictName(difference.verdict)), says,
                                  difference.isAlarm()});
    }
    if (!titles.empty()) {
        shown.comparedInAll =
            "Of all that they recorded: " + regression::summaryLine(comparison.differences) + ".";
    }
    report::writeReport(folder / "report.html", runs, shown);
    say("report: {}\n", (folder / "report.html").string());
}

void sayAll(const regression::Comparison& comparison, const fs::path& folder) {
    for (const std::string& note : comparison.notes) say("warning: {}\n", note);
    const std::vector<std::string> titles =
        regression::titlesOf(regression::keysOf(comparison.differences));
    for (std::size_t i = 0; i < titles.size(); ++i) {
        const Difference& difference = comparison.differences[i];
        const bool isOfNone = difference.isOfNone();
        if (!difference.isAlarm() && !isOfNone) continue;
        if (difference.verdict == regression::SeriesVerdict::Lost || isOfNone ||
            difference.isPicture()) {
            say("{}: {}: {}\n", titles[i], regression::verdictName(difference.verdict),
                difference.reason);
            continue;
        }
        say("{}: {} × {:.3f} [{:.3f}, {:.3f}]\n", titles[i],
            regression::verdictName(difference.verdict), difference.ratio, difference.interval.low,
            difference.interval.high);
    }
    for (const regression::SeriesStep& step : comparison.steps) {
        say("{}\n", regression::stepLine(step));
    }
    say("{}; {}\n", regression::summaryLine(comparison.differences),
        (folder / "comparison.md").string());
}

bool isKept(const std::string& dir) {
    return !fs::exists(fs::path(dir) / "plan.json") && fs::exists(fs::path(dir) / "cells.csv");
}

/// A case that neither side measured weighs more than what the others say. One that the newer side
/// alone lost is what they say.
int exitCodeOf(const regression::Comparison& comparison, const regression::CaseTexts& failures) {
    const bool isUnmeasured =
        std::ranges::any_of(comparison.differences, [&](const Difference& one) {
            return one.verdict == regression::SeriesVerdict::Failed && failures.contains(one.key);
        });
    if (isUnmeasured) return kExitIncomplete;
    if (comparison.isAlarm()) return kExitClaimFailed;
    return failures.empty() ? kExitOk : kExitIncomplete;
}

}  // namespace

int compare(const CompareOptions& options) {
    const bool isByTurns = options.areBinaries || options.arePrograms;
    if (options.inputs.size() < (isByTurns ? 3 : 2) || (!isByTurns && options.inputs.size() > 2)) {
        throw UsageError(options.areBinaries   ? "compare: --binaries needs OLD NEW CONFIG…"
                         : options.arePrograms ? "compare: --programs needs OLD_DIR NEW_DIR CONFIG…"
                                               : "compare: needs two run directories");
    }
    const fs::path folder =
        options.out.empty() ? run::defaultRunPath("compare") : fs::path(options.out);
    regression::Comparison comparison;
    Measured newer;
    if (isByTurns) {
        if (options.areBinaries) tellDevice(options.device.empty() ? "auto" : options.device);
        Turns turns(options, folder);
        comparison.differences = turns.compare();
        newer = turns.newer();
        newer.failures = turns.failures();
        if (options.arePrograms) newer.commit = buildName(newer, options.inputs[1]);
    } else if (std::ranges::any_of(options.inputs, isKept)) {
        // Kept results have no records: their verdicts and cells stand beside the other's.
        std::string lines;
        for (const std::string& dir : options.inputs) {
            lines += outcome::madeFromLine(dir, shownRun(dir).manifest);
        }
        outcome::requireMadeFrom(folder, lines);
        outcome::noteMadeFrom(folder, lines);
        writePage(options, comparison, folder);
        return kExitOk;
    } else {
        const Measured older = readMeasured(options.inputs[0]);
        newer = readMeasured(options.inputs[1]);
        outcome::requireMadeFrom(folder, older.madeFrom + newer.madeFrom);
        outcome::noteMadeFrom(folder, older.madeFrom + newer.madeFrom);
        comparison.differences = compareRuns(older, newer, folder, comparison.notes);
        for (std::size_t i = 0; i < 2; ++i) {
            for (const std::string& note : (i == 0 ? older : newer).notes) {
                comparison.notes.push_back(options.inputs[i] + ": " + note);
            }
        }
    }
    if (newer.untimedCases > 0) {
        comparison.notes.push_back(
            fmt::format("{} of the quality lane: times that are not compared",
                        newer.untimedCases == 1 ? "one case is"
                                                : fmt::format("{} cases are", newer.untimedCases)));
    }
    if (!options.history.empty()) comparison.steps = keepHistory(options.history, newer);
    comparison.started = newer.started;
    writeFileAtomic(folder / "comparison.md", regression::markdown(comparison));
    writeFileAtomic(folder / "junit.xml", regression::junitXml(comparison));
    const std::string times = regression::smallerIsBetterJson(comparison.differences);
    if (!times.empty()) writeFileAtomic(folder / "benchmark.json", times);
    if (times.empty()) fs::remove(folder / "benchmark.json");  // of a comparison before
    sayAll(comparison, folder);
    if (!isByTurns) writePage(options, comparison, folder);
    return exitCodeOf(comparison, newer.failures);
}

}  // namespace gfxrepro::cli
