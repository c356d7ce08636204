#include "runner/regression/comparison.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <string_view>
#include <utility>

#include "engine/metrics/mean_test.h"
#include "runner/config/outputs.h"
#include "runner/records/records.h"
#include "runner/tables/layout_cases.h"

namespace gfxrepro::regression {

namespace {

/// Processes of which ranks can tell at 95 %: C(n + m, n) at least 40.
constexpr const char* kFewestApart = "4 a side are needed, 5 beside 3, or 8 beside 2";

Series logarithms(const Series& values) {
    Series logs;
    for (const double value : values) logs.push_back(std::log(value));
    return logs;
}

/// log(time after / time before) for each pair of rounds in which both stand.
Series logRatios(const Series& before, const Series& after) {
    Series ratios;
    for (std::size_t i = 0; i < std::min(before.size(), after.size()); ++i) {
        ratios.push_back(std::log(after[i] / before[i]));
    }
    return standing(ratios);
}

bool arePositive(const Series& values) {
    return std::ranges::all_of(values, [](double value) { return value > 0.0; });
}

bool areWhole(const Series& values) {
    return std::ranges::all_of(values, [](double value) { return value == std::floor(value); });
}

/// Of numbers that differ between the processes of a side, as of a program that seeds itself: the
/// chance that all of so many of one side lie beyond all of the other where nothing changed.
double chanceApart(std::size_t before, std::size_t after) {
    double ways = 1.0;  // to choose the processes of one side of all
    for (std::size_t i = 1; i <= before; ++i) {
        ways *= static_cast<double>(after + i) / static_cast<double>(i);
    }
    return 2.0 / ways;
}

bool areApart(const Series& before, const Series& after) {
    const auto [low, high] = std::ranges::minmax(before);
    const auto [otherLow, otherHigh] = std::ranges::minmax(after);
    return low > otherHigh || otherLow > high;
}

/// Within the relative tolerance; two infinities are the same, their difference is not a number.
bool areSame(double a, double b, double within) {
    const double scale = std::max(std::abs(a), std::abs(b));
    return a == b || (std::isfinite(scale) && std::abs(a - b) <= within * scale);
}

bool differ(const Series& values, double within) {
    return std::ranges::any_of(
        values, [&](double value) { return !areSame(value, values.front(), within); });
}

/// Why what is alike on either side may differ by chance; `series`: of how many of its metric that
/// differ. No `why`: there is no doubt.
struct InDoubt {
    std::string why;
    std::size_t series = 0;
};

/// Of numbers of programs and imports without a seed those that may be alike by chance
/// (tables::Doubt). What is within the tolerance is alike.
class Doubts {
  public:
    Doubts(const SeriesMap& before, const SeriesMap& after, const Rules& rules) : rules_(rules) {
        for (const SeriesMap* side : {&before, &after}) {
            for (const auto& [key, values] : *side) {
                const double within = areWhole(values) ? 0.0 : rules.valueTolerance;
                if (!isOfUnseeded(key) || !differ(values, within)) continue;
                doubts_[programOf(key)].note(key.metric, key.unit);
                differing_[{programOf(key), key.metric}].insert(key);
            }
        }
    }

    InDoubt of(const SeriesKey& key) const {
        const auto found = doubts_.find(isOfUnseeded(key) ? programOf(key) : "");
        const bool isOfElsewhere = isOfUnseeded(key) && rules_.unseeded.at(key.table).empty();
        if (found == doubts_.end() ||
            !found->second.reaches(key.metric, tables::isOfMachine(key.metric, key.unit),
                                   rules_.ofSetup.contains({key.table, key.metric}),
                                   isOfElsewhere)) {
            return {};
        }
        const auto differing = differing_.find({found->first, key.metric});
        if (differing == differing_.end())
            return {"other numbers of the program differ between processes of one side"};
        return {"in other cases it differs between processes of one side",
                differing->second.size()};
    }

  private:
    bool isOfUnseeded(const SeriesKey& key) const {
        return !key.isTime() && rules_.unseeded.contains(key.table);
    }
    std::string programOf(const SeriesKey& key) const {
        const std::string& program = rules_.unseeded.at(key.table);
        return program.empty() ? "import " + key.table : "program " + program;
    }

