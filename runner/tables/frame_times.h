// The times of whole frames of a table, round by round: how sure they are, and what stands out.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "runner/config/experiment.h"
#include "runner/records/records.h"
#include "runner/tables/table.h"

namespace gfxrepro::tables {

/// A frame that took far longer than its fellows.
struct Outlier {
    std::string caseId;
    std::string caseName;  // "models/duck slices": its scene and method, for who knows no better
    int frame = 0;
    int process = 0;
    int repeat = 0;
    double timeMs = 0.0;
    double factor = 1.0;  // of the median of its fellows
};

class FrameTimes {
  public:
    /// `goesByClock`: config::goesByClock.
    explicit FrameTimes(bool goesByClock = false) : goesByClock_(goesByClock) {}

    /// Takes wall and process times of whole frames; other records, void times and the quality
    /// lane's are passed over.
    void add(const records::Record& record);

    /// In each process that measured all of a case's frames, the sum over frames of the median of
    /// their repeats in ms: of each case in the order of its first record.
    std::vector<std::map<int, double>> times(Clock clock) const;
    /// Processes of the case that has most.
    std::size_t roundCount() const;
    /// Whether the case has a time in each of the first `rounds` processes.
    bool hasRounds(const std::string& caseId, int rounds) const;

    /// The process's, where it was recorded of all cases, unless they go by the clock.
    Clock judgedClock() const;
    /// By the judged clock, the largest of all cases: half the 95 % interval of the time of its
    /// frames (medianInterval) ÷ the time. Cases that miss a round are left out; none where there
    /// are too few rounds for an interval.
    std::optional<double> relativeError() const { return relativeErrorOf(roundCount()); }
    /// Whether rounds that go on until that error may end here. `asked` is how many were asked for.
    ///
    /// To look after each round and to end at the first narrow interval picks the narrow ones: of
    /// times that scatter twice as much as is asked for, 82 % of such intervals hold the truth. So
    /// where some look found the error small enough, rounds go on to the last number of them at
    /// which the interval ends as far from the ends of the sorted values (14, 16, 19: there it is
    /// sure by 97.9 to 98.7 %), with two new values in it. Of those that so would end with 8 or 11
    /// rounds, 91 % hold the truth. tests/unit/claims/coverage_test.cpp has what this comes to.
    bool isKnownTo(double relativeError, int asked) const;
    /// By how much two equal cases of the table would differ, as a share: the half width of the
    /// 95 % interval (medianInterval) of the log ratio of two neighbouring cases, measured in pairs
    /// by turns, the median over all such neighbours. Of one case alone √2 of its own. None with
    /// too few rounds, nor by CPU time of what goes by the clock.
    std::optional<double> noise(Clock clock) const;

    /// Frames whose time on the wall is kOutlierFactor times the median of the same frame in other
    /// repeats and rounds, or, where these are fewer than three, of the other frames of their case.
    std::vector<Outlier> outliers() const;

    static constexpr double kOutlierFactor = 5.0;

  private:
    using Repeats = std::map<int, double>;
    using Frames = std::map<int, Repeats>;
    struct CaseTimes {
        std::string id, name;
        std::map<int, Frames> wall, cpu;  // by process
        std::vector<double> fellowsOf(int frame) const;
    };
    static constexpr std::size_t kFewestFellows = 3;

    CaseTimes& caseOf(const records::Record& record);
    /// Of the first `rounds`.
    std::optional<double> relativeErrorOf(std::size_t rounds) const;
    std::vector<CaseTimes> cases_;
    std::map<std::string, std::size_t> indices_;
    bool goesByClock_ = false;
};

/// The same of what stands in these columns of a table, whose neighbouring rows are such cases; of
/// a table without two sets of rounds there the noise of its frames. None without columns.
std::optional<double> columnNoise(const Table& table, const std::vector<std::string>& labels,
                                  Clock clock);

/// What ended the rounds: "processes" (as many as asked for, no more),
/// "relative_error", "most_rounds", or "time_budget_s".
std::string_view endOfRounds(const config::Measure& measure, const FrameTimes& times);

/// What a reader knows cases by, by their ids: "torus, light ratio 0.25".
using LabelsOfCases = std::map<std::string, std::string>;

/// A sentence an outlier, of the first few. A case without a name is called by its scene and
/// method.
std::vector<std::string> outlierTexts(const FrameTimes& times, const LabelsOfCases& names = {});

/// Sentences below a table of times: its rounds and what ended them, its noise, its outliers.
std::vector<std::string> timeNotes(const FrameTimes& times, const config::Measure& measure,
                                   const LabelsOfCases& names = {});

}  // namespace gfxrepro::tables
