#include "runner/claims/judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/metrics/alike.h"
#include "runner/tables/cell.h"

namespace gfxrepro::claims {

namespace {

GroupPoint pointOf(const Group& group, const std::function<double(const Sampled&)>& pick) {
    GroupPoint point;
    for (const auto& operand : group.operands) {
        std::vector<double>& values = point.operands.emplace_back();
        for (const Sampled& sampled : operand) values.push_back(pick(sampled));
    }
    for (const Sampled& sampled : group.x) point.x.push_back(pick(sampled));
    return point;
}

/// "2 [1.9, 2.1]" with an interval, "2 (1.9 … 2.1)" with a range.
std::string boundedText(double point, tables::Bounds bounds, const metrics::Interval& interval,
                        const Requirement& requirement) {
    const std::string text = quantityText(point, requirement);
    if (bounds == tables::Bounds::None) return text;
    return fmt::format(
        fmt::runtime(bounds == tables::Bounds::Interval ? "{} [{}, {}]" : "{} ({} … {})"), text,
        quantityText(interval.low, requirement), quantityText(interval.high, requirement));
}

/// To the nearest bound, as the share by which a time would differ.
double ratioToBound(double value, const Requirement& requirement) {
    double nearest = kInfinity;
    for (const double bound : {requirement.low, requirement.high}) {
        if (!std::isfinite(bound) || !std::isfinite(value)) continue;
        const double larger = std::max(std::abs(value), std::abs(bound));
        const double distance = value > 0.0 && bound > 0.0 ? std::abs(std::log(value / bound))
                                : larger > 0.0             ? std::abs(value - bound) / larger
                                                           : 0.0;
        nearest = std::min(nearest, distance);
    }
    return nearest;
}

/// How far the rounds lie beyond the nearer bound: on a scale of which nothing is known, and of
/// what is infinite, only on which side.
std::map<int, double> beyondBound(const std::map<int, double>& rounds,
                                  const Requirement& requirement, Scale scale) {
    std::map<int, double> farthest;
    double largest = -kInfinity;
    for (const bool isHigh : {false, true}) {
        const double bound = isHigh ? requirement.high : requirement.low;
        if (!std::isfinite(bound)) continue;
        const double side = isHigh ? 1.0 : -1.0;
        const bool isFinite = std::ranges::all_of(
            rounds, [](const auto& round) { return std::isfinite(round.second); });
        const bool isLogarithmic =
            scale == Scale::Logarithmic && bound > 0.0 &&
            std::ranges::all_of(rounds, [](const auto& round) { return round.second > 0.0; });
        double sum = 0.0;
        std::map<int, double> beyond;
        for (const auto& [round, value] : rounds) {
            const double distance = !isFinite || scale == Scale::Ranks
                                        ? static_cast<double>(value > bound) - (value < bound)
                                    : isLogarithmic ? std::log(value / bound)
                                                    : value - bound;
            sum += beyond[round] = side * distance;
        }
        if (sum <= largest) continue;
        largest = sum;
        farthest = std::move(beyond);
    }
    return farthest;
}

/// A verdict, where times are far enough apart for one.
Decision decide(const Contrast& contrast, const metrics::Interval& interval, double distance,
                double noise) {
    if (contrast.decide) return contrast.decide(interval, noise);
    const Verdict verdict = verdictOf(interval, contrast.requirement);
    const bool isDecided = verdict == Verdict::Holds || verdict == Verdict::Fails;
    if (!isDecided || distance >= noise) return {verdict};
    return {
        Verdict::Ambiguous,
        fmt::format("nearer to the bound than the noise of these times, {:.3g} %", 100.0 * noise)};
}

/// Of rounds that are processes.
std::string whatIsNeeded() {
    return fmt::format(
        "an interval needs {0}: `measure: {{processes: {0}}}`, or as many in column 'process' of "
        "an import",
        metrics::kFewestForInterval);
}

std::string whyTooFew(std::size_t rounds, const Group& group) {
    if (const std::string why = whyNoInterval(group); !why.empty()) return why;
    if (rounds == 0) return "no process has all that is compared";
    if (rounds < 2) return "one sample of a time decides nothing";
    return fmt::format("a range of {} processes; {}", rounds, whatIsNeeded());
}

/// All that the group has, in one order.
template <class AnyGroup>
auto valuesOf(AnyGroup& group) {
    std::vector<decltype(&group.x[0])> all;
    for (auto& operand : group.operands) {
        for (auto& value : operand) all.push_back(&value);
    }
    for (auto& value : group.x) all.push_back(&value);
    return all;
}

/// The first of its values that is such; null where none is.
const Sampled* findIn(const Group& group, const std::function<bool(const Sampled&)>& isSuch) {
    const auto all = valuesOf(group);
    const auto found = std::ranges::find_if(all, [&](const Sampled* one) { return isSuch(*one); });
    return found == all.end() ? nullptr : *found;
}

bool isRounded(const Sampled& value) {
    return value.halfStep > 0.0;
}

constexpr const char* kWithinStep =
    "rounded values: with half a step on either side the interval reaches over the bound";

/// From the least to the most that the quantity comes to where true values lie within half a step
/// of rounded ones.
metrics::Interval reachOf(const Group& group, const GroupPoint& point,
                          const GroupNumber& quantity) {
    const double own = quantity(point);
    GroupPoint one = point, least = point, most = point;
    const auto sampled = valuesOf(group);
    const auto values = valuesOf(one), lower = valuesOf(least), upper = valuesOf(most);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double half = sampled[i]->halfStep, value = *values[i];
        if (half == 0.0) continue;
        *values[i] = value - half;
        const double before = quantity(one);
        *values[i] = value + half;
        const double after = quantity(one);
        *values[i] = value;
        const double towards = before < after ? half : before > after ? -half : 0.0;
        *lower[i] -= towards;
        *upper[i] += towards;
    }
    return {std::min(own, quantity(least)), std::max(own, quantity(most))};
}

Judgement judgeContrast(const Group& group, const std::vector<int>& rounds,
                        const Contrast& contrast, double noise) {
    const GroupPoint whole = pointOf(group);
    double middle = contrast.quantity(whole);
    std::vector<double> values, least, most;
    std::map<int, double> byRound;
    for (const int round : rounds) {
        const GroupPoint point = pointOf(group, round);
        values.push_back(byRound[round] = contrast.quantity(point));
        const metrics::Interval reach = reachOf(group, point, contrast.quantity);
        least.push_back(reach.low);
        most.push_back(reach.high);
    }
    Judgement judgement;
    if (std::isnan(middle) ||
        std::ranges::any_of(values, [](double value) { return std::isnan(value); })) {
        judgement.measured = "not a number";
        return judgement;
    }
    const Requirement& requirement = contrast.requirement;
    if (values.size() < metrics::kFewestForInterval || !whyNoInterval(group).empty()) {
        judgement.verdict = Verdict::Ambiguous;
        judgement.why = whyTooFew(values.size(), group);
        metrics::Interval range{middle, middle};
        if (values.size() > 1) range = {std::ranges::min(values), std::ranges::max(values)};
        const bool isRange = range.low < range.high;
        judgement.measured = boundedText(
            middle, isRange ? tables::Bounds::Range : tables::Bounds::None, range, requirement);
    } else {
        const metrics::Interval interval{metrics::medianInterval(least)->low,
                                         metrics::medianInterval(most)->high};
        middle = metrics::median(values);
        const double distance = contrast.distance ? contrast.distance(whole, middle)
                                                  : ratioToBound(middle, requirement);
        Decision decision = decide(contrast, interval, distance, noise);
        judgement.verdict = decision.verdict;
        judgement.why = std::move(decision.why);
        if (verdictOf(interval, requirement) != Verdict::Holds) {
            judgement.beyond = beyondBound(byRound, requirement, contrast.scale);
            const auto isAtBound = [](const auto& round) { return round.second == 0.0; };
            if (std::ranges::all_of(judgement.beyond, isAtBound)) judgement.beyond.clear();
        }
        const bool isOpen = judgement.verdict == Verdict::Ambiguous && judgement.why.empty();
        if (isOpen && findIn(group, isRounded)) judgement.why = kWithinStep;
        judgement.measured = boundedText(middle, tables::Bounds::Interval, interval, requirement);
    }
    if (!contrast.name.empty()) judgement.measured = contrast.name + " " + judgement.measured;
    judgement.isBeside = contrast.isBeside;
    judgement.isAbsent = !requirement.absence.empty() && std::isinf(middle);
    judgement.margin = std::min(middle - requirement.low, requirement.high - middle);
    judgement.marginText = quantityText(judgement.margin, requirement);
    return judgement;
}

}  // namespace

