#include "runner/outcome/results.h"

#include <fmt/format.h>
#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/text.h"
#include "runner/claims/claims.h"
#include "runner/claims/kept_claims.h"
#include "runner/outcome/export.h"
#include "runner/report/report.h"
#include "runner/report/writers.h"
#include "runner/run/case_filter.h"
#include "runner/run/machine_state.h"
#include "runner/run/manifest.h"
#include "runner/run/plan.h"
#include "runner/run/rounds.h"
#include "runner/run/run_directory.h"
#include "runner/studies/sensitivity.h"
#include "runner/tables/calibration.h"
#include "runner/tables/table.h"

namespace gfxrepro::outcome {

namespace fs = std::filesystem;

namespace {

constexpr const char* kFile = "made-from.txt";

}  // namespace

std::string madeFromLine(const fs::path& runDir, const run::Json& manifest) {
    return fmt::format("{}, started {}, plan {}\n",
                       fs::weakly_canonical(runDir).filename().string(),
                       manifest.value("started", "?"), manifest.value("plan", "?"));
}

void requireMadeFrom(const fs::path& folder, const std::string& lines) {
    if (fs::exists(folder / kFile)) {
        const std::string others = readFile(folder / kFile);
        if (others == lines) return;
        throw Error(fmt::format("{}: was made from another run ({}); give another folder",
                                folder.string(), others.substr(0, others.find('\n'))));
    }
    for (const char* name : {"plan.json", "manifest.json", "claims.csv", "tables", "junit.xml",
                             "report.html", "comparison.md"}) {
        if (!fs::exists(folder / name)) continue;
        throw Error(fmt::format("{}: has {}, and no {} says of which run; give another folder",
                                folder.string(), name, kFile));
    }
}

void noteMadeFrom(const fs::path& folder, const std::string& lines) {
    writeFileAtomic(folder / kFile, lines);
}

void takeFolder(const fs::path& folder, const fs::path& runDir, const run::Json& manifest) {
    std::error_code isAbsent;
    if (fs::equivalent(folder, runDir, isAbsent)) return;
    const std::string line = madeFromLine(runDir, manifest);
    requireMadeFrom(folder, line);
    noteMadeFrom(folder, line);
}

bool isPaperFolder(const fs::path& folder) {
    if (!fs::is_directory(folder)) return false;
    return std::ranges::any_of(entriesIn(folder), [](const auto& file) {
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
    run::forEachEvent(runDir / "journal.jsonl", [&](const run::Json& event) {
        if (event.contains("case")) events[event.value("case", "")].push_back(eventText(event));
    });
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

}  // namespace

report::ReportOptions reportOptions(bool embeds, report::PicturesDone progress) {
    const fs::path configs = dataFolder("configs");
    const fs::path findings = configs.parent_path() / "results" / "findings";
    return {config::readDocuments(configs / "documents.yaml"), embeds, std::move(progress),
            fs::is_directory(findings) ? findings : fs::path()};
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

namespace {

/// "a=1; b=x" as its axes and their values.
void takeRow(const std::string& row, std::vector<std::string>& axes,
             std::vector<std::string>& labels) {
    for (const std::string& part : split(row, ';')) {
        const std::string text(trimmed(part));
        const std::size_t at = std::min(text.find('='), text.size());
        axes.push_back(text.substr(0, at));
        labels.push_back(at < text.size() ? text.substr(at + 1) : "");
    }
}

/// Tables of numbers alone, in the order of the file.
std::vector<tables::Table> keptTables(const fs::path& file) {
    std::vector<tables::Table> kept;
    for (const claims::KeptCell& cell : claims::readKeptCells(file)) {
        if (kept.empty() || kept.back().id != cell.table) {
            kept.emplace_back().id = cell.table;
        }
        tables::Table& table = kept.back();
        tables::TableRow row;
        table.rowAxes.clear();
        takeRow(cell.row, table.rowAxes, row.labels);
        auto place = std::ranges::find(table.rows, row.labels, &tables::TableRow::labels);
        if (place == table.rows.end()) place = table.rows.insert(place, std::move(row));
        std::size_t column = table.findColumn(cell.column).value_or(table.columns.size());
        if (column == table.columns.size()) table.columns.push_back({cell.column, ""});
        if (place->cells.size() <= column) place->cells.resize(column + 1);
        tables::Cell& shown = place->cells[column];
        if (!cell.printed.empty()) shown.printed = cell.printed;
        if (!cell.measured) continue;
        const auto text = [](double value) { return fmt::format("{:.4g}", value); };
        tables::Measured value;
        value.value = *cell.measured;
        shown.status = records::Status::Ok;
        shown.measured = text(*cell.measured);
        if (cell.low && cell.high) {
            value.bounds = cell.isInterval ? tables::Bounds::Interval : tables::Bounds::Range;
            value.interval = {*cell.low, *cell.high};
            shown.low = text(*cell.low);
            shown.high = text(*cell.high);
        }
        shown.values = {value};
    }
    for (tables::Table& table : kept) {
        for (tables::TableRow& row : table.rows) {
            row.cells.resize(table.columns.size());
            for (tables::Cell& cell : row.cells) cell.isPlanned = cell.isOk();
        }
    }
    return kept;
}

}  // namespace

report::ReportRun keptRun(const fs::path& folder) {
    const fs::path runs = folder / "runs.csv", claims = folder / "claims.csv";
    if (!fs::exists(runs) || !fs::exists(claims)) {
        throw Error(folder.string() + ": is neither a run directory (plan.json) nor kept results " +
                    "(runs.csv and claims.csv)");
    }
    run::requirePlainFiles(folder);
    report::ReportRun result;
    result.folder = folder;
    result.claims = claims::readClaims(claims);
    if (fs::exists(folder / "cells.csv")) result.keptTables = keptTables(folder / "cells.csv");
    std::set<std::string> commits;
    for (const claims::KeptRun& run : claims::readKeptRuns(runs)) {
        commits.insert(run.commit);
        result.manifest = {{"gl", {{"renderer", run.device}, {"version", run.gl}}},
                           {"cpu", run.cpu},
                           {"cores", run.cores},
                           {"started", run.started}};
        result.context.device = run.device;
        result.context.deviceClass = run.deviceClass;
        result.context.command = run.command;
    }
    result.context.profile = fs::weakly_canonical(folder).filename().string();
    result.context.commit =
        commits.size() == 1 ? *commits.begin() : fmt::format("of {} programs", commits.size());
    return result;
}

claims::ReportContext reportContext(const run::Json& manifest) {
    claims::ReportContext context;
    context.device = manifest.at("gl").at("renderer").get<std::string>();
    context.deviceClass = manifest.at("device_class").get<std::string>();
    context.profile = manifest.at("profile").get<std::string>();
    context.commit = manifest.at("commit").get<std::string>();
    context.command = manifest.at("invocations").at(0).at("command").get<std::string>();
    return context;
}

namespace {

using Experiments = std::vector<config::Experiment>;

/// What the kept results say of the claims; that there is nowhere to look where some are of
/// documents.
void takeKeptSensitivity(const run::Plan& plan, const Experiments& experiments,
                         claims::ReportContext& context) {
    const auto kept = studies::keptSensitivity(plan, experiments);
    const bool areOfDocuments = std::ranges::any_of(experiments, &config::Experiment::isPublished);
    context.knowsTried = kept || !areOfDocuments;
    context.tried = kept.value_or(claims::KeptSensitivity{});
}

/// Of each table, of what the scenes were made that its cases loaded.
std::map<std::string, std::string> sceneClasses(const run::StoredRun& run) {
    claims::SceneFiles files;
    for (const auto& [scene, from] : run.manifest.at("scenes").items()) {
        files[scene] = !from.at("sha256").get<std::string>().empty();
    }
    std::map<std::string, std::set<std::string>> loaded;
    for (const config::Case& item : run.plan.cases) {
        if (!item.scene.isNull()) loaded[item.experiment].insert(item.scene.text());
    }
    std::map<std::string, std::string> classes;
    for (const auto& [table, scenes] : loaded) classes[table] = claims::sceneClass(scenes, files);
    return classes;
}

claims::ReportContext contextOf(const run::StoredRun& run, const Experiments& experiments) {
    claims::ReportContext context = reportContext(run.manifest);
    context.sceneClasses = sceneClasses(run);
    takeKeptSensitivity(run.plan, experiments, context);
    const run::Request& request = run.plan.request;
    context.isAltered = !request.only.empty() || !request.sets.empty() || !request.sweeps.empty();
    context.tableNotes =
        tables::keptCalibrations(dataFolder("configs").parent_path() / "results/calibration");
    for (const config::Experiment& experiment : experiments) {
        const std::string note = run::machineStateNote(run.manifest, experiment.id);
        if (!note.empty()) context.tableNotes[experiment.id].push_back(note);
    }
    return context;
}

/// Behind what the run itself must say: that its files were changed, that machines differ.
std::vector<tables::Table> withNotes(std::vector<tables::Table> tables,
                                     const std::vector<std::string>& notes) {
    for (tables::Table& table : tables) {
        table.notes.insert(table.notes.begin(), notes.begin(), notes.end());
    }
    return tables;
}

}  // namespace

Results resultsOf(const run::StoredRun& run) {
    return resultsOf(run, run.plan.experiments);
}

Results resultsOf(const run::StoredRun& run, const Experiments& experiments) {
    Results results;
    results.context = contextOf(run, experiments);
    results.tables =
        tables::buildTables(experiments, run.plan.cases, run.records, run.plan.experiments);
    tables::addNotes(results.context.tableNotes, results.tables);
    const tables::MovedClocks clocks = run::movedClocks(run.manifest);
    for (tables::Table& table : results.tables) {
        tables::markMovedClocks(clocks, table);
        table.timesOf = run::takenTimesNote(run.manifest, table.id);
    }
    results.claims =
        claims::evaluateClaims(experiments, results.tables, results.context, run.plan.cases);
    for (tables::Table& table : results.tables) {
        std::vector<std::string> labels = table.judgedByProcess;
        for (const claims::ClaimResult& claim : results.claims) {
            if (claim.table != table.id) continue;
            labels.insert(labels.end(), claim.columnsByProcess.begin(),
                          claim.columnsByProcess.end());
        }
        tables::showProcessTimes(labels, table);
    }
    results.printedCells = tables::countPrintedCells(experiments, results.tables);
    return results;
}

Results writeResults(const fs::path& runDir, const run::StoredRun& run, const ResultFiles& which) {
    const fs::path out = which.out.empty() ? runDir : which.out;
    if (!which.out.empty()) takeFolder(out, runDir, run.manifest);
    const Experiments& experiments = run.plan.experiments;
    Results results = resultsOf(run);
    if (which.tables) {
        writeCases(out / "cases.csv", run.plan.cases);
        const std::vector<std::string> notes = run::notesOf(run.manifest);
        report::writeTables(out, withNotes(results.tables, notes), notes);
        tables::writeFits(out, experiments, results.tables);
        report::writeNearness(out, experiments, results.tables);
    }
    if (which.claims) {
        report::writeClaims(out, run::caseResults(run, runDir), results.claims, results.context,
                            run.manifest.value("started", ""));
    }
    if (!which.tables && !which.report) return results;
    const bool isKept = which.tables || !which.embeds;
    std::vector<report::Curve> curves =
        report::drawCurves(isKept ? out : fs::path(), results.tables, experiments);
    if (which.report) {
        report::ReportRun shown = reportRun(runDir, run, results);
        shown.curves = std::move(curves);
        report::writeReport(out / "report.html", {&shown, 1},
                            reportOptions(which.embeds, which.progress));
    }
    return results;
}

}  // namespace gfxrepro::outcome
