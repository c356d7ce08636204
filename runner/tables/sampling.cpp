#include "runner/tables/sampling.h"

#include <algorithm>

#include "engine/core/error.h"

namespace gfxrepro::tables {

namespace {

using Units = std::map<int, std::vector<double>>;
using metrics::Statistic;

double summarizeUnits(const Units& units, Statistic statistic) {
    if (units.size() == 1) return metrics::summarize(units.begin()->second, statistic);
    std::vector<double> values;
    for (const auto& [unit, repeats] : units) {
        values.push_back(metrics::summarize(repeats, Statistic::Median));
    }
    return metrics::summarize(values, statistic);
}

Units pooled(const Samples& samples) {
    Units units;
    for (const auto& [process, own] : samples.processes) {
        for (const auto& [unit, repeats] : own) {
            std::vector<double>& all = units[unit];
            all.insert(all.end(), repeats.begin(), repeats.end());
        }
    }
    return units;
}

/// What the first repeat of every unit alone would give, then the second, …
std::vector<double> byRepeat(const Units& units, Statistic statistic) {
    std::size_t count = units.begin()->second.size();
    for (const auto& [unit, repeats] : units) count = std::min(count, repeats.size());
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i) {
        Units alone;
        for (const auto& [unit, repeats] : units) alone[unit] = {repeats[i]};
        values.push_back(summarizeUnits(alone, statistic));
    }
    return values;
}

metrics::Interval rangeOf(const std::vector<double>& values) {
    const auto [low, high] = std::ranges::minmax(values);
    return {low, high};
}

/// Value and bounds of what each process came to, at least one.
void fillFromRounds(const std::vector<double>& values, Summary& summary) {
    summary.value = metrics::summarize(values, Statistic::Median);
    summary.interval = rangeOf(values);
    if (values.size() > 1) summary.bounds = Bounds::Range;
    if (const auto interval = metrics::medianInterval(values)) {
        summary.bounds = Bounds::Interval;
        summary.interval = *interval;
    }
}

}  // namespace

std::string_view boundsName(Bounds bounds) {
    switch (bounds) {
        case Bounds::None:
            return "";
        case Bounds::Range:
            return "range";
        case Bounds::Interval:
            return "95 % interval";
    }
    return "";
}

Summary summarize(const Samples& samples, Statistic statistic) {
    const Units all = pooled(samples);
    GFXREPRO_ASSERT(!all.empty());
    Summary summary;
    std::vector<double> values;
    for (const auto& [process, units] : samples.processes) {
        if (units.size() < all.size()) continue;
        values.push_back(summarizeUnits(units, statistic));
        summary.rounds[process] = values.back();
    }
    summary.value = summarizeUnits(all, statistic);
    summary.interval = {summary.value, summary.value};
    if (!values.empty()) fillFromRounds(values, summary);
    // A sum or a count of repeats is not what one of them gives.
    const bool isOfRepeats =
        all.size() == 1 && (statistic == Statistic::Sum || statistic == Statistic::Count);
    if (values.size() != 1 || isOfRepeats) return summary;
    const std::vector<double> repeats = byRepeat(all, statistic);
    if (repeats.size() < 2) return summary;
    summary.bounds = Bounds::Range;
    summary.interval = rangeOf(repeats);
    return summary;
}

Summary together(const Summary& a, const Summary& b, double (*of)(double, double)) {
    Summary both;
    std::vector<double> values;
    for (const auto& [process, value] : a.rounds) {
        const auto other = b.rounds.find(process);
        if (other == b.rounds.end()) continue;
        values.push_back(of(value, other->second));
        both.rounds[process] = values.back();
    }
    both.value = of(a.value, b.value);
    both.interval = {both.value, both.value};
    if (!values.empty()) fillFromRounds(values, both);
    return both;
}

}  // namespace gfxrepro::tables
