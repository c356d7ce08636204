// Runs as their report shows them.
#pragma once

#include <filesystem>
#include <vector>

#include "runner/batch/run.h"
#include "runner/html/report.h"

namespace gfxrepro::batch {

/// What the shipped configs say of documents, for every report.
html::ReportOptions reportOptions(bool embeds = false);

/// With the plan's cases: the command that runs each again, and what log.jsonl says of it.
html::ReportRun reportRun(const std::filesystem::path& runDir, const StoredRun& run);

/// A folder of which only manifest.json and claims.csv are at hand, as results/reference keeps
/// them: its verdicts stand beside those of whole runs. Throws Error when it has neither these nor
/// a plan.
html::ReportRun reportRun(const std::filesystem::path& folder);

}  // namespace gfxrepro::batch
