#include "runner/cli/data_commands.h"

#include "runner/cli/parse.h"

namespace gfxrepro::cli {

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
            "CSV with columns metric and value, optionally unit, pass, frame, repeat, process, "
            "lane, status, message; every other column is a parameter")
        ->required()
        ->option_text("FILE");
    importApp->add_option("--config", o.configs, "layout, claims and plots for the numbers")
        ->allow_extra_args(false)
        ->option_text("CONFIG");
    importApp
        ->add_option("--metric", o.metrics, "a column of numbers, in place of metric and value")
        ->allow_extra_args(false)
        ->option_text("COLUMN=UNIT");
    importApp->add_option("--cases", o.cases, "CSV with the parameters of each case_id")
        ->option_text("FILE");
    importApp
        ->add_option("--machine", o.machine,
                     "what measured them, in words (default: as in the run.csv beside --cases)")
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

}  // namespace gfxrepro::cli