    const Rules& rules_;
    std::map<std::string, tables::Doubt> doubts_;
    std::map<std::pair<std::string, std::string>, std::set<SeriesKey>> differing_;  // of a metric
};

/// Why values that are not alike, and may differ by chance, do not tell whether they changed; empty
/// where they do. What is alike on each side may be one of two values by chance, as any of the
/// metric's series that differ. `count`: of how many series each may raise an alarm.
std::string whyUndecided(const Series& before, const Series& after, const InDoubt& doubt,
                         std::size_t count, double familyError) {
    const double level = familyError / static_cast<double>(count);
    const auto tell = [&](std::size_t a, std::size_t b) {
        if (doubt.why.empty()) return chanceApart(a, b) <= level;
        const double chance = std::exp2(1.0 - static_cast<double>(a + b));
        return std::min(a, b) >= metrics::kFewestForInterval &&
               static_cast<double>(doubt.series) * chance <= familyError;
    };
    const bool isDecided = areApart(before, after) || !doubt.why.empty();
    if (isDecided && tell(before.size(), after.size())) return "";
    std::size_t needed = metrics::kFewestForInterval;
    while (!tell(needed, needed)) ++needed;
    const std::string why =
        doubt.why.empty() ? "numbers that differ between processes of one side" : doubt.why;
    if (std::min(before.size(), after.size()) >= needed) return why;
    return fmt::format("{}; {} a side tell: `measure: {{processes: {}}}`", why, needed, needed);
}

/// `count`: of how many series each may raise an alarm.
Difference compareValues(const SeriesKey& key, const Series& before, const Series& after,
                         const Rules& rules, std::size_t count, const InDoubt& doubt) {
    Difference result{
        .key = key, .before = metrics::median(before), .after = metrics::median(after)};
    const bool isRatio = result.before != 0.0 && std::isfinite(result.before);
    result.ratio = isRatio ? result.after / result.before : 1.0;
    result.interval = {result.ratio, result.ratio};
    result.floor = areWhole(before) && areWhole(after) ? 0.0 : rules.valueTolerance;
    const bool isSame = areSame(result.before, result.after, result.floor);
    const bool isAlike = std::ranges::equal(
        before, after, [&](double a, double b) { return areSame(a, b, result.floor); });
    const bool isOwn = differ(before, result.floor) || differ(after, result.floor);
    result.verdict = isSame ? SeriesVerdict::Same : SeriesVerdict::Changed;
    if (isAlike || (!isOwn && doubt.why.empty())) return result;
    result.reason =
        whyUndecided(before, after, isOwn ? InDoubt() : doubt, count, rules.familyError);
    if (!result.reason.empty()) result.verdict = SeriesVerdict::CannotTell;
    return result;
}

Difference missing(const SeriesKey& key, const Series& values, bool isBefore) {
    const Series own = key.isTime() ? standing(values) : values;
    if (own.empty()) {
        constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
        return {
            .key = key,
            .before = kNone,
            .after = kNone,
            .verdict = SeriesVerdict::Missing,
            .reason = isBefore ? "void before, not there after" : "void after, not there before"};
    }
    Difference result{.key = key,
                      .verdict = isBefore ? SeriesVerdict::Lost : SeriesVerdict::Missing};
    (isBefore ? result.before : result.after) = metrics::median(own);
    result.reason = isBefore ? "measured before only" : "measured after only";
    return result;
}

/// What becomes of a time that is void in all processes of a side; null where some stand on both.
std::optional<Difference> voidTime(const SeriesKey& key, const Series& before,
                                   const Series& after) {
    const bool isBefore = !standing(before).empty(), isAfter = !standing(after).empty();
    if (isBefore && isAfter) return std::nullopt;
    if (isBefore || isAfter) return missing(key, isBefore ? before : after, isBefore);
    return Difference{.key = key, .verdict = SeriesVerdict::Void};
}

/// A time of both sides, and how it was tested.
struct TestedTime {
    Difference difference;
    RankTest test;                   // apart: its chance is that of the means
    std::size_t rounds[2] = {0, 0};  // alternate: of pairs, twice the same
    double t = 0.0;                  // apart, of the means
    /// Beyond the floor: alternate the ratio, apart its bound on that side.
    bool isSlower = false, isFaster = false;
};

TestedTime testTime(const SeriesKey& key, const Series& allBefore, const Series& allAfter,
                    Pairing pairing, const Rules& rules) {
    const Series before = standing(allBefore), after = standing(allAfter);
    TestedTime time{
        {.key = key, .before = metrics::median(before), .after = metrics::median(after)}, {}};
    Difference& difference = time.difference;
    if (!arePositive(before) || !arePositive(after)) {
        difference.reason = "a time of zero or less";
        return time;
    }
    if (pairing == Pairing::ByTurns && allBefore.size() != allAfter.size()) {
        difference.reason = fmt::format("measured in {} and {} rounds: no pairs", allBefore.size(),
                                        allAfter.size());
        return time;
    }
    if (pairing == Pairing::ByTurns) {
        const Series ratios = logRatios(allBefore, allAfter);
        if (ratios.empty()) {
            difference.reason = "no round in which both sides' times stand";
            return time;
        }
        time.rounds[0] = time.rounds[1] = ratios.size();
        time.test = signedRank(ratios);
        difference.floor = detectableChange(before, rules);
    } else {
        time.rounds[0] = before.size();
        time.rounds[1] = after.size();
        time.test = rankSum(logarithms(before), logarithms(after));
        difference.floor = rules.driftApart;
        if (std::min(before.size(), after.size()) > 1) {
            const WelchTest means = welch(logarithms(before), logarithms(after));
            time.t = means.t;
            time.test.chance = means.chance;
        }
    }
    difference.ratio = std::exp(time.test.shift);
    difference.interval = {std::exp(time.test.interval.low), std::exp(time.test.interval.high)};
    const double shift = time.test.shift, floor = std::log1p(difference.floor);
    const bool isApart = pairing == Pairing::Apart;
    time.isSlower = (isApart ? time.test.bounds.low : shift) > floor;
    time.isFaster = (isApart ? time.test.bounds.high : shift) < -floor;
    return time;
}

/// Whether the chances are too small for none, all together: by turns by steps down [Holm 1979],
/// with `level` the chance of one false alarm. Apart by steps up [Benjamini and Hochberg 1995]: the
/// chance where nothing changed, else the share of false ones.
std::vector<bool> rejections(const std::vector<TestedTime*>& times, Pairing pairing, double level) {
    std::vector<std::size_t> order(times.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t i) { return times[i]->test.chance; });
    const auto count = static_cast<double>(order.size());
    std::size_t rejected = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
        const double chance = times[order[i]]->test.chance, step = static_cast<double>(i);
        if (pairing == Pairing::Apart && chance <= level * (step + 1.0) / count) rejected = i + 1;
        if (pairing == Pairing::ByTurns && chance > level / (count - step)) break;
        if (pairing == Pairing::ByTurns) rejected = i + 1;
    }
    std::vector<bool> isRejected(times.size(), false);
    for (std::size_t i = 0; i < rejected; ++i) isRejected[order[i]] = true;
    return isRejected;
}

