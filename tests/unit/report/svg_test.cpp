#include "runner/report/svg.h"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/support/support.h"

namespace gfxrepro::report {
namespace {

using testing::DoubleEq;

constexpr double kGap = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<std::string> textsOf(const std::vector<Tick>& ticks) {
    std::vector<std::string> texts;
    for (const Tick& tick : ticks) {
        if (!tick.text.empty()) texts.push_back(tick.text);
    }
    return texts;
}

std::vector<std::string> upward(const PlotAxis& axis, double length = 270.0) {
    return textsOf(ticksOf(axis, length, Along::Y));
}

TEST(PlotAxis, Ranges) {
    const PlotAxis flat = axisOf({3.0, 3.0}, false, true);
    EXPECT_DOUBLE_EQ(flat.low, 2.85);
    EXPECT_DOUBLE_EQ(flat.high, 3.15);
    EXPECT_EQ(axisOf({0.0}, false, true).high, 1.0);
    EXPECT_EQ(axisOf({1.0, 10.0}, false, true).low, 0.0);
    EXPECT_DOUBLE_EQ(axisOf({1.0, 10.0}, false, true).high, 10.45);
    EXPECT_DOUBLE_EQ(axisOf({1.0, 10.0}, false, false).low, 0.55);
    EXPECT_DOUBLE_EQ(axisOf({9.0, 10.0}, false, true).low, 8.95);  // a small change far from zero
    EXPECT_DOUBLE_EQ(axisOf({-1.0, 1.0}, false, true).low, -1.1);
    const PlotAxis powers = axisOf({1.0, 100.0}, true, true);
    EXPECT_DOUBLE_EQ(powers.low, std::pow(10.0, -0.1));
    EXPECT_DOUBLE_EQ(powers.high, std::pow(10.0, 2.1));
}

TEST(PlotAxis, LeavesOutWhatItCannotShow) {
    EXPECT_EQ(axisOf({}, false, true).high, 1.0);
    EXPECT_EQ(axisOf({kGap, kInfinity}, false, true).high, 1.0);
    EXPECT_DOUBLE_EQ(axisOf({kGap, 2.0, 4.0, -kInfinity}, false, false).low, 1.9);
    const PlotAxis powers = axisOf({-1.0, 0.0, 5.0}, true, false);
    EXPECT_DOUBLE_EQ(powers.low, 5.0 / 1.1);
    EXPECT_DOUBLE_EQ(powers.high, 5.0 * 1.1);
    EXPECT_FALSE(powers.shows(0.0));
    EXPECT_FALSE(powers.shows(kGap));
    EXPECT_TRUE(PlotAxis().shows(-3.0));
    EXPECT_FALSE(PlotAxis().shows(kInfinity));
}

TEST(PlotAxis, Places) {
    const PlotAxis linear{2.0, 10.0};
    EXPECT_DOUBLE_EQ(linear.at(2.0), 0.0);
    EXPECT_DOUBLE_EQ(linear.at(4.0), 0.25);
    const PlotAxis powers{1.0, 1e4, true};
    EXPECT_DOUBLE_EQ(powers.at(10.0), 0.25);
    EXPECT_DOUBLE_EQ(powers.at(1e4), 1.0);
}

TEST(PlotAxis, LinearTicksAreRound) {
    EXPECT_THAT(upward({0.0, 21.0}), ElementsAre("0", "5", "10", "15", "20"));
    EXPECT_THAT(upward({0.0, 1.1}), ElementsAre("0", "0.2", "0.4", "0.6", "0.8", "1.0"));
    EXPECT_THAT(upward({0.0, 1.1}, 60.0), ElementsAre("0", "1"));
    EXPECT_THAT(upward({9.6, 12.5}, 150.0), ElementsAre("10", "11", "12"));
    EXPECT_THAT(upward({-0.011, 0.011}, 100.0), ElementsAre("−0.01", "0", "0.01"));
    EXPECT_THAT(upward({0.0, 2.1e6}, 120.0), ElementsAre("0", "10⁶", "2·10⁶"));
    EXPECT_THAT(upward({0.0, 0.00045}, 120.0), ElementsAre("0", "2·10⁻⁴", "4·10⁻⁴"));
    EXPECT_THAT(upward({3.0, 3.0 + 4.5e-5}, 100.0), ElementsAre("3.00000", "3.00002", "3.00004"));
    EXPECT_THAT(upward({1e6 - 1.0, 1e6 + 11.0}, 100.0),
                ElementsAre("10⁶", "1.000005·10⁶", "1.00001·10⁶"));
    const std::vector<Tick> ticks = ticksOf({0.0, 0.35}, 300.0, Along::X);
    EXPECT_EQ(ticks[3].value, 0.3);  // not 0.1 · 3, which is another number
}

/// Whatever the range: within it, two texts or more, one step, which is 1, 2 or 5 times a power.
TEST(PlotAxis, LinearTicksAreRoundEverywhere) {
    for (double high = 1e-9; high < 1e12; high *= 1.37) {
        for (const double low : {0.0, -0.3 * high, 0.9 * high}) {
            for (const double length : {150.0, 270.0, 560.0}) {
                const std::vector<Tick> ticks = ticksOf({low, high}, length, Along::Y);
                ASSERT_GE(ticks.size(), 2U) << low << " " << high;
                const double step = ticks[1].value - ticks[0].value;
                const double mantissa = step / std::pow(10.0, std::floor(std::log10(step) + 1e-6));
                EXPECT_THAT(mantissa,
                            AnyOf(testing::DoubleNear(1, 1e-6), testing::DoubleNear(2, 1e-6),
                                  testing::DoubleNear(5, 1e-6)));
                EXPECT_LE(static_cast<double>(ticks.size()), length / 30.0 + 2.0);
                EXPECT_GE(ticks[0].value, low - 1e-6 * step);
                EXPECT_LE(ticks.back().value, high + 1e-6 * step);
            }
        }
    }
}

TEST(PlotAxis, LogarithmicTicks) {
    EXPECT_THAT(upward({0.5, 2e7, true}),
                ElementsAre("1", "10", "100", "1000", "10⁴", "10⁵", "10⁶", "10⁷"));
    EXPECT_THAT(upward({0.04, 3.0, true}), ElementsAre("0.05", "0.1", "0.2", "0.5", "1", "2"));
    EXPECT_THAT(upward({1e-9, 1e-6, true}, 150.0), ElementsAre("10⁻⁹", "10⁻⁸", "10⁻⁷", "10⁻⁶"));
    EXPECT_THAT(upward({9000, 60000, true}, 150.0), ElementsAre("10⁴", "2·10⁴", "5·10⁴"));
    EXPECT_THAT(upward({0.5, 2e10, true}, 100.0), ElementsAre("1", "10⁵", "10¹⁰"));
    EXPECT_THAT(upward({9.9, 11.1, true}, 100.0), ElementsAre("10.0", "10.5", "11.0"));
    const std::vector<Tick> ticks = ticksOf({0.9, 110.0, true}, 100.0, Along::Y);
    EXPECT_THAT(textsOf(ticks), ElementsAre("1", "10", "100"));
    EXPECT_EQ(ticks.size(), 20U);  // 0.9, and of each decade nine, and 100
}

TEST(PlotAxis, TextsDoNotOverlap) {
    for (double decades = 0.02; decades < 200.0; decades *= 1.1) {
        for (const double length : {120.0, 290.0, 560.0}) {
            for (const bool isLog : {true, false}) {
                const PlotAxis axis{3e-7, 3e-7 * std::pow(10.0, decades), isLog};
                double end = -100.0;
                for (const Tick& tick : ticksOf(axis, length, Along::X)) {
                    if (tick.text.empty()) continue;
                    const double place = length * axis.at(tick.value);
                    EXPECT_GT(place - 0.5 * textWidth(tick.text), end) << decades << " " << length;
                    end = place + 0.5 * textWidth(tick.text);
                }
                EXPECT_GT(end, 0.0) << "no text: " << decades << " " << length;
            }
        }
    }
}

TEST(PlotAxis, ExtremeValuesEndTicksToo) {
    const std::vector<std::vector<double>> extremes = {
        {1e-310, 2e-310}, {1e-200, 1.0, 1e200}, {1e-119, 1e119}, {-1e119, 1e119}, {1e-9, 1e299}};
    for (const auto& values : extremes) {
        for (const bool isLog : {false, true}) {
            const PlotAxis axis = axisOf(values, isLog, false);
            EXPECT_FALSE(ticksOf(axis, 300.0, Along::X).empty()) << values[0] << ' ' << isLog;
            EXPECT_FALSE(ticksOf(axis, 100.0, Along::Y).empty()) << values[0] << ' ' << isLog;
            for (const double value : values) {
                if (!axis.shows(value)) continue;
                EXPECT_GE(axis.at(value), 0.0) << value;
                EXPECT_LE(axis.at(value), 1.0) << value;
            }
        }
    }
}

TEST(PlotAxis, NamesStandAtAsManyPlacesAsHaveRoom) {
    const std::vector<std::string> days(10, "2026-11-21");
    EXPECT_EQ(ticksNamed(days, {-0.5, 9.5}, 1000.0).size(), 10U);
    const std::vector<Tick> some = ticksNamed(days, {-0.5, 9.5}, 300.0);
    ASSERT_EQ(some.size(), 3U);
    EXPECT_EQ(some[0].value, 1.0);
    EXPECT_EQ(some[1].value, 4.0);
    EXPECT_EQ(ticksNamed({"one"}, {-1.0, 1.0}, 300.0).at(0).value, 0.0);
}

TEST(PlotAxis, TicksStandAtFewAndShortValues) {
    EXPECT_THAT(textsOf(ticksAt({512, 64, 128, 256, 64}, {60, 540, true}, 300.0)),
                ElementsAre("64", "128", "256", "512"));
    EXPECT_THAT(textsOf(ticksAt({1, 3, 7}, {0, 8}, 300.0)), ElementsAre("1", "3", "7"));
    // 1 to 3 would overlap; the next have too many digits to be read.
    EXPECT_THAT(textsOf(ticksAt({1, 2, 3, 1000}, {0, 1000}, 300.0)),
                ElementsAre("0", "500", "1000"));
    EXPECT_THAT(textsOf(ticksAt({1.23456, 2.34567}, {1, 2.4}, 300.0)),
                ElementsAre("1.0", "1.5", "2.0"));
    EXPECT_THAT(textsOf(ticksAt({kGap, 2}, {1, 3}, 300.0)), ElementsAre("2"));
    EXPECT_GE(ticksAt({}, {0, 1}, 300.0).size(), 2U);
}

}  // namespace
}  // namespace gfxrepro::report
