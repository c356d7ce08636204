// A run for others: as an artifact (artifact.cpp), or as tidy tables for the field's other
// programs, without JSON in cells (tidy.cpp).
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "runner/run/run.h"

namespace gfxrepro::outcome {

/// Writes the folder `target`, which must not exist, as a whole or not at all: plan, manifest,
/// records, tables, claims, report (made again there: the run's folder is left as it is) and log,
/// environment.txt, ASSETS.md with checksums and licences, configs/ (the experiments with all that
/// they extend laid in), scripts/<table>.sh without parameters, README.md with the measured minutes
/// and disk space of each table, SHA256SUMS. What the stamp for replicability in graphics and ACM's
/// badges ask for.
void writeArtifact(const std::filesystem::path& runDir, const run::StoredRun& run,
                   const scene::Catalog& catalog, const std::filesystem::path& target);

/// The columns of cases.csv before the parameters. None is a word of SQL.
inline constexpr std::string_view kCaseColumns[] = {
    "case_id", "experiment", "technique", "scene", "lane", "run_seed", "seeds", "processes_asked"};
/// Begins the column of a parameter that has the name of one of these.
inline constexpr std::string_view kParamPrefix = "params.";

/// A case a row: kCaseColumns, then a column for each parameter of any case, empty where a case has
/// not got it. What has parts is a column a part: "output.width", "offset.0".
void writeCases(const std::filesystem::path& file, std::span<const config::Case> cases);

/// Writes the folder `target`, which must not exist, as a whole or not at all: cases.csv,
/// records.csv (a number a row; of what belongs to the whole case, frame and repeat are −1),
/// run.csv (key, value: of the manifest) and programs.csv (file, sha256, version: of programs
/// measured from outside; not written where there are none).
void writeTidy(const std::filesystem::path& runDir, const run::StoredRun& run,
               const std::filesystem::path& target);
}  // namespace gfxrepro::outcome
