#include "runner/cluster/shards.h"

#include <algorithm>
#include <numeric>

#include "engine/core/text.h"
#include "runner/run/twins.h"

namespace gfxrepro::cluster {

namespace {

constexpr int kMaxShards = 10000;

}  // namespace

run::Shard parseShard(std::string_view text) {
    const std::vector<std::string> parts = split(text, '/');
    const auto index = parts.size() == 2 ? parseInteger(parts[0]) : std::nullopt;
    const auto count = parts.size() == 2 ? parseInteger(parts[1]) : std::nullopt;
    if (!index || !count || *count < 1 || *count > kMaxShards || *index < 1 || *index > *count) {
        throw UsageError("--shard: expected k/n with 1 ≤ k ≤ n ≤ " + std::to_string(kMaxShards) +
                         ", found '" + std::string(text) + "'");
    }
    return {static_cast<int>(*index), static_cast<int>(*count)};
}

std::vector<std::vector<std::size_t>> indivisibleGroups(std::span<const config::Case> cases) {
    std::vector<std::vector<std::size_t>> groups;
    std::map<std::string, std::size_t> groupOf;  // of an experiment, or of work
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const bool isTiming = cases[i].measure.lane == config::Measure::Lane::Timing;
        const std::string key = isTiming ? cases[i].experiment : run::workKey(cases[i]);
        const auto [group, isNew] = groupOf.try_emplace(key, groups.size());
        if (isNew) groups.emplace_back();
        groups[group->second].push_back(i);
    }
    return groups;
}

std::vector<int> cutShards(std::span<const config::Case> cases, std::span<const double> timesS,
                           int count) {
    GFXREPRO_ASSERT_EQ(cases.size(), timesS.size());
    const std::vector<std::vector<std::size_t>> groups = indivisibleGroups(cases);
    std::vector<double> groupS;
    for (const std::vector<std::size_t>& group : groups) {
        groupS.push_back(std::accumulate(group.begin(), group.end(), 0.0,
                                         [&](double sum, auto i) { return sum + timesS[i]; }));
    }
    std::vector<std::size_t> order(groups.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, [&](auto a, auto b) { return groupS[a] > groupS[b]; });

    // Of shards with equal times the one with fewer cases: cases that take no time spread too.
    std::vector<std::pair<double, std::size_t>> load(static_cast<std::size_t>(count));
    std::vector<int> shardOf(cases.size());
    for (const std::size_t g : order) {
        const auto least = std::ranges::min_element(load);
        least->first += groupS[g];
        least->second += groups[g].size();
        for (const std::size_t i : groups[g]) shardOf[i] = static_cast<int>(least - load.begin());
    }
    return shardOf;
}

void takeShard(run::Plan& plan, const run::Shard& shard, std::span<const double> timesS) {
    const std::vector<int> shardOf = cutShards(plan.cases, timesS, shard.count);
    plan.shard = {shard.index, shard.count, {}};
    for (std::size_t i = 0; i < plan.cases.size(); ++i) {
        if (shardOf[i] == shard.index - 1) plan.shard->caseIds.insert(plan.cases[i].id);
    }
}

}  // namespace gfxrepro::cluster
