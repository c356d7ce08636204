#include "runner/metrics/statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "runner/core/error.h"
#include "runner/core/random.h"

namespace gfxrepro::metrics {

namespace {

constexpr std::array<std::pair<std::string_view, Statistic>, 6> kStatistics = {{
    {"median", Statistic::Median},
    {"mean", Statistic::Mean},
    {"min", Statistic::Min},
    {"max", Statistic::Max},
    {"sum", Statistic::Sum},
    {"count", Statistic::Count},
}};

double median(std::span<const double> values) {
    std::vector<double> sorted(values.begin(), values.end());
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    if (sorted.size() % 2 == 1) return *middle;
    return std::midpoint(*std::max_element(sorted.begin(), middle), *middle);
}

}  // namespace

Statistic statisticFromName(std::string_view name) {
    for (const auto& [known, statistic] : kStatistics) {
        if (known == name) return statistic;
    }
    throw Error("unknown statistic '" + std::string(name) +
                "'; allowed: median, mean, min, max, sum, count");
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
        case Statistic::Count:
            break;
    }
    return static_cast<double>(values.size());
}

std::vector<double> bootstrap(std::span<const double> values, Statistic statistic, int draws,
                              std::uint64_t seed) {
    GFXREPRO_ASSERT(!values.empty());
    Random random(seed);
    std::vector<double> resample(values.size());
    std::vector<double> results(static_cast<std::size_t>(draws));
    for (double& result : results) {
        for (double& value : resample) {
            value = values[random.index(static_cast<std::uint32_t>(values.size()))];
        }
        result = summarize(resample, statistic);
    }
    return results;
}

Interval centralInterval(std::vector<double> values, double confidence) {
    GFXREPRO_ASSERT(!values.empty());
    std::sort(values.begin(), values.end());
    const auto quantile = [&](double share) {
        const double position = share * static_cast<double>(values.size() - 1);
        const auto below = static_cast<std::size_t>(position);
        const std::size_t above = std::min(below + 1, values.size() - 1);
        const double rest = position - static_cast<double>(below);
        // std::lerp makes not-a-number of an infinite end.
        if (rest == 0.0 || values[below] == values[above]) return values[below];
        return std::lerp(values[below], values[above], rest);
    };
    return {quantile((1.0 - confidence) / 2.0), quantile((1.0 + confidence) / 2.0)};
}

}  // namespace gfxrepro::metrics
