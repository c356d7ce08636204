// Shares that were counted once: their intervals, and claims about them.
#include "runner/tables/cell.h"

#include <random>

#include "runner/claims/judge.h"
#include "tests/support/support.h"
#include "tests/unit/tables/fixture.h"

namespace gfxrepro::tables {
namespace {

metrics::Interval intervalOf(double percent, double count, const std::string& name = "case") {
    std::vector<double> draws;
    for (const auto& [number, value] : shareDraws(percent, count, name)) draws.push_back(value);
    return drawsInterval(std::move(draws));
}

TEST(ShareDraws, IntervalsAreJeffreys) {
    // Beta quantiles of 2.5 and 97.5 %, from their distribution functions integrated numerically.
    const metrics::Interval few = intervalOf(100.0 * 11.0 / 2272.0, 2272.0);
    EXPECT_NEAR(few.low, 0.2575, 0.02);
    EXPECT_NEAR(few.high, 0.8364, 0.04);
    const metrics::Interval none = intervalOf(0.0, 50.0);
    EXPECT_EQ(none.low, 0.0) << "what was never seen may not be there";
    EXPECT_NEAR(none.high, 5.015, 0.7);
    const metrics::Interval all = intervalOf(100.0, 50.0);
    EXPECT_EQ(all.high, 100.0);
    EXPECT_NEAR(all.low, 94.985, 0.7);
    const metrics::Interval many = intervalOf(70.0, 200'000.0);
    EXPECT_NEAR(many.high - many.low, 0.402, 0.05);
}

TEST(ShareDraws, IntervalsHoldTheTruthInNinetyThreePercentOrMore) {
    constexpr int kTrials = test::kIsSanitized ? 100 : 1000;
    for (const double truth : {0.005, 0.1, 0.5}) {
        std::mt19937_64 random(7);
        std::binomial_distribution<int> counted(1500, truth);
        int held = 0;
        for (int i = 0; i < kTrials; ++i) {
            const metrics::Interval interval =
                intervalOf(100.0 * counted(random) / 1500.0, 1500.0, std::to_string(i));
            held += interval.low <= 100.0 * truth && 100.0 * truth <= interval.high ? 1 : 0;
        }
        EXPECT_GE(held, (test::kIsSanitized ? 0.85 : 0.93) * kTrials) << truth;
    }
}

TEST(ShareDraws, TheSameNameGivesTheSameDrawsAnotherOnesOwn) {
    EXPECT_EQ(shareDraws(30.0, 900.0, "a"), shareDraws(30.0, 900.0, "a"));
    EXPECT_NE(shareDraws(30.0, 900.0, "a"), shareDraws(30.0, 900.0, "b"));
}

const char* const kDrawnShares = R"(
sweep:
  scene: [models/duck, models/bunny]
layout:
  rows: scene
  columns:
    useful: {metric: useful_pct, pass: a}
    peeled: {metric: useful_pct, pass: b}
  cell: {format: "{median:.3f}"}
claims:
  few: {says: more, origin: ours, order: useful < peeled, at: {scene: models/duck}}
  many: {says: more, origin: ours, order: useful < peeled, at: {scene: models/bunny}}
)";

RecordMaker sharesCounted(double duckCount, double bunnyCount) {
    RecordMaker maker;
    for (const auto& [scene, count] :
         {std::pair{"models/duck", duckCount}, std::pair{"models/bunny", bunnyCount}}) {
        maker.beginCase(scene)
            .add("useful_pct", {0.5}, "a", "%")
            .add("useful_pct_of", {count}, "a", "sample")
            .add("useful_pct", {0.7}, "b", "%")
            .add("useful_pct_of", {count}, "b", "sample");
    }
    return maker;
}

TEST(ShareDraws, CellsOfSharesThatSayTheirCountHaveAnInterval) {
    const Table table =
        buildTable(experimentFrom(kDrawnShares), sharesCounted(2000, 200'000).records());
    const Cell& cell = table.rows[0].cells[0];
    EXPECT_EQ(cell.bounds(), Bounds::Interval);
    EXPECT_EQ(cell.measured, "0.500");
    EXPECT_NEAR(cell.values[0].interval.low, 0.26, 0.03);
    EXPECT_NEAR(cell.values[0].interval.high, 0.88, 0.05);
}

TEST(ShareDraws, ClaimsAreJudgedByTheIntervalOfWhatTheyCompare) {
    const config::Experiment experiment = experimentFrom(kDrawnShares);
    const Table table = buildTable(experiment, sharesCounted(2000, 200'000).records());
    const auto results =
        claims::evaluateClaims(experiment, table, {"llvmpipe", "software", "quick", "abc", ""});
    ASSERT_EQ(results.size(), 2U);
    EXPECT_EQ(results[0].verdict, claims::Verdict::Ambiguous) << results[0].measured;
    EXPECT_EQ(results[1].verdict, claims::Verdict::Holds) << results[1].measured;
}

/// Another count comes to another share by more than chance in counting.
TEST(ShareDraws, AShareThatDiffersWhenItIsCountedAgainIsOneSample) {
    RecordMaker maker = sharesCounted(200'000, 200'000);
    maker.beginCase("models/tree").add("useful_pct", {0.5}, "a", "%");
    maker.process(1).add("useful_pct", {0.6}, "a", "%");
    const config::Experiment experiment = experimentFrom(kDrawnShares);
    const Table table = buildTable(experiment, maker.records());
    EXPECT_EQ(table.rows[0].cells[0].bounds(), Bounds::None);
    const auto results =
        claims::evaluateClaims(experiment, table, {"llvmpipe", "software", "quick", "abc", ""});
    EXPECT_EQ(results[1].verdict, claims::Verdict::Ambiguous) << results[1].measured;
}

TEST(ShareDraws, ExactClaimsAreOfTheCountItself) {
    std::string body = kDrawnShares;
    body +=
        "  half: {says: half a percent, origin: ours, bound_from: ours, exact: useful, equals: "
        "0.5}\n";
    const config::Experiment experiment = experimentFrom(body);
    const Table table = buildTable(experiment, sharesCounted(2000, 200'000).records());
    const auto results =
        claims::evaluateClaims(experiment, table, {"llvmpipe", "software", "quick", "abc", ""});
    EXPECT_EQ(results.at(2).verdict, claims::Verdict::Holds) << results.at(2).measured;
}

TEST(ShareDraws, WhereThereAreRoundsTheDrawsOfOthersAreDropped) {
    claims::Sampled share{5.0, {{0, 4.0}, {1, 6.0}}, true};
    claims::Sampled time{2.0, {{3, 1.0}, {4, 3.0}}, false};
    claims::Sampled* both[] = {&share, &time};
    EXPECT_FALSE(keepRoundsOrDraws(both));
    EXPECT_TRUE(share.rounds.empty());
    claims::Sampled other{5.0, {{0, 4.0}, {1, 6.0}}, true};
    claims::Sampled* alone[] = {&other};
    EXPECT_TRUE(keepRoundsOrDraws(alone));
    EXPECT_EQ(other.rounds.size(), 2U);
}

}  // namespace
}  // namespace gfxrepro::tables
