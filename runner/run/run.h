// A run from its plan to its tables; what `run`, `reproduce` and the commands over a finished run
// share.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "runner/records/records.h"
#include "runner/run/plan.h"
#include "runner/run/protocol.h"
#include "runner/run/rounds.h"
#include "runner/run/run_directory.h"

namespace gfxrepro::run {

/// The units, also of further rounds that were begun, that have no complete set of `ok` or `flaky`
/// rows yet. Rows of failed units are taken out of records.csv: they are about to be made again.
std::vector<Unit> remainingUnits(const Plan& plan, const RunDirectory& directory);

/// Takes the rows of flaky units out of records.csv, so that they remain to be measured.
void forgetFlaky(const RunDirectory& directory);

/// What was decided so far of the rounds of a run's tables.
Rounds roundsOf(const Plan& plan, const RunDirectory& directory, const std::vector<Json>& journal);

/// A run that goes on on another machine: the times of an experiment are of one machine, so where
/// some of them are still to be measured, all are measured again. The rows so far go from
/// records.csv to `records-replaced.csv`. Notes the machine in the manifest and gives the
/// experiments. Does nothing on the machine on which the run began.
std::vector<std::string> replaceForeignTimes(const Plan& plan, const RunDirectory& directory,
                                             const std::vector<Json>& journal, Json& manifest,
                                             const std::string& machine);

/// What a run directory holds, for tables, claims and report.
struct StoredRun {
    Plan plan;
    Json manifest;
    std::vector<records::Record> records;
};
/// Throws Error when the folder is no run. The manifest notes what was changed since its end
/// (noteChanges), and that several machines measured (noteMachines).
StoredRun readRun(const std::filesystem::path& runDir);
/// The same; of a shard with its experiments unread, as the plan that was cut has them.
StoredRun readPart(const std::filesystem::path& runDir);
/// Adds to the manifest's notes which pictures are missing or are not as they were written, but for
/// those of the cases that are measured `again`: each is read, which takes time.
void noteChangedImages(Json& manifest, const std::filesystem::path& runDir,
                       const std::vector<Unit>& again = {});

/// Whether something was begun to be measured there. A plan alone is a shard that waits for its
/// task.
bool holdsRun(const std::filesystem::path& folder);

/// What became of the units of the run's plan, or of its shard. Every exit code that says whether a
/// run is complete is of this.
struct Completeness {
    int units = 0;
    int missing = 0;                               // without a row of any kind
    int failed = 0;                                // did not end `ok` or `flaky`
    std::map<records::Status, int> failures = {};  // the failed ones

    bool isComplete() const { return missing + failed == 0; }
    int measured() const { return units - missing - failed; }
};
Completeness completeness(const StoredRun& run);

/// Keeps the sums in the manifest, until breakSeal(): what many shards came to is read from there.
void noteCompleteness(Json& manifest, const Completeness& counts);
/// … without `failures`: from the manifest where the run ended and its records are as they were
/// then, else from the whole run. Throws Error, also where its `plan` was read, and the manifest is
/// of another.
Completeness readCompleteness(const std::filesystem::path& runDir, const Plan* plan = nullptr);

/// How every case of the run's plan, or of its shard, ended: by its worst process. Of a `runDir`
/// that is given also how long each took, as its journal tells.
std::vector<records::CaseEnd> caseResults(const StoredRun& run,
                                          const std::filesystem::path& runDir = {});

/// The cases that were under way at two ends of the runner, or more, that it did not say (no `end`,
/// no `interrupted`), with a message that says so; by id. What counts is the work, not its name:
/// a case in whichever of its processes, and a twin (workKey) in place of another. A unit that ends
/// after all clears what was counted of it; an interruption and a stop rule count nothing and clear
/// nothing.
std::map<std::string, std::string> casesNotSurvived(const Plan& plan,
                                                    const std::vector<Json>& journal);

}  // namespace gfxrepro::run
