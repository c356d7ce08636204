// Experiments from YAML text and records from a few words, for the tests of tables and claims.
#pragma once

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "runner/config/experiment.h"
#include "runner/report/claims.h"
#include "runner/report/records.h"
#include "runner/report/table.h"

namespace gfxrepro::report {

/// The experiment "zju2005/9.9" of technique `voxelization` with `body` below these keys.
config::Experiment experimentFrom(const std::string& body);

/// The same with these cases under the profile `paper`, as a plan finds them: scene, parameters as
/// JSON.
config::Experiment withPaperCases(config::Experiment experiment,
                                  std::initializer_list<std::pair<const char*, const char*>> cases);

/// Makes records of "zju2005/9.9"; a case is known by its scene and params.
class RecordMaker {
  public:
    /// `params` is JSON. What follows is recorded for this case.
    RecordMaker& beginCase(const std::string& scene, const std::string& params = "{}");
    RecordMaker& process(int process);
    RecordMaker& frame(int frame);
    RecordMaker& lane(const std::string& lane);
    /// One value a repeat.
    RecordMaker& add(const std::string& metric, std::initializer_list<double> repeats,
                     const std::string& pass = "", const std::string& unit = "ms");
    RecordMaker& add(const std::string& metric, const std::vector<double>& repeats,
                     const std::string& pass = "", const std::string& unit = "ms");
    RecordMaker& fail(Status status, const std::string& message);

    const std::vector<Record>& records() const { return records_; }

  private:
    Record current_;
    std::vector<Record> records_;
};

}  // namespace gfxrepro::report
