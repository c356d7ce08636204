#include "runner/tables/cell_format.h"

#include "tests/support/support.h"

namespace gfxrepro::tables {
namespace {

TEST(CellFormat, WritesStatistics) {
    const CellFormat format("{mean:.2f}/{max:.0f} {{x}}", {});
    EXPECT_EQ(format.format(std::vector<double>{3.005, 106.4}), "3.00/106 {x}");
    EXPECT_EQ(CellFormat("{median}", {}).format(std::vector<double>{0.1}), "0.1");
}

TEST(CellFormat, ReadsWhatItWrites) {
    const CellFormat pair("{mean:.2f}/{max:.0f}", {});
    EXPECT_THAT(pair.parse("3.00/106"), ElementsAre(3.0, 106.0));
    EXPECT_THAT(pair.parse("3.00"), ElementsAre(std::nullopt, std::nullopt));
    EXPECT_THAT(CellFormat("{median:.0f}", {}).parse("1,765,388"), ElementsAre(1765388.0));
    EXPECT_THAT(CellFormat("{median:.0f}", {}).parse("16MB"), ElementsAre(std::nullopt));
    EXPECT_THAT(CellFormat("{median:.0f} MB", {}).parse("16 MB"), ElementsAre(16.0));
    EXPECT_THAT(CellFormat("{median:.0f} MB", {}).parse("16"), ElementsAre(16.0));
}

TEST(CellFormat, BadFormatsAreErrorsInTheirPlace) {
    const auto error = [](const std::string& text) {
        return errorText([&] { CellFormat(text, {"a.yaml", 3, 7}); });
    };
    EXPECT_EQ(error("{avg:.2f}"),
              "a.yaml:3:7: format '{avg:.2f}': unknown statistic 'avg'; allowed: median, mean, "
              "min, max, sum, count, rate, stddev, p95, p99");
    EXPECT_EQ(error("{mean"), "a.yaml:3:7: format '{mean': '{' without '}'");
    EXPECT_EQ(error("mean}"),
              "a.yaml:3:7: format 'mean}': '}' without '{'; write '}}' for a brace");
    EXPECT_EQ(error("12"),
              "a.yaml:3:7: format '12': expected a statistic in braces, as in '{median:.2f}'");
    EXPECT_THAT(error("{mean:.2q}"),
                StartsWith("a.yaml:3:7: format '{mean:.2q}': bad number format '.2q': "));
}

}  // namespace
}  // namespace gfxrepro::tables
