// Numbers that were measured elsewhere become a run.
#include <filesystem>

#include "runner/cli/console.h"
#include "runner/cli/data_commands.h"
#include "runner/cli/experiments.h"
#include "runner/cli/results.h"
#include "runner/results/import_run.h"
#include "runner/results/tidy.h"

namespace gfxrepro::cli {

namespace fs = std::filesystem;

namespace {

std::pair<std::string, std::string> metricFrom(const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals == 0 || equals == text.npos || equals + 1 == text.size()) {
        throw UsageError("--metric '" + text +
                         "'; allowed: COLUMN=UNIT, such as render_time_ms=ms; 1 is the "
                         "unit of what has none");
    }
    return {text.substr(0, equals), text.substr(equals + 1)};
}

}  // namespace

int importRun(const Context& context, const ImportOptions& options) {
    results::ImportRequest request;
    request.files = {options.file, options.cases, {}};
    for (const std::string& metric : options.metrics) {
        request.files.metrics.push_back(metricFrom(metric));
    }
    request.profile = options.profile;
    request.isOfGpu = options.isOfGpu;
    if (!options.machine.empty()) {
        request.machine = options.machine;
    } else if (!options.cases.empty()) {  // perhaps exported: then it is known what measured it
        const auto known = results::exportedRun(fs::path(options.cases).parent_path());
        if (known.contains("machine")) request.machine = known.at("machine");
        request.isOfGpu |= known.contains("device_class") && known.at("device_class") == "gpu";
    }
    request.commandLine = context.commandLine;
    if (!options.configs.empty()) {
        Selection selection;
        request.experiments = loadExperiments(
            requestOf(selection, findPaperConfigs(options.configs)), options.profile);
    }
    const run::StoredRun run =
        results::importRun(request, openCatalog(context, options.assets), context.techniques);
    const fs::path dir =
        options.out.empty() ? run::defaultRunPath(runSlug(run.plan)) : fs::path(options.out);
    {
        const run::RunDirectory directory = run::RunDirectory::create(dir);
        results::writeImported(directory, run);
    }
    say("imported {} numbers of {} case{} into {}\n", run.records.size(), run.plan.cases.size(),
        run.plan.cases.size() == 1 ? "" : "s", dir.string());
    const int verdict = conclude(dir);
    const run::Completeness counts = run::completeness(run);
    if (counts.isComplete()) return verdict;
    say("incomplete: {} not measured, {} failed\n", counts.missing, counts.failed);
    return kExitIncomplete;
}

}  // namespace gfxrepro::cli
