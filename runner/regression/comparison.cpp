#include "runner/regression/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "runner/core/error.h"
#include "runner/core/random.h"

namespace gfxrepro::regression {

namespace {

constexpr int kDraws = 4000;  // enough for the tails that Bonferroni asks for
constexpr std::uint64_t kSeed = 1;

double medianOf(const Series& values) {
    return metrics::summarize(values, metrics::Statistic::Median);
}

/// log(time after / time before) for each pair of rounds.
Series logRatios(const Series& before, const Series& after) {
    Series ratios;
    for (std::size_t i = 0; i < std::min(before.size(), after.size()); ++i) {
        ratios.push_back(std::log(after[i] / before[i]));
    }
    return ratios;
}

/// Resampled log ratios of medians.
Series draws(const Series& before, const Series& after, Pairing pairing) {
    if (pairing == Pairing::ByTurns) {
        return metrics::bootstrap(logRatios(before, after), metrics::Statistic::Median, kDraws,
                                  kSeed);
    }
    const Series a = metrics::bootstrap(before, metrics::Statistic::Median, kDraws, kSeed);
    const Series b = metrics::bootstrap(after, metrics::Statistic::Median, kDraws, kSeed + 1);
    return logRatios(a, b);
}

bool arePositive(const Series& values) {
    return std::ranges::all_of(values, [](double value) { return value > 0.0; });
}

Difference compareValues(const SeriesKey& key, const Series& before, const Series& after,
                         const Rules& rules) {
    Difference result{.key = key, .before = medianOf(before), .after = medianOf(after)};
    result.ratio = result.before == 0.0 ? 1.0 : result.after / result.before;
    result.interval = {result.ratio, result.ratio};
    result.floor = rules.qualityTolerance;
    const double scale = std::max(std::abs(result.before), std::abs(result.after));
    const bool isSame = std::abs(result.after - result.before) <= rules.qualityTolerance * scale;
    result.verdict = isSame ? Verdict::Same : Verdict::Changed;
    return result;
}

Difference missing(const SeriesKey& key, const Series& values, bool isBefore) {
    Difference result{.key = key, .verdict = Verdict::Missing};
    (isBefore ? result.before : result.after) = medianOf(values);
    result.reason = isBefore ? "measured before only" : "measured after only";
    return result;
}

}  // namespace

std::string_view verdictName(Verdict verdict) {
    switch (verdict) {
        case Verdict::Faster:
            return "faster";
        case Verdict::Slower:
            return "slower";
        case Verdict::Same:
            return "same";
        case Verdict::CannotTell:
            return "cannot tell";
        case Verdict::Changed:
            return "changed";
        case Verdict::Missing:
            return "missing";
    }
    return "cannot tell";
}

double detectableChange(const Series& values, const Rules& rules) {
    Series even, odd;
    for (std::size_t i = 0; i + 1 < values.size(); i += 2) {
        even.push_back(values[i]);
        odd.push_back(values[i + 1]);
    }
    if (even.size() < 2 || !arePositive(values)) return rules.effectFloor;
    const metrics::Interval interval = metrics::centralInterval(draws(even, odd, Pairing::ByTurns));
    // Half as many pairs as a comparison has: its interval is narrower by the square root of two.
    const double half = 0.5 * (interval.high - interval.low) / std::sqrt(2.0);
    return std::max(rules.effectFloor, std::expm1(half));
}

Difference compareTimes(const SeriesKey& key, const Series& before, const Series& after,
                        Pairing pairing, double confidence, const Rules& rules) {
    Difference result{.key = key, .before = medianOf(before), .after = medianOf(after)};
    if (!arePositive(before) || !arePositive(after)) {
        result.reason = "a time of zero or less";
        return result;
    }
    // A rate is the reciprocal of a time: the sides change places.
    const Series& denominator = key.isRate() ? after : before;
    const Series& numerator = key.isRate() ? before : after;
    result.ratio = pairing == Pairing::ByTurns
                       ? std::exp(medianOf(logRatios(denominator, numerator)))
                       : medianOf(numerator) / medianOf(denominator);
    result.floor = detectableChange(before, rules);
    const std::size_t count = std::min(before.size(), after.size());
    if (count < rules.fewestProcesses) {
        result.interval = {result.ratio, result.ratio};
        result.reason = fmt::format("{} {} a side; {} are needed", count,
                                    count == 1 ? "process" : "processes", rules.fewestProcesses);
        return result;
    }
    const metrics::Interval logs =
        metrics::centralInterval(draws(denominator, numerator, pairing), confidence);
    result.interval = {std::exp(logs.low), std::exp(logs.high)};
    const double same = std::max(result.floor, rules.sameWithin);
    if (result.interval.low > 1.0 && result.ratio > 1.0 + result.floor) {
        result.verdict = Verdict::Slower;
    } else if (result.interval.high < 1.0 && result.ratio < 1.0 / (1.0 + result.floor)) {
        result.verdict = Verdict::Faster;
    } else if (result.interval.low >= 1.0 / (1.0 + same) && result.interval.high <= 1.0 + same) {
        result.verdict = Verdict::Same;
    } else {
        result.reason = "the interval is too wide";
    }
    return result;
}

std::vector<Difference> compare(const SeriesMap& allBefore, const SeriesMap& allAfter,
                                Pairing pairing, const Rules& rules) {
    SeriesMap before = allBefore, after = allAfter;
    matchParams(before, after);
    const auto timeCount = std::ranges::count_if(
        before, [](const auto& entry) { return entry.first.isTime() || entry.first.isRate(); });
    const double confidence =
        1.0 - rules.familyError / static_cast<double>(std::max<std::ptrdiff_t>(timeCount, 1));
    std::vector<Difference> differences;
    for (const auto& [key, values] : before) {
        const auto found = after.find(key);
        if (found == after.end()) {
            differences.push_back(missing(key, values, true));
        } else if (key.isTime() || key.isRate()) {
            differences.push_back(
                compareTimes(key, values, found->second, pairing, confidence, rules));
        } else {
            differences.push_back(compareValues(key, values, found->second, rules));
        }
    }
    for (const auto& [key, values] : after) {
        if (!before.contains(key)) differences.push_back(missing(key, values, false));
    }
    std::ranges::sort(differences, {}, &Difference::key);
    return differences;
}

void confirm(std::vector<Difference>& differences, const std::vector<Difference>& again) {
    for (Difference& difference : differences) {
        if (!difference.isAlarm()) continue;
        const auto found = std::ranges::find(again, difference.key, &Difference::key);
        if (found != again.end() && found->verdict == difference.verdict) continue;
        difference.reason =
            fmt::format("{} once, not when measured again", verdictName(difference.verdict));
        difference.verdict = Verdict::CannotTell;
    }
}

}  // namespace gfxrepro::regression
