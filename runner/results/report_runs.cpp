#include "runner/results/report_runs.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>

#include "engine/core/files.h"
#include "engine/core/text.h"
#include "runner/claims/claims.h"
#include "runner/claims/kept_claims.h"
#include "runner/run/case_filter.h"
#include "runner/run/run_directory.h"
#include "runner/run/run_files.h"

namespace gfxrepro::results {

namespace fs = std::filesystem;

bool isPaperFolder(const fs::path& folder) {
    if (!fs::is_directory(folder)) return false;
    return std::ranges::any_of(fs::directory_iterator(folder), [](const auto& file) {
        const std::string name = file.path().filename().string();
        return name.starts_with("table-") || name.starts_with("figure-") ||
               name.starts_with("section-");
    });
}

namespace {

/// "load 0.01 s, setup 0.14 s, render 0.46 s, record 0.03 s, peak 124 MB".
std::string costText(const run::Json& cost) {
    std::string text;
    for (const char* phase : {"load", "setup", "render", "record"}) {
        const auto found = cost.find(std::string(phase) + "_s");
        if (found == cost.end()) continue;
        text += fmt::format("{} {:.3g} s, ", phase, found->get<double>());
    }
    if (const auto peak = cost.find("peak_bytes"); peak != cost.end()) {
        text += fmt::format("peak {:.0f} MB", peak->get<double>() / 1e6);
    }
    return text;
}

/// A line of journal.jsonl about a case, for people; then what its worker printed.
std::string eventText(const run::Json& event) {
    const int process = event.value("process", 0);
    std::string text = event.value("time", "");
    text += fmt::format("  process {}", process);
    text += fmt::format("  {}", event.value("status", ""));
    if (event.contains("as")) text += "  measured as " + event.value("as", "");
    if (event.contains("cost")) text += "  " + costText(event["cost"]);
    for (const char* key : {"message", "output"}) {
        if (const std::string said = event.value(key, ""); !said.empty()) text += '\n' + said;
    }
    return text;
}

/// Of each case, what the journal says; a torn or foreign line is passed over.
std::map<std::string, std::vector<std::string>> eventsOfCases(const fs::path& runDir) {
    std::map<std::string, std::vector<std::string>> events;
    for (const run::Json& event : run::readJournal(runDir / "journal.jsonl")) {
        if (!event.contains("case")) continue;
        events[event.value("case", "")].push_back(eventText(event));
    }
    return events;
}

/// "xie2017/table-13" of a shipped config; another's file.
std::string configName(const fs::path& file) {
    const fs::path folder = file.parent_path();
    std::error_code isAbsent;
    const bool isShipped = fs::equivalent(folder.parent_path(), dataFolder("configs"), isAbsent);
    return isShipped && isPaperFolder(folder) ? (folder.filename() / file.stem()).string()
                                              : file.string();
}

/// "gfxrepro COMMAND CONFIG" with what else the run was asked for, but for `--only`.
std::string commandFor(const char* command, const std::string& experimentId,
                       const run::Plan& plan) {
    std::string config;
    for (const config::Experiment& experiment : plan.experiments) {
        if (experiment.id == experimentId) config = configName(experiment.file);
    }
    std::string text = fmt::format("gfxrepro {} {} --profile {}", command, shellQuoted(config),
                                   shellQuoted(plan.profile));
    if (plan.request.device != "auto") text += " --device " + shellQuoted(plan.request.device);
    for (const std::string& set : plan.request.sets) text += " --set " + shellQuoted(set);
    for (const std::string& sweep : plan.request.sweeps) text += " --sweep " + shellQuoted(sweep);
    return text;
}

std::string commandOf(const config::Case& item, const run::Plan& plan, run::CaseNames& names) {
    std::string command = commandFor("run", item.experiment, plan);
    for (const std::string& only : names.onlyOf(item)) command += " --only " + shellQuoted(only);
    return command;
}

/// The command that measures a table again, as this run did.
std::string commandOf(const config::Experiment& experiment, const run::Plan& plan) {
    std::string command = commandFor("reproduce", experiment.id, plan);
    for (const std::string& only : plan.request.only) command += " --only " + shellQuoted(only);
    return command;
}

/// The shipped config of a table, figure, section or sweep; none for one of another's.
std::optional<fs::path> shippedConfig(const std::string& experiment) {
    const fs::path id = experiment;
    const bool isSweep = id.parent_path() == "sweep";
    const fs::path folder = dataFolder("configs") / (isSweep ? "sweeps" : id.parent_path());
    for (const char* kind : {"", "table-", "section-"}) {
        const fs::path file = folder / (kind + id.filename().string() + ".yaml");
        if (fs::is_regular_file(file)) return file;
    }
    return std::nullopt;
}

/// Kept verdicts of before say nothing in words: those of the shipped configs' claims of that name.
void addWords(std::vector<claims::ClaimResult>& claims) {
    std::map<std::string, std::map<std::string, std::string>> words;  // by experiment, by claim
    for (claims::ClaimResult& claim : claims) {
        if (!claim.text.empty()) continue;
        const auto [known, isNew] = words.try_emplace(claim.table);
        const auto file = isNew ? shippedConfig(claim.table) : std::nullopt;
        if (file) {
            for (const config::ClaimSpec& spec :
                 config::loadExperiment(*file, {}, dataFolder("configs")).claims) {
                known->second[spec.id] = spec.text;
            }
        }
        if (const auto found = known->second.find(claim.id); found != known->second.end()) {
            claim.text = found->second;
        }
    }
}

}  // namespace

report::ReportOptions reportOptions(bool embeds, report::PicturesDone progress) {
    return {config::readDocuments(dataFolder("configs") / "documents.yaml"), embeds,
            std::move(progress)};
}

report::ReportRun reportRun(const fs::path& runDir, const run::StoredRun& run,
                            const Results& results) {
    report::ReportRun result;
    result.folder = runDir;
    result.context = results.context;
    result.manifest = run.manifest;
    result.experiments = run.plan.experiments;
    result.tables = results.tables;
    result.claims = results.claims;
    result.records = run.records;
    for (const config::Experiment& experiment : run.plan.experiments) {
        result.commands[experiment.id] = commandOf(experiment, run.plan);
    }
    result.cases = run.plan.cases;
    result.events = eventsOfCases(runDir);
    run::CaseNames names(run.plan);
    const bool isImported = run.manifest.contains("imported");
    for (const config::Case& item : run.plan.cases) {
        result.commands[item.id] =
            isImported ? result.context.command : commandOf(item, run.plan, names);
    }
    return result;
}

report::ReportRun keptRun(const fs::path& folder) {
    if (!fs::exists(folder / "manifest.json") || !fs::exists(folder / "claims.csv")) {
        throw Error(folder.string() + ": is neither a run directory (plan.json) nor kept results " +
                    "(manifest.json and claims.csv)");
    }
    run::requirePlainFiles(folder);
    report::ReportRun result;
    result.folder = folder;
    result.manifest = run::readManifest(folder / "manifest.json");
    result.context = reportContext(result.manifest);
    result.claims = claims::readClaims(folder / "claims.csv");
    addWords(result.claims);
    return result;
}

}  // namespace gfxrepro::results
