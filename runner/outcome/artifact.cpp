#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "engine/core/files.h"
#include "engine/core/hash.h"
#include "engine/core/output_files.h"
#include "engine/core/text.h"
#include "runner/cluster/predictions.h"
#include "runner/config/external_program.h"
#include "runner/outcome/export.h"
#include "runner/outcome/import_run.h"
#include "runner/outcome/results.h"
#include "runner/report/markup.h"
#include "runner/run/manifest.h"
#include "runner/run/run_directory.h"

namespace gfxrepro::outcome {

namespace fs = std::filesystem;

namespace {

std::uintmax_t sizeOf(const fs::path& path) {
    if (!fs::exists(path)) return 0;
    if (fs::is_regular_file(path)) return fs::file_size(path);
    std::uintmax_t bytes = 0;
    for (const auto& entry : entriesBelow(path)) {
        if (entry.is_regular_file()) bytes += entry.file_size();
    }
    return bytes;
}

/// What was measured; what is made of it is made again there.
void copyMeasured(const fs::path& runDir, const fs::path& target) {
    for (const char* name :
         {"plan.json", "manifest.json", "records.csv", "journal.jsonl", "images"}) {
        copyTree(runDir / name, target / name);
    }
}

/// Every number and text of a JSON object, a line each: "gl.vendor: Mesa".
std::string flatText(const run::Json& object, const std::string& prefix) {
    std::string text;
    for (const auto& [key, value] : object.items()) {
        if (value.is_object()) {
            text += flatText(value, prefix + key + '.');
        } else if (!value.is_array()) {
            text +=
                prefix + key + ": " + (value.is_string() ? value.get<std::string>() : value.dump());
            text += '\n';
        }
    }
    return text;
}

std::string environmentText(run::Json manifest) {
    manifest.erase("scenes");
    return flatText(manifest, "");
}

std::string assetsText(const run::Json& manifest, const scene::Catalog& catalog) {
    using report::escapeMarkdown;
    std::string text =
        "# Scenes\nWhat was loaded. Generated scenes and stand-ins of generators come with the "
        "program, under its licence (Apache-2.0).\n\n| scene | kind | what | SHA-256 | licence | "
        "where to get it |\n| --- | --- | --- | --- | --- | --- |\n";
    for (const auto& [name, use] : manifest.at("scenes").items()) {
        const std::string sha256 = use.at("sha256").get<std::string>();
        std::string licence = sha256.empty() ? "Apache-2.0" : "not recorded", where;
        const auto entry = catalog.entries().find(name);
        if (entry != catalog.entries().end() && !sha256.empty()) {
            if (!entry->second.licence.empty()) licence = entry->second.licence;
            where = entry->second.canonical;
        }
        text += fmt::format("| {} | {} | {} | {} | {} | {} |\n", escapeMarkdown(name),
                            use.at("kind").get<std::string>(),
                            escapeMarkdown(use.at("description").get<std::string>()), sha256,
                            escapeMarkdown(licence), escapeMarkdown(where));
    }
    return text;
}

/// Where the artifact has a program's file, by its name as the manifest has it.
using Places = std::map<std::string, fs::path>;

/// Empty where none was measured.
std::string programsText(const run::Json& manifest, const Places& places) {
    const std::set<run::ProgramUse> programs = run::programsOf(manifest);
    if (programs.empty()) return "";
    std::string text =
        "\n# Programs\nWhat was measured from outside, with the files that it reads. What lay "
        "beside "
        "or below the config is in this folder, where its copy looks for it, if it is still what "
        "was measured; the others are to be installed by who measures again.\n\n"
        "| file | version | SHA-256 | in this folder |\n| --- | --- | --- | --- |\n";
    for (const run::ProgramUse& use : programs) {
        const auto place = places.find(use.file);
        text += fmt::format(
            "| {} | {} | {} | {} |\n", report::escapeMarkdown(use.file),
            report::escapeMarkdown(use.version), use.sha256,
            place == places.end() ? "" : report::escapeMarkdown(place->second.string()));
    }
    return text;
}

/// configs/<folder>/<file> of an experiment.
fs::path configPlace(const config::Experiment& experiment) {
    return fs::path("configs") / experiment.file.parent_path().filename() /
           experiment.file.filename();
}

/// The files of an experiment's program, by path; none where one of them is not here any more.
std::map<fs::path, std::string> programFiles(const run::Plan& plan,
                                             const config::Experiment& experiment) {
    std::map<fs::path, std::string> files;
    const Node& node = config::programOf(experiment);
    if (node.isNull()) return files;
    const config::ExternalProgram program = config::readProgram(node);
    try {
        for (const config::Case& item : plan.cases) {
            if (item.experiment != experiment.id) continue;
            for (const config::ProgramFile& file :
                 config::filesOf(program, program.valuesOf(item.params))) {
                if (!file.path.empty()) files.emplace(file.path, file.name);
            }
        }
    } catch (const Error&) {
        files.clear();
    }
    return files;
}

/// Copies what lies beside or below a config, and is what was measured, to the same place beside
/// the config's copy.
Places copyProgramFiles(const run::StoredRun& run, const fs::path& target) {
    const std::set<run::ProgramUse> uses = run::programsOf(run.manifest);
    Places places;
    for (const config::Experiment& experiment : run.plan.experiments) {
        const fs::path folder = fs::absolute(experiment.file).lexically_normal().parent_path();
        for (const auto& [path, name] : programFiles(run.plan, experiment)) {
            const fs::path inside = path.lexically_relative(folder);
            if (inside.empty() || *inside.begin() == "..") continue;
            const auto isThis = [&path = path, &name = name](const run::ProgramUse& use) {
                return use.file == name && use.sha256 == sha256OfFile(path);
            };
            const bool isMeasured = std::ranges::any_of(uses, isThis);
            if (!isMeasured) continue;
            const fs::path place = configPlace(experiment).parent_path() / inside;
            fs::create_directories((target / place).parent_path());
            fs::copy_file(path, target / place, fs::copy_options::overwrite_existing);
            places.emplace(name, place);
        }
    }
    return places;
}

std::string scriptText(const run::Plan& plan, const config::Experiment& experiment) {
    std::string command = "reproduce " + shellQuoted(configPlace(experiment).string()) +
                          " --profile " + shellQuoted(plan.profile) + " --device " +
                          shellQuoted(plan.request.device);
    for (const std::string& set : plan.request.sets) command += " --set " + shellQuoted(set);
    for (const std::string& sweep : plan.request.sweeps)
        command += " --sweep " + shellQuoted(sweep);
    for (const std::string& only : plan.request.only) command += " --only " + shellQuoted(only);
    return fmt::format(
        "#!/bin/sh\n# {}: {}\nset -e\ncd \"$(dirname \"$0\")/..\"\n"
        "exec \"${{GFXREPRO:-gfxrepro}}\" {} --out again/{}\n",
        experiment.label(), experiment.title, command, experiment.slug());
}

void writeScripts(const run::Plan& plan, const fs::path& target) {
    const fs::path configs = dataFolder("configs");
    for (const char* folder : {"presets", "scenes"}) {
        if (fs::exists(configs / folder)) copyTree(configs / folder, target / "configs" / folder);
    }
    for (const config::Experiment& experiment : plan.experiments) {
        const fs::path place = target / configPlace(experiment);
        copyTree(experiment.file, place);
        const fs::path script = target / "scripts" / (experiment.slug() + ".sh");
        writeFileAtomic(script, scriptText(plan, experiment));
        fs::permissions(script, fs::perms::owner_all | fs::perms::group_read |
                                    fs::perms::group_exec | fs::perms::others_read |
                                    fs::perms::others_exec);
    }
}

/// Minutes that the cases of each experiment took, one after another.
std::map<std::string, double> minutesOf(const fs::path& runDir) {
    std::map<std::string, double> minutes;
    for (const cluster::PastCase& past : cluster::readPastCases(runDir)) {
        const run::Cost& cost = past.cost;
        minutes[past.item.experiment] += cost.totalS() * past.item.measure.processes / 60.0;
    }
    return minutes;
}

/// Of the artifact, when all else is in it.
std::string readmeText(const fs::path& artifact, const run::StoredRun& run) {
    std::map<std::string, double> minutes = minutesOf(artifact);
    const claims::ReportContext context = reportContext(run.manifest);
    std::string text = fmt::format(
        "# Measured by gfxrepro {}\nProfile {}, on {}.\n\n"
        "`report.html` shows all; `tables/` and `claims.csv` are what it shows, made from the "
        "cases of `plan.json`, where their parameters are, and `records.csv`. `environment.txt` "
        "says with what and on what it was measured, `ASSETS.md` which models and their terms "
        "and which programs, "
        "`SHA256SUMS` that nothing changed since. `scripts/` measures each table again: "
        "`scripts/NAME.sh`, with the program on the path or named by "
        "`GFXREPRO`, of the same commit for the same bytes.\n\n| table | script | minutes | MiB of "
        "results |\n| --- | --- | ---: | ---: |\n",
        context.commit, context.profile, report::escapeMarkdown(context.device));
    for (const config::Experiment& experiment : run.plan.experiments) {
        const std::string slug = experiment.slug();
        std::uintmax_t bytes = 0;
        for (const fs::path& part :
             {fs::path("images") / slug, fs::path("thumbnails") / slug,
              fs::path("tables") / (slug + ".csv"), fs::path("tables") / (slug + ".md"),
              fs::path("tables") / (slug + ".tex")}) {
            bytes += sizeOf(artifact / part);
        }
        text += fmt::format("| {}: {} | scripts/{}.sh | {:.1f} | {:.1f} |\n", experiment.label(),
                            report::escapeMarkdown(experiment.title), slug, minutes[experiment.id],
                            static_cast<double>(bytes) / (1 << 20));
    }
    return text;
}

std::string checksums(const fs::path& target) {
    std::vector<fs::path> files;
    for (const auto& entry : entriesBelow(target)) {
        if (entry.is_regular_file()) files.push_back(entry.path());
    }
    std::ranges::sort(files);
    std::string text;
    for (const fs::path& file : files) {
        text += sha256OfFile(file) + "  " + fs::relative(file, target).string() + '\n';
    }
    return text;
}

void fillArtifact(const fs::path& runDir, const run::StoredRun& run, const scene::Catalog& catalog,
                  const fs::path& target) {
    takeFolder(target, runDir, run.manifest);
    writeFileAtomic(target / "environment.txt", environmentText(run.manifest));
    copyMeasured(runDir, target);
    writeResults(target, run, {});
    writeFileAtomic(target / "manifest.json", run.manifest.dump(2) + '\n');  // with its notes
    writeScripts(run.plan, target);
    const Places places = copyProgramFiles(run, target);
    writeFileAtomic(target / "ASSETS.md",
                    assetsText(run.manifest, catalog) + programsText(run.manifest, places));
    writeFileAtomic(target / "README.md", readmeText(target, run));
    writeFileAtomic(target / "SHA256SUMS", checksums(target));
}

}  // namespace

void writeArtifact(const fs::path& runDir, const run::StoredRun& run, const scene::Catalog& catalog,
                   const fs::path& target) {
    requireNotImported(run.manifest, runDir.string(),
                       "measure again; `export --tidy` gives its numbers");
    writeFolder(target, [&](const fs::path& part) { fillArtifact(runDir, run, catalog, part); });
}

}  // namespace gfxrepro::outcome
