// Verdicts on generated scenes that were taken at several seeds.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/tables/fixture.h"

namespace gfxrepro::claims {
namespace {

constexpr const char* kBody = R"(
sweep: {scene: [grass, scan]}
layout:
  rows: scene
  columns: {share: {metric: share}}
  cell: "{median:.1f}"
claims:
  bound: {says: the meadow has many, bound: share, at_least: 5, at: {scene: grass}}
  order: {says: and more than the scan, order: [scene=scan, scene=grass]}
)";

/// The meadow's share at each seed; the scan, which has none, has 6.
tables::Recorded records(const std::vector<double>& shares) {
    tables::RecordMaker maker;
    for (std::size_t i = 0; i < shares.size(); ++i) {
        const std::string sample = "\"scene_sample\":" + std::to_string(i);
        if (i == 0) {
            maker.beginCase("grass", "{" + sample + "}");
        } else {
            maker.beginCase("grass@" + std::to_string(i + 1),
                            "{" + sample + ",\"stands_for\":\"grass\"}");
        }
        maker.lane("quality").add("share", {shares[i]}, "", "%");
    }
    maker.beginCase("scan").lane("quality").add("share", {6.0}, "", "%");
    return maker.records();
}

Verdict verdictOnShares(const std::string& claim, const std::vector<double>& shares) {
    const config::Experiment experiment = tables::experimentFrom(kBody);
    for (const ClaimResult& result :
         evaluateClaims(experiment, tables::buildTable(experiment, records(shares)),
                        {"llvmpipe", "software", "paper", "abc", ""})) {
        if (result.id == claim) return result.verdict;
    }
    return Verdict::Unmeasured;
}

TEST(SceneSeeds, AreOneCellWithTheRange) {
    const config::Experiment experiment = tables::experimentFrom(kBody);
    const tables::Table table = tables::buildTable(experiment, records({9, 8, 7, 10, 11}));
    ASSERT_EQ(table.rows.size(), 2U);
    const tables::Cell& grass = table.rows[0].cells[0];
    EXPECT_TRUE(grass.isOk()) << grass.message;
    EXPECT_EQ(grass.measured, "9.0");
    EXPECT_EQ(grass.low, "7.0");
    EXPECT_EQ(grass.high, "11.0");
    EXPECT_EQ(table.rows[1].cells[0].measured, "6.0");
}

/// Other scenes have other numbers: these are no random ones.
TEST(SceneSeeds, AreNoScatter) {
    const config::Experiment experiment = tables::experimentFrom(kBody);
    const tables::Table table = tables::buildTable(experiment, records({9, 8, 7, 10, 11}));
    EXPECT_FALSE(table.rows[0].cells[0].scatters);
}

TEST(SceneSeeds, FewDecideNothing) {
    EXPECT_EQ(verdictOnShares("bound", {9, 8}), Verdict::Ambiguous);
    EXPECT_EQ(verdictOnShares("bound", {9, 8, 7, 10}), Verdict::Ambiguous);
    EXPECT_EQ(verdictOnShares("bound", {9, 9}), Verdict::Holds) << "they do not differ";
}

/// However many processes each scene has, these are no more scenes.
TEST(SceneSeeds, AreAsManyRoundsAsScenes) {
    tables::RecordMaker maker;
    for (int seed = 0; seed < 3; ++seed) {
        const std::string sample = "\"scene_sample\":" + std::to_string(seed);
        const std::string other = seed == 0 ? "" : ",\"stands_for\":\"grass\"";
        maker.beginCase(seed == 0 ? "grass" : "grass@" + std::to_string(seed + 1),
                        "{" + sample + other + "}");
        maker.lane("quality");
        for (const int process : {0, 1}) {
            maker.process(process).add("share", {9.0 + seed + 0.2 * process}, "", "%");
        }
    }
    const tables::Table table = tables::buildTable(tables::experimentFrom(kBody), maker.records());
    const tables::Cell& grass = table.rows[0].cells[0];
    EXPECT_EQ(grass.values[0].rounds.size(), 3U);
    EXPECT_DOUBLE_EQ(grass.values[0].value, 10.1);
}

/// Two processes of a scan are two however many seeds the meadow has.
TEST(SceneSeeds, ProcessesOfOtherScenesAreNoSeeds) {
    tables::RecordMaker maker;
    for (int seed = 0; seed < 5; ++seed) {
        const std::string sample = "\"scene_sample\":" + std::to_string(seed);
        maker.beginCase(
            seed == 0 ? "grass" : "grass@" + std::to_string(seed + 1),
            seed == 0 ? "{" + sample + "}" : "{" + sample + ",\"stands_for\":\"grass\"}");
        maker.lane("quality").add("share", {9.0}, "", "%");
    }
    maker.beginCase("scan").lane("quality");
    for (const int process : {0, 1}) {
        maker.process(process).add("share", {process == 0 ? 6.0 : 7.0}, "", "%");
    }
    const config::Experiment experiment = tables::experimentFrom(kBody);
    const tables::Table table = tables::buildTable(experiment, maker.records());
    const tables::Cell& scan = table.rows[1].cells[0];
    EXPECT_EQ(scan.values[0].rounds.size(), 2U);
    EXPECT_EQ(scan.bounds(), tables::Bounds::Range);
    for (const ClaimResult& result :
         evaluateClaims(experiment, table, {"llvmpipe", "software", "paper", "abc", ""})) {
        if (result.id == "order") EXPECT_EQ(result.verdict, Verdict::Ambiguous);
    }
}

TEST(SceneSeeds, AVerdictTakesAllOfThem) {
    EXPECT_EQ(verdictOnShares("bound", {9, 8, 7, 10, 11}), Verdict::Holds);
    EXPECT_EQ(verdictOnShares("bound", {9, 8, 3, 10, 11}), Verdict::Ambiguous);
    EXPECT_EQ(verdictOnShares("bound", {1, 2, 3, 4, 4.5}), Verdict::Fails);
    EXPECT_EQ(verdictOnShares("order", {9, 8, 7, 10, 11}), Verdict::Holds);
    EXPECT_EQ(verdictOnShares("order", {9, 8, 5.5, 10, 11}), Verdict::Ambiguous);
    EXPECT_EQ(verdictOnShares("order", {1, 2, 3, 4, 5.5}), Verdict::Fails);
}

}  // namespace
}  // namespace gfxrepro::claims
