// Cuts: complete, disjoint, repeatable, balanced, and never through a table of times.
#include "runner/cluster/shards.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "tests/support/support.h"
#include "tests/unit/run/plan_fixture.h"

namespace gfxrepro::test {
namespace {

using config::Case;
using Lane = config::Measure::Lane;
using ::testing::ElementsAre;

std::vector<Case> qualityCases(int count) {
    std::vector<Case> cases;
    for (int i = 0; i < count; ++i) cases.push_back(makeCase("q/1", "a", i));
    return cases;
}

std::vector<double> loads(const std::vector<int>& shardOf, const std::vector<double>& timesS,
                          int count) {
    std::vector<double> sums(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < shardOf.size(); ++i) {
        sums[static_cast<std::size_t>(shardOf[i])] += timesS[i];
    }
    return sums;
}

TEST(Shards, ReadsKOfN) {
    const run::Shard shard = cluster::parseShard("2/4");
    EXPECT_EQ(shard.index, 2);
    EXPECT_EQ(shard.count, 4);
    EXPECT_EQ(shard.name(), "2/4");
    for (const char* text : {"", "2", "0/4", "5/4", "-1/4", "1/0", "1/4/2", "a/b", "1/10001"}) {
        EXPECT_EQ(
            errorText([&] { cluster::parseShard(text); }),
            "--shard: expected k/n with 1 ≤ k ≤ n ≤ 10000, found '" + std::string(text) + "'");
    }
}

TEST(Shards, LongestFirstToTheLeastLoaded) {
    // By hand: 7 → 0, 5 → 1, 4 → 2, 3 → 2 (4 is least), 3 → 1 (5), 2 → 0 or 2 (both 7): the first.
    EXPECT_THAT(cluster::cutShards(qualityCases(6), std::vector<double>{3, 7, 2, 5, 3, 4}, 3),
                ElementsAre(2, 0, 0, 1, 1, 2));
}

TEST(Shards, MoreShardsThanCasesLeaveSomeEmpty) {
    EXPECT_THAT(cluster::cutShards(qualityCases(2), std::vector<double>{1, 1}, 5),
                ElementsAre(0, 1));
    EXPECT_TRUE(cluster::cutShards({}, {}, 3).empty());
}

TEST(Shards, CasesWithoutATimeSpread) {
    const std::vector<int> shardOf =
        cluster::cutShards(qualityCases(9), std::vector<double>(9, 0.0), 3);
    for (int shard = 0; shard < 3; ++shard) EXPECT_EQ(std::ranges::count(shardOf, shard), 3);
}

/// The best that any cut can do, by trying all.
double bestLongest(const std::vector<double>& timesS, int count) {
    std::vector<int> shardOf(timesS.size(), 0);
    double best = std::accumulate(timesS.begin(), timesS.end(), 0.0);
    while (true) {
        best = std::min(best, std::ranges::max(loads(shardOf, timesS, count)));
        std::size_t i = 0;
        while (i < shardOf.size() && ++shardOf[i] == count) shardOf[i++] = 0;
        if (i == shardOf.size()) return best;
    }
}

TEST(Shards, RandomCutsAreBalancedAndRepeatable) {
    std::mt19937 random(7);
    for (int round = 0; round < 100; ++round) {
        const int count = 1 + static_cast<int>(random() % 4);
        const std::vector<Case> cases = qualityCases(1 + static_cast<int>(random() % 7));
        std::vector<double> timesS;
        for (std::size_t i = 0; i < cases.size(); ++i) timesS.push_back(1.0 + random() % 1000);
        const std::vector<int> shardOf = cluster::cutShards(cases, timesS, count);
        EXPECT_EQ(shardOf, cluster::cutShards(cases, timesS, count));
        EXPECT_TRUE(std::ranges::all_of(shardOf, [&](int s) { return s >= 0 && s < count; }));
        // Graham 1969: at most 4/3 − 1/3m of the optimum.
        EXPECT_LE(std::ranges::max(loads(shardOf, timesS, count)),
                  (4.0 / 3.0 - 1.0 / (3.0 * count)) * bestLongest(timesS, count) + 1e-9);
    }
}

TEST(Shards, TimesOfATableStayTogether) {
    std::vector<Case> cases;
    for (const char* experiment : {"t/1", "t/2"}) {
        for (const char* method : {"a", "b"}) {
            for (int size = 1; size <= 3; ++size) {
                cases.push_back(makeCase(experiment, method, size, Lane::Timing));
            }
        }
    }
    for (Case& item : qualityCases(4)) cases.push_back(item);
    EXPECT_EQ(cluster::indivisibleGroups(cases).size(), 2U + 4U);
    for (int count = 1; count <= 8; ++count) {
        const std::vector<int> shardOf =
            cluster::cutShards(cases, std::vector<double>(cases.size(), 1.0), count);
        for (const std::size_t first : {0U, 6U}) {
            for (std::size_t i = first; i < first + 6; ++i) EXPECT_EQ(shardOf[i], shardOf[first]);
        }
        if (count > 1) EXPECT_NE(shardOf[0], shardOf[6]);
    }
}

TEST(Shards, AllShardsTogetherHaveEachUnitOnce) {
    run::Plan plan;
    plan.cases = qualityCases(10);
    plan.cases[3].measure.processes = 2;
    const std::vector<double> timesS = {5, 1, 1, 8, 1, 1, 1, 2, 2, 3};
    std::multiset<std::string> units;
    for (int k = 1; k <= 3; ++k) {
        run::Plan part = plan;
        cluster::takeShard(part, {k, 3, {}}, timesS);
        for (const run::Unit& unit : run::unitsOf(part)) {
            units.insert(unit.item->id + '#' + std::to_string(unit.process));
        }
    }
    std::multiset<std::string> whole;
    for (const run::Unit& unit : run::unitsOf(plan)) {
        whole.insert(unit.item->id + '#' + std::to_string(unit.process));
    }
    EXPECT_EQ(whole.size(), 11U);
    EXPECT_EQ(units, whole);
}

}  // namespace
}  // namespace gfxrepro::test