GroupPoint pointOf(const Group& group, int round) {
    return pointOf(group, [round](const Sampled& sampled) { return sampled.at(round); });
}

GroupPoint pointOf(const Group& group) {
    return pointOf(group, [](const Sampled& sampled) { return sampled.point; });
}

std::vector<int> roundsOf(const Group& group) {
    std::vector<Sampled> all = group.x;
    for (const auto& operand : group.operands)
        all.insert(all.end(), operand.begin(), operand.end());
    return tables::commonRounds(all);
}

Verdict verdictOf(const metrics::Interval& given, const Requirement& requirement) {
    metrics::Interval interval = given;
    for (double* end : {&interval.low, &interval.high}) {
        // By rounding beside a bound it is the bound.
        for (const double bound : {requirement.low, requirement.high}) {
            if (metrics::areAlike(*end, bound)) *end = bound;
        }
    }
    const bool isAboveLow = requirement.isLowExcluded ? interval.low > requirement.low
                                                      : interval.low >= requirement.low;
    const bool isBelowLow = requirement.isLowExcluded ? interval.high <= requirement.low
                                                      : interval.high < requirement.low;
    const bool isBelowHigh = requirement.isHighExcluded ? interval.high < requirement.high
                                                        : interval.high <= requirement.high;
    const bool isAboveHigh = requirement.isHighExcluded ? interval.low >= requirement.high
                                                        : interval.low > requirement.high;
    // What is not there lies outside of any range, an open one too.
    const bool mayBeAbsent = !requirement.absence.empty();
    const bool isAbsent = mayBeAbsent && std::isinf(interval.low) && interval.low == interval.high;
    const bool isPartlyAbsent =
        mayBeAbsent && (std::isinf(interval.low) || std::isinf(interval.high));
    if (isBelowLow || isAboveHigh || isAbsent) return Verdict::Fails;
    if (isAboveLow && isBelowHigh && !isPartlyAbsent) return Verdict::Holds;
    return Verdict::Ambiguous;
}

