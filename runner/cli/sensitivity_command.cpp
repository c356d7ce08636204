// How tables' claims depend on their assumptions: each table is measured once for each of their
// values, alternately, so that a budget serves all tables alike.
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <limits>
#include <optional>
#include <set>

#include "engine/core/files.h"
#include "engine/core/text.h"
#include "runner/claims/claims.h"
#include "runner/cli/commands.h"
#include "runner/cli/console.h"
#include "runner/cli/experiments.h"
#include "runner/outcome/results.h"
#include "runner/run/child_process.h"
#include "runner/run/run.h"
#include "runner/studies/sensitivity.h"

namespace gfxrepro::cli {

namespace fs = std::filesystem;

namespace {

constexpr std::chrono::hours kSensitivityRunLimit{24};  // its cases have limits of their own

/// Of a table of times its other claims alone: in the quality lane a time is none.
const std::vector<std::string> kOnceForQuality = {"measure.lane=quality", "measure.processes=1",
                                                  "measure.repeats=1"};

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// A table under study.
struct Study {
    std::string file;
    run::Plan plan;
    studies::Variations variations;
    std::string basis;
    fs::path folder;
    std::set<std::string> timed = {};                     // the claims that read a time
    std::vector<std::string> sets = {};                   // of every run
    std::vector<studies::VariationResult> outcomes = {};  // of the first runs
    double spentS = 0.0;
    bool isIncomplete = false;  // something was not measured that should have been

