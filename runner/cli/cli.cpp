#include "runner/cli/cli.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <functional>

#include "runner/batch/manifest.h"
#include "runner/batch/worker.h"
#include "runner/cli/commands.h"
#include "runner/cli/image_commands.h"
#include "runner/core/files.h"
#include "runner/core/text.h"

namespace gfxrepro::cli {

namespace {

/// All options of all commands, and the command that was chosen.
struct Options {
    Selection selection;
    RunOptions run;
    SceneOptions scene;
    CompareOptions compare;
    SubmitOptions submit;
    SensitivityOptions sensitivity;
    batch::WorkerOptions worker;
    std::string name;                 // of list and describe; a run directory
    std::vector<std::string> shards;  // run directories of merge and report
    ImageCommandOptions image;
    std::string out;  // of export
    std::string lane = "quality";
    bool asJson = false;
    std::function<int()> command;
};

void addAssets(CLI::App* app, std::string& assets) {
    app->add_option("--assets", assets, "folder of real models");
}

void addSelection(CLI::App* app, Selection& selection) {
    app->add_option("--profile", selection.profile, "quick | full | paper")
        ->check(CLI::IsMember({"quick", "full", "paper"}));
    app->add_option("--set", selection.sets, "key=value laid over every config")
        ->allow_extra_args(false);
    app->add_option("--sweep", selection.sweeps, "axis=a,b replaces or adds an axis")
        ->allow_extra_args(false);
    app->add_option("--device", selection.device, "auto | software | number from doctor");
    addAssets(app, selection.assets);
}

void addOnly(CLI::App* app, std::vector<std::string>& only) {
    app->add_option("--only", only, "key=value: only the cases that have it")
        ->allow_extra_args(false);
}

void addFrom(CLI::App* app, std::vector<std::string>& from) {
    app->add_option("--from", from, "run to predict times from (default: the newest in runs/)")
        ->allow_extra_args(false);
}

void addRunOptions(CLI::App* app, RunOptions& options) {
    addSelection(app, options.selection);
    addOnly(app, options.selection.only);
    app->add_option("--out", options.out, "run directory (default runs/<time>-<name>)");
    app->add_option("--resume", options.resume,
                    "continue this run; begin it where configs are given too");
    app->add_option("--shard", options.shard,
                    "k/n: measure one of n parts; each with the same --from");
    addFrom(app, options.from);
    app->add_option("--budget", options.budget, "20m: the tables that decide most claims in it");
    app->add_option("--jobs", options.jobs, "quality cases at once")->check(CLI::Range(1, 256));
    app->add_flag("--quiet", options.isQuiet, "print failures only");
}

void addQueries(CLI::App& app, const Context& context, Options& o) {
    CLI::App* doctorApp = app.add_subcommand("doctor", "devices, limits, assets, disk");
    addAssets(doctorApp, o.selection.assets);
    doctorApp->add_flag("--json", o.asJson, "machine-readable");
    doctorApp->callback(
        [&] { o.command = [&] { return doctor(context, o.selection.assets, o.asJson); }; });

    CLI::App* listApp =
        app.add_subcommand("list", "tables | techniques | scenes | configs | generators");
    listApp->add_option("what", o.name, "what to list")->required();
    listApp->add_flag("--json", o.asJson, "machine-readable");
    addAssets(listApp, o.selection.assets);
    listApp->callback(
        [&] { o.command = [&] { return list(context, o.name, o.selection.assets, o.asJson); }; });

    CLI::App* describeApp = app.add_subcommand(
        "describe", "a technique, scene, generator, table or config file; 'config': the schema");
    describeApp->add_option("name", o.name, "what to describe")->required();
    addAssets(describeApp, o.selection.assets);
    describeApp->callback(
        [&] { o.command = [&] { return describe(context, o.name, o.selection.assets); }; });

    CLI::App* checkApp = app.add_subcommand("check", "validate configs; needs no device");
    checkApp->add_option("configs", o.selection.names, "config files")->required();
    addSelection(checkApp, o.selection);
    checkApp->callback([&] { o.command = [&] { return check(context, o.selection); }; });

    CLI::App* planApp =
        app.add_subcommand("plan", "list the cases of configs with their time and memory");
    planApp->add_option("configs", o.selection.names, "config files")->required();
    addSelection(planApp, o.selection);
    addOnly(planApp, o.selection.only);
    addFrom(planApp, o.run.from);
    planApp->add_flag("--json", o.asJson, "the plan as it would be frozen");
    planApp->callback(
        [&] { o.command = [&] { return plan(context, o.selection, o.run.from, o.asJson); }; });
}

void addRuns(CLI::App& app, const Context& context, Options& o) {
    CLI::App* runApp = app.add_subcommand("run", "measure the cases of configs: records.csv");
    runApp->add_option("configs", o.run.selection.names, "config files");
    addRunOptions(runApp, o.run);
    runApp->callback([&] { o.command = [&] { return run(context, o.run); }; });

    CLI::App* reproduceApp =
        app.add_subcommand("reproduce", "run + tables + claims + report of papers or tables");
    reproduceApp->add_option("names", o.run.selection.names,
                             "PAPER, PAPER/TABLE or a config file; none: all papers");
    addRunOptions(reproduceApp, o.run);
    reproduceApp->callback([&] { o.command = [&] { return reproduce(context, o.run); }; });

    const auto addResult = [&](const char* name, const char* doc,
                               int (*function)(const std::string&)) {
        CLI::App* result = app.add_subcommand(name, doc);
        result->add_option("dir", o.name, "run directory")->required();
        result->callback(
            [&o, function] { o.command = [&o, function] { return function(o.name); }; });
    };
    addResult("table", "make a run's tables again from its records", table);
    addResult("claims", "judge a run's claims again", claims);
    CLI::App* reportApp =
        app.add_subcommand("report", "make a run's report.html again, or one of several runs");
    reportApp->add_option("dirs", o.shards, "run directories, or kept results")->required();
    reportApp->add_option("--out", o.out,
                          "file (default DIR/report.html; of several: report.html)");
    reportApp->callback([&] { o.command = [&] { return report(o.shards, o.out); }; });

    CLI::App* exportApp =
        app.add_subcommand("export", "a run as an artifact: results, scripts, licences, checksums");
    exportApp->add_option("dir", o.name, "run directory")->required();
    exportApp->add_option("--out", o.out, "folder (default DIR-artifact)");
    addAssets(exportApp, o.selection.assets);
    exportApp->callback(
        [&o] { o.command = [&o] { return exportRun(o.name, o.out, o.selection.assets); }; });
}

void addCluster(CLI::App& app, const Context& context, Options& o) {
    CLI::App* mergeApp = app.add_subcommand("merge", "shards into one run; names what is missing");
    mergeApp->add_option("out", o.name, "folder of the whole run")->required();
    mergeApp->add_option("shards", o.shards, "run directories of the shards")->required();
    mergeApp->callback([&] { o.command = [&] { return merge(context, o.name, o.shards); }; });

    SubmitOptions& s = o.submit;
    CLI::App* submitApp =
        app.add_subcommand("submit", "shards on other machines: a Slurm array, or commands");
    submitApp->add_option("configs", s.selection.names, "config files, papers or tables");
    addSelection(submitApp, s.selection);
    addOnly(submitApp, s.selection.only);
    submitApp->add_option("--out", s.out, "folder of the shards and of the merged run");
    submitApp->add_option("--engine", s.engine, "slurm | commands")
        ->check(CLI::IsMember({"slurm", "commands"}));
    submitApp->add_option("--shards", s.shardCount, "default: one a predicted half hour")
        ->check(CLI::Range(1, 10000));
    addFrom(submitApp, s.from);
    submitApp->add_option("--jobs", s.jobs, "quality cases at once, a shard")
        ->check(CLI::Range(1, 256));
    submitApp->add_option("--partition", s.partition, "sbatch's");
    submitApp->add_option("--gres", s.gres, "sbatch's: gpu:1");
    submitApp->add_option("--sbatch", s.sbatchFlags, "any other: --sbatch=--account=x")
        ->allow_extra_args(false);
    submitApp->add_flag("--dry-run", s.isDryRun, "print scripts and commands only");
    submitApp->add_flag("--status", s.isStatus, "of the submission in this folder");
    submitApp->callback([&] { o.command = [&] { return submit(context, o.submit); }; });
}

void addCompare(CLI::App& app, CompareOptions& options, std::function<int()>& command) {
    CLI::App* compareApp =
        app.add_subcommand("compare", "regressions between two runs, or two builds by turns");
    compareApp->add_option("inputs", options.inputs, "A B; or OLD NEW CONFIG… with --binaries")
        ->required();
    compareApp->add_flag("--binaries", options.areBinaries,
                         "OLD and NEW are programs; they measure the configs by turns");
    compareApp->add_option("--rounds", options.rounds, "of each program")
        ->check(CLI::Range(2, 1000));
    compareApp->add_option("--profile", options.profile, "quick | full | paper")
        ->check(CLI::IsMember({"quick", "full", "paper"}));
    compareApp->add_option("--device", options.device, "auto | software | number from doctor");
    compareApp->add_option("--out", options.out, "folder (default runs/<time>-compare)");
    compareApp->add_option("--history", options.history, "append to this CSV; say its steps");
    addAssets(compareApp, options.assets);
    compareApp->callback([&] { command = [&] { return compare(options); }; });
}

void addSensitivity(CLI::App& app, const Context& context, Options& o) {
    SensitivityOptions& s = o.sensitivity;
    CLI::App* sensitivityApp =
        app.add_subcommand("sensitivity", "how claims depend on what the paper left open");
    sensitivityApp->add_option("names", s.selection.names, "PAPER/TABLE or config files")
        ->required();
    addSelection(sensitivityApp, s.selection);
    s.selection.profile = "quick";
    sensitivityApp->add_option("--points", s.points, "values of a range of numbers (default 3)")
        ->check(CLI::Range(2, 100));
    sensitivityApp->add_option("--out", s.out, "folder (default runs/<time>-sensitivity)");
    sensitivityApp->callback(
        [&] { o.command = [&] { return sensitivity(context, o.sensitivity); }; });
}

void addTools(CLI::App& app, const Context& context, Options& o) {
    addImageCommands(app, o.image, o.command);

    CLI::App* sceneApp = app.add_subcommand("scene", "look at a scene, or export it");
    sceneApp->add_option("name", o.scene.name, "catalogue name or file")->required();
    sceneApp->add_option("--export", o.scene.exportFile, "write .glb or .ply");
    sceneApp->add_option("--render", o.scene.renderFile,
                         "write f.png (rasterized) and f-raytraced.png");
    sceneApp->add_option("--size", o.scene.sizePx, "pixels along each side of the render")
        ->check(CLI::Range(16, 8192));
    sceneApp->add_option("--device", o.scene.device, "auto | software | number from doctor");
    addAssets(sceneApp, o.scene.assets);
    sceneApp->callback([&] { o.command = [&] { return scene(o.scene); }; });

    // The program starts itself with this; `group("")` keeps it out of the help.
    CLI::App* workerApp = app.add_subcommand("worker", "")->group("");
    workerApp->add_option("--device", o.worker.device);
    workerApp->add_option("--assets", o.worker.assetsFolder);
    workerApp->add_option("--lane", o.lane);
    workerApp->add_option("--run", o.worker.runDir);
    workerApp->add_option("--command", o.worker.command);
    workerApp->callback([&] {
        o.command = [&] {
            o.worker.lane =
                o.lane == "timing" ? config::Measure::Lane::Timing : config::Measure::Lane::Quality;
            batch::runWorker(o.worker, context.techniques);
            return kExitOk;
        };
    });
}

/// The innermost command that was named.
const CLI::App* chosenCommand(const CLI::App& app) {
    const auto chosen = app.get_subcommands();
    return chosen.empty() ? &app : chosenCommand(*chosen.front());
}

std::vector<std::string> optionNames(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options()) {
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
    return names;
}

std::vector<std::string> commandNames(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands({})) {
        if (!command->get_group().empty()) names.push_back(command->get_name());
    }
    return names;
}

/// One clear message for what the parser did not take.
UsageError usageError(const CLI::App& app, const CLI::ParseError& problem) {
    const CLI::App& command = *chosenCommand(app);
    const std::string name = command.get_name();
    const std::vector<std::string> extras = app.remaining(true);
    if (!extras.empty()) {
        const std::string& extra = extras.front();
        if (extra.starts_with("-")) {
            const std::string option = extra.substr(0, extra.find('='));
            return UsageError(name + ": unknown option '" + option + "'" +
                              suggestion(option, optionNames(command)) + "; see '" + name +
                              " --help'");
        }
        if (&command == &app) {
            return UsageError("unknown command '" + extra + "'" +
                              suggestion(extra, commandNames(app)) + "; see 'gfxrepro --help'");
        }
        return UsageError(name + ": unexpected argument '" + extra + "'");
    }
    return UsageError(name + ": " + problem.what());
}

/// Parses; empty command: help or version was printed.
void parse(CLI::App& app, int argc, const char* const* argv) {
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& help) {  // --help, --version: CLI11 answers them by throwing
        app.exit(help);
    } catch (const CLI::ParseError& problem) {
        throw usageError(app, problem);
    }
}

