// One number of two runs.
#include "runner/tables/run_ratio.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gfxrepro::tables {
namespace {

Cell cellOf(double value, double low, double high, Bounds bounds = Bounds::Interval) {
    Cell cell;
    cell.status = records::Status::Ok;
    Measured number;
    number.value = value;
    number.bounds = bounds;
    number.interval = {low, high};
    cell.values = {number};
    return cell;
}

TEST(RunRatio, HasTheIntervalOfBoth) {
    const auto exact = ratioOfRuns(cellOf(20, 18, 24), cellOf(10, 10, 10));
    ASSERT_TRUE(exact && exact->interval);
    EXPECT_DOUBLE_EQ(exact->ratio, 2.0);
    EXPECT_DOUBLE_EQ(exact->interval->low, 1.8);
    EXPECT_DOUBLE_EQ(exact->interval->high, 2.4);
    // 10 % either way on both sides: about 14 %.
    const auto both = ratioOfRuns(cellOf(20, 20 / 1.1, 22), cellOf(10, 10 / 1.1, 11));
    EXPECT_NEAR(both->interval->high / 2.0, std::pow(1.1, std::sqrt(2.0)), 1e-12);
    const auto turned = ratioOfRuns(cellOf(10, 9, 12), cellOf(20, 18, 21));
    const auto back = ratioOfRuns(cellOf(20, 18, 21), cellOf(10, 9, 12));
    EXPECT_NEAR(turned->interval->low, 1.0 / back->interval->high, 1e-12);
}

TEST(RunRatio, IsOfPositiveNumbersAlone) {
    EXPECT_FALSE(ratioOfRuns(cellOf(0, 0, 0), cellOf(1, 1, 1)));
    EXPECT_FALSE(ratioOfRuns(cellOf(1, 1, 1), cellOf(-1, -2, 1)));
    EXPECT_FALSE(ratioOfRuns(Cell(), cellOf(1, 1, 1)));
    const auto ranged = ratioOfRuns(cellOf(3, 2, 4, Bounds::Range), cellOf(2, 1, 3));
    ASSERT_TRUE(ranged);
    EXPECT_DOUBLE_EQ(ranged->ratio, 1.5);
    EXPECT_FALSE(ranged->interval) << "a range promises nothing";
    EXPECT_FALSE(ratioOfRuns(cellOf(3, 0, 4), cellOf(2, 1, 3))->interval) << "it has no logarithm";
}

}  // namespace
}  // namespace gfxrepro::tables
