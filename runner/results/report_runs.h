// Runs as their report shows them.
#pragma once

#include <filesystem>

#include "runner/report/report.h"
#include "runner/results/results.h"
#include "runner/run/run.h"

namespace gfxrepro::results {

/// Whether it is the configs of a document: of tables, figures or sections.
bool isPaperFolder(const std::filesystem::path& folder);

/// What the shipped configs say of documents, for every report.
report::ReportOptions reportOptions(bool embeds = false, report::PicturesDone progress = {});

/// With the plan's cases: the command that runs each again, and what journal.jsonl says of it. Its
/// curves are not drawn.
report::ReportRun reportRun(const std::filesystem::path& runDir, const run::StoredRun& run,
                            const Results& results);

/// A folder of which only manifest.json and claims.csv are at hand, as results/reference keeps
/// them: its verdicts stand beside those of whole runs. Throws Error when these are not there.
report::ReportRun keptRun(const std::filesystem::path& folder);

}  // namespace gfxrepro::results
