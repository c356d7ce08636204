// From the records of a finished run to the files that people read.
#pragma once

#include <filesystem>
#include <vector>

#include "runner/report/report.h"
#include "runner/run/manifest.h"

namespace gfxrepro::cli {

/// Prints what a reader of the run's results must know: a warning a line.
void sayNotes(const run::Json& manifest);

/// What differs between runs of several machines may differ by them: a note of the first run.
void noteOtherMachines(std::vector<report::ReportRun>& runs);

/// Throws Error where the file is there and is not a page of ours.
void requireReport(const std::filesystem::path& file);

/// Makes tables, claims and report; says what the claims came to. kExitUsage where a column names
/// no pass of what is there of passes alone, kExitClaimFailed when a claim fails, else kExitOk.
int conclude(const std::filesystem::path& runDir);

}  // namespace gfxrepro::cli
