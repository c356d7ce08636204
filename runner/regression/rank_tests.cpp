#include "runner/regression/rank_tests.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "engine/core/error.h"

namespace gfxrepro::regression {

namespace {

constexpr double kTail = 0.025;  // of a 95 % interval
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr metrics::Interval kUnbounded{-kInfinity, kInfinity};

/// Ranks times two: whole numbers where values are equal, too.
std::vector<std::size_t> doubledRanks(std::span<const double> values) {
    std::vector<std::size_t> doubled;
    for (const double rank : ranksOf(values)) {
        doubled.push_back(static_cast<std::size_t>(std::lround(2.0 * rank)));
    }
    return doubled;
}

std::vector<std::size_t> doubledPlaces(std::size_t count) {
    std::vector<std::size_t> places(count);
    for (std::size_t i = 0; i < count; ++i) places[i] = 2 * (i + 1);
    return places;
}

/// The chance of each sum of `count` of the scores, each choice as likely as another.
Series choiceSums(const std::vector<std::size_t>& scores, std::size_t count) {
    const std::size_t size = std::accumulate(scores.begin(), scores.end(), std::size_t{0}) + 1;
    // Of the first i scores, a share of j / i in the choices of j is with the i-th: no large
    // binomial coefficient is ever formed.
    std::vector<Series> chances(count + 1, Series(size, 0.0));
    chances[0][0] = 1.0;
    for (std::size_t i = 1; i <= scores.size(); ++i) {
        const std::size_t score = scores[i - 1];
        for (std::size_t j = std::min(i, count); j >= 1; --j) {
            const double with = static_cast<double>(j) / static_cast<double>(i);
            for (std::size_t sum = size; sum-- > 0;) {
                const double before = sum >= score ? chances[j - 1][sum - score] : 0.0;
                chances[j][sum] = (1.0 - with) * chances[j][sum] + with * before;
            }
        }
    }
    return chances[count];
}

/// The chance of a sum as far from the mean as `sum` or farther.
double twoSided(const Series& chances, double mean, double sum) {
    const double distance = std::abs(sum - mean) - 0.25;
    double chance = 0.0;
    for (std::size_t i = 0; i < chances.size(); ++i) {
        if (std::abs(static_cast<double>(i) - mean) >= distance) chance += chances[i];
    }
    return std::min(chance, 1.0);
}

/// How many steps of two from `begin` on lie below a tail of kTail.
std::size_t stepsInTail(const Series& chances, std::size_t begin) {
    double tail = 0.0;
    std::size_t steps = 0;
    for (std::size_t sum = begin; sum < chances.size(); sum += 2, ++steps) {
        tail += chances[sum];
        if (tail > kTail) break;
    }
    return steps;
}

}  // namespace

Series ranksOf(std::span<const double> values) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t i) { return values[i]; });
    Series ranks(values.size());
    for (std::size_t begin = 0; begin < order.size();) {
        std::size_t end = begin + 1;
        while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
        for (std::size_t i = begin; i < end; ++i) {
            ranks[order[i]] = 0.5 * static_cast<double>(begin + 1 + end);
        }
        begin = end;
    }
    return ranks;
}

RankTest signedRank(std::span<const double> differences) {
    const std::size_t count = differences.size();
    GFXREPRO_ASSERT(count > 0);
    RankTest test;
    test.attainable = std::min(1.0, std::exp2(1.0 - static_cast<double>(count)));
    test.shift = metrics::centre(differences);
    test.interval = metrics::centreInterval(differences).value_or(kUnbounded);
    Series sizes;
    for (const double difference : differences) {
        if (difference != 0.0) sizes.push_back(std::abs(difference));
    }
    const std::vector<std::size_t> ranks = doubledRanks(sizes);
    double sum = 0.0, all = 0.0;
    for (std::size_t i = 0, ranked = 0; i < count; ++i) {
        if (differences[i] == 0.0) continue;
        const auto rank = static_cast<double>(ranks[ranked++]);
        all += rank;
        if (differences[i] > 0.0) sum += rank;
    }
    test.chance = twoSided(metrics::coinSums(ranks), 0.5 * all, sum);
    return test;
}

double rankSumChance(std::span<const double> first, std::span<const double> rest) {
    Series all(first.begin(), first.end());
    all.insert(all.end(), rest.begin(), rest.end());
    const std::vector<std::size_t> ranks = doubledRanks(all);
    // The side with fewer values: far fewer sums.
    const bool isFirstSmaller = first.size() <= rest.size();
    const std::size_t count = std::min(first.size(), rest.size());
    const auto begin =
        isFirstSmaller ? ranks.begin() : ranks.begin() + static_cast<std::ptrdiff_t>(first.size());
    const auto sum =
        std::accumulate(begin, begin + static_cast<std::ptrdiff_t>(count), std::size_t{0});
    const double mean = static_cast<double>(count * (all.size() + 1));
    return twoSided(choiceSums(ranks, count), mean, static_cast<double>(sum));
}

RankTest rankSum(std::span<const double> before, std::span<const double> after) {
    GFXREPRO_ASSERT(!before.empty() && !after.empty());
    RankTest test;
    test.chance = rankSumChance(before, after);
    const std::size_t count = std::min(before.size(), after.size());
    const Series untied = choiceSums(doubledPlaces(before.size() + after.size()), count);
    const std::size_t least = count * (count + 1);  // the doubled sum of the lowest places
    test.attainable = std::min(1.0, 2.0 * untied[least]);
    Series steps;
    for (const double a : after) {
        for (const double b : before) steps.push_back(a - b);
    }
    std::ranges::sort(steps);
    test.shift = metrics::summarize(steps, metrics::Statistic::Median);
    const std::size_t inTail = stepsInTail(untied, least);
    test.interval = inTail > 0 ? metrics::Interval{steps[inTail - 1], steps[steps.size() - inTail]}
                               : kUnbounded;
    return test;
}

}  // namespace gfxrepro::regression
