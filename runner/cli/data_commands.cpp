// Data that leaves and comes in: `export`, `import`, `history`.
#include <algorithm>
#include <filesystem>
#include <iterator>
#include <set>
#include <string>

#include "engine/core/text.h"
#include "runner/cli/commands.h"
#include "runner/cli/console.h"
#include "runner/cli/experiments.h"
#include "runner/cli/parse.h"
#include "runner/cli/reading_commands.h"
#include "runner/outcome/export.h"
#include "runner/outcome/import_run.h"
#include "runner/regression/nightly_history.h"

namespace gfxrepro::cli {

namespace fs = std::filesystem;

namespace {

void addExport(CLI::App& app, const Context& context, ExportOptions& o,
               std::function<int()>& command) {
    CLI::App* exportApp =
        app.add_subcommand("export", "write a run as an artifact with checksums, or as tables");
    exportApp->add_option("dir", o.runDir, "run directory")->required()->option_text("RUN");
    exportApp->add_flag("--tidy", o.isTidy, "cases.csv, records.csv and run.csv instead");
    exportApp->add_option("--out", o.out, "folder (default RUN-artifact or RUN-tidy)")
        ->option_text("DIR");
    exportApp->add_option("--assets", o.assets, "folder of real models")->option_text("DIR");
    exportApp->callback([&] { command = [&] { return exportRun(context, o); }; });
}

void addImport(CLI::App& app, const Context& context, ImportOptions& o,
               std::function<int()>& command) {
    CLI::App* importApp = app.add_subcommand("import", "make a run of numbers measured elsewhere");
    importApp
        ->add_option(
            "file", o.file,
            "CSV with columns metric and value, optionally unit, pass, frame, repeat, process or "
            "seed, lane, status, message; every other column is a parameter")
        ->required()
        ->option_text("FILE");
    importApp->add_option("--config", o.configs, "layout, claims and plots for the numbers")
        ->allow_extra_args(false)
        ->option_text("CONFIG");
    importApp
        ->add_option("--metric", o.metrics, "a column of numbers, in place of metric and value")
        ->allow_extra_args(false)
        ->option_text("COLUMN=UNIT");
    importApp->add_option("--machine", o.machine, "what measured them, in words")
        ->option_text("TEXT");
    importApp->add_flag("--gpu", o.isOfGpu, "a GPU measured them: judge claims about GPUs, too");
    addProfile(importApp, o.profile, "profile of the configs");
    importApp->add_option("--out", o.out, "run directory (default runs/<time>-<name>)")
        ->option_text("DIR");
    importApp->callback([&] { command = [&] { return importRun(context, o); }; });
}

void addHistory(CLI::App& app, HistoryOptions& o, std::function<int()>& command) {
    CLI::App* historyApp =
        app.add_subcommand("history", "show many nights on a page: curves, changes, commits");
    historyApp->add_option("files", o.files, "CSV kept by compare --history or scripts/nightly")
        ->required()
        ->option_text("FILE");
    historyApp->add_option("--out", o.out, "the page to write (default history.html)")
        ->option_text("FILE");
    historyApp->callback([&] { command = [&] { return historyPage(o); }; });
}

}  // namespace

void addDataCommands(CLI::App& app, const Context& context, DataOptions& options,
                     std::function<int()>& command) {
    addExport(app, context, options.exported, command);
    addImport(app, context, options.imported, command);
    addHistory(app, options.history, command);
}

int exportRun(const Context& context, const ExportOptions& options) {
    const std::string target = options.out.empty()
                                   ? options.runDir + (options.isTidy ? "-tidy" : "-artifact")
                                   : options.out;
    run::StoredRun run = run::readRun(options.runDir);
    run::noteChangedImages(run.manifest, options.runDir);
    if (options.isTidy) {
        outcome::writeTidy(options.runDir, run, target);
    } else {
        outcome::writeArtifact(options.runDir, run, openCatalog(context, options.assets), target);
    }
    sayNotes(run.manifest);
    say("{}\n", target);
    return kExitOk;
}

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
    outcome::ImportRequest request;
    request.files = {options.file, {}};
    for (const std::string& metric : options.metrics) {
        request.files.metrics.push_back(metricFrom(metric));
    }
    request.profile = options.profile;
    request.isOfGpu = options.isOfGpu;
    if (!options.machine.empty()) request.machine = options.machine;
    const bool isLine = std::ranges::none_of(request.machine,
                                             [](unsigned char c) { return c < 0x20 || c == 0x7F; });
    if (!isLine || !isUtf8(request.machine)) {
        throw Error("the machine's name (--machine): allowed: text of one line, in UTF-8");
    }
    request.commandLine = context.commandLine;
    if (!options.configs.empty()) {
        Chosen selection;
        request.experiments = loadExperiments(
            requestOf(selection, findPaperConfigs(options.configs)), options.profile);
    }
    const scene::Catalog catalog = openCatalog(context, options.assets);
    std::set<std::string> told;
    for (const config::Experiment& experiment : request.experiments) {
        requireSound(context, catalog, experiment,
                     run::resolveCases(experiment, catalog, context.techniques, 1), told);
    }
    const run::StoredRun run = outcome::importRun(request, catalog, context.techniques);
    if (!options.configs.empty()) requireLaidOut(context, catalog, run);
    const fs::path dir =
        options.out.empty() ? run::defaultRunPath(runSlug(run.plan)) : fs::path(options.out);
    {
        const run::RunDirectory directory = run::RunDirectory::create(dir);
        outcome::writeImported(directory, run);
    }
    say("imported {} numbers of {} case{} into {}\n", run.records.size(), run.plan.cases.size(),
        run.plan.cases.size() == 1 ? "" : "s", dir.string());
    const int verdict = conclude(dir);
    const run::Completeness counts = run::completeness(run);
    if (counts.isComplete()) return verdict;
    say("incomplete: {} not measured, {} failed\n", counts.missing, counts.failed);
    return kExitIncomplete;
}

int historyPage(const HistoryOptions& options) {
    std::vector<regression::HistoryRow> rows;
    for (const std::string& file : options.files) {
        std::vector<regression::HistoryRow> more = regression::readHistoryRows(file);
        if (more.empty()) throw Error({file, 0, 0}, "has no night");
        std::ranges::move(more, std::back_inserter(rows));
    }
    requireReport(options.out);
    const std::vector<regression::MachineHistory> histories = regression::historiesOf(rows);
    regression::writeHistoryPage(options.out, "History", histories);
    for (const regression::MachineHistory& history : histories) {
        std::size_t changes = 0;
        for (const regression::SeriesHistory& series : history.series) {
            changes += series.changes.size();
        }
        say("{}: {} nights, {} series, {} changes\n", history.machine, history.nights.size(),
            history.series.size(), changes);
    }
    say("history: {}\n", options.out);
    return kExitOk;
}

}  // namespace gfxrepro::cli
