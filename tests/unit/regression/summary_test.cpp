#include "runner/regression/comparison.h"

#include <gtest/gtest.h>
#include <cmath>
#include <nlohmann/json.hpp>

#include "runner/regression/series.h"
#include "tests/unit/regression/nights.h"

namespace gfxrepro::regression {
namespace {

std::vector<Difference> differences() {
    const Difference slower{test::timeOf("<a>"),   10, 12, 1.2, {1.1, 1.3}, 0.02,
                            SeriesVerdict::Slower, ""};
    const Difference same{test::timeOf("b"),   10, 10, 1.0, {1.0, 1.0}, 0.02,
                          SeriesVerdict::Same, ""};
    const Difference unknown{
        test::timeOf("c"),         10, 10, 1.0, {0.5, 2.0}, 0.02, SeriesVerdict::CannotTell,
        "the interval is too wide"};
    return {slower, same, unknown};
}

TEST(Summary, SaysHowManyAndWhich) {
    EXPECT_EQ(summaryLine(differences()), "1 slower, 1 same, 1 cannot tell");
    EXPECT_EQ(summaryLine({}), "nothing to compare");
    EXPECT_EQ(markdown({differences(), {}, {"it was <changed>"}}),
              "# Comparison\n\n1 slower, 1 same, 1 cannot tell\n\n"
              "Note: it was \\<changed\\>\n\n"
              "| what | before | after | time after / before | floor | verdict |\n"
              "| --- | ---: | ---: | ---: | ---: | --- |\n"
              "| p/1 mock \\<a\\> wall\\_time\\_ms | 10 | 12 ms | 1.200 [1.100, 1.300] | 0.02 | "
              "slower |\n"
              "| p/1 mock c wall\\_time\\_ms | 10 | 10 ms | 1.000 [0.500, 2.000] | 0.02 | cannot "
              "tell: the interval is too wide |\n");
}

TEST(Summary, WhatIsNotThereHasNoNumber) {
    Difference lost{.key = test::timeOf("a"), .before = 10.0, .verdict = SeriesVerdict::Lost};
    Difference missing{.key = test::timeOf("b"), .after = 10.0, .verdict = SeriesVerdict::Missing};
    const std::string text = markdown({{lost, missing}});
    EXPECT_NE(text.find("wall\\_time\\_ms | 10 |  |  | 0 | lost |\n"), std::string::npos) << text;
    EXPECT_NE(text.find("wall\\_time\\_ms |  | 10 ms |  | 0 | missing |\n"), std::string::npos)
        << text;
}

TEST(Summary, JUnitFailsOnAlarmsOnly) {
    const std::string xml = junitXml({differences()});
    EXPECT_NE(xml.find("tests=\"3\" failures=\"1\" errors=\"0\" skipped=\"1\""), std::string::npos)
        << xml;
    EXPECT_NE(xml.find("<failure message=\"slower 1.200 [1.100, 1.300]\" type=\"slower\">slower "
                       "1.200 [1.100, 1.300]</failure>"),
              std::string::npos)
        << xml;
    EXPECT_NE(xml.find("name=\"p/1 mock &lt;a&gt; wall_time_ms\""), std::string::npos) << xml;
}

TEST(Summary, WhatNeitherSideHasIsCountedAndSkipped) {
    const Comparison both{
        {{.key = test::timeOf("a"), .verdict = SeriesVerdict::Void, .reason = "blank"},
         {.key = test::timeOf("b"), .verdict = SeriesVerdict::Failed, .reason = "crash: SIGSEGV"}}};
    EXPECT_FALSE(both.isAlarm());
    EXPECT_EQ(summaryLine(both.differences), "1 void on both sides, 1 failed on both sides");
    EXPECT_NE(
        markdown(both).find(
            "| p/1 mock b wall\\_time\\_ms | | | | | failed on both sides: crash: SIGSEGV |\n"),
        std::string::npos)
        << markdown(both);
    const std::string xml = junitXml(both);
    EXPECT_NE(xml.find("tests=\"2\" failures=\"0\" errors=\"0\" skipped=\"2\""), std::string::npos)
        << xml;
    EXPECT_NE(xml.find("<skipped message=\"void on both sides: blank \"/>"), std::string::npos)
        << xml;
}

TEST(Summary, AStepToSlowerIsAnAlarm) {
    const SeriesStep slower{test::timeOf("a"), 30, {18, 1.1, 2e-7}};
    SeriesStep faster = slower;
    faster.step.ratio = 0.9;
    EXPECT_EQ(stepLine(slower),
              "step in p/1 mock a wall_time_ms: × 1.100 since night 19 of 30 (chance 2e-07)");
    EXPECT_TRUE((Comparison{{}, {slower}}).isAlarm());
    EXPECT_FALSE((Comparison{{}, {faster}}).isAlarm());
    EXPECT_TRUE((Comparison{differences()}).isAlarm());
    const Comparison both{{}, {slower, faster}};
    EXPECT_NE(markdown(both).find("since night 19 of 30"), std::string::npos) << markdown(both);
    EXPECT_NE(junitXml(both).find("tests=\"2\" failures=\"1\" errors=\"0\" skipped=\"0\""),
              std::string::npos)
        << junitXml(both);
}

/// A name is that of a history: it has what tells series apart, and no more.
TEST(Summary, ParametersAreNoPartOfABenchmarksName) {
    std::vector<Difference> two(2, differences()[0]);
    two[0].key.params = R"({"bias":0.1,"samples":4})";
    two[1].key.params = R"({"bias":0.1,"samples":8})";
    const auto json = nlohmann::json::parse(smallerIsBetterJson(two));
    ASSERT_EQ(json.size(), 2U);
    EXPECT_EQ(json[0]["name"], "p/1 mock <a> wall_time_ms, samples=4");
    EXPECT_EQ(json[1]["name"], "p/1 mock <a> wall_time_ms, samples=8");
    EXPECT_EQ(json[0]["extra"], two[0].key.params);
}

TEST(Summary, WithoutTimesThereIsNoBenchmark) {
    Difference picture = differences()[0];
    picture.key.metric = kPictureMetric;
    picture.picture = PictureError{0.5, 0.5};
    EXPECT_EQ(smallerIsBetterJson({picture}), "");
}

TEST(Summary, JsonHoldsTimes) {
    const auto json = nlohmann::json::parse(smallerIsBetterJson(differences()));
    ASSERT_EQ(json.size(), 3U);
    EXPECT_EQ(json[0]["name"], "p/1 mock <a> wall_time_ms");
    EXPECT_EQ(json[0]["extra"], "{}");
    EXPECT_EQ(json[0]["value"], 12.0);
    EXPECT_EQ(json[0]["unit"], "ms");
}

TEST(RankTests, SignedRanksAreExact) {
    // All of six on one side: 2 of the 64 ways of signs.
    const RankTest all = signedRank(Series{1, 2, 3, 4, 5, 6});
    EXPECT_NEAR(all.chance, 2.0 / 64.0, 1e-15);
    EXPECT_NEAR(all.attainable, 2.0 / 64.0, 1e-15);
    EXPECT_EQ(all.shift, 3.5);
    EXPECT_EQ(all.interval.low, 1.0);
    EXPECT_EQ(all.interval.high, 6.0);
    // One against: its rank is the only one on its side; sums of 0 and 1 are as far.
    EXPECT_NEAR(signedRank(Series{-1, 2, 3, 4, 5, 6}).chance, 4.0 / 64.0, 1e-15);
    // R: wilcox.test(c(1.83,.5,1.62,2.48,1.68,1.88,1.55,3.06,1.3) - c(.878,.647,.598,2.05,1.06,
    // 1.29,1.06,3.14,1.29)), p = 0.03906 [Hollander and Wolfe 1973, depression scores].
    EXPECT_NEAR(
        signedRank(Series{0.952, -0.147, 1.022, 0.43, 0.62, 0.59, 0.49, -0.08, 0.01}).chance,
        0.0390625, 1e-12);
}

TEST(RankTests, FewValuesGiveNoInterval) {
    const RankTest five = signedRank(Series{1, 2, 3, 4, 5});
    EXPECT_TRUE(std::isinf(five.interval.low) && std::isinf(five.interval.high));
    EXPECT_TRUE(std::isinf(rankSum(Series{1, 2, 3}, Series{4, 5, 6}).interval.high));
    EXPECT_FALSE(std::isinf(rankSum(Series{1, 2, 3, 4}, Series{4, 5, 6, 7}).interval.high));
}

TEST(RankTests, EqualValuesAreNoEvidence) {
    EXPECT_EQ(signedRank(Series{0, 0, 0, 0, 0, 0}).chance, 1.0);
    EXPECT_EQ(rankSum(Series{1, 1, 1, 1}, Series{1, 1, 1, 1}).chance, 1.0);
    EXPECT_EQ(ranksOf(Series{5, 1, 5}), (Series{2.5, 1, 2.5}));
}

TEST(RankTests, RankSumsAreExact) {
    EXPECT_NEAR(rankSum(Series{1, 2, 3, 4, 5}, Series{6, 7, 8, 9, 10}).chance, 2.0 / 252.0, 1e-14);
    // One exchanged: sums of 15 and 16 on either end.
    EXPECT_NEAR(rankSum(Series{1, 2, 3, 4, 6}, Series{5, 7, 8, 9, 10}).chance, 4.0 / 252.0, 1e-14);
    // Sides of unlike sizes, either way: 2 of the 10 ways to choose 2 of 5.
    EXPECT_NEAR(rankSum(Series{1, 2}, Series{3, 4, 5}).chance, 0.2, 1e-14);
    const RankTest test = rankSum(Series{3, 4, 5}, Series{1, 2});
    EXPECT_NEAR(test.chance, 0.2, 1e-14);
    EXPECT_NEAR(test.attainable, 0.2, 1e-14);
    EXPECT_EQ(test.shift, -2.5);
}

TEST(RankTests, WelchesMeansScatterDifferently) {
    // Means 3 and 8, squared errors 0.5 and 2: t = 5 / √2.5, 5.88 degrees of freedom.
    const WelchTest test = welch(Series{1, 2, 3, 4, 5}, Series{4, 6, 8, 10, 12});
    EXPECT_NEAR(test.t, 3.162278, 1e-6);
    EXPECT_EQ(test.freedom, 5);
    EXPECT_NEAR(test.chance, 0.025031, 1e-6);  // R: 2 * pt(-3.162278, 5)
    EXPECT_EQ(welch(Series{1, 1}, Series{1, 1}).chance, 1.0);
    EXPECT_EQ(welch(Series{1, 1}, Series{2, 2}).chance, 0.0);
}

}  // namespace
}  // namespace gfxrepro::regression