namespace {

/// Seeds of a scene: with five, the range misses the median of all in 6 % of cases, with two in 50.
constexpr std::size_t kFewestScenes = 5;

/// Whether its rounds are seeds of scenes; else they are processes.
bool isOfScenes(const Group& group) {
    return findIn(group, [](const Sampled& value) {
        return !value.rounds.empty() && value.rounds.rbegin()->first >= records::kMostProcesses;
    });
}

}  // namespace

Judgement judge(Group group, const GroupNumber& quantity, const Requirement& requirement) {
    std::vector<Sampled*> all;
    for (auto& operand : group.operands)
        for (Sampled& sampled : operand) all.push_back(&sampled);
    const bool areDraws = tables::keepRoundsOrDraws(all) && !requirement.isOfCounts;
    for (Sampled* sampled : all) {
        if (sampled->areDraws && !areDraws) *sampled = {sampled->point, {}, false};
    }
    Judgement judgement;
    const double point = quantity(pointOf(group));
    std::vector<double> values;
    std::map<int, double> byRound;
    for (const int round : roundsOf(group)) {
        values.push_back(byRound[round] = quantity(pointOf(group, round)));
    }
    const auto isNotANumber = [](double value) { return std::isnan(value); };
    if (std::isnan(point) || std::ranges::any_of(values, isNotANumber)) {
        judgement.measured = "not a number";
        return judgement;
    }
    judgement.isSingleSample = values.empty();
    judgement.isAbsent = !requirement.absence.empty() && std::isinf(point);
    metrics::Interval interval{point, point};
    tables::Bounds bounds = tables::Bounds::None;
    const bool isEqual =
        std::ranges::all_of(values, [&](double value) { return metrics::areAlike(value, point); });
    if (!isEqual) {
        const auto [low, high] = std::ranges::minmax(values);
        std::optional<metrics::Interval> told;  // a count is that in all of them, or in none
        if (!requirement.isOfCounts) {
            told = areDraws ? tables::drawsInterval(values) : metrics::medianInterval(values);
        }
        bounds = told ? tables::Bounds::Interval : tables::Bounds::Range;
        interval = told.value_or(metrics::Interval{low, high});
    }
    const std::size_t fewest = isOfScenes(group) ? kFewestScenes : metrics::kFewestForInterval;
    const bool areTooFew =
        !isEqual && !areDraws && !requirement.isOfCounts && values.size() < fewest;
    judgement.verdict = verdictOf(interval, requirement);
    // What is otherwise at times is exactly so in a few of them by chance, or in none.
    const bool isByChance = requirement.isOfCounts && isRandom(group);
    if (const std::string why = isByChance ? whyNoInterval(group) : ""; !why.empty()) {
        judgement.verdict = Verdict::Ambiguous;
        judgement.why = why;
    }
    if (areTooFew && judgement.verdict != Verdict::Unmeasured) {
        judgement.verdict = Verdict::Ambiguous;
        judgement.why = fewest == kFewestScenes
                            ? fmt::format("{} scenes that differ; {} are the fewest that decide",
                                          values.size(), fewest)
                            : whyTooFew(values.size(), group);
    }
    if (bounds == tables::Bounds::Interval && judgement.verdict != Verdict::Holds) {
        if (areDraws) {
            const auto isWithin = [&](double value) {
                return verdictOf({value, value}, requirement) == Verdict::Holds;
            };
            judgement.drawsWithin = static_cast<double>(std::ranges::count_if(values, isWithin)) /
                                    static_cast<double>(values.size());
        } else {
            judgement.beyond = beyondBound(byRound, requirement, Scale::Linear);
        }
    }
    const bool isFarthest = requirement.isOfCounts && !isEqual;
    judgement.measured =
        boundedText(isFarthest ? interval.high : point, bounds, interval, requirement);
    judgement.margin = std::min(point - requirement.low, requirement.high - point);
    judgement.marginText = quantityText(judgement.margin, requirement);
    return judgement;
}

