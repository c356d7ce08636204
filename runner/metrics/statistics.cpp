#include "runner/metrics/statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "runner/core/error.h"

namespace gfxrepro::metrics {

namespace {

constexpr std::array<std::pair<std::string_view, Statistic>, 7> kStatistics = {{
    {"median", Statistic::Median},
    {"mean", Statistic::Mean},
    {"min", Statistic::Min},
    {"max", Statistic::Max},
    {"sum", Statistic::Sum},
    {"count", Statistic::Count},
    {"rate", Statistic::Rate},
}};

double median(std::span<const double> values) {
    std::vector<double> sorted(values.begin(), values.end());
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    if (sorted.size() % 2 == 1) return *middle;
    return std::midpoint(*std::max_element(sorted.begin(), middle), *middle);
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

/// The greatest number of outcomes to leave out at each end of a distribution over 0, 1, … with
/// these weights, so that 95 % or more is left.
std::size_t leftOut(const std::vector<double>& weights) {
    const double all = std::accumulate(weights.begin(), weights.end(), 0.0);
    double below = 0.0;
    std::size_t count = 0;
    while (below + weights[count] <= 0.025 * all) below += weights[count++];
    return count;
}

/// How often k of n signs are positive, k = 0 … n. Scaled, so that no n overflows.
std::vector<double> signWeights(std::size_t n) {
    std::vector<double> weights{1.0};
    for (std::size_t i = 0; i < n; ++i) {
        std::vector<double> next(weights.size() + 1, 0.0);
        for (std::size_t k = 0; k < weights.size(); ++k) {
            next[k] += 0.5 * weights[k];
            next[k + 1] += 0.5 * weights[k];
        }
        weights = std::move(next);
    }
    return weights;
}

/// How often the positive ones of the ranks 1 … n sum to w, w = 0 … n (n + 1) / 2. Scaled.
std::vector<double> rankSumWeights(std::size_t n) {
    std::vector<double> weights(n * (n + 1) / 2 + 1, 0.0);
    weights[0] = 1.0;
    for (std::size_t rank = 1; rank <= n; ++rank) {
        for (std::size_t sum = weights.size(); sum-- > 0;) {
            weights[sum] = 0.5 * (weights[sum] + (sum >= rank ? weights[sum - rank] : 0.0));
        }
    }
    return weights;
}

}  // namespace

Statistic statisticFromName(std::string_view name) {
    for (const auto& [known, statistic] : kStatistics) {
        if (known == name) return statistic;
    }
    throw Error("unknown statistic '" + std::string(name) +
                "'; allowed: median, mean, min, max, sum, count, rate");
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
        case Statistic::Count:
            break;
    }
    return static_cast<double>(values.size());
}

std::optional<Interval> medianInterval(std::span<const double> values) {
    if (values.size() < kFewestForInterval) return std::nullopt;
    std::vector<double> sorted(values.begin(), values.end());
    std::ranges::sort(sorted);
    // Out of k outcomes left out, the interval ends at the k-th value from each end.
    const std::size_t count = leftOut(signWeights(sorted.size()));
    return Interval{sorted[count - 1], sorted[sorted.size() - count]};
}

double centre(std::span<const double> values) {
    return median(walshAverages(values));
}

std::optional<Interval> centreInterval(std::span<const double> values) {
    if (values.size() < kFewestForInterval) return std::nullopt;
    const std::vector<double> means = walshAverages(values);
    const std::size_t count = leftOut(rankSumWeights(values.size()));
    return Interval{means[count - 1], means[means.size() - count]};
}

double kendall(std::span<const double> x, std::span<const double> y) {
    GFXREPRO_ASSERT_EQ(x.size(), y.size());
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
