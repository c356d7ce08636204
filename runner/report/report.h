// From the records of a run to what people read. Each function writes files of the run directory
// (atomically) and may be called again at any time; none needs a GPU.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "runner/config/experiment.h"
#include "runner/report/claims.h"
#include "runner/report/records.h"
#include "runner/report/table.h"

namespace gfxrepro::report {

/// The tables of a run, beside `experiments`; `planned` are the cases of its plan.
std::vector<Table> buildTables(const std::vector<config::Experiment>& experiments,
                               std::span<const PlannedCase> planned,
                               const std::vector<Record>& records);

/// tables/<slug>.csv (every column printed, measured, low, high, what these bounds are, status;
/// at full precision), .md
/// (printed beside measured) and .tex (booktabs, a macro a number) for each. All say at which
/// parameters was measured and which differ from the printed ones: the CSV of each row (column
/// `parameters`) and of each cell (`…_at_printed`: yes or no).
void writeTables(const std::filesystem::path& runDir, const std::vector<Table>& tables);

/// The claims of all experiments, in order; `tables` lies beside `experiments`. Throws Error as the
/// single-experiment form.
std::vector<ClaimResult> evaluateClaims(const std::vector<config::Experiment>& experiments,
                                        const std::vector<Table>& tables,
                                        const ReportContext& context);

/// The columns of claims.csv.
inline constexpr std::array<std::string_view, 16> kClaimsColumns = {
    "claim",   "says",  "table",    "device",   "profile", "origin", "bound_from", "kind",
    "verdict", "known", "measured", "required", "margin",  "reason", "because",    "rests_on"};

/// How a case ended, for junit.xml.
struct CaseResult {
    enum class Outcome { Measured, Skipped, Failed };
    std::string table;  // "zju2005/2.1"
    std::string title;  // "zju2005/2.1 scene=models/duck"
    Outcome outcome = Outcome::Measured;
    std::string text = {};   // of the others: "crash: SIGSEGV", "not run"
    SourceLocation where{};  // its config
};

/// claims.csv (kClaimsColumns) and junit.xml: every case and every claim is a test with a name of
/// its own. A case or claim that failed is a failure; a case that was left out and a claim that
/// could not be judged are skipped.
void writeClaims(const std::filesystem::path& runDir, const std::vector<CaseResult>& cases,
                 const std::vector<ClaimResult>& results, const ReportContext& context);
/// The text of junit.xml.
std::string junitXml(const std::vector<CaseResult>& cases, const std::vector<ClaimResult>& results);

/// The verdict of that name. Throws Error at `where` for a name that is none.
Verdict verdictAt(const SourceLocation& where, const std::string& name);

/// claims.csv as writeClaims() wrote it, in older forms too: then nothing is known of a claim's
/// origin, or of what it says. Throws Error with file and line.
std::vector<ClaimResult> readClaims(const std::filesystem::path& file);

}  // namespace gfxrepro::report
