// The numbers of a run that can be compared with another run's, and exact tests of them.
#pragma once

#include <compare>
#include <cstddef>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/metrics/statistics.h"
#include "runner/records/records.h"

namespace gfxrepro::regression {

/// The metric of a picture's key, whose pass is the picture's name.
inline constexpr const char* kPictureMetric = "picture";

/// One metric of one case. Two builds have the same key where they were asked the same.
struct SeriesKey {
    std::string table;
    std::string technique;
    std::string method;
    std::string scene;
    std::string params;  // one-line JSON of the resolved parameters
    std::string pass;
    std::string metric;
    std::string unit;

    auto operator<=>(const SeriesKey&) const = default;

    /// Of a frame: by the clock, of all the process's threads, or a program's own.
    bool isTime() const { return metric.ends_with("_ms"); }
    bool isProcessTime() const { return metric == "process_time_ms"; }
    /// "zju2005/2.1 TECHNIQUE worksheet models/duck"; parameters are left away.
    std::string caseTitle() const;
    /// … wall_time_ms
    std::string title() const;
};

/// A value a process: the mean over frames of the median over repeats. Not-a-number where the time
/// is void: a frame of that process showed nothing, or its repeats did not do the same.
using Series = std::vector<double>;
using SeriesMap = std::map<SeriesKey, Series>;
/// The values that are not void.
Series standing(const Series& values);

/// The parameters of a run's cases as SeriesKey has them, by id.
using CaseParams = std::map<std::string, std::string>;

/// Names of tables.
using Tables = std::set<std::string>;

/// Table and metric.
using MetricsOfTables = std::set<std::pair<std::string, std::string>>;
/// Those that stand under frame −1 alone.
MetricsOfTables setupMetricsOf(const std::vector<records::Record>& records);

/// The series of `ok` rows, and of times that are void; of two rows of one place the last, as
/// tables have it. Of times there is the frame's of each case in the timing lane, no more: every
/// further series asks for more rounds of all, a pass that matters shows in its frame, a rate is a
/// reciprocal, and loading and setting up depend on what the disk has in its cache. Of the tables
/// that go by the clock (config::goesByClock) there are the program's own times (…_ms), too. Left
/// out are numbers made from times (of a unit of time or a rate, or "time" in the name) and what is
/// about the machine (memory of the process, counts that the order of parallel work changes).
SeriesMap seriesOf(const std::vector<records::Record>& records, const CaseParams& params,
                   const Tables& byClock = {});

/// Of a case: pass and unit are empty.
SeriesKey keyOf(const records::Record& record, const CaseParams& params, std::string metric);

/// What is said of cases, by case: the key's metric is "status", its pass and unit are empty.
using CaseTexts = std::map<SeriesKey, std::string>;
/// Cases that did not end as they should, be it that their second try did: "crash: SIGSEGV: …".
CaseTexts failuresOf(const std::vector<records::Record>& records, const CaseParams& params);
/// Why times of cases are void: "frame 0: the picture of repeat 0 is blank: …".
CaseTexts voidTimesOf(const std::vector<records::Record>& records, const CaseParams& params);
/// Those of these cases that one process measured.
CaseTexts onceOf(const std::vector<records::Record>& records, const CaseParams& params,
                 const std::set<std::string>& cases);
/// How many cases ran side by side in the quality lane, so that their times are not compared.
std::size_t untimedCases(const std::vector<records::Record>& records);

/// The names of the parameters that keys have, by technique.
using ParamNames = std::map<std::string, std::set<std::string>>;
void addParamNames(const SeriesKey& key, ParamNames& names);
/// The parameters in `known` alone; all where nothing is known of the technique.
std::string reducedParams(const SeriesKey& key, const ParamNames& known);

/// Titles in their order; where several have one, with the parameters in which these differ:
/// "sweep/mine … wall_time_ms, samples=4".
std::vector<std::string> titlesOf(const std::vector<const SeriesKey*>& keys);
/// Of whatever has a `key`.
template <class Results>
std::vector<const SeriesKey*> keysOf(const Results& results) {
    std::vector<const SeriesKey*> keys;
    for (const auto& result : results) keys.push_back(&result.key);
    return keys;
}

/// Puts `more`'s processes behind those of `series`: rounds of alternating runs.
void append(SeriesMap& series, const SeriesMap& more);

/// Takes parameters that only one side's build knows out of both sides' keys, so that a build with
/// a new parameter can be compared with the one before. Not where keys of a side would fall
/// together: then the new parameter was varied.
void matchParams(SeriesMap& before, SeriesMap& after);

/// Leaves one time of each case of the tables `byProcess`, which a built-in technique measured on a
/// software device, the same on both sides: the CPU time of the process where both have it, for the
/// clock counts what else the machine did; else the clock's. Of other tables all stay.
void chooseTimes(SeriesMap& before, SeriesMap& after, const Tables& byProcess);

/// A shift between two sides [Hodges and Lehmann 1963], its exact two-sided chance under no shift
/// [Wilcoxon 1945], and where it lies at 95 %.
struct RankTest {
    double shift = 0.0;
    double chance = 1.0;
    /// The smallest chance that so many values can give.
    double attainable = 1.0;
    /// Unbounded where there are too few values for 95 %: below 6 pairs, or 4 and 4 values.
    metrics::Interval interval;
    /// Of rank sums: above the one, and below the other, it lies with 95 % each.
    metrics::Interval bounds{};
};

/// The differences of pairs against none: signed ranks. At least one.
RankTest signedRank(std::span<const double> differences);

/// `after` against `before`, which are no pairs: rank sums. At least one value each.
RankTest rankSum(std::span<const double> before, std::span<const double> after);

/// Two sides that may scatter differently [Welch 1947].
struct WelchTest {
    double t = 0.0;       // difference of the means over its standard error; ±∞ where that is 0
    int freedom = 1;      // degrees of it, rounded down
    double chance = 1.0;  // two-sided, under equal means
};
/// At least two values each.
WelchTest welch(std::span<const double> before, std::span<const double> after);

/// The exact two-sided chance that as many values as `first`, drawn from both, have a rank sum as
/// far from its mean as `first`'s.
double rankSumChance(std::span<const double> first, std::span<const double> rest);

/// 1 … n, the mean of their places where values are equal.
Series ranksOf(std::span<const double> values);

}  // namespace gfxrepro::regression
