#include <fmt/core.h>

#include "runner/batch/ledger.h"
#include "runner/cli/commands.h"
#include "runner/cli/experiments.h"
#include "runner/report/claims.h"
#include "runner/cli/expectation_lists.h"

#include "runner/config/schema.h"
namespace gfxrepro::cli {

int check(const Context& context, const Selection& selection) {
    const scene::Catalog catalog = openCatalog(selection.assets);
    batch::Request request{{}, selection.sets, selection.sweeps, {}, selection.device};
    for (const std::string& file : selection.names) {
        request.configs = {file};
        config::Experiment experiment = loadExperiments(request, selection.profile).front();
        const std::vector<batch::Case> cases =
            batch::resolveCases(experiment, catalog, context.techniques, 1);
        batch::bindAssumptions(experiment, cases, catalog, context.techniques);
        batch::requireRanges(experiment, cases, catalog, context.techniques);
        const std::size_t caseCount = cases.size();
        report::requireProvenance(experiment, report::buildTable(experiment, {}));
        batch::resolvePaperCases(experiment, catalog, context.techniques);
        fmt::print("{}: ok, {}, {} case{}, {} claim{}\n", file, experiment.id, caseCount,
                   caseCount == 1 ? "" : "s", experiment.claims.size(),
                   experiment.claims.size() == 1 ? "" : "s");
    }
    return kExitOk;
}

}  // namespace gfxrepro::cli
    const std::vector<Error> unknown = unknownExpectations(
        context, selection.names, {config::kDeviceClasses.begin(), config::kDeviceClasses.end()},
        selection.assets);
    if (!unknown.empty()) throw unknown.front();
