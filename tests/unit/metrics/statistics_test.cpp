#include "engine/metrics/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "tests/support/support.h"

namespace gfxrepro::metrics {
namespace {

TEST(Statistics, Summaries) {
    const std::vector<double> values = {5.0, 1.0, 4.0, 2.0};
    EXPECT_EQ(summarize(values, Statistic::Median), 3.0);
    EXPECT_EQ(summarize(values, Statistic::Mean), 3.0);
    EXPECT_EQ(summarize(values, Statistic::Min), 1.0);
    EXPECT_EQ(summarize(values, Statistic::Max), 5.0);
    EXPECT_EQ(summarize(values, Statistic::Sum), 12.0);
    EXPECT_EQ(summarize(values, Statistic::Count), 4.0);
    EXPECT_EQ(summarize(std::vector<double>{9.0, 1.0, 4.0}, Statistic::Median), 4.0);
    EXPECT_EQ(summarize({}, Statistic::Count), 0.0);
    // Two frames at 10 and 40 a second last 125 ms together: 16 a second.
    EXPECT_DOUBLE_EQ(summarize(std::vector<double>{10.0, 40.0}, Statistic::Rate), 16.0);
    EXPECT_EQ(summarize(std::vector<double>{10.0, 0.0}, Statistic::Rate), 0.0);
}

TEST(Statistics, Names) {
    EXPECT_EQ(statisticFromName("max"), Statistic::Max);
    EXPECT_EQ(statisticFromName("rate"), Statistic::Rate);
    EXPECT_EQ(errorText([] { statisticFromName("avg"); }),
              "unknown statistic 'avg'; allowed: median, mean, min, max, sum, count, rate, stddev, "
              "p95, p99");
}

TEST(Statistics, Spread) {
    const std::vector<double> values = {2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0};
    EXPECT_DOUBLE_EQ(summarize(values, Statistic::StdDev), std::sqrt(32.0 / 7.0));
    EXPECT_TRUE(std::isnan(summarize(std::vector<double>{3.0}, Statistic::StdDev)));
    // As numpy.percentile has it by default.
    EXPECT_DOUBLE_EQ(summarize(values, Statistic::P95), 8.3);
    EXPECT_DOUBLE_EQ(summarize(values, Statistic::P99), 8.86);
    EXPECT_EQ(summarize(std::vector<double>{3.0}, Statistic::P95), 3.0);
}

std::vector<double> upTo(int n) {
    std::vector<double> values;
    for (int i = n; i >= 1; --i) values.push_back(i);
    return values;
}

/// Ranks of the ends: tables of the sign test, as in Conover 1999, Table A3.
TEST(Statistics, MedianIntervalIsOfOrderStatistics) {
    EXPECT_FALSE(medianInterval(upTo(5)));
    const auto ends = [](int n) {
        const Interval interval = *medianInterval(upTo(n));
        return std::pair(interval.low, interval.high);
    };
    EXPECT_EQ(ends(6), std::pair(1.0, 6.0));
    EXPECT_EQ(ends(8), std::pair(1.0, 8.0));
    EXPECT_EQ(ends(9), std::pair(2.0, 8.0));
    EXPECT_EQ(ends(12), std::pair(3.0, 10.0));
    EXPECT_EQ(ends(20), std::pair(6.0, 15.0));
    EXPECT_EQ(ends(100), std::pair(40.0, 61.0));
    const double infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(medianInterval(std::vector<double>(6, infinity))->low, infinity);
}

TEST(Statistics, MedianIntervalDepthIsThatOfItsEnds) {
    std::vector<std::size_t> depths;
    for (std::size_t count = 6; count <= 20; ++count) depths.push_back(medianIntervalDepth(count));
    EXPECT_EQ(depths, (std::vector<std::size_t>{1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 5, 5, 5, 6}));
}

/// Of three coins with 1, 2 and 3 two of eight throws come to 3; of ties whole numbers stay whole.
TEST(Statistics, CoinSumsAreChances) {
    const std::vector<std::size_t> ranks = {1, 2, 3}, ties = {2, 2};
    EXPECT_EQ(coinSums(ranks),
              (std::vector<double>{0.125, 0.125, 0.125, 0.25, 0.125, 0.125, 0.125}));
    EXPECT_EQ(coinSums(ties), (std::vector<double>{0.25, 0.0, 0.5, 0.0, 0.25}));
    EXPECT_EQ(coinSums({}), std::vector<double>{1.0});
    const std::vector<std::size_t> many(2000, 1);
    EXPECT_NEAR(coinSums(many)[1000], 0.01784, 1e-5) << "no overflow";
}

/// Critical values of Wilcoxon's signed ranks at 5 %, two-sided (Hollander, Wolfe and Chicken 2014,
/// Table A.4): with 6 values none of the 21 means is left out but the outermost stays the end.
TEST(Statistics, CentreIntervalIsOfSignedRanks) {
    EXPECT_FALSE(centreInterval(upTo(5)));
    const auto ends = [](int n) {
        const Interval interval = *centreInterval(upTo(n));
        return std::pair(interval.low, interval.high);
    };
    EXPECT_EQ(ends(6), std::pair(1.0, 6.0));
    EXPECT_EQ(ends(8), std::pair(2.0, 7.0));   // the 4th of 36: 1, 1.5, 2, 2
    EXPECT_EQ(ends(10), std::pair(3.0, 8.0));  // the 9th of 55: 1, 1.5, 2, 2, 2.5, 2.5, 3, 3, 3
    EXPECT_EQ(centre(upTo(7)), 4.0);
    // One value that is anything moves it by a step, not away.
    EXPECT_NEAR(centre(std::vector<double>{1.0, 1.1, 0.9, 1.0, 1.05, 0.95, 1e6}), 1.0, 0.1);
}

TEST(Statistics, KendallCountsPairs) {
    const std::vector<double> x = {1.0, 2.0, 3.0, 4.0};
    EXPECT_EQ(kendall(x, std::vector<double>{1.0, 2.0, 5.0, 7.0}), 1.0);
    EXPECT_EQ(kendall(x, std::vector<double>{4.0, 3.0, 2.0, 1.0}), -1.0);
    EXPECT_DOUBLE_EQ(kendall(x, std::vector<double>{1.0, 3.0, 2.0, 4.0}), 4.0 / 6.0);
    EXPECT_EQ(kendall(x, std::vector<double>(4, 1.0)), 0.0);
    EXPECT_EQ(kendall(x, std::vector<double>{0.4, 0.4 + 6e-17, 0.4 + 1.2e-16, 0.4 + 6e-17}), 0.0)
        << "apart by rounding";
    EXPECT_EQ(kendall(std::vector<double>{1.0, 1.0}, std::vector<double>{1.0, 2.0}), 0.0);
}

/// Of one series the sign test's chance: six values of one sign are 1 of 64 changes of sign, either
/// way 2.
TEST(JointChances, OfOneSeriesAreThoseOfItsSigns) {
    const std::map<int, double> up = {{0, 1.0}, {1, 1.1}, {2, 0.9}, {3, 1.2}, {4, 1.0}, {5, 0.8}};
    EXPECT_DOUBLE_EQ(jointChances(std::vector{up}, false).at(0), 1.0 / 64.0);
    EXPECT_DOUBLE_EQ(jointChances(std::vector{up}, true).at(0), 2.0 / 64.0);
    std::map<int, double> down;
    for (const auto& [round, value] : up) down[round] = -value;
    EXPECT_DOUBLE_EQ(jointChances(std::vector{down}, false).at(0), 1.0);
    EXPECT_DOUBLE_EQ(jointChances(std::vector{down}, true).at(0), 2.0 / 64.0);
}

/// What is far from 0 is as sure among many as alone; what others come as near to is not.
TEST(JointChances, ManySeriesAreLookedAtTogether) {
    std::vector<std::map<int, double>> series(41);
    for (int round = 0; round < 6; ++round) {
        series[0][round] = 8.0 + round % 2;
        for (std::size_t i = 1; i < series.size(); ++i) {
            series[i][round] = ((i >> static_cast<unsigned>(round)) & 1U) != 0 ? 1.0 : -0.9;
        }
    }
    const std::vector<double> chances = jointChances(series, false);
    EXPECT_DOUBLE_EQ(chances[0], 1.0 / 64.0);
    EXPECT_GT(*std::ranges::min_element(chances.begin() + 1, chances.end()), 0.1);
    // A series with fewer rounds, and more rounds than there are changes of sign to go through.
    series[0].erase(5);
    EXPECT_EQ(jointChances(series, true).size(), 41U);
    std::map<int, double> many;
    for (int round = 0; round < 40; ++round) many[round] = 1.0;
    EXPECT_DOUBLE_EQ(jointChances(std::vector{many}, false).at(0), 1.0 / 1024.0);
    EXPECT_TRUE(jointChances({}, false).empty());
}

}  // namespace
}  // namespace gfxrepro::metrics
