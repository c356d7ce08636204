// From the records of a run to what people read. Each function writes files of the run directory
// (atomically) and may be called again at any time; none needs a GPU.
#pragma once

#include <filesystem>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "runner/config/experiment.h"
#include "runner/report/claims.h"
#include "runner/report/records.h"
#include "runner/report/table.h"

namespace gfxrepro::report {

/// The tables of a run, beside `experiments`.
std::vector<Table> buildTables(const std::vector<config::Experiment>& experiments,
                               const std::vector<Record>& records);

/// tables/<slug>.csv (every column printed, measured, low, high, status at full precision), .md
/// (printed beside measured) and .tex (booktabs, a macro a number) for each.
void writeTables(const std::filesystem::path& runDir, const std::vector<Table>& tables);

/// The claims of all experiments, in order; `tables` lies beside `experiments`. Throws Error as the
/// single-experiment form.
std::vector<ClaimResult> evaluateClaims(const std::vector<config::Experiment>& experiments,
                                        const std::vector<Table>& tables,
                                        const ReportContext& context);

/// claims.csv (claim,table,device,profile,verdict,measured,required,margin,reason) and junit.xml
/// (a failed claim is a failure, one that could not be judged is skipped).
void writeClaims(const std::filesystem::path& runDir, const std::vector<ClaimResult>& results,
                 const ReportContext& context);

/// report.html: one file without scripts or outside references; images/index.csv gives its images,
/// which lie inside of it up to 20 MB a run and are linked beyond. Builds the tables and judges the
/// claims itself. `manifest` is manifest.json; of it are shown, where there: commit, build, cpu,
/// gl.renderer, gl.version, profile, started.
void writeReport(const std::filesystem::path& runDir,
                 const std::vector<config::Experiment>& experiments,
                 const std::vector<Record>& records, const nlohmann::ordered_json& manifest,
                 const ReportContext& context);

}  // namespace gfxrepro::report
