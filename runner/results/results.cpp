#include "runner/results/results.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>

#include "engine/core/files.h"
#include "runner/report/report.h"
#include "runner/report/writers.h"
#include "runner/results/made_from.h"
#include "runner/results/report_runs.h"
#include "runner/results/tidy.h"
#include "runner/run/machine_state.h"
#include "runner/run/manifest.h"
#include "runner/run/plan.h"
#include "runner/studies/sensitivity.h"
#include "runner/tables/fit.h"
#include "runner/tables/moved_clocks.h"

namespace gfxrepro::results {

namespace fs = std::filesystem;

claims::ReportContext reportContext(const run::Json& manifest) {
    claims::ReportContext context;
    context.device = manifest.at("gl").at("renderer").get<std::string>();
    context.deviceClass = manifest.at("device_class").get<std::string>();
    context.profile = manifest.at("profile").get<std::string>();
    context.commit = manifest.at("commit").get<std::string>();
    context.command = manifest.at("invocations").at(0).at("command").get<std::string>();
    if (const auto info = manifest.at("gl"); info.contains("balance")) {
        context.fragmentShare =
            run::balanceFromJson(info["balance"], {"manifest.json", 0, 0}).fragmentShare();
    }
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
    results.tables = tables::buildTables(experiments, run.plan.cases, run.records);
    tables::addNotes(results.context.tableNotes, results.tables);
    const tables::MovedClocks clocks = run::movedClocks(run.manifest);
    for (tables::Table& table : results.tables) tables::markMovedClocks(clocks, table);
    results.claims = claims::evaluateClaims(experiments, results.tables, results.context);
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
    }
    if (which.claims) {
        report::writeClaims(out, run::caseResults(run), results.claims, results.context);
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

}  // namespace gfxrepro::results
