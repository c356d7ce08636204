// Verdicts on two builds, from their series.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "runner/metrics/statistics.h"
#include "runner/regression/series.h"

namespace gfxrepro::regression {

/// Times are faster, slower, same or cannot tell; other metrics same or changed. A case that only
/// one side has is Missing.
enum class Verdict { Faster, Slower, Same, CannotTell, Changed, Missing };
std::string_view verdictName(Verdict verdict);

/// Whether the sides were measured by turns (round i of one beside round i of the other), so that
/// what a machine does over hours touches both.
enum class Pairing { ByTurns, Apart };

struct Rules {
    double effectFloor = 0.02;       // a change of time below it is none, whatever the interval
    double sameWithin = 0.05;        // `same` needs the interval inside of ± this
    double familyError = 0.05;       // chance of one false alarm among all series
    double qualityTolerance = 1e-6;  // relative, of metrics that are no times
    std::size_t fewestProcesses = 5;
};

/// What became of one series. `ratio` is time after / time before (rates count as their
/// reciprocal): above 1 is slower; of other metrics value after / before.
struct Difference {
    SeriesKey key;
    double before = 0.0;  // median over processes
    double after = 0.0;
    double ratio = 1.0;
    metrics::Interval interval{1.0, 1.0};
    double floor = 0.0;  // the smallest change that counts, relative
    Verdict verdict = Verdict::CannotTell;
    std::string reason{};  // of CannotTell and Missing

    bool isAlarm() const { return verdict == Verdict::Slower || verdict == Verdict::Changed; }
};

/// The smallest relative change that `values`, measured in turn, can show: half the interval of the
/// median ratio of neighbours (A/A), at least `rules.effectFloor`.
double detectableChange(const Series& values, const Rules& rules);

/// Slower: the interval of the ratio lies above 1 and the ratio above 1 + floor; faster likewise.
/// Same: the interval lies within ± max(floor, sameWithin).
Difference compareTimes(const SeriesKey& key, const Series& before, const Series& after,
                        Pairing pairing, double confidence, const Rules& rules);

/// Every series of both sides, after matchParams, in the order of their keys.
std::vector<Difference> compare(const SeriesMap& before, const SeriesMap& after, Pairing pairing,
                                const Rules& rules = {});

/// An alarm counts when measuring once more in fresh processes gives it again; else it becomes
/// CannotTell with the reason. Other verdicts stay. Both in the order of their keys.
void confirm(std::vector<Difference>& differences, const std::vector<Difference>& again);

}  // namespace gfxrepro::regression
