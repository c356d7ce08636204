#include "runner/cli/cli.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <new>
#include <nlohmann/json.hpp>

#include "engine/core/files.h"
#include "engine/core/text.h"
#include "runner/cli/commands.h"
#include "runner/cli/console.h"
#include "runner/cli/help.h"
#include "runner/cli/parse.h"
#include "runner/run/manifest.h"

namespace gfxrepro::cli {

namespace {

/// All options of all commands, and the command that was chosen.
struct Options {
    Chosen selection;
    RunOptions run;
    SceneOptions scene;
    CompareOptions compare;
    SubmitOptions submit;
    SensitivityOptions sensitivity;
    DescribeOptions describe;
    WorkerOptions worker;
    std::string name;                 // of list; a run directory; a shell
    std::vector<std::string> shards;  // run directories of merge and report
    ImageCommandOptions image;
    DataOptions data;
    FileOptions file;
    std::vector<std::string> configs;  // that claims judges by
    std::string out;                   // of table, claims, report
    bool embeds = false;               // of report
    bool asJson = false;
    std::function<int()> command;
};

void addAssets(CLI::App* app, std::string& assets) {
    app->add_option("--assets", assets, "folder of real models")->option_text("DIR");
}

void addDevice(CLI::App* app, std::string& device) {
    app->add_option("--device", device, "auto, gpu, software, or N or UUID from doctor")
        ->option_text("DEVICE");
}

CLI::Option* addRunDirectory(CLI::App* app, std::string& dir) {
    return app->add_option("dir", dir, "run directory")->required()->option_text("RUN");
}

CLI::Option* addConfigs(CLI::App* app, std::vector<std::string>& names) {
    return app->add_option("configs", names, "config files")->option_text("CONFIG");
}

CLI::Option* addTables(CLI::App* app, std::vector<std::string>& names) {
    return app->add_option("tables", names, "PAPER, PAPER/TABLE or config files")
        ->option_text("TABLE");
}

/// An option that may be given several times.
void addEach(CLI::App* app, const char* name, std::vector<std::string>& values, const char* doc,
             const char* value) {
    app->add_option(name, values, doc)->allow_extra_args(false)->option_text(value);
}

void addSelection(CLI::App* app, Chosen& selection) {
    addProfile(app, selection.profile);
    addEach(app, "--set", selection.sets, "override a key of every config", "KEY=VALUE");
    addEach(app, "--sweep", selection.sweeps, "replace or add an axis", "AXIS=A,B");
    addDevice(app, selection.device);
    addAssets(app, selection.assets);
}

void addOnly(CLI::App* app, std::vector<std::string>& only) {
    addEach(app, "--only", only, "only these cases; * and ? match; repeatable", "KEY=VALUE");
}

void addFrom(CLI::App* app, std::vector<std::string>& from) {
    addEach(app, "--from", from, "predict times from it (default: newest in runs/)", "RUN");
}

void addRunOptions(CLI::App* app, RunOptions& options) {
    addSelection(app, options.selection);
    addOnly(app, options.selection.only);
    app->add_option("--out", options.out, "run directory (default runs/<time>-<name>)")
        ->option_text("DIR");
    app->add_option("--resume", options.resume, "continue this run; with configs, start it if new")
        ->option_text("RUN");
    app->add_option("--shard", options.shard, "part K of N; give all parts the same --from")
        ->option_text("K/N");
    addFrom(app, options.from);
    app->add_option("--jobs", options.jobs, "cases to run at once where no times are taken")
        ->check(CLI::Range(1, 256))
        ->option_text("N");
    app->add_option("--max-failures", options.failuresAtMost, "stop after this many failed cases")
        ->check(CLI::Range(1, 1'000'000'000))
        ->option_text("N");
    app->add_flag("--retry", options.triesAgain,
                  "on resuming, retry crashes, timeouts, flaky cases");
    app->add_flag("--quiet", options.isQuiet, "print failures only");
}

void addQueries(CLI::App& app, const Context& context, Options& o) {
    CLI::App* doctorApp = app.add_subcommand("doctor", "what this machine has and what it lacks");
    addAssets(doctorApp, o.selection.assets);
    doctorApp->add_flag("--json", o.asJson, "machine-readable");
    doctorApp->callback(
        [&] { o.command = [&] { return doctor(context, o.selection.assets, o.asJson); }; });

    CLI::App* listApp = app.add_subcommand("list", "what there is: tables, techniques, scenes, …");
    listApp->add_option("what", o.name, "what to list")->required()->option_text(kListed);
    listApp->add_flag("--json", o.asJson, "machine-readable");
    addAssets(listApp, o.selection.assets);
    listApp->callback(
        [&] { o.command = [&] { return list(context, o.name, o.selection.assets, o.asJson); }; });

    CLI::App* describeApp = app.add_subcommand(
        "describe", "a technique, scene, generator, table or config; the schema");
    describeApp
        ->add_option("name", o.describe.name, "what to describe; 'config': the keys of configs")
        ->option_text("NAME");
    describeApp->add_flag("--json-schema", o.describe.asJsonSchema,
                          "schema of NAME for editors: experiment (default), preset, scene, "
                          "documents");
    describeApp->add_flag("--markdown", o.describe.asMarkdown,
                          "the keys of all kinds of files, as tables");
    describeApp->add_flag("--merged", o.describe.isMerged,
                          "the whole config of a table, with all that it extends, as one file");
    addAssets(describeApp, o.describe.assets);
    describeApp->callback([&] { o.command = [&] { return describe(context, o.describe); }; });

    CLI::App* checkApp = app.add_subcommand("check", "find mistakes in configs; needs no device");
    addConfigs(checkApp, o.selection.names)->required();
    addSelection(checkApp, o.selection);
    addOnly(checkApp, o.selection.only);
    checkApp->callback([&] { o.command = [&] { return check(context, o.selection); }; });

    CLI::App* planApp =
        app.add_subcommand("plan", "list the cases of configs, with expected time and memory");
    addTables(planApp, o.selection.names)->required();
    addSelection(planApp, o.selection);
    addOnly(planApp, o.selection.only);
    addFrom(planApp, o.run.from);
    planApp->add_flag("--json", o.asJson, "the plan as it would be frozen");
    planApp->callback(
        [&] { o.command = [&] { return plan(context, o.selection, o.run.from, o.asJson); }; });
}

void addRuns(CLI::App& app, const Context& context, Options& o) {
    CLI::App* runApp = app.add_subcommand("run", "measure the cases of configs into records.csv");
    addTables(runApp, o.run.selection.names);
    addRunOptions(runApp, o.run);
    runApp->callback([&] { o.command = [&] { return run(context, o.run); }; });

    CLI::App* reproduceApp =
        app.add_subcommand("reproduce", "measure papers or tables and write a report");
    addTables(reproduceApp, o.run.selection.names)
        ->description("PAPER, PAPER/TABLE or config files; none: all papers");
    addRunOptions(reproduceApp, o.run);
    reproduceApp->callback([&] { o.command = [&] { return reproduce(context, o.run); }; });

    const auto addOut = [&](CLI::App* result) {
        result->add_option("--out", o.out, "write here, and leave RUN as it is (default: RUN)")
            ->option_text("DIR");
    };
    CLI::App* tableApp = app.add_subcommand("table", "rebuild a run's tables from its records");
    addRunDirectory(tableApp, o.name);
    addOut(tableApp);
    tableApp->callback([&o] { o.command = [&o] { return table(o.name, o.out); }; });
    CLI::App* claimsApp = app.add_subcommand("claims", "judge a run's claims again");
    addRunDirectory(claimsApp, o.name);
    addOut(claimsApp);
    claimsApp
        ->add_option("--config", o.configs,
                     "judge by this config, not the run's own; written to judged-afterwards/")
        ->option_text("CONFIG");
    claimsApp->callback([&o] { o.command = [&o] { return claims(o.name, o.configs, o.out); }; });
    CLI::App* reportApp =
        app.add_subcommand("report", "rebuild a run's report.html, or make one of several runs");
    reportApp->add_option("runs", o.shards, "run directories, or kept results")
        ->required()
        ->option_text("RUN");
    reportApp->add_option("--out", o.out, "default: RUN/report.html; of several: report.html")
        ->option_text("FILE");
    reportApp->add_flag("--embed", o.embeds, "one file to send, with every picture inside");
    reportApp->callback([&] { o.command = [&] { return report(o.shards, o.out, o.embeds); }; });
}

void addCluster(CLI::App& app, const Context& context, Options& o) {
    CLI::App* mergeApp =
        app.add_subcommand("merge", "join shards into one run; tells what is missing");
    mergeApp->add_option("shards", o.shards, "the shards' run directories; or a submission")
        ->required()
        ->option_text("RUN");
    mergeApp->add_option("--out", o.out, "folder of the whole run; default: the submission")
        ->option_text("DIR");
    mergeApp->callback([&] { o.command = [&] { return merge(context, o.out, o.shards); }; });

    SubmitOptions& s = o.submit;
    CLI::App* submitApp =
        app.add_subcommand("submit", "measure in shards elsewhere: a Slurm array, or commands");
    addTables(submitApp, s.selection.names);
    addSelection(submitApp, s.selection);
    addOnly(submitApp, s.selection.only);
    submitApp->add_option("--out", s.out, "folder for the shards and the merged run")
        ->option_text("DIR");
    submitApp->add_option("--engine", s.engine, "what starts the shards")
        ->check(CLI::IsMember({"slurm", "commands"}));
    submitApp->add_option("--shards", s.shardCount, "default: one per predicted half hour")
        ->check(CLI::Range(1, 10000))
        ->option_text("N");
    addFrom(submitApp, s.from);
    submitApp->add_option("--jobs", s.jobs, "cases at once in a shard where no times are taken")
        ->check(CLI::Range(1, 256))
        ->option_text("N");
    submitApp->add_option("--partition", s.partition, "as for sbatch")->option_text("PARTITION");
    submitApp->add_option("--gres", s.gres, "as for sbatch: gpu:1")->option_text("LIST");
    addEach(submitApp, "--sbatch", s.sbatchFlags,
            "any other option of sbatch: --sbatch=--account=x", "FLAG");
    submitApp->add_flag("--force", s.isForced, "submit even if squeue does not answer");
    submitApp->add_flag("--dry-run", s.isDryRun, "print scripts and commands only");
    submitApp->add_flag("--status", s.isStatus, "how far the submission in this folder is");
    submitApp->callback([&] { o.command = [&] { return submit(context, o.submit); }; });
}

void addCompare(CLI::App& app, CompareOptions& options, std::function<int()>& command) {
    CLI::App* compareApp =
        app.add_subcommand("compare", "times, values and pictures of two runs or two builds");
    compareApp->add_option("inputs", options.inputs, "A B; or OLD NEW CONFIG… by turns")
        ->required()
        ->option_text("RUN");
    CLI::Option* binaries = compareApp->add_flag(
        "--binaries", options.areBinaries, "OLD and NEW are builds of gfxrepro, which take turns");
    compareApp
        ->add_flag("--programs", options.arePrograms,
                   "OLD and NEW are folders of two builds of your program, which take turns")
        ->excludes(binaries);
    compareApp
        ->add_option("--rounds", options.rounds,
                     "rounds of each program (default 20); up to five times as many while "
                     "undecided")
        ->check(CLI::Range(2, 1000))
        ->option_text("N");
    addProfile(compareApp, options.profile);
    addDevice(compareApp, options.device);
    compareApp->add_option("--out", options.out, "folder (default runs/<time>-compare)")
        ->option_text("DIR");
    compareApp
        ->add_option("--history", options.history, "append to this CSV, and report steps in it")
        ->option_text("FILE");
    addAssets(compareApp, options.assets);
    compareApp->callback([&] { command = [&] { return compare(options); }; });
}

void addSensitivity(CLI::App& app, const Context& context, Options& o) {
    SensitivityOptions& s = o.sensitivity;
    CLI::App* sensitivityApp =
        app.add_subcommand("sensitivity", "how claims depend on what the paper leaves open");
    sensitivityApp->add_option("names", s.selection.names, "PAPER, PAPER/TABLE or config files")
        ->required()
        ->option_text("TABLE");
    s.selection.profile = "quick";
    addSelection(sensitivityApp, s.selection);
    sensitivityApp
        ->add_option("--points", s.points, "values to try of a range of numbers (default 3)")
        ->check(CLI::Range(2, 100))
        ->option_text("N");
    sensitivityApp->add_option("--budget", s.budget, "start no run after this time, such as 15m")
        ->option_text("TIME");
    sensitivityApp->add_flag("--times", s.hasTimes, "include claims about times (slow)");
    sensitivityApp->add_option("--from", s.from, "a run that measured the tables as configured")
        ->option_text("RUN");
    sensitivityApp->add_option("--keep", s.keep, "summaries to continue: results/sensitivity")
        ->option_text("DIR");
    sensitivityApp->add_option("--out", s.out, "folder (default runs/<time>-sensitivity)")
        ->option_text("DIR");
    sensitivityApp->callback(
        [&] { o.command = [&] { return sensitivity(context, o.sensitivity); }; });
}

void addTools(CLI::App& app, const Context& context, Options& o) {
    addImageCommands(app, o.image, o.command);

    CLI::App* sceneApp = app.add_subcommand("scene", "look at a scene or export it");
    sceneApp->add_option("name", o.scene.name, "catalogue name or file")
        ->required()
        ->option_text("SCENE");
    sceneApp->add_option("--export", o.scene.exportFile, "write it as .glb or .ply")
        ->option_text("FILE");
    sceneApp->add_option("--render", o.scene.renderFile, "write a picture of it as .png")
        ->option_text("FILE");
    sceneApp->add_option("--size", o.scene.sizePx, "pixels per side of the render")
        ->check(CLI::Range(16, 8192))
        ->option_text("N");
    addDevice(sceneApp, o.scene.device);
    addAssets(sceneApp, o.scene.assets);
    sceneApp->callback([&] { o.command = [&] { return scene(context, o.scene); }; });

    // The program starts itself with this; `group("")` keeps it out of the help.
    CLI::App* workerApp = app.add_subcommand("worker", "")->group("");
    workerApp->add_option("--device", o.worker.device);
    workerApp->add_option("--assets", o.worker.assets);
    workerApp->add_option("--lane", o.worker.lane);
    workerApp->add_option("--run", o.worker.runDir);
    workerApp->add_option("--command", o.worker.command);
    workerApp->add_option("--jobs", o.worker.jobs);
    workerApp->callback([&] { o.command = [&] { return worker(context, o.worker); }; });
}

/// What a shell wants to know: the commands as they are defined above.
void addShell(CLI::App& app, Options& o) {
    CLI::App* completionApp =
        app.add_subcommand("completion", "print a script that lets a shell complete commands");
    completionApp->add_option("shell", o.name, "which shell")
        ->required()
        ->check(CLI::IsMember({"bash", "zsh", "fish"}));
    completionApp->callback([&] {
        o.command = [&] {
            fmt::print("{}", completionScript(o.name));
            return kExitOk;
        };
    });

    CLI::App* manApp = app.add_subcommand("man", "")->group("");
    manApp->callback([&] {
        o.command = [&] {
            fmt::print("{}", manPage(app));
            return kExitOk;
        };
    });
}

int runCommand(int argc, const char* const* argv,
               std::span<const technique::TechniqueInfo> techniques,
               std::span<const scene::GeneratorInfo> generators) {
    Context context{techniques, generators, "gfxrepro", std::chrono::steady_clock::now()};
    for (int i = 1; i < argc; ++i) context.commandLine += ' ' + shellQuoted(argv[i]);
    Options options;
    CLI::App app("Measures the tables of rendering papers again, and your own experiments.",
                 "gfxrepro");
    app.require_subcommand(0, 1);  // what follows a command is no other one: describe scene
    app.set_help_flag("-h,--help", "this text");
    app.set_version_flag("--version", fmt::format("gfxrepro {} (commit {})", GFXREPRO_VERSION,
                                                  run::programCommit()));
    addQueries(app, context, options);
    addRuns(app, context, options);
    addCluster(app, context, options);
    addSensitivity(app, context, options);
    addTools(app, context, options);
    addDataCommands(app, context, options.data, options.command);
    addFileCommands(app, context, options.file, options.command);
    addCompare(app, options.compare, options.command);
    addShell(app, options);
    arrangeHelp(app);
    if (argc < 2) throw UsageError("no command; see 'gfxrepro --help'");
    if (std::string_view(argv[1]) == "complete") {  // ahead of the parser: the words are unfinished
        for (const std::string& word : completions(app, context, {argv + 2, argv + argc})) {
            fmt::print("{}\n", word);
        }
        return kExitOk;
    }
    parse(app, argc, argv);
    return options.command ? options.command() : kExitOk;
}

}  // namespace

// The catch of the program stands here, not in main.cpp, so that tests' programs exit alike.
int run(int argc, const char* const* argv, std::span<const technique::TechniqueInfo> techniques,
        std::span<const scene::GeneratorInfo> generators) {
    // Inherited as ignored, the ends of children would be known to nobody: a crash would be "ok".
    std::signal(SIGCHLD, SIG_DFL);
    // A file that may not grow beyond `ulimit -f` is then a write that fails, with a line of its
    // own.
    std::signal(SIGXFSZ, SIG_IGN);
    try {
        const int code = runCommand(argc, argv, techniques, generators);
        if (std::fflush(stdout) == 0) return code;
        tell("gfxrepro: cannot write the standard output: {}\n", std::strerror(errno));
        return kExitUsage;
    } catch (const std::filesystem::filesystem_error& error) {
        tell("gfxrepro: {}\n", textOf(error));
        return kExitUsage;
    } catch (const nlohmann::json::exception& error) {
        const std::string_view text = error.what();  // "[json.exception.NAME] TEXT"
        tell("gfxrepro: cannot read or write JSON: {}\n", text.substr(text.find("] ") + 2));
        return kExitUsage;
    } catch (const std::bad_alloc& error) {
        tell("gfxrepro: out of memory\n");
        return kExitUsage;
    } catch (const std::exception& error) {
        tell("gfxrepro: {}\n", error.what());
        return dynamic_cast<const NoDeviceError*>(&error) ? kExitNoDevice : kExitUsage;
    }
}

}  // namespace gfxrepro::cli
