#include "engine/metrics/statistics.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <set>

#include "engine/core/error.h"
#include "engine/metrics/alike.h"

namespace gfxrepro::metrics {

double median(std::span<const double> values) {
    GFXREPRO_ASSERT(!values.empty());
    std::vector<double> sorted(values.begin(), values.end());
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    if (sorted.size() % 2 == 1) return *middle;
    return std::midpoint(*std::max_element(sorted.begin(), middle), *middle);
}

namespace {

double percentile(std::span<const double> values, double share) {
    std::vector<double> sorted(values.begin(), values.end());
    std::ranges::sort(sorted);
    const double place = share * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const double next = sorted[std::min(below + 1, sorted.size() - 1)];
    return std::lerp(sorted[below], next, place - static_cast<double>(below));
}

double sampleDeviation(std::span<const double> values) {
    const auto count = static_cast<double>(values.size());
    const double mean = std::reduce(values.begin(), values.end()) / count;
    double squares = 0.0;
    for (const double value : values) squares += (value - mean) * (value - mean);
    return std::sqrt(squares / (count - 1.0));
}

double harmonicMean(std::span<const double> values) {
    double sum = 0.0;
    for (const double value : values) sum += 1.0 / value;
    return static_cast<double>(values.size()) / sum;
}

/// The means of all pairs of values, each with itself too, in ascending order.
std::vector<double> walshAverages(std::span<const double> values) {
    std::vector<double> means;
    for (std::size_t i = 0; i < values.size(); ++i) {
        for (std::size_t j = i; j < values.size(); ++j) {
            means.push_back(std::midpoint(values[i], values[j]));
        }
    }
    std::ranges::sort(means);
    return means;
}

/// Changes of sign of so many rounds, the first of which changes none.
std::vector<std::vector<double>> signChanges(std::size_t rounds) {
    constexpr std::size_t kMostOfAll = 10, kDrawn = 1024;
    const bool areAll = rounds <= kMostOfAll;
    std::vector<std::vector<double>> changes(areAll ? std::size_t{1} << rounds : kDrawn,
                                             std::vector<double>(rounds, 1.0));
    std::mt19937_64 random(1);
    for (std::size_t i = 1; i < changes.size(); ++i) {
        for (std::size_t round = 0; round < rounds; ++round) {
            const bool isChanged = ((areAll ? i >> round : random()) & 1U) != 0;
            if (isChanged) changes[i][round] = -1.0;
        }
    }
    return changes;
}

/// The greatest number of outcomes to leave out at each end of a symmetric distribution over 0, 1,
/// … with these chances, so that 95 % or more is left.
std::size_t leftOut(const std::vector<double>& chances) {
    double below = 0.0;
    std::size_t count = 0;
    while (below + chances[count] <= 0.025) below += chances[count++];
    return count;
}

}  // namespace

Statistic statisticFromName(std::string_view name) {
    const auto found = std::ranges::find(kStatistics, name);
    if (found != kStatistics.end()) return static_cast<Statistic>(found - kStatistics.begin());
    throw Error(
        fmt::format("unknown statistic '{}'; allowed: {}", name, fmt::join(kStatistics, ", ")));
}

double summarize(std::span<const double> values, Statistic statistic) {
    if (statistic == Statistic::Count) return static_cast<double>(values.size());
    GFXREPRO_ASSERT(!values.empty());
    const double sum = std::accumulate(values.begin(), values.end(), 0.0);
    switch (statistic) {
        case Statistic::Median:
            return median(values);
        case Statistic::Mean:
            return sum / static_cast<double>(values.size());
        case Statistic::Min:
            return *std::min_element(values.begin(), values.end());
        case Statistic::Max:
            return *std::max_element(values.begin(), values.end());
        case Statistic::Sum:
            return sum;
        case Statistic::Rate:
            return harmonicMean(values);
        case Statistic::StdDev:
            return sampleDeviation(values);
        case Statistic::P95:
            return percentile(values, 0.95);
        case Statistic::P99:
            return percentile(values, 0.99);
        case Statistic::Count:
            break;
    }
    return static_cast<double>(values.size());
}

std::optional<Interval> medianInterval(std::span<const double> values) {
    if (values.size() < kFewestForInterval) return std::nullopt;
    std::vector<double> sorted(values.begin(), values.end());
    std::ranges::sort(sorted);
    const std::size_t count = medianIntervalDepth(sorted.size());
    return Interval{sorted[count - 1], sorted[sorted.size() - count]};
}

std::size_t medianIntervalDepth(std::size_t count) {
    // Of k outcomes left out, the interval ends at the k-th value from each end. Signs are scores
    // of one each.
    return leftOut(coinSums(std::vector<std::size_t>(count, 1)));
}

double centre(std::span<const double> values) {
    return median(walshAverages(values));
}

std::optional<Interval> centreInterval(std::span<const double> values) {
    if (values.size() < kFewestForInterval) return std::nullopt;
    const std::vector<double> means = walshAverages(values);
    std::vector<std::size_t> ranks(values.size());
    std::iota(ranks.begin(), ranks.end(), std::size_t{1});
    const std::size_t count = leftOut(coinSums(ranks));
    return Interval{means[count - 1], means[means.size() - count]};
}

std::vector<double> jointChances(std::span<const std::map<int, double>> series, bool isTwoSided) {
    if (series.empty()) return {};
    std::set<int> rounds;
    for (const auto& one : series) {
        for (const auto& [round, value] : one) rounds.insert(round);
    }
    std::vector<std::vector<double>> values;  // of each series in each round, ÷ their number
    std::vector<double> squares;
    for (const auto& one : series) {
        std::vector<double>& own = values.emplace_back();
        for (const int round : rounds) {
            const auto found = one.find(round);
            own.push_back(found == one.end() ? 0.0
                                             : found->second / static_cast<double>(one.size()));
        }
        const double sum = std::inner_product(own.begin(), own.end(), own.begin(), 0.0);
        squares.push_back(sum * static_cast<double>(one.size()));
    }
    const double usual = median(squares);
    const auto statistic = [&](std::size_t i, const std::vector<double>& signs) {
        const double scale = std::sqrt(squares[i] + usual);
        const double mean = std::inner_product(signs.begin(), signs.end(), values[i].begin(), 0.0);
        return scale == 0.0 ? 0.0 : (isTwoSided ? std::abs(mean) : mean) / scale;
    };
    const std::vector<std::vector<double>> changes = signChanges(rounds.size());
    std::vector<double> observed;
    for (std::size_t i = 0; i < values.size(); ++i) observed.push_back(statistic(i, changes[0]));
    std::vector<std::size_t> ascending(values.size());
    std::iota(ascending.begin(), ascending.end(), std::size_t{0});
    std::ranges::stable_sort(ascending, {}, [&](std::size_t i) { return observed[i]; });
    constexpr double kRounding = 1e-12;
    std::vector<double> chances(values.size(), 0.0);
    for (const std::vector<double>& signs : changes) {
        double largest = -std::numeric_limits<double>::infinity();
        for (const std::size_t i : ascending) {
            largest = std::max(largest, statistic(i, signs));
            chances[i] += largest >= observed[i] - kRounding ? 1.0 : 0.0;
        }
    }
    // What is nearer to 0 is no surer than what is farther.
    double surest = 0.0;
    for (auto i = ascending.rbegin(); i != ascending.rend(); ++i) {
        surest = std::max(surest, chances[*i] / static_cast<double>(changes.size()));
        chances[*i] = surest;
    }
    return chances;
}

std::vector<double> coinSums(std::span<const std::size_t> scores) {
    std::vector<double> chances(std::accumulate(scores.begin(), scores.end(), std::size_t{1}), 0.0);
    chances[0] = 1.0;
    std::size_t largest = 0;
    for (const std::size_t score : scores) {
        largest += score;
        for (std::size_t sum = largest + 1; sum-- > 0;) {
            chances[sum] = 0.5 * (chances[sum] + (sum >= score ? chances[sum - score] : 0.0));
        }
    }
    return chances;
}

double kendall(std::span<const double> givenX, std::span<const double> givenY) {
    GFXREPRO_ASSERT_EQ(givenX.size(), givenY.size());
    const std::vector<double> x = withoutRounding(givenX), y = withoutRounding(givenY);
    int score = 0;
    int pairs = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        for (std::size_t j = i + 1; j < x.size(); ++j) {
            if (x[i] == x[j]) continue;
            ++pairs;
            if (y[i] == y[j]) continue;
            score += (x[i] < x[j]) == (y[i] < y[j]) ? 1 : -1;
        }
    }
    return pairs == 0 ? 0.0 : static_cast<double>(score) / pairs;
}

}  // namespace gfxrepro::metrics
