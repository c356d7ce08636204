// What a run came to: made once, and given to all that write of it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runner/claims/claims.h"
#include "runner/report/gallery.h"
#include "runner/report/report.h"
#include "runner/run/manifest.h"
#include "runner/run/run.h"
#include "runner/tables/printed.h"
#include "runner/tables/table.h"

namespace gfxrepro::outcome {

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
/// Makes cases.csv (as in tidy.h), tables/, nearness.csv and plots/, claims.csv with junit.xml,
/// report.html again from the records. With `out` nothing is written into the run's folder, and
/// nothing over the results of another run.
Results writeResults(const std::filesystem::path& runDir, const run::StoredRun& run,
                     const ResultFiles& which);

/// The line that made-from.txt has of a run: its name, when it started, the hash of its plan.
std::string madeFromLine(const std::filesystem::path& runDir, const run::Json& manifest);

/// Throws Error where `folder` was made from other runs than `lines`, is a run itself, or has
/// results and does not say of what.
void requireMadeFrom(const std::filesystem::path& folder, const std::string& lines);
/// Writes made-from.txt.
void noteMadeFrom(const std::filesystem::path& folder, const std::string& lines);
/// Both, for what is made of one run; the run's own folder needs neither.
void takeFolder(const std::filesystem::path& folder, const std::filesystem::path& runDir,
                const run::Json& manifest);

/// Whether it is the configs of a document: of tables, figures or sections.
bool isPaperFolder(const std::filesystem::path& folder);

/// What the shipped configs say of documents, for every report.
report::ReportOptions reportOptions(bool embeds = false, report::PicturesDone progress = {});

/// With the plan's cases: the command that runs each again, and what journal.jsonl says of it. Its
/// curves are not drawn.
report::ReportRun reportRun(const std::filesystem::path& runDir, const run::StoredRun& run,
                            const Results& results);

/// A folder of results/reference, with runs.csv and claims.csv: its verdicts stand beside those of
/// whole runs. Of several programs the last is named. Throws Error when these are not there.
report::ReportRun keptRun(const std::filesystem::path& folder);

}  // namespace gfxrepro::outcome
