#include "runner/report/sampling.h"

#include "runner/core/random.h"

namespace gfxrepro::report {

namespace {

/// The repeats of each unit, over all processes.
using Pooled = std::map<int, std::vector<double>>;

void addTo(Pooled& pooled, int unit, double value) {
    pooled[unit].push_back(value);
}

double summarizePooled(const Pooled& pooled, metrics::Statistic statistic) {
    if (pooled.size() == 1) return metrics::summarize(pooled.begin()->second, statistic);
    std::vector<double> units;
    for (const auto& [unit, repeats] : pooled) {
        if (repeats.empty()) continue;
        units.push_back(metrics::summarize(repeats, metrics::Statistic::Median));
    }
    return metrics::summarize(units, statistic);
}

}  // namespace

bool Samples::isRepeated() const {
    std::map<int, std::size_t> counts;
    for (const auto& process : processes) {
        for (const auto& [unit, repeats] : process) counts[unit] += repeats.size();
    }
    for (const auto& [unit, count] : counts) {
        if (count > 1) return true;
    }
    return false;
}

double summarize(const Samples& samples, metrics::Statistic statistic) {
    Pooled pooled;
    for (const auto& process : samples.processes) {
        for (const auto& [unit, repeats] : process) {
            for (const double value : repeats) addTo(pooled, unit, value);
        }
    }
    return summarizePooled(pooled, statistic);
}

std::vector<std::vector<double>> drawSummaries(const Samples& samples,
                                               const std::vector<metrics::Statistic>& statistics,
                                               std::uint64_t seed) {
    std::vector<std::vector<double>> draws(statistics.size());
    if (!samples.isRepeated()) return draws;
    Random random(seed);
    const auto index = [&](std::size_t count) {
        return random.index(static_cast<std::uint32_t>(count));
    };
    for (int draw = 0; draw < kDrawCount; ++draw) {
        Pooled pooled;
        for (std::size_t i = 0; i < samples.processes.size(); ++i) {
            const auto& process = samples.processes[index(samples.processes.size())];
            for (const auto& [unit, repeats] : process) {
                for (std::size_t j = 0; j < repeats.size(); ++j) {
                    addTo(pooled, unit, repeats[index(repeats.size())]);
                }
            }
        }
        for (std::size_t i = 0; i < statistics.size(); ++i) {
            draws[i].push_back(summarizePooled(pooled, statistics[i]));
        }
    }
    return draws;
}

}  // namespace gfxrepro::report
