// What the cases of a plan will take, as far as earlier runs tell.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "runner/run/plan.h"
#include "runner/run/protocol.h"

namespace gfxrepro::cluster {

/// What one process of a case will take, and how that is known.
struct Prediction {
    enum class Source {
        SameCase,  // measured, by the same hash
        OtherRun,  // the same parameters, scene and size under another build, device or profile
        Median,    // of all cases of the technique, or of all cases
        File,      // as a file of predictions says
    };
    double timeS = 0.0;
    long long memoryBytes = 0;
    Source source = Source::SameCase;
    bool isTold = true;  // else, as a median is, it is good to balance shards by, and no more
};
/// "same case", "same case, other run", "median", "file".
std::string_view sourceName(Prediction::Source source);

/// A case that an earlier run finished.
struct PastCase {
    config::Case item;
    run::Cost cost;  // usualCost() of its processes
};
/// What one of a case's processes takes, at least one: medians, but the mean of recording and the
/// most memory, for the first of them records more than the others.
run::Cost usualCost(const std::vector<run::Cost>& costs);
/// Those of a run directory: its plan and its log. Throws Error when it is no run.
std::vector<PastCase> readPastCases(const std::filesystem::path& runDir);

/// The newest run directories under `folder` that were made on this class of device, at most
/// `count`, the newest first; none when there is no such folder. What cannot be read is passed
/// over.
std::vector<std::filesystem::path> newestRuns(const std::filesystem::path& folder,
                                              const std::string& deviceClass, std::size_t count);

/// Predicts from what it was given; of equal cases the first counts.
class Predictor {
  public:
    explicit Predictor(std::vector<PastCase> past = {});
    /// Run directories, or files that writePredictions made. Throws Error.
    static Predictor from(const std::vector<std::filesystem::path>& sources);

    /// None when nothing is known at all.
    std::optional<Prediction> predict(const config::Case& item) const;

  private:
    std::optional<Prediction> median(const config::Case& item) const;

    std::vector<PastCase> past_;
    std::map<std::string, std::size_t> byId_;
    std::map<std::string, std::size_t> byContent_;
    std::map<std::string, Prediction> file_;  // by title
};

/// A line a case: title, time of one process, memory, source. Every shard of a plan is cut by the
/// same predictions; a file keeps them.
void writePredictions(const std::filesystem::path& path, const run::Plan& plan,
                      const Predictor& predictor);

/// The time of each case of the plan, all its processes together. Where nothing is known, each
/// iteration is taken for a second: good enough to balance shards by, and for nothing else.
std::vector<double> caseTimesS(const run::Plan& plan, const Predictor& predictor);

/// The time that is left of `totalS` predicted seconds, `doneS` of which took `elapsedS`, with
/// `jobs` units at once.
double remainingS(double totalS, double doneS, double elapsedS, int jobs);

}  // namespace gfxrepro::cluster
