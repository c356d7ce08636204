// What a run came to: made once, and given to all that write of it.
#pragma once

#include <filesystem>
#include <vector>

#include "runner/claims/claims.h"
#include "runner/report/gallery.h"
#include "runner/run/run.h"
#include "runner/tables/printed_parameters.h"
#include "runner/tables/table.h"

namespace gfxrepro::results {

/// What claims and the report ask of a run.
claims::ReportContext reportContext(const run::Json& manifest);

struct Results {
    claims::ReportContext context;
    std::vector<tables::Table> tables;        // beside the experiments
    std::vector<claims::ClaimResult> claims;  // of all of them, in order
    tables::PrintedCells printedCells;
};
Results resultsOf(const run::StoredRun& run);
/// By these experiments in the place of those of its plan: some of them, or what judges afterwards.
Results resultsOf(const run::StoredRun& run, const std::vector<config::Experiment>& experiments);

/// Which files writeResults() makes.
struct ResultFiles {
    bool tables = true;  // with their curves
    bool claims = true;
    bool report = true;
    bool embeds = false;  // every picture inside of the report
    report::PicturesDone progress = {};
    std::filesystem::path out = {};  // where they go; empty: the run's folder
};
/// Makes cases.csv (as in tidy.h), tables/ and plots/, claims.csv with junit.xml, report.html again
/// from the records. With `out` nothing is written into the run's folder, and nothing over the
/// results of another run (made_from.h).
Results writeResults(const std::filesystem::path& runDir, const run::StoredRun& run,
                     const ResultFiles& which);

}  // namespace gfxrepro::results
