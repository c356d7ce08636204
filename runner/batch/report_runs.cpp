#include "runner/batch/report_runs.h"

#include <fmt/format.h>

#include <map>
#include <set>
#include <sstream>

#include "runner/batch/case_filter.h"
#include "runner/batch/run_directory.h"
#include "runner/batch/run_files.h"
#include "runner/batch/submission.h"
#include "runner/core/files.h"
#include "runner/core/text.h"
#include "runner/report/report.h"

namespace gfxrepro::batch {

namespace fs = std::filesystem;

namespace {

/// "load 0.01 s, setup 0.14 s, render 0.46 s, record 0.03 s, peak 124 MB".
std::string costText(const Json& cost) {
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

/// A line of log.jsonl about a case, for people; then what its worker printed.
std::string eventText(const Json& event) {
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

/// Of each case, what the log says; a torn or foreign line is passed over.
std::map<std::string, std::vector<std::string>> caseLogs(const fs::path& runDir) {
    std::map<std::string, std::vector<std::string>> logs;
    for (const Json& event : readLog(runDir / "log.jsonl")) {
        if (!event.contains("case")) continue;
        logs[event.value("case", "")].push_back(eventText(event));
    }
    return logs;
}

/// "xie2017/table-13" of a shipped config; another's file.
std::string configName(const fs::path& file) {
    const fs::path folder = file.parent_path();
    std::error_code isAbsent;
    const bool isShipped = fs::equivalent(folder.parent_path(), dataFolder("configs"), isAbsent);
    static const std::set<std::string> kNamedByFile = {"calibration", "nightly", "smoke", "sweeps"};
    const bool isPaper = isShipped && !kNamedByFile.contains(folder.filename().string());
    return isPaper ? (folder.filename() / file.stem()).string() : file.string();
}

std::string commandOf(const Case& item, const Plan& plan, CaseNames& names) {
    std::string config;
    for (const config::Experiment& experiment : plan.experiments) {
        if (experiment.id == item.experiment) config = configName(experiment.file);
    }
    std::string command =
        "gfxrepro run " + shellQuoted(config) + " --profile " + shellQuoted(plan.profile);
    const auto add = [&](const char* option, const std::string& value) {
        command += fmt::format(" {} {}", option, shellQuoted(value));
    };
    if (plan.request.device != "auto") add("--device", plan.request.device);
    for (const std::string& set : plan.request.sets) add("--set", set);
    for (const std::string& sweep : plan.request.sweeps) add("--sweep", sweep);
    for (const std::string& only : names.onlyOf(item)) add("--only", only);
    return command;
}

}  // namespace

html::ReportOptions reportOptions(bool embeds) {
    return {config::readDocuments(dataFolder("configs") / "documents.yaml"), embeds};
}

html::ReportRun reportRun(const fs::path& runDir, const StoredRun& run) {
    html::ReportRun result{runDir,
                           reportContext(run),
                           run.manifest,
                           run.plan.experiments,
                           plannedCases(run.plan.cases),
                           run.records,
                           {},
                           {}};
    auto logs = caseLogs(runDir);
    CaseNames names(run.plan);
    const bool isImported = run.manifest.contains("imported");
    for (const Case& item : run.plan.cases) {
        result.cases.push_back(
            {item.id, item.experiment, item.title(),
             isImported ? result.context.command : commandOf(item, run.plan, names),
             std::move(logs[item.id])});
    }
    return result;
}

html::ReportRun reportRun(const fs::path& folder) {
    if (fs::exists(folder / "plan.json")) return reportRun(folder, readRun(folder));
    if (!fs::exists(folder / "manifest.json") || !fs::exists(folder / "claims.csv")) {
        throw Error(folder.string() + ": is neither a run directory (plan.json) nor kept results " +
                    "(manifest.json and claims.csv)");
    }
    requirePlainFiles(folder);
    html::ReportRun result;
    result.folder = folder;
    result.manifest = readManifest(folder / "manifest.json");
    result.context = reportContext(result.manifest);
    result.keptClaims = report::readClaims(folder / "claims.csv");
    return result;
}

}  // namespace gfxrepro::batch