    const config::Experiment& experiment() const { return plan.experiments.front(); }
    std::size_t left() const { return variations.runs.size() - outcomes.size(); }
    std::vector<studies::VariationResult> withLeft() const {
        return studies::withLeft(outcomes, variations, left());
    }
    const studies::Variation& next() const { return variations.runs[outcomes.size()]; }
};

/// A name for a folder: what is no letter, digit or point becomes '_'.
std::string folderName(std::string title) {
    std::ranges::replace_if(
        title, [](unsigned char c) { return std::isalnum(c) == 0 && c != '.' && c != '-'; }, '_');
    return title;
}

/// Measures in a process of its own; a run that is there already goes on. What goes wrong is the
/// outcome; cases that failed, or a run that came to no end, leave the study incomplete. A value
/// that the technique refuses does not.
studies::VariationResult measureNext(Study& study, const Chosen& selection) {
    const studies::Variation& variation = study.next();
    const fs::path dir = study.folder / folderName(variation.title());
    std::vector<std::string> arguments = {"/proc/self/exe", "run",      study.file,
                                          "--quiet",        "--resume", dir.string()};
    for (const auto& [option, value] :
         {std::pair{"--profile", selection.profile}, std::pair{"--device", selection.device},
          std::pair{"--assets", selection.assets}}) {
        if (!value.empty()) arguments.insert(arguments.end(), {option, value});
    }
    for (const std::string& sweep : selection.sweeps) {
        arguments.insert(arguments.end(), {"--sweep", sweep});
    }
    for (const std::string& only : selection.only) {
        arguments.insert(arguments.end(), {"--only", only});
    }
    std::vector<std::string> sets = selection.sets;
    sets.insert(sets.end(), study.sets.begin(), study.sets.end());
    sets.insert(sets.end(), variation.sets.begin(), variation.sets.end());
    for (const std::string& set : sets) arguments.insert(arguments.end(), {"--set", set});
    const run::ProgramEnd end = run::runToEnd(arguments, kSensitivityRunLimit);
    const bool isAnswer = end.exitCode == kExitOk || end.exitCode == kExitUsage;
    if (!isAnswer) study.isIncomplete = true;
    if (end.exitCode != kExitOk && end.exitCode != kExitIncomplete) {
        std::string said(trimmed(end.output));
        const std::size_t error = said.find("gfxrepro: ");  // after the device that the run names
        if (error != std::string::npos) said.erase(0, error);
        // What is kept names no folder of this machine.
        const std::string folder = fs::path(study.file).parent_path() / "";
        for (std::size_t at = 0; (at = said.find(folder, at)) != std::string::npos;)
            said.erase(at, folder.size());
        return {variation, {}, fmt::format("exit code {}: {}", end.exitCode, said)};
    }
    const run::StoredRun run = run::readRun(dir);
    return {
        variation,
        outcome::writeResults(dir, run, {.tables = true, .claims = true, .report = false}).claims};
}

void writeStudy(const Study& study, const std::string& keep) {
    const std::string markdown = studies::sensitivityMarkdown(study.experiment(), study.outcomes,
                                                              study.variations, study.left());
    const std::string& table = study.experiment().id;
    const std::string csv = studies::sensitivityCsv(table, study.withLeft(), study.basis);
    writeFileAtomic(study.folder / "sensitivity.md", markdown);
    writeFileAtomic(study.folder / "sensitivity.csv", csv);
    if (!keep.empty()) studies::keepSensitivity(studies::keptFile(keep, study.plan), table, csv);
}

/// Whether it was measured where times are none, and the study asks for them.
bool lacksTimes(const studies::VariationResult& outcome, const Study& study) {
    if (!study.sets.empty()) return false;  // it asks for none
    return std::ranges::any_of(outcome.claims, [&](const claims::ClaimResult& claim) {
        return study.timed.contains(claim.id) && claim.verdict == claims::Verdict::Unmeasured;
    });
}

/// What `keep` has of the same cases and claims: the runs that are left come after it.
void takeKept(const std::string& keep, Study& study) {
    const fs::path file = studies::keptFile(keep, study.plan);
    if (!fs::is_regular_file(file)) return;
    for (studies::VariationResult& kept :
         studies::readSensitivity(file, study.experiment().id, study.basis)) {
        const auto left =
            study.variations.runs.begin() + static_cast<std::ptrdiff_t>(study.outcomes.size());
        const auto run = std::find_if(left, study.variations.runs.end(), [&](const auto& one) {
            return one.title() == kept.variation.title();
        });
        if (run == study.variations.runs.end() || kept.claims.empty()) continue;
        if (lacksTimes(kept, study)) continue;
        std::rotate(left, run, run + 1);
        kept.variation = *left;
        for (claims::ClaimResult& claim : kept.claims) {
            const auto& claims = study.experiment().claims;
            const auto spec = std::ranges::find(claims, claim.id, &config::ClaimSpec::id);
            if (spec != claims.end()) claim.text = spec->text;
        }
        study.outcomes.push_back(std::move(kept));
    }
}

/// The verdicts as configured, where `run` has measured the same.
void takeBase(const run::StoredRun& run, Study& study) {
    for (const config::Experiment& experiment : run.plan.experiments) {
        if (experiment.id != study.experiment().id || !study.outcomes.empty()) continue;
        if (run.plan.deviceClass != study.plan.deviceClass ||
            studies::basisOf(run.plan, experiment) != study.basis) {
            continue;
        }
        study.outcomes.push_back({study.next(), outcome::resultsOf(run, {experiment}).claims});
        writeStudy(study, "");
    }
}

std::optional<Study> studyOf(const Context& context, const std::string& file,
                             const SensitivityOptions& options, const std::string& deviceClass,
                             const fs::path& folder) {
    const Chosen& selection = options.selection;
    Study study{.file = file,
                .plan = planFor(context, requestOf(selection, {file}), selection.profile,
                                selection.assets, deviceClass),
                .variations = {},
                .basis = {},
                .folder = {}};
    const config::Experiment& experiment = study.experiment();
    const tables::Table table = tableBefore(context, experiment, study.plan.cases);
    for (const config::ClaimSpec& claim : experiment.claims) {
        if (claims::isOfTime(claim, table)) study.timed.insert(claim.id);
    }
    const bool isTimed = experiment.measure.lane == config::Measure::Lane::Timing;
    if (study.timed.size() == experiment.claims.size() &&
        (experiment.claims.empty() || !options.hasTimes)) {
        tell("{}: left out, {}\n", experiment.id,
             experiment.claims.empty() ? "it has no claims" : "all its claims are of times");
        return std::nullopt;
    }
    if (isTimed && !options.hasTimes) study.sets = kOnceForQuality;
    study.variations = studies::variationsOf(
        experiment, study.plan.cases, openCatalog(context, selection.assets), options.points);
    study.basis = studies::basisOf(study.plan, experiment);
    study.folder = folder / experiment.slug();
    return study;
}

/// The table that had least time so far, of those with runs left.
Study* nextOf(std::vector<Study>& studies) {
    Study* next = nullptr;
    for (Study& study : studies) {
        if (study.left() > 0 && (!next || study.spentS < next->spentS)) next = &study;
    }
    return next;
}

void printStudy(const Study& study) {
    if (study.outcomes.empty()) return;
    const studies::VariationResult& base = study.outcomes.front();
    if (!base.error.empty()) say("{}: {}\n", study.experiment().id, base.error);
    for (std::size_t i = 0; i < base.claims.size(); ++i) {
        say("{} {}: {}; rests on: {}\n", study.experiment().id, base.claims[i].id,
            studies::dependence(study.outcomes, i), studies::restsOn(study.withLeft(), i));
    }
    say("{}\n", (study.folder / "sensitivity.md").string());
}

/// "90s", "20m", "1.5h" in seconds. Throws UsageError for anything else, and for 0.
double parseBudgetS(const std::string& text) {
    const char unit = text.empty() ? ' ' : text.back();
    const double seconds = unit == 's' ? 1.0 : unit == 'm' ? 60.0 : unit == 'h' ? 3600.0 : 0.0;
    const std::optional<double> value =
        parseDouble(std::string_view(text).substr(0, text.empty() ? 0 : text.size() - 1));
    if (!value || *value <= 0.0 || seconds == 0.0) {
        throw UsageError("--budget is '" + text + "'; allowed: a time such as 90s, 20m or 1.5h");
    }
    return *value * seconds;
}

}  // namespace

int sensitivity(const Context& context, const SensitivityOptions& options) {
    const Clock::time_point begin = Clock::now();
    const double budgetS = options.budget.empty() ? std::numeric_limits<double>::infinity()
                                                  : parseBudgetS(options.budget);
    const fs::path folder =
        options.out.empty() ? run::defaultRunPath("sensitivity") : fs::path(options.out);
    tellDevice(options.selection.device);
    const std::string deviceClass = deviceClassFor(options.selection);
    std::vector<Study> studies;
    std::size_t total = 0, made = 0;
    for (const std::string& file : findPaperConfigs(options.selection.names)) {
        auto study = studyOf(context, file, options, deviceClass, folder);
        if (!study) continue;
        total += study->variations.runs.size();
        studies.push_back(std::move(*study));
    }
    for (Study& study : studies) {
        if (!options.keep.empty()) takeKept(options.keep, study);
        made += study.outcomes.size();
        // In today's words, and with what is left, also where no time is left to measure more.
        if (!study.outcomes.empty()) writeStudy(study, options.keep);
    }
    if (!options.from.empty()) {
        const run::StoredRun run = run::readRun(options.from);
        for (Study& study : studies) takeBase(run, study);
    }
    while (Study* study = nextOf(studies)) {
        if (secondsSince(begin) >= budgetS) break;
        const Clock::time_point start = Clock::now();
        const studies::VariationResult& outcome =
            study->outcomes.emplace_back(measureNext(*study, options.selection));
        study->spentS += secondsSince(start);
        writeStudy(*study, options.keep);
        tell("[{}/{}] {} {}{}\n", ++made, total, study->experiment().id, outcome.variation.title(),
             outcome.error.empty() ? "" : ": " + outcome.error);
        // Without verdicts as configured there is nothing to compare with.
        if (outcome.variation.assumption.empty() && !outcome.error.empty()) {
            study->variations.runs.resize(1);
            study->isIncomplete = true;
        }
    }
    for (const Study& study : studies) printStudy(study);
    if (!options.keep.empty() && fs::is_directory(options.keep)) {
        writeFileAtomic(fs::path(options.keep) / "README.md",
                        studies::sensitivityIndex(options.keep, context.commandLine));
    }
    bool isComplete = true;
    for (const Study& study : studies) {
        if (!study.isIncomplete) continue;
        isComplete = false;
        tell("{}: not all of its cases were measured; the runs are in {}\n", study.experiment().id,
             study.folder.string());
    }
    return isComplete ? kExitOk : kExitIncomplete;
}

}  // namespace gfxrepro::cli
