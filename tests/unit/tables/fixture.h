// Experiments from YAML text and records from a few words, for the tests of tables and claims.
#pragma once

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "runner/claims/claims.h"
#include "runner/config/experiment.h"
#include "runner/records/records.h"
#include "runner/tables/case_records.h"
#include "runner/tables/table.h"

namespace gfxrepro::tables {

/// What a verdict says of fewer processes.
inline const std::string kNeedsSix =
    "an interval needs 6: `measure: {processes: 6}`, or as many in column 'process' of an import";

/// The experiment "zju2005/9.9" of technique `voxelization` with `body` below these keys.
config::Experiment experimentFrom(const std::string& body);

/// The same with these cases under the profile `paper`, as a plan finds them: scene, parameters as
/// JSON.
config::Experiment withPaperCases(config::Experiment experiment,
                                  std::initializer_list<std::pair<const char*, const char*>> cases);

/// Records with the cases that they are of.
struct Recorded : std::vector<records::Record> {
    std::vector<config::Case> cases;
};

/// The cases of the experiment's sweep, those that are recorded in the place of those that they
/// are; behind them the other recorded ones.
std::vector<config::Case> planOf(const config::Experiment& experiment, const Recorded& records);
/// The table of a run with that plan.
Table buildTable(const config::Experiment& experiment, const Recorded& records);
std::vector<Table> buildTables(const std::vector<config::Experiment>& experiments,
                               const Recorded& records);

/// Makes records of a table; a case is known by its scene and params.
class RecordMaker {
  public:
    explicit RecordMaker(std::string table = "zju2005/9.9") : table_(std::move(table)) {}
    /// `params` is JSON. What follows is recorded for this case.
    RecordMaker& beginCase(const std::string& scene, const std::string& params = "{}");
    RecordMaker& process(int process);
    RecordMaker& frame(int frame);
    RecordMaker& lane(const std::string& lane);
    /// The case draws random numbers.
    RecordMaker& seeds(config::Measure::Seeds seeds);
    /// One value a repeat.
    RecordMaker& add(const std::string& metric, std::initializer_list<double> repeats,
                     const std::string& pass = "", const std::string& unit = "ms");
    RecordMaker& add(const std::string& metric, const std::vector<double>& repeats,
                     const std::string& pass = "", const std::string& unit = "ms");
    RecordMaker& fail(records::Status status, const std::string& message);

    const Recorded& records() const { return records_; }

  private:
    std::string table_;
    records::Record current_;
    Recorded records_;
};

}  // namespace gfxrepro::tables
