// How a table's claims depend on its assumptions: the table is measured once for each of their
// values.
#include "runner/batch/sensitivity.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "runner/batch/child_process.h"
#include "runner/batch/manifest.h"
#include "runner/batch/run.h"
#include "runner/cli/commands.h"
#include "runner/cli/experiments.h"
#include "runner/core/files.h"

namespace gfxrepro::cli {

namespace fs = std::filesystem;

namespace {

/// A name for a folder: what is no letter, digit or point becomes '_'.
std::string folderName(std::string title) {
    std::ranges::replace_if(
        title, [](unsigned char c) { return std::isalnum(c) == 0 && c != '.' && c != '-'; }, '_');
    return title;
}

/// Measures in a process of its own; a run that is there already goes on.
std::vector<report::ClaimResult> claimsUnder(const batch::Variation& variation,
                                             const std::string& file, const Selection& selection,
                                             const fs::path& dir) {
    std::vector<std::string> arguments = {"/proc/self/exe", "run",      file,
                                          "--quiet",        "--resume", dir.string()};
    for (const auto& [option, value] :
         {std::pair{"--profile", selection.profile}, std::pair{"--device", selection.device},
          std::pair{"--assets", selection.assets}}) {
        if (!value.empty()) arguments.insert(arguments.end(), {option, value});
    }
    std::vector<std::string> sets = selection.sets;
    sets.insert(sets.end(), variation.sets.begin(), variation.sets.end());
    for (const std::string& set : sets) arguments.insert(arguments.end(), {"--set", set});
    const batch::ProgramEnd end = batch::runToEnd(arguments);
    if (end.exitCode != kExitOk && end.exitCode != kExitIncomplete) {
        throw Error(
            fmt::format("{}: exit code {}: {}", variation.title(), end.exitCode, end.output));
    }
    return batch::writeResults(dir, batch::readRun(dir),
                               {.tables = true, .claims = true, .report = false})
        .claims;
}

void analyse(const Context& context, const std::string& file, const SensitivityOptions& options,
             const fs::path& folder) {
    const batch::Request request = requestOf(options.selection, {file});
    const batch::Plan plan = planFor(context, request, options.selection.profile,
                                     options.selection.assets, deviceClassFor(options.selection));
    const config::Experiment& experiment = plan.experiments.front();
    if (experiment.claims.empty()) {
        fmt::print("{}: has no claims\n", experiment.id);
        return;
    }
    const batch::Variations variations =
        batch::variationsOf(experiment, plan.cases, options.points);
    const fs::path own = folder / experiment.slug();
    std::vector<batch::Outcome> outcomes;
    for (const batch::Variation& variation : variations.runs) {
        const fs::path dir = own / folderName(variation.title());
        outcomes.push_back({variation, claimsUnder(variation, file, options.selection, dir)});
        fmt::print(stderr, "[{}/{}] {} {}\n", outcomes.size(), variations.runs.size(),
                   experiment.id, variation.title());
    }
    writeFileAtomic(own / "sensitivity.md",
                    batch::sensitivityMarkdown(experiment, outcomes, variations));
    writeFileAtomic(own / "sensitivity.csv", batch::sensitivityCsv(outcomes));
    for (std::size_t i = 0; i < outcomes.front().claims.size(); ++i) {
        fmt::print("{} {}: {}\n", experiment.id, outcomes.front().claims[i].id,
                   batch::dependence(outcomes, i));
    }
    fmt::print("{}\n", (own / "sensitivity.md").string());
}

}  // namespace

int sensitivity(const Context& context, const SensitivityOptions& options) {
    const fs::path folder =
        options.out.empty() ? batch::defaultRunPath("sensitivity") : fs::path(options.out);
    for (const std::string& file : findPaperConfigs(options.selection.names)) {
        analyse(context, file, options, folder);
    }
    return kExitOk;
}

}  // namespace gfxrepro::cli
