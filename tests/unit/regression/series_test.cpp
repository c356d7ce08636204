#include "runner/regression/series.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gfxrepro::regression {
namespace {

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