/// How many rounds, or processes a side, would make the chance so small, were all as it is; as far
/// as a thousand.
std::size_t countNeeded(const TestedTime& time, Pairing pairing, double level) {
    const std::size_t had = std::min(time.rounds[0], time.rounds[1]);
    const auto chance = [&](std::size_t count) {
        const auto now = static_cast<double>(count);
        if (pairing == Pairing::ByTurns) return std::exp2(1.0 - now);
        const double t = time.t * std::sqrt(now / static_cast<double>(had));
        return metrics::studentP(t, 2 * static_cast<int>(count) - 2);
    };
    std::size_t count = had;
    while (count < 1000 && chance(count) > level) ++count;
    return count;
}

std::string whyUndecided(const TestedTime& time, std::size_t seriesCount, Pairing pairing,
                         double level) {
    const std::string among =
        seriesCount == 1 ? "one series" : fmt::format("{} series", seriesCount);
    const std::size_t needed = countNeeded(time, pairing, level / static_cast<double>(seriesCount));
    if (pairing == Pairing::ByTurns) {
        if (needed == time.rounds[0]) return "the interval is too wide";
        return fmt::format("{} rounds cannot decide among {}: {} are needed", time.rounds[0], among,
                           needed);
    }
    if (time.isSlower || time.isFaster) {
        return fmt::format("{} and {} processes cannot decide among {}: {} a side are needed",
                           time.rounds[0], time.rounds[1], among, needed);
    }
    const std::string drift = fmt::format("{:.0f} %", 100.0 * time.difference.floor);
    if (std::abs(time.test.shift) <= std::log1p(time.difference.floor)) {
        return fmt::format("measured apart: a machine may drift by {}", drift);
    }
    return fmt::format("the interval reaches into the {} by which a machine may drift", drift);
}

