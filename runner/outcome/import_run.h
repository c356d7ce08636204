// Numbers that were measured elsewhere as a run: they get tables, claims, plots and a report.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "runner/outcome/import_csv.h"
#include "runner/run/run.h"

namespace gfxrepro::outcome {

struct ImportRequest {
    ImportFiles files;
    /// How the numbers are shown and what must follow from them. None: one table of all, in which
    /// every column that varies is an axis. Several: column `experiment` says whose a case is.
    std::vector<config::Experiment> experiments = {};
    std::string profile = "full";
    std::string machine = "a machine that was not named";  // for people
    bool isOfGpu = false;                                  // then claims about a GPU are judged
    std::string commandLine;
};

/// The run: its cases have the parameters of the files, its records their numbers; the manifest has
/// what was imported (`imported`: file, sha256, rows, machine) and a note that says so in every
/// table and report. Throws Error as readImport(), for a case of an experiment that is not given,
/// and for two cases that are alike.
run::StoredRun importRun(const ImportRequest& request, const scene::Catalog& catalog,
                         std::span<const technique::TechniqueInfo> techniques);

/// plan.json, records.csv, journal.jsonl and the sealed manifest.
void writeImported(const run::RunDirectory& directory, const run::StoredRun& run);

/// Throws Error where the run was imported: nobody can `purpose` ("go on with") it.
void requireNotImported(const run::Json& manifest, const std::string& runDir,
                        const std::string& purpose);

}  // namespace gfxrepro::outcome
