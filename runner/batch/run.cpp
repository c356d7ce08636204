#include "runner/batch/run.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "runner/batch/report_runs.h"
#include "runner/batch/run_files.h"
#include "runner/batch/sensitivity.h"
#include "runner/core/files.h"
#include "runner/core/text.h"
#include "runner/report/fit.h"
#include "runner/report/report.h"

namespace gfxrepro::batch {

namespace fs = std::filesystem;

namespace {

/// Every unit that has rows, and whether all have values.
std::map<UnitKey, bool> recordedUnits(const std::vector<report::Record>& records) {
    std::map<UnitKey, bool> units;
    for (const report::Record& row : records) {
        const auto [unit, isNew] = units.try_emplace({row.caseId, row.process}, true);
        unit->second = unit->second &&
                       (row.status == report::Status::Ok || row.status == report::Status::Flaky);
    }
    return units;
}

void rewriteRecords(const RunDirectory& directory, const std::vector<report::Record>& rows) {
    fs::path rewritten = directory.recordsFile();
    rewritten += ".tmp";
    fs::remove(rewritten);
    report::RecordWriter(rewritten).append(rows);
    fs::rename(rewritten, directory.recordsFile());
}

}  // namespace

std::vector<Unit> remainingUnits(const Plan& plan, const RunDirectory& directory) {
    if (!fs::exists(directory.recordsFile())) return unitsOf(plan);
    const std::vector<report::Record> records = report::readRecords(directory.recordsFile());
    const std::map<UnitKey, bool> recorded = recordedUnits(records);
    std::vector<report::Record> kept;
    for (const report::Record& row : records) {
        if (recorded.at({row.caseId, row.process})) kept.push_back(row);
    }
    if (kept.size() != records.size()) rewriteRecords(directory, kept);
    std::vector<Unit> units = unitsOf(plan, records);
    std::erase_if(units, [&](const Unit& unit) {
        const auto found = recorded.find({unit.item->id, unit.process});
        return found != recorded.end() && found->second;
    });
    return units;
}

Rounds roundsOf(const Plan& plan, const RunDirectory& directory) {
    std::vector<report::Record> records;
    if (fs::exists(directory.recordsFile())) records = report::readRecords(directory.recordsFile());
    return {plan, records, readLog(directory.path() / "log.jsonl")};
}

std::vector<std::string> replaceForeignTimes(const Plan& plan, const RunDirectory& directory,
                                             Json& manifest, const std::string& machine) {
    if (!fs::exists(directory.recordsFile())) report::RecordWriter{directory.recordsFile()};
    std::set<std::string> unfinished;
    for (const Unit& unit : remainingUnits(plan, directory)) {
        if (unit.item->measure.lane != config::Measure::Lane::Timing) continue;
        const std::string& experiment = unit.item->experiment;
        if (timingMachine(manifest, experiment) != machine) unfinished.insert(experiment);
    }
    if (unfinished.empty()) return {};
    std::vector<report::Record> kept, replaced;
    std::set<std::string> experiments;
    for (const report::Record& row : report::readRecords(directory.recordsFile())) {
        const bool isReplaced = row.lane == "timing" && unfinished.contains(row.table);
        (isReplaced ? replaced : kept).push_back(row);
        if (isReplaced) experiments.insert(row.table);
    }
    if (!replaced.empty()) {
        report::RecordWriter(directory.path() / "records-replaced.csv").append(replaced);
        rewriteRecords(directory, kept);
    }
    for (const std::string& experiment : unfinished) {
        manifest["timing_machines"][experiment] = machine;
    }
    return {experiments.begin(), experiments.end()};
}

StoredRun readRun(const fs::path& runDir) {
    if (!fs::exists(runDir / "plan.json")) {
        throw Error(runDir.string() + ": is no run directory (it has no plan.json)");
    }
    requirePlainFiles(runDir);
    StoredRun run;
    run.plan = Plan::fromJsonFile(runDir / "plan.json");
    run.manifest = readManifest(runDir / "manifest.json");
    noteChanges(run.manifest, runDir);
    noteMachines(run.manifest);
    if (fs::exists(runDir / "records.csv")) {
        run.records = report::readRecords(runDir / "records.csv");
    }
    return run;
}

Completeness completeness(const StoredRun& run) {
    const std::map<UnitKey, bool> recorded = recordedUnits(run.records);
    Completeness counts;
    for (const Unit& unit : unitsOf(run.plan, run.records)) {
        ++counts.units;
        const auto found = recorded.find({unit.item->id, unit.process});
        if (found == recorded.end()) {
            ++counts.missing;
        } else if (!found->second) {
            ++counts.failed;
        }
    }
    return counts;
}

std::vector<report::CaseResult> caseResults(const StoredRun& run) {
    using Ended = report::CaseResult::Outcome;
    std::map<std::string, SourceLocation> files;
    for (const config::Experiment& experiment : run.plan.experiments) {
        files[experiment.id] = {experiment.file.string(), 0, 0};
    }
    std::map<UnitKey, const report::Record*> worst;
    for (const report::Record& row : run.records) {
        const auto [unit, isNew] = worst.try_emplace({row.caseId, row.process}, &row);
        if (!isNew && unit->second->status == report::Status::Ok) unit->second = &row;
    }
    std::map<std::string, report::CaseResult> results;
    std::vector<std::string> order;
    for (const Unit& unit : unitsOf(run.plan, run.records)) {
        const Case& item = *unit.item;
        const auto [result, isNew] = results.try_emplace(
            item.id, report::CaseResult{item.experiment, item.title(), Ended::Measured, "",
                                        files[item.experiment]});
        if (isNew) order.push_back(item.id);
        if (result->second.outcome == Ended::Failed) continue;
        const auto found = worst.find({item.id, unit.process});
        const report::Record* row = found == worst.end() ? nullptr : found->second;
        if (row && (row->status == report::Status::Ok || row->status == report::Status::Flaky)) {
            continue;
        }
        const bool isSkipped = row && (row->status == report::Status::Missing ||
                                       row->status == report::Status::Unsupported);
        result->second.outcome = isSkipped ? Ended::Skipped : Ended::Failed;
        result->second.text = row ? std::string(report::statusName(row->status)) : "not run";
        if (row && !row->message.empty()) result->second.text += ": " + row->message;
    }
    std::vector<report::CaseResult> ordered;
    for (const std::string& id : order) ordered.push_back(std::move(results.at(id)));
    return ordered;
}

report::ReportContext reportContext(const StoredRun& run) {
    report::ReportContext context = reportContext(run.manifest);
    context.tried = keptSensitivity(run.plan);
    context.calibrations =
        report::keptCalibrations(dataFolder("configs").parent_path() / "results/calibration");
    return context;
}

Conclusion writeResults(const fs::path& runDir, const StoredRun& run, const Results& which) {
    const fs::path out = which.out.empty() ? runDir : which.out;
    const report::ReportContext context = reportContext(run);
    std::vector<report::Table> tables = report::buildTables(run.plan.experiments, run.records);
    report::addCalibrations(context.calibrations, tables);
    const std::vector<std::string> notes = notesOf(run.manifest);
    for (report::Table& table : tables) {
        table.notes.insert(table.notes.begin(), notes.begin(), notes.end());
    }
    Conclusion conclusion;
    conclusion.printedCells = report::countPrintedCells(run.plan.experiments, tables);
    if (which.tables) {
        report::writeTables(out, tables);
        report::writeFits(out, run.plan.experiments, tables);
    }
    if (which.claims) {
        conclusion.claims = report::evaluateClaims(run.plan.experiments, tables, context);
        report::writeClaims(out, caseResults(run), conclusion.claims, context);
    }
    if (which.report) {
        const html::ReportRun shown = reportRun(runDir, run);
        html::writeReport(out / "report.html", {&shown, 1});
    }
    return conclusion;
}

}  // namespace gfxrepro::batch
