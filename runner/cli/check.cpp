#include <algorithm>
#include <set>

#include "runner/batch/ledger.h"
#include "runner/cli/commands.h"
#include "runner/cli/console.h"
#include "runner/cli/expectation_lists.h"
#include "runner/cli/experiments.h"
#include "runner/config/program.h"
#include "runner/config/scene_reference.h"
#include "runner/config/schema.h"
#include "runner/report/claims.h"
#include "runner/report/figure.h"

namespace gfxrepro::cli {

namespace {

/// Says which claims and plots the profile or an override leaves without what they read in the file
/// as it stands: they will be unmeasured, or left out.
void sayUnread(const Context& context, const scene::Catalog& catalog, const std::string& file,
               const config::Experiment& experiment, const report::Table& table) {
    const config::Experiment whole = loadExperiments({{file}, {}, {}, {}, ""}, "full").front();
    const std::vector<batch::Case> cases =
        batch::resolveParameters(whole, catalog, context.techniques, 1);
    const report::Table wholeTable = report::buildTable(whole, batch::plannedCases(cases), {});
    for (const config::ClaimSpec& claim : experiment.claims) {
        const std::string absent = report::whatIsAbsent(claim, table);
        const auto then = std::ranges::find(whole.claims, claim.id, &config::ClaimSpec::id);
        const bool isOurs =
            then == whole.claims.end() || report::whatIsAbsent(*then, wholeTable).empty();
        if (absent.empty() || !isOurs) continue;
        say("{}: claim '{}' will be unmeasured: {}\n", file, claim.id, absent);
    }
    for (std::size_t i = 0; i < experiment.plots.size(); ++i) {
        const std::string absent = report::whatIsAbsent(experiment.plots[i], table);
        const bool isOurs =
            i >= whole.plots.size() || report::whatIsAbsent(whole.plots[i], wholeTable).empty();
        if (absent.empty() || !isOurs) continue;
        say("{}: plot {} will be left out: {}\n", file, i + 1, absent);
    }
}

/// Reads the user's own files, each once: what is wrong in one would be found by the first case.
void requireReadable(const std::vector<batch::Case>& cases, const scene::Catalog& catalog) {
    std::set<std::string> read;
    for (const batch::Case& item : cases) {
        const bool isOwn = !item.scene.isNull() && config::isSceneFile(item.scene.text());
        if (!isOwn || !read.insert(item.scene.text()).second) continue;
        try {
            catalog.load(item.scene);
        } catch (const Error& error) {
            throw Error(item.scene.location(), error.what());
        }
    }
}

/// Says which programs are not on this machine: other machines may have them.
void sayAbsent(const std::string& file, const std::vector<batch::Case>& cases) {
    std::set<std::string> absent;
    for (const batch::Case& item : cases) {
        if (item.program.isNull()) continue;
        const config::Program program = config::readProgram(item.program);
        const auto files = config::filesOf(program, program.valuesOf(item.params));
        if (const config::ProgramFile* one = config::absentOf(files)) absent.insert(one->name);
    }
    for (const std::string& name : absent) {
        say("{}: the program '{}' is not on this machine: its cases will be unsupported\n", file,
            name);
    }
}

}  // namespace

int check(const Context& context, const Selection& selection) {
    const scene::Catalog catalog = openCatalog(context, selection.assets);
    batch::Request request{{}, selection.sets, selection.sweeps, {}, selection.device};
    for (const std::string& file : selection.names) {
        request.configs = {file};
        config::Experiment experiment = loadExperiments(request, selection.profile).front();
        const std::vector<batch::Case> cases =
            batch::resolveCases(experiment, catalog, context.techniques, 1);
        batch::bindAssumptions(experiment, cases, catalog, context.techniques);
        batch::requireRanges(experiment, cases, catalog, context.techniques);
        requireReadable(cases, catalog);
        sayAbsent(file, cases);
        const std::size_t caseCount = cases.size();
        const report::Table table = report::buildTable(experiment, batch::plannedCases(cases), {});
        report::requireProvenance(experiment, table);
        batch::resolvePaperCases(experiment, catalog, context.techniques);
        say("{}: ok, {}, {} case{}, {} claim{}\n", file, experiment.id, caseCount,
            caseCount == 1 ? "" : "s", experiment.claims.size(),
            experiment.claims.size() == 1 ? "" : "s");
        const bool isReduced =
            !selection.sets.empty() || !selection.sweeps.empty() || selection.profile != "full";
        if (isReduced) sayUnread(context, catalog, file, experiment, table);
    }
    const std::vector<Error> unknown = unknownExpectations(
        context, selection.names, {config::kDeviceClasses.begin(), config::kDeviceClasses.end()},
        selection.assets);
    if (!unknown.empty()) throw unknown.front();
    return kExitOk;
}

}  // namespace gfxrepro::cli