int runCommand(int argc, const char* const* argv,
               std::span<const technique::TechniqueInfo> techniques) {
    Context context{techniques, "gfxrepro", std::chrono::steady_clock::now()};
    for (int i = 1; i < argc; ++i) context.commandLine += std::string(" ") + argv[i];
    Options options;
    CLI::App app("Measures the tables of rendering papers again.", "gfxrepro");
    app.get_formatter()->column_width(36);  // an option and its doc on one line
    app.set_version_flag("--version", "gfxrepro " + batch::programCommit());
    addQueries(app, context, options);
    addRuns(app, context, options);
    addCluster(app, context, options);
    addSensitivity(app, context, options);
    addTools(app, context, options);
    addCompare(app, options.compare, options.command);
    if (argc < 2) throw UsageError("no command; see 'gfxrepro --help'");
    parse(app, argc, argv);
    return options.command ? options.command() : kExitOk;
}

}  // namespace

// The catch of the program stands here and not in main.cpp, so that a program with other techniques
// (tests) has the same exit codes.
int run(int argc, const char* const* argv, std::span<const technique::TechniqueInfo> techniques) {
    try {
        return runCommand(argc, argv, techniques);
    } catch (const NoDeviceError& error) {
        fmt::print(stderr, "gfxrepro: {}\n", error.what());
        return kExitNoDevice;
    } catch (const std::exception& error) {
        fmt::print(stderr, "gfxrepro: {}\n", error.what());
        return kExitUsage;
    }
}

}  // namespace gfxrepro::cli
