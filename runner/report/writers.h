// The files of a run that people and programs read. Each is written atomically, and may be again.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "runner/claims/claims.h"
#include "runner/config/experiment.h"
#include "runner/records/records.h"
#include "runner/tables/table.h"

namespace gfxrepro::report {

/// tables/<slug>.csv (every column printed, measured, low, high, what these bounds are, status;
/// at full precision), .md
/// (printed beside measured) and .tex (booktabs, a macro a number) for each. All say at which
/// parameters was measured and which differ from the printed ones: the CSV of each row (column
/// `parameters`) and of each cell (`…_at_printed`: yes or no). `runNotes`, which are among each
/// table's notes, stand in the .tex, too.
void writeTables(const std::filesystem::path& runDir, const std::vector<tables::Table>& tables,
                 const std::vector<std::string>& runNotes = {});

/// nearness.csv: of every cell of a table at the printed parameters what was measured and printed,
/// and their ratio (tables/nearness.h). None without such cells.
void writeNearness(const std::filesystem::path& runDir,
                   const std::vector<config::Experiment>& experiments,
                   const std::vector<tables::Table>& tables);

/// claims.csv (kClaimsColumns) and junit.xml: every case and every claim is a test with a name of
/// its own. A case that failed is an error, a claim that fails a failure; a case that was left out
/// and a claim that could not be judged are skipped. `started` is when the run began, in UTC.
void writeClaims(const std::filesystem::path& runDir, const std::vector<records::CaseEnd>& cases,
                 const std::vector<claims::ClaimResult>& results,
                 const claims::ReportContext& context, const std::string& started);

inline constexpr std::string_view kXmlHead = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
/// A test of a JUnit file: of what passed nothing is said.
struct JunitTest {
    enum class Outcome { Passed, Skipped, Failed, Broken };
    std::string group;
    std::string name;
    Outcome outcome = Outcome::Passed;
    std::string type = {};  // of failure
    std::string message = {};
    double seconds = 0.0;
};
struct JunitSuite {
    std::string name;
    std::vector<JunitTest> tests;
};
/// The text of a JUnit file, as the schemas of Ant and of Jenkins have it.
std::string junitXml(const std::vector<JunitSuite>& suites, const std::string& started);

/// A table as LaTeX: a macro for each number, and a tabular of these macros. Its head says how the
/// numbers are cited. `runNotes` stand below the table: what holds of all numbers of the run, as
/// that they were imported.
std::string tableLatex(const tables::Table& table, const std::vector<std::string>& runNotes = {});

/// Part of a macro's key: letters, digits and . + - _ stay, anything else becomes "-". They hold
/// nothing that LaTeX would expand.
std::string latexKeyPart(const std::string& label);

}  // namespace gfxrepro::report