void judgeTime(TestedTime& time, bool isRejected, std::size_t seriesCount, Pairing pairing,
               double level, const Rules& rules) {
    Difference& difference = time.difference;
    const double same = rules.sameWithin;
    if (isRejected && time.isSlower) {
        difference.verdict = SeriesVerdict::Slower;
    } else if (isRejected && time.isFaster) {
        difference.verdict = SeriesVerdict::Faster;
    } else if (pairing == Pairing::ByTurns && difference.interval.low >= 1.0 / (1.0 + same) &&
               difference.interval.high <= 1.0 + same) {
        difference.verdict = SeriesVerdict::Same;
    } else {
        difference.reason = whyUndecided(time, seriesCount, pairing, level);
    }
}

void judgeTimes(std::vector<TestedTime>& times, Pairing pairing, const Rules& rules) {
    const std::size_t looks = pairing == Pairing::Apart ? 1 : rules.looks;
    const double level = rules.familyError / static_cast<double>(looks);
    std::vector<TestedTime*> tested;
    for (TestedTime& time : times) {
        if (!time.difference.reason.empty()) continue;
        // What has no interval, or no spread, shares in no chance.
        const std::size_t fewest = std::min(time.rounds[0], time.rounds[1]);
        if (pairing == Pairing::Apart && (time.test.attainable > level || fewest < 2)) {
            time.difference.reason = fmt::format("{} and {} processes cannot decide: {}",
                                                 time.rounds[0], time.rounds[1], kFewestApart);
            continue;
        }
        tested.push_back(&time);
    }
    const std::vector<bool> isRejected = rejections(tested, pairing, level);
    for (std::size_t i = 0; i < tested.size(); ++i) {
        judgeTime(*tested[i], isRejected[i], tested.size(), pairing, level, rules);
    }
}

/// Measures until every time is told, or the looks are used up; after the first look the tables
/// with times that are not, alone.
std::vector<Difference> measureUntilDecided(const MeasureRounds& measure,
                                            std::set<std::string> tables) {
    Sides sides;
    Rules rules;
    std::vector<Difference> differences;
    for (std::size_t look = 0; look < rules.looks; ++look) {
        measure(sides, tables);
        rules.byProcess = sides.byProcess;
        differences = compare(sides.before, sides.after, Pairing::ByTurns, rules);
        noteFailures(differences, sides.failuresBefore, sides.failuresAfter);
        noteVoidTimes(differences, sides.voidBefore, sides.voidAfter);
        addPictures(differences, sides.pictures);
        tables.clear();
        for (const Difference& one : differences) {
            const bool isOpen = one.verdict == SeriesVerdict::CannotTell && !one.isPicture();
            if (isOpen) tables.insert(one.key.table);
        }
        if (tables.empty()) break;
    }
    return differences;
}

}  // namespace

std::string_view verdictName(SeriesVerdict verdict) {
    constexpr std::string_view kNames[] = {"faster",
                                           "slower",
                                           "same",
                                           "cannot tell",
                                           "changed",
                                           "missing",
                                           "lost",
                                           "void on both sides",
                                           "failed on both sides"};
    return kNames[static_cast<std::size_t>(verdict)];
}

