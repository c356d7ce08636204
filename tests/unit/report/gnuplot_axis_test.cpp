#include "runner/report/gnuplot_axis.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace gfxrepro::report {
namespace {

using testing::ElementsAre;

TEST(GnuplotAxis, Ranges) {
    const AxisRange flat = rangeOf({3.0, 3.0}, false, true);
    EXPECT_LT(flat.low, 3.0);
    EXPECT_GT(flat.high, 3.0);
    EXPECT_EQ(rangeOf({0.0}, false, true).high, 1.0);
    EXPECT_EQ(rangeOf({1.0, 10.0}, false, true).low, 0.0);
    EXPECT_GT(rangeOf({9.0, 10.0}, false, true).low, 8.0);  // a small change far from zero
    const AxisRange powers = rangeOf({1.0, 1000.0}, true, false);
    EXPECT_LT(powers.low, 1.0);
    EXPECT_GT(powers.low, 0.1);
    EXPECT_GT(powers.high, 1000.0);
}

TEST(GnuplotAxis, Tics) {
    const auto labels = [](const Tics& tics) {
        std::vector<std::string> texts;
        for (const auto& [value, text] : tics) {
            if (!text.empty()) texts.push_back(text);
        }
        return texts;
    };
    EXPECT_THAT(labels(logarithmicTics({0.5, 2e7})),
                ElementsAre("1", "10", "100", "1000", "10⁴", "10⁵", "10⁶", "10⁷"));
    EXPECT_THAT(labels(logarithmicTics({0.04, 3.0})),
                ElementsAre("0.05", "0.1", "0.2", "0.5", "1", "2"));
    EXPECT_THAT(labels(logarithmicTics({1e-9, 1e-6})), ElementsAre("10⁻⁹", "10⁻⁸", "10⁻⁷", "10⁻⁶"));
    EXPECT_THAT(labels(logarithmicTics({9000, 60000})), ElementsAre("10⁴", "2·10⁴", "5·10⁴"));
    EXPECT_EQ(linearStep({0.0, 1.1}, 6), 0.2);
    EXPECT_EQ(linearStep({0.0, 18.0}, 4), 5.0);
    EXPECT_DOUBLE_EQ(linearStep({3.0, 3.0 + 5e-5}, 6), 1e-5);
    EXPECT_EQ(linearStep({0.0, 2.1e6}, 4), 1e6);
    EXPECT_THAT(labels(logarithmicTics({9.9, 11.1})), ElementsAre("10", "10.5", "11"));
    EXPECT_THAT(labels(ticsAt({512, 64, 128, 256, 64}, {60, 540}, true)),
                ElementsAre("64", "128", "256", "512"));
    EXPECT_TRUE(ticsAt({1, 2, 3, 1000}, {0, 1000}, false).empty());  // 1 to 3 would overlap
}

}  // namespace
}  // namespace gfxrepro::report
