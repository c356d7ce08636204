// Verdicts on two builds, from their series; a comparison for people and for other tools.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "engine/metrics/statistics.h"
#include "runner/regression/nightly_history.h"
#include "runner/regression/series.h"

namespace gfxrepro::regression {

/// Times are faster, slower, same or cannot tell; other metrics same or changed. What the earlier
/// build measured and the later one did not is Lost, and so is a case that failed in the later one
/// alone; what only the later one has is Missing. A time that stands on neither side is Void, a
/// case that failed on both has Failed: nothing is known of them.
enum class SeriesVerdict { Faster, Slower, Same, CannotTell, Changed, Missing, Lost, Void, Failed };
std::string_view verdictName(SeriesVerdict verdict);

/// Whether the sides were measured alternately (round i of one beside round i of the other), so
/// that what a machine does over hours touches both.
enum class Pairing { ByTurns, Apart };

struct Rules {
    double effectFloor = 0.02;  // a change of time below it is none, however sure
    /// `same` needs the 95 % interval inside of ± this: less than the 10 % that are to be found, or
    /// one look in forty would take these for the same.
    double sameWithin = 0.08;
    double familyError = 0.05;  // chance of one false alarm among all series and looks
    /// Runs that were measured apart differ by what the machine does over hours, which no number of
    /// processes tells from a change of the build: only what is larger can be.
    double driftApart = 0.5;
    /// Relative, of values that are no times; whole numbers (counts) are compared exactly. The
    /// order in which parallel work draws instances at one depth and sums floats moves the errors
    /// of pictures by 1e-5, and no table prints a fifth digit.
    double valueTolerance = 1e-4;
    Tables byProcess{};  // see chooseTimes
    /// By table its program, of those whose cases declare no seed; of an import nothing.
    std::map<std::string, std::string> unseeded{};
    MetricsOfTables ofSetup{};  // which draw nothing
    std::size_t looks = 5;      // at most, each after as many further rounds
};

/// How far two pictures are apart.
struct PictureError {
    double flip = 0.0;     // mean; of the exposures' largest where a value exceeds 1
    double largest = 0.0;  // difference of any value of any channel
};

/// What became of one series, or of a picture (isPicture). `ratio` is after / before, of times:
/// above 1 is slower.
struct Difference {
    SeriesKey key;
    double before = 0.0;  // median over processes
    double after = 0.0;
    double ratio = 1.0;
    metrics::Interval interval{1.0, 1.0};  // of the ratio, at 95 %
    double floor = 0.0;                    // the smallest change that counts, relative
    SeriesVerdict verdict = SeriesVerdict::CannotTell;
    std::string reason{};  // of all but Faster, Slower and Same, but of no value that is Changed
    std::optional<PictureError> picture{};  // of two that can be subtracted
    /// Of a picture that is Changed: both, and the map of differences if there is one, lie beside
    /// the comparison under this name with -before, -after and -flip.
    std::string evidence{};

    bool isPicture() const { return key.metric == kPictureMetric; }
    /// Neither side has a value.
    bool isOfNone() const {
        return verdict == SeriesVerdict::Void || verdict == SeriesVerdict::Failed;
    }
    bool isAlarm() const {
        return verdict == SeriesVerdict::Slower || verdict == SeriesVerdict::Changed ||
               verdict == SeriesVerdict::Lost;
    }
};

/// The smallest relative change that `values`, measured in turn, can show: half the 95 % interval
/// of the ratio of neighbours (A/A), at least `rules.effectFloor`; that alone below 12 values.
double detectableChange(const Series& values, const Rules& rules);

/// Every series of both sides, after matchParams and chooseTimes, in the order of their keys.
/// Times measured by turns: the exact chance of such log ratios of rounds without a change (signed
/// ranks) is held against familyError / looks over all series [Holm 1979]; slower and faster, when
/// the ratio lies beyond the floor too. Apart: the chance of such means of logarithms [Welch 1947],
/// against familyError over those that have an interval [Benjamini and Hochberg 1995]; slower and
/// faster, when the ratio (rank sums) lies beyond the floor with 95 %, too. Otherwise same, where
/// the interval says so, or cannot tell.
std::vector<Difference> compare(const SeriesMap& before, const SeriesMap& after, Pairing pairing,
                                const Rules& rules = {});

/// Says of what was lost how its cases failed, and of what is missing how they had; adds a Lost for
/// each case that failed afterwards alone and of which nothing else was lost, and a Failed for each
/// that failed on both sides. In the order of their keys.
void noteFailures(std::vector<Difference>& differences, const CaseTexts& before,
                  const CaseTexts& after);

/// Says why times are void, where that lost them or leaves them undecided.
void noteVoidTimes(std::vector<Difference>& differences, const CaseTexts& before,
                   const CaseTexts& after);

/// Where nothing says whether another process would make another.
inline constexpr const char* kOnce =
    "one process of each side, and no seed is declared; two a side tell whether they differ";

/// What changed of a case that one process of each side told, without a seed, is CannotTell.
void noteOnce(std::vector<Difference>& differences, const CaseTexts& before,
              const CaseTexts& after);

/// Adds what became of the pictures. Those that are lost with all that was measured of their case
/// are Missing: the case is an alarm already. In the order of their keys.
void addPictures(std::vector<Difference>& differences, std::vector<Difference> pictures);

/// An alarm counts when measuring once more in fresh processes gives it again; else it becomes
/// CannotTell with the reason. Other verdicts stay. Both in the order of their keys.
void confirm(std::vector<Difference>& differences, const std::vector<Difference>& again);

/// What both sides have given so far.
struct Sides {
    SeriesMap before, after;
    CaseTexts failuresBefore, failuresAfter;
    CaseTexts voidBefore, voidAfter;
    std::vector<Difference> pictures{};  // those of the first round held against each other
    Tables byProcess{};                  // as in Rules
};
/// Appends further alternate rounds; of `tables` alone where there are some.
using MeasureRounds = std::function<void(Sides& sides, const std::set<std::string>& tables)>;

/// Measures and compares, up to Rules::looks times, until every time is slower, faster or the
/// same: first all, then the tables of which a time is none of these; then measures the tables with
/// alarms in the same way once more, and confirms.
std::vector<Difference> compareByTurns(const MeasureRounds& measure);

/// One line: "2 slower, 1 faster, 40 same, 3 cannot tell".
std::string summaryLine(const std::vector<Difference>& differences);

/// "step in zju2005/2.1 …: × 1.102 since night 18 of 30 (chance 1e-07)".
std::string stepLine(const SeriesStep& step);

/// What was compared: differences, steps of the history, and what a reader must know of the runs.
struct Comparison {
    std::vector<Difference> differences;
    std::vector<SeriesStep> steps{};
    std::vector<std::string> notes{};
    std::string started{};  // when the newer run began

    /// Something got slower or changed, now or since some night.
    bool isAlarm() const;
};

/// A table of everything that is not the same, the summary line, steps and notes.
std::string markdown(const Comparison& comparison);

/// A test each, of a name of its own: alarms are failures; what could not be told is skipped.
std::string junitXml(const Comparison& comparison);

/// [{"name", "unit", "value", "range", "extra"}]: the times after, in the form
/// `customSmallerIsBetter` of GitHub's benchmark action, which keeps their history by their names:
/// parameters stand in `extra`. Empty without times, of which the action makes an error.
std::string smallerIsBetterJson(const std::vector<Difference>& differences);

}  // namespace gfxrepro::regression