double detectableChange(const Series& values, const Rules& rules) {
    Series even, odd;
    for (std::size_t i = 0; i + 1 < values.size(); i += 2) {
        even.push_back(values[i]);
        odd.push_back(values[i + 1]);
    }
    if (even.empty() || !arePositive(values)) return rules.effectFloor;
    const metrics::Interval interval = signedRank(logRatios(even, odd)).interval;
    if (!std::isfinite(interval.high - interval.low)) return rules.effectFloor;
    // Half as many pairs as a comparison has: its interval is narrower by the square root of two.
    const double half = 0.5 * (interval.high - interval.low) / std::sqrt(2.0);
    return std::max(rules.effectFloor, std::expm1(half));
}

std::vector<Difference> compare(const SeriesMap& allBefore, const SeriesMap& allAfter,
                                Pairing pairing, const Rules& rules) {
    SeriesMap before = allBefore, after = allAfter;
    matchParams(before, after);
    chooseTimes(before, after, rules.byProcess);
    const Doubts doubts(before, after, rules);
    std::vector<Difference> differences;
    std::vector<TestedTime> times;
    for (const auto& [key, values] : before) {
        const auto found = after.find(key);
        if (found == after.end()) {
            differences.push_back(missing(key, values, true));
        } else if (auto own = key.isTime() ? voidTime(key, values, found->second) : std::nullopt) {
            differences.push_back(std::move(*own));
        } else if (key.isTime()) {
            times.push_back(testTime(key, values, found->second, pairing, rules));
        } else {
            differences.push_back(
                compareValues(key, values, found->second, rules, before.size(), doubts.of(key)));
        }
    }
    judgeTimes(times, pairing, rules);
    for (TestedTime& time : times) differences.push_back(std::move(time.difference));
    for (const auto& [key, values] : after) {
        if (!before.contains(key)) differences.push_back(missing(key, values, false));
    }
    std::ranges::sort(differences, {}, &Difference::key);
    return differences;
}

void addPictures(std::vector<Difference>& differences, std::vector<Difference> pictures) {
    std::map<SeriesKey, bool> isLost;  // by case: whether nothing is left of it
    const auto caseOf = [](SeriesKey key) {
        key.pass = key.metric = key.unit = "";
        return key;
    };
    for (const Difference& one : differences) {
        if (one.verdict == SeriesVerdict::Missing) continue;
        const auto [found, isNew] = isLost.try_emplace(caseOf(one.key), true);
        found->second = found->second && one.verdict == SeriesVerdict::Lost;
    }
    for (Difference& picture : pictures) {
        const auto found = isLost.find(caseOf(picture.key));
        if (picture.verdict == SeriesVerdict::Lost && found != isLost.end() && found->second) {
            picture.verdict = SeriesVerdict::Missing;
        }
    }
    std::ranges::move(pictures, std::back_inserter(differences));
    std::ranges::sort(differences, {}, &Difference::key);
}

void confirm(std::vector<Difference>& differences, const std::vector<Difference>& again) {
    for (Difference& difference : differences) {
        if (!difference.isAlarm()) continue;
        const auto found = std::ranges::find(again, difference.key, &Difference::key);
        if (found != again.end() && found->verdict == difference.verdict) continue;
        difference.reason =
            fmt::format("{} once, not when measured again", verdictName(difference.verdict));
        difference.verdict = SeriesVerdict::CannotTell;
    }
}

std::vector<Difference> compareByTurns(const MeasureRounds& measure) {
    std::vector<Difference> differences = measureUntilDecided(measure, {});
    std::set<std::string> tables;
    for (const Difference& difference : differences) {
        if (difference.isAlarm()) tables.insert(difference.key.table);
    }
    if (!tables.empty()) confirm(differences, measureUntilDecided(measure, tables));
    return differences;
}

// How cases failed and why times are void, said of what that left undecided.

namespace {

/// Finds what is said of a case, also where one side's build knows parameters that the other does
/// not: cases are held against each other by the parameters that all of them know.
class Cases {
  public:
    Cases(const std::vector<Difference>& differences, const CaseTexts& before,
          const CaseTexts& after) {
        ParamNames ofDifferences, ofBefore, ofAfter;
        for (const Difference& one : differences) addParamNames(one.key, ofDifferences);
        for (const auto& [key, text] : before) addParamNames(key, ofBefore);
        for (const auto& [key, text] : after) addParamNames(key, ofAfter);
        for (const ParamNames* side : {&ofDifferences, &ofBefore, &ofAfter}) {
            for (const auto& one : *side) {
                const auto [found, isNew] = common_.insert(one);
                if (isNew) continue;
                std::erase_if(found->second,
                              [&](const std::string& name) { return !one.second.contains(name); });
            }
        }
    }