namespace {

const Sampled* findOverProcesses(const Group& group) {
    return findIn(group, [](const Sampled& value) { return !value.overProcesses.empty(); });
}

}  // namespace

bool isRandom(const Group& group) {
    return findIn(group, &Sampled::isRandom) != nullptr;
}

bool isOverProcesses(const Group& group) {
    return findOverProcesses(group) != nullptr;
}

std::string whyNoInterval(const Group& group) {
    if (const Sampled* over = findOverProcesses(group)) {
        return fmt::format(
            "a {} over processes has no interval, as what is rare moves it by any amount; "
            "'{{median}}' has one",
            over->overProcesses);
    }
    const auto isOnceAlong = [](const Sampled& value) { return !value.onceAlong.empty(); };
    if (const Sampled* one = findIn(group, isOnceAlong)) {
        return fmt::format(
            "takes values of '{0}' together that were measured once each, and may repeat one case: "
            "an axis of rows tells them apart; what repeats a case is its processes (of an import "
            "the column 'process', or 'seed')",
            one->onceAlong);
    }
    if (findIn(group, &Sampled::isOnce)) return "one sample of a time decides nothing";
    if (findIn(group, &Sampled::isRunOnce)) {
        return "one process of a program without a seed; `measure: {processes: 2}` tells whether "
               "another comes to the same, `processes: 1` says so";
    }
    std::optional<std::size_t> fewest;
    bool isDeclared = true, areEqual = true;
    const auto count = [&](const std::vector<Sampled>& values) {
        for (const Sampled& value : values) {
            if (!value.isRandom) continue;
            const std::size_t seeds = std::max<std::size_t>(value.rounds.size(), 1);
            if (!fewest || seeds < *fewest) isDeclared = !value.scatters;
            areEqual &= std::ranges::all_of(
                value.rounds, [&](const auto& round) { return round.second == value.point; });
            fewest = std::min(fewest.value_or(seeds), seeds);
        }
    };
    std::ranges::for_each(group.operands, count);
    count(group.x);
    if (!fewest || *fewest >= metrics::kFewestForInterval) return "";
    if (!isDeclared) {
        return fmt::format(
            "{}; {}",
            *fewest == 1 ? "one process of numbers that differ when they are taken again"
                         : fmt::format("{}{}", *fewest,
                                       areEqual ? " equal processes beside numbers that differ"
                                                : " processes came to different numbers"),
            whatIsNeeded());
    }
    return fmt::format(
        "{} of random numbers; an interval needs {}: `measure: {{processes: {}}}` where the seed "
        "is not swept, or as many values of 'seed' in a sweep or an import",
        *fewest == 1 ? "one sample" : fmt::format("{} seeds", *fewest), metrics::kFewestForInterval,
        metrics::kFewestForInterval);
}

