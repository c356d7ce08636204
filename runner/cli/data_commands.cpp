#include "runner/cli/data_commands.h"

#include <CLI/CLI.hpp>

namespace gfxrepro::cli {

namespace {

void addExport(CLI::App& app, const Context& context, ExportOptions& o,
               std::function<int()>& command) {
    CLI::App* exportApp =
        app.add_subcommand("export", "a run as an artifact with checksums, or as tables");
    exportApp->add_option("dir", o.runDir, "run directory")->required()->option_text("RUN");
    exportApp->add_flag("--tidy", o.isTidy, "cases.csv, records.csv and run.sqlite instead");
    exportApp->add_option("--out", o.out, "folder (default RUN-artifact, RUN-tidy)")
        ->option_text("DIR");
    exportApp->add_option("--assets", o.assets, "folder of real models")->option_text("DIR");
    exportApp->callback([&] { command = [&] { return exportRun(context, o); }; });
}

void addImport(CLI::App& app, const Context& context, ImportOptions& o,
               std::function<int()>& command) {
    CLI::App* importApp = app.add_subcommand("import", "numbers measured elsewhere, as a run");
    importApp
        ->add_option(
            "file", o.file,
            "CSV: columns metric, value, perhaps unit, pass, frame, repeat, process, lane, "
            "status, message; all others are parameters")
        ->required()
        ->option_text("FILE");
    importApp->add_option("--config", o.configs, "layout, claims and plots for the numbers")
        ->allow_extra_args(false)
        ->option_text("CONFIG");
    importApp->add_option("--metric", o.metrics, "a column of numbers, instead of metric and value")
        ->allow_extra_args(false)
        ->option_text("COLUMN=UNIT");
    importApp->add_option("--cases", o.cases, "CSV that says what each case_id is")
        ->option_text("FILE");
    importApp
        ->add_option(
            "--machine", o.machine,
            "what measured them, for readers; as exported, where run.csv is beside --cases")
        ->option_text("TEXT");
    importApp->add_flag("--gpu", o.isOfGpu, "a GPU did: claims about one are judged");
    importApp->add_option("--profile", o.profile, "of the configs")
        ->check(CLI::IsMember({"quick", "full", "paper"}));
    importApp->add_option("--out", o.out, "run directory (default runs/<time>-<name>)")
        ->option_text("DIR");
    importApp->callback([&] { command = [&] { return importRun(context, o); }; });
}

void addHistory(CLI::App& app, HistoryOptions& o, std::function<int()>& command) {
    CLI::App* historyApp =
        app.add_subcommand("history", "many nights as a page: curves, changes, their commits");
    historyApp->add_option("files", o.files, "what compare --history and scripts/nightly keep")
        ->required()
        ->option_text("FILE");
    historyApp->add_option("--out", o.out, "the page (default history.html)")->option_text("FILE");
    historyApp->add_option("--sqlite", o.sqlite, "the same as a file of SQLite")
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

}  // namespace gfxrepro::cli