    SeriesKey of(SeriesKey key) const {
        key.params = reducedParams(key, common_);
        key.pass = key.unit = "";
        key.metric = "status";
        return key;
    }

    CaseTexts matched(const CaseTexts& texts) const {
        CaseTexts result;
        for (const auto& [key, text] : texts) result[of(key)] = text;
        return result;
    }

  private:
    ParamNames common_;
};

const std::string* textOf(const CaseTexts& texts, const SeriesKey& key) {
    const auto found = texts.find(key);
    return found == texts.end() ? nullptr : &found->second;
}

Difference failure(const SeriesKey& key, const std::string* before, const std::string& after) {
    const std::string_view flaky = records::statusName(records::Status::Flaky);
    const bool wasMeasured = !before || (before->starts_with(flaky) && !after.starts_with(flaky));
    Difference result{.key = key,
                      .verdict = wasMeasured ? SeriesVerdict::Lost : SeriesVerdict::Failed,
                      .reason = after};
    if (before && *before != after) {
        result.reason = fmt::format("before {}; after {}", *before, after);
    }
    return result;
}

}  // namespace

void noteFailures(std::vector<Difference>& differences, const CaseTexts& before,
                  const CaseTexts& after) {
    if (before.empty() && after.empty()) return;
    const Cases cases(differences, before, after);
    const CaseTexts earlier = cases.matched(before), later = cases.matched(after);
    std::set<SeriesKey> said;
    for (Difference& one : differences) {
        if (one.verdict != SeriesVerdict::Lost && one.verdict != SeriesVerdict::Missing) continue;
        const SeriesKey key = cases.of(one.key);
        const bool isLost = one.verdict == SeriesVerdict::Lost;
        const std::string* text = textOf(isLost ? later : earlier, key);
        if (!text) continue;
        one.reason = isLost ? *text : fmt::format("{}: {}", one.reason, *text);
        if (isLost) said.insert(key);
    }
    for (const auto& [key, text] : after) {
        const SeriesKey own = cases.of(key);
        if (!said.contains(own)) differences.push_back(failure(key, textOf(earlier, own), text));
    }
    std::ranges::sort(differences, {}, &Difference::key);
}

void noteVoidTimes(std::vector<Difference>& differences, const CaseTexts& before,
                   const CaseTexts& after) {
    if (before.empty() && after.empty()) return;
    const Cases cases(differences, before, after);
    const CaseTexts earlier = cases.matched(before), later = cases.matched(after);
    for (Difference& one : differences) {
        if (!one.key.isTime()) continue;
        const SeriesKey key = cases.of(one.key);
        const std::string* then = textOf(earlier, key);
        const std::string* now = textOf(later, key);
        const std::string* either = now ? now : then;
        if (!either) continue;
        if (one.verdict == SeriesVerdict::Void) {
            one.reason = *either;
        } else if (one.verdict == SeriesVerdict::Lost && now) {
            one.reason = fmt::format("its times are void: {}", *now);
        } else if (one.verdict == SeriesVerdict::Missing && then) {
            one.reason += fmt::format(": void before: {}", *then);
        } else if (one.verdict == SeriesVerdict::CannotTell) {
            one.reason += fmt::format(" (void in some rounds: {})", *either);
        }
    }
}

void noteOnce(std::vector<Difference>& differences, const CaseTexts& before,
              const CaseTexts& after) {
    if (before.empty() || after.empty()) return;
    const Cases cases(differences, before, after);
    const CaseTexts earlier = cases.matched(before), later = cases.matched(after);
    for (Difference& one : differences) {
        const SeriesKey key = cases.of(one.key);
        const bool isOnce = textOf(earlier, key) && textOf(later, key);
        if (one.verdict != SeriesVerdict::Changed || !isOnce) continue;
        one.verdict = SeriesVerdict::CannotTell;
        one.reason = kOnce;
    }
}

}  // namespace gfxrepro::regression
