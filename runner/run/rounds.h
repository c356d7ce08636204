// Rounds of a table of times: in round k every case is measured once, as its process k. Which
// units that are, and when there are enough.
#pragma once

#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "runner/run/plan.h"
#include "runner/run/protocol.h"
#include "runner/run/worker_handle.h"
#include "runner/tables/frame_times.h"

namespace gfxrepro::run {

/// The units of a plan, or of its shard, in the order in which they run: the quality lane, side by
/// side, experiment by experiment; then the timing lane, in which the rounds of each experiment are
/// spread evenly, so that what changes within minutes is in its intervals. The cases of a round
/// follow each other, in every other one backwards (ABBA), so that what drifts evenly reaches all
/// of them alike.
///
/// With the `records` of a run, of rounds beyond the first `processes` those that were begun, too:
/// in these a case takes part that was measured in all rounds before.
std::vector<Unit> unitsOf(const Plan& plan, const std::vector<records::Record>& records = {});

/// Decides after each round of a table of times whether another follows: while the time of some
/// case is not known to config::kKnownTo (tables::FrameTimes::isKnownTo), there are fewer than
/// config::kMostRounds, and the next may follow by `time_budget_s` (Measure::mayFollow). A decision
/// is final, also for a run that is resumed.
class Rounds {
  public:
    using TimePoint = std::chrono::steady_clock::time_point;

    /// Of a run with these records and lines of journal.jsonl so far. The plan must outlive it.
    Rounds(const Plan& plan, const std::vector<records::Record>& records,
           const std::vector<Json>& journal);

    /// A unit of an experiment runs, until end() or the begin() of its second try. Budgets count
    /// this alone, of this start of the program, and without what was made once (Cost::onceS): no
    /// round makes it again.
    void begin(const std::string& experiment, TimePoint now);
    void end(const std::string& experiment, TimePoint now, double onceS = 0.0);
    void add(const std::vector<records::Record>& rows);
    /// The times of the case were measured as another table's; as its own where that is empty.
    void takenFrom(const Case& item, const std::string& table);
    /// The units of the next round of an experiment whose rounds so far are complete; empty when
    /// there is none, which is then decided and said by ending().
    std::vector<Unit> next(const std::string& experiment);
    bool isUndecided(const std::string& experiment) const;
    /// Whether rounds may follow those that are measured whatever they take.
    bool mayFollow(const std::string& experiment) const;
    /// Experiments that are still to be decided, in the plan's order.
    std::vector<std::string> undecided() const;

    /// {"table", "rounds", "ended_by", "relative_error", "seconds"}; null while it is undecided.
    /// "ended_by" is as in tables::endOfRounds.
    Json ending(const std::string& experiment) const;
    /// The endings of all experiments that have one, by name: for the manifest. Of a table with
    /// times of another "times_of" is that table, and "taken" of how many of its "cases".
    Json endings() const;
    /// Frames that took far longer than their fellows: "zju2005/4.1: Outlier: …".
    std::vector<std::string> warnings() const;

  private:
    struct TimedTable {
        std::vector<const Case*> cases;  // those that this run measures
        tables::FrameTimes times;
        std::optional<TimePoint> runsSince = {};
        std::chrono::duration<double> spent{0.0};
        int roundsBegun = 0;
        Json ending;
        std::map<std::string, std::string> takenFrom = {};  // of cases with times of another table
    };

    std::map<std::string, TimedTable> tables_;
    std::vector<std::string> order_;
};

/// With which table the times of a table were measured, where it was another, by the manifest's
/// endings(): a sentence without its end; empty for its own.
std::string takenTimesNote(const Json& manifest, const std::string& table);

}  // namespace gfxrepro::run