std::vector<Judgement> judgeVarying(const Group& group, const Contrasts& contrasts,
                                    std::optional<double> noise) {
    const std::vector<int> rounds = roundsOf(group);
    std::vector<Judgement> judgements;
    for (const Contrast& contrast : contrasts(pointOf(group))) {
        judgements.push_back(judgeContrast(group, rounds, contrast, noise.value_or(0.0)));
    }
    return judgements;
}

void forgiveChance(std::span<Judgement* const> all) {
    constexpr double kOneEnd = 0.025;
    std::vector<Judgement*> sampled, drawn;
    std::vector<std::map<int, double>> series;
    for (Judgement* one : all) {
        if (one->drawsWithin) drawn.push_back(one);
        if (one->beyond.empty()) continue;
        sampled.push_back(one);
        series.push_back(one->beyond);
    }
    const auto forgive = [](Judgement& one, double chance, std::size_t count) {
        if (one.verdict != Verdict::Fails || chance <= kOneEnd) return;
        one.verdict = Verdict::Ambiguous;
        one.why = fmt::format(
            "fails by itself, but the farthest of {} comparisons is as far off by chance in {:.3g} "
            "% of tables",
            count, 100.0 * std::min(chance, 1.0));
    };
    if (series.size() > 1) {
        const std::vector<double> chances = metrics::jointChances(series, false);
        for (std::size_t i = 0; i < chances.size(); ++i) {
            forgive(*sampled[i], chances[i], series.size());
        }
    }
    for (Judgement* one : drawn) {
        if (drawn.size() < 2) break;
        forgive(*one, *one->drawsWithin * static_cast<double>(drawn.size()), drawn.size());
    }
}

Judgement worstOf(std::vector<Judgement> judgements) {
    std::optional<Judgement> worst;
    for (Judgement& judgement : judgements) {
        const auto isWorse = [&] {
            const int left = severity(judgement.verdict), right = severity(worst->verdict);
            return left != right ? left > right
                                 : judgement.margin < worst->margin && !judgement.isBeside;
        };
        if (!worst || isWorse()) worst = std::move(judgement);
    }
    return worst.value_or(Judgement{});
}

}  // namespace gfxrepro::claims
