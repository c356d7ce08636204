#include "runner/tables/summary.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <optional>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "engine/core/error.h"
#include "engine/metrics/alike.h"

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

/// One repeat of one unit in each process.
bool hasOneValueEach(const Samples& samples) {
    return std::ranges::all_of(samples.processes, [](const auto& process) {
        return process.second.size() == 1 && process.second.begin()->second.size() == 1;
    });
}

metrics::Interval rangeOf(const std::vector<double>& values) {
    const auto [low, high] = std::ranges::minmax(values);
    return {low, high};
}

/// Value and bounds of what each process came to, at least one.
void fillFromRounds(std::vector<double> values, Summary& summary) {
    summary.value = metrics::summarize(values, Statistic::Median);
    if (std::ranges::all_of(
            values, [&](double value) { return metrics::areAlike(value, summary.value); })) {
        std::ranges::fill(values, summary.value);
        for (auto& [round, value] : summary.rounds) value = summary.value;
    }
    summary.interval = rangeOf(values);
    if (values.size() > 1) summary.bounds = Bounds::Range;
    if (const auto interval = metrics::medianInterval(values)) {
        summary.bounds = Bounds::Interval;
        summary.interval = *interval;
    }
}

/// Whether one value alone has none.
bool isSpread(Statistic statistic) {
    return statistic == Statistic::StdDev || statistic == Statistic::P95 ||
           statistic == Statistic::P99;
}

/// What the processes' values come to together where their median is not what is asked for.
std::optional<double> overProcesses(const Samples& samples, Statistic statistic) {
    const bool isOver = isSpread(statistic) || statistic == Statistic::Mean ||
                        statistic == Statistic::Min || statistic == Statistic::Max;
    if (!isOver || samples.processes.size() < 2 || !hasOneValueEach(samples)) return std::nullopt;
    const std::vector<double> values = metrics::withoutRounding(pooled(samples).begin()->second);
    const bool areAlike =
        std::ranges::all_of(values, [&](double value) { return value == values.front(); });
    if (areAlike && statistic != Statistic::StdDev) return std::nullopt;
    return metrics::summarize(values, statistic);
}

}  // namespace

std::string_view boundsName(Bounds bounds) {
    constexpr std::string_view kNames[] = {"", "range", "95 % interval"};
    return kNames[static_cast<std::size_t>(bounds)];
}

Summary summarize(const Samples& samples, Statistic statistic) {
    const Units all = pooled(samples);
    GFXREPRO_ASSERT(!all.empty());
    Summary summary;
    if (const auto value = overProcesses(samples, statistic)) {
        summary = summaryOf(*value, {}, false);
        summary.isOverProcesses = true;
        return summary;
    }
    std::vector<double> values;
    for (const auto& [process, units] : samples.processes) {
        if (units.size() < all.size()) continue;
        values.push_back(summarizeUnits(units, statistic));
        summary.rounds[process] = values.back();
    }
    summary.value = summarizeUnits(all, statistic);
    summary.interval = {summary.value, summary.value};
    const std::size_t processes = values.size();
    if (!values.empty()) fillFromRounds(std::move(values), summary);
    // A sum, a count or a spread of repeats is not what one of them gives.
    const bool isOfRepeats =
        all.size() == 1 &&
        (statistic == Statistic::Sum || statistic == Statistic::Count || isSpread(statistic));
    if (processes != 1 || isOfRepeats) return summary;
    const std::vector<double> repeats = byRepeat(all, statistic);
    if (repeats.size() < 2) return summary;
    summary.bounds = Bounds::Range;
    summary.interval = rangeOf(repeats);
    return summary;
}

Summary summaryOf(double value, std::map<int, double> rounds, bool areDraws) {
    Summary summary{value, Bounds::None, {value, value}, std::move(rounds), areDraws};
    std::vector<double> values;
    for (const auto& [round, one] : summary.rounds) values.push_back(one);
    if (areDraws) {
        summary.bounds = Bounds::Interval;
        summary.interval = drawsInterval(std::move(values));
    } else if (!values.empty()) {
        fillFromRounds(std::move(values), summary);
    }
    return summary;
}

double halfStepOf(std::span<const std::map<int, double>* const> series) {
    std::set<double> all;
    bool areRounded = false;
    for (const auto* rounds : series) {
        std::vector<double> values;
        for (const auto& [round, value] : *rounds) values.push_back(value);
        values = metrics::withoutRounding(values);
        std::set<double> own(values.begin(), values.end());
        areRounded |= own.size() > 1 && own.size() < rounds->size();
        all.merge(own);
    }
    if (!areRounded) return 0.0;
    double least = std::numeric_limits<double>::infinity();
    for (auto next = std::next(all.begin()); next != all.end(); ++next) {
        const double before = *std::prev(next);
        if (!metrics::areAlike(before, *next)) least = std::min(least, *next - before);
    }
    constexpr double kHair = 1e-6;
    return std::isfinite(least) ? (0.5 - kHair) * least : 0.0;
}

// What a share that was counted once could be in truth.

namespace {

/// The ends of an interval lie within 0.05 standard deviations of where ever more would put them.
constexpr int kDraws = 4000;
constexpr int kReaching = 20;  // more than one in forty of them, which an interval leaves out

/// FNV-1a: the same on every machine.
std::uint64_t seedOf(std::string_view name) {
    std::uint64_t hash = 14695981039346656037ULL;
    for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
    return hash;
}

}  // namespace

std::map<int, double> shareDraws(double percent, double count, std::string_view name) {
    const double successes = std::round(percent / 100.0 * count);
    std::mt19937_64 random(seedOf(name));
    std::gamma_distribution<double> in(successes + 0.5), out(count - successes + 0.5);
    std::map<int, double> draws;
    for (int i = 0; i < kDraws; ++i) {
        const double a = in(random), b = out(random);
        draws[i] = 100.0 * a / (a + b);
        // The interval of none or all reaches them (Brown, Cai and DasGupta 2001, Sec. 4.1.1).
        if (i % kReaching == 0 && (successes == 0.0 || successes == count)) draws[i] = percent;
    }
    return draws;
}

void boundByDraws(Summary& share, double scale, double count, std::string_view name) {
    share.rounds = shareDraws(share.value / scale, count, name);
    std::vector<double> draws;
    for (auto& [number, value] : share.rounds) draws.push_back(value *= scale);
    share.areDraws = true;
    share.bounds = Bounds::Interval;
    share.interval = drawsInterval(std::move(draws));
}

metrics::Interval drawsInterval(std::vector<double> draws) {
    std::ranges::sort(draws);
    const auto tail = static_cast<std::size_t>(0.025 * static_cast<double>(draws.size()));
    return {draws[tail], draws[draws.size() - 1 - tail]};
}

}  // namespace gfxrepro::tables
