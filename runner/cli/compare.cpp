// Two runs, or two builds measured by turns: which is faster.
#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "runner/batch/child_process.h"
#include "runner/batch/run.h"
#include "runner/cli/commands.h"
#include "runner/core/files.h"
#include "runner/regression/comparison.h"
#include "runner/regression/history.h"
#include "runner/regression/summary.h"

namespace gfxrepro::cli {

namespace fs = std::filesystem;

namespace {

using regression::Difference;
using regression::Pairing;

/// A run's series with what they were measured on.
struct Measured {
    regression::SeriesMap series;
    std::string machine;
    std::string commit;
};

Measured readMeasured(const fs::path& runDir) {
    const batch::StoredRun run = batch::readRun(runDir);
    return {regression::seriesOf(run.records), batch::machineName(run.manifest),
            run.manifest.at("commit").get<std::string>()};
}

void requireSameMachine(const Measured& a, const Measured& b) {
    if (a.machine == b.machine) return;
    throw Error(fmt::format("measured on different machines, whose times are not compared: {}; {}",
                            a.machine, b.machine));
}

/// Runs a program to its end; its output is shown when it fails. Exit code 4 (a case did not
/// finish) passes: the series tell what is missing.
void runProgram(const std::vector<std::string>& arguments) {
    const batch::ProgramEnd end = batch::runToEnd(arguments);
    if (end.exitCode == kExitOk || end.exitCode == kExitIncomplete) return;
    throw Error(fmt::format("{}: exit code {}: {}", arguments.front(), end.exitCode, end.output));
}

/// Rounds of both programs by turns, in fresh processes: OLD NEW, NEW OLD, OLD NEW, …
class Turns {
  public:
    Turns(const CompareOptions& options, fs::path folder)
        : options_(options), folder_(std::move(folder)) {}

    /// Measures `options.rounds` more rounds.
    std::vector<Difference> measure() {
        Measured sides[2];
        for (int round = 0; round < options_.rounds; ++round, ++roundCount_) {
            const int first = round % 2;
            for (const int side : {first, 1 - first}) take(side, sides[side]);
        }
        requireSameMachine(sides[0], sides[1]);
        last_ = sides[1];
        return regression::compare(sides[0].series, sides[1].series, Pairing::ByTurns);
    }
    /// The newer program's last measurement.
    const Measured& last() const { return last_; }

  private:
    void take(int side, Measured& measured) const {
        const std::string dir =
            folder_ / fmt::format("{}-{:02}", side == 0 ? "old" : "new", roundCount_);
        std::vector<std::string> arguments = {
            fs::absolute(options_.inputs[static_cast<std::size_t>(side)]), "run", "--quiet"};
        for (const auto& [option, value] :
             {std::pair{"--out", dir}, std::pair{"--profile", options_.profile},
              std::pair{"--device", options_.device}, std::pair{"--assets", options_.assets}}) {
            if (!value.empty()) arguments.insert(arguments.end(), {option, value});
        }
        arguments.insert(arguments.end(), options_.inputs.begin() + 2, options_.inputs.end());
        runProgram(arguments);
        Measured run = readMeasured(dir);
        regression::SeriesMap all = std::move(measured.series);
        regression::append(all, run.series);
        measured = {std::move(all), run.machine, run.commit};
    }

    const CompareOptions& options_;
    fs::path folder_;
    int roundCount_ = 0;
    Measured last_;
};

/// Appends to the history; prints the steps in the series of this machine.
void keepHistory(const std::string& path, const Measured& measured) {
    regression::appendNight(path,
                            {batch::utcTime(), measured.commit, measured.machine, measured.series});
    for (const auto& [key, values] : regression::readHistory(path, measured.machine)) {
        if (!key.isTime()) continue;
        const std::optional<regression::Step> step = regression::findStep(values);
        if (!step) continue;
        fmt::print("step in {}: × {:.3f} since night {} of {} (chance {:.4f})\n", key.title(),
                   step->ratio, step->first + 1, values.size(), step->chance);
    }
}

}  // namespace

int compare(const CompareOptions& options) {
    const std::size_t fewest = options.areBinaries ? 3 : 2;
    if (options.inputs.size() < fewest || (!options.areBinaries && options.inputs.size() > 2)) {
        throw UsageError(options.areBinaries ? "compare: --binaries needs OLD NEW CONFIG…"
                                             : "compare: needs two run directories");
    }
    const fs::path folder =
        options.out.empty() ? batch::defaultRunPath("compare") : fs::path(options.out);
    std::vector<Difference> differences;
    Measured newer;
    if (options.areBinaries) {
        Turns turns(options, folder);
        differences = turns.measure();
        if (std::ranges::any_of(differences, &Difference::isAlarm)) {
            fmt::print("alarm; measuring again\n");
            regression::confirm(differences, turns.measure());
        }
        newer = turns.last();
    } else {
        const Measured older = readMeasured(options.inputs[0]);
        newer = readMeasured(options.inputs[1]);
        requireSameMachine(older, newer);
        differences = regression::compare(older.series, newer.series, Pairing::Apart);
    }
    writeFileAtomic(folder / "comparison.md", regression::markdown(differences));
    writeFileAtomic(folder / "junit.xml", regression::junitXml(differences));
    writeFileAtomic(folder / "benchmark.json", regression::smallerIsBetterJson(differences));
    if (!options.history.empty()) keepHistory(options.history, newer);
    for (const Difference& difference : differences) {
        if (!difference.isAlarm()) continue;
        fmt::print("{}: {} × {:.3f} [{:.3f}, {:.3f}]\n", difference.key.title(),
                   regression::verdictName(difference.verdict), difference.ratio,
                   difference.interval.low, difference.interval.high);
    }
    fmt::print("{}; {}\n", regression::summaryLine(differences),
               (folder / "comparison.md").string());
    return std::ranges::any_of(differences, &Difference::isAlarm) ? kExitClaimFailed : kExitOk;
}

}  // namespace gfxrepro::cli
