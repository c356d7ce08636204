#include "runner/metrics/statistics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "runner/core/random.h"
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
}

TEST(Statistics, Names) {
    EXPECT_EQ(statisticFromName("max"), Statistic::Max);
    EXPECT_EQ(test::errorText([] { statisticFromName("avg"); }),
              "unknown statistic 'avg'; allowed: median, mean, min, max, sum, count");
}

TEST(Statistics, CentralIntervalInterpolates) {
    std::vector<double> values;
    for (int i = 100; i >= 0; --i) values.push_back(i);
    const Interval interval = centralInterval(values, 0.95);
    EXPECT_NEAR(interval.low, 2.5, 1e-12);
    EXPECT_NEAR(interval.high, 97.5, 1e-12);
    const double infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(centralInterval({infinity, infinity}).high, infinity);
}

TEST(Statistics, BootstrapIsSeeded) {
    const std::vector<double> values = {1.0, 2.0, 3.0, 4.0, 5.0};
    EXPECT_EQ(bootstrap(values, Statistic::Mean, 50, 7), bootstrap(values, Statistic::Mean, 50, 7));
    EXPECT_NE(bootstrap(values, Statistic::Mean, 50, 7), bootstrap(values, Statistic::Mean, 50, 8));
    EXPECT_THAT(bootstrap(std::vector<double>{4.0}, Statistic::Median, 10, 1), testing::Each(4.0));
}

/// The 95 % interval of a mean covers the true mean about as often as it says.
TEST(Statistics, BootstrapCovers) {
    int covered = 0;
    constexpr int kTrials = 200;
    for (int trial = 0; trial < kTrials; ++trial) {
        Random random(static_cast<std::uint64_t>(trial) + 1);
        std::vector<double> values(30);
        for (double& value : values) value = double{random.uniform(9.0F, 11.0F)};
        const Interval interval = centralInterval(bootstrap(values, Statistic::Mean, 400, 5));
        if (interval.low <= 10.0 && 10.0 <= interval.high) ++covered;
    }
    EXPECT_GE(covered, kTrials * 88 / 100);
    EXPECT_LE(covered, kTrials * 99 / 100);
}

}  // namespace
}  // namespace gfxrepro::metrics
