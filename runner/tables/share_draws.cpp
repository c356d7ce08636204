#include "runner/tables/share_draws.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace gfxrepro::tables {

namespace {

/// The ends of an interval lie within 0.05 standard deviations of where ever more would put them.
constexpr int kDraws = 4000;

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
