#include "runner/studies/budget.h"

#include <gmock/gmock.h>

#include "tests/support/support.h"

namespace gfxrepro::studies {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(Budget, ReadsTimes) {
    EXPECT_EQ(parseBudgetS("90s"), 90.0);
    EXPECT_EQ(parseBudgetS("20m"), 1200.0);
    EXPECT_EQ(parseBudgetS("1.5h"), 5400.0);
    for (const char* bad : {"", "20", "m", "0m", "-1m", "20 m", "20min", "nanm", "infh"}) {
        EXPECT_EQ(
            test::errorText([&] { parseBudgetS(bad); }),
            "--budget is '" + std::string(bad) + "'; allowed: a time such as 90s, 20m or 1.5h");
    }
}

TEST(Budget, TakesTheTablesWithTheMostClaimsForTheirTime) {
    const std::vector<BudgetItem> items{{60, 1}, {10, 3}, {40, 2}, {5, 0}, {20, 2}};
    EXPECT_THAT(withinBudget(items, 70), ElementsAre(1, 2, 4));
    EXPECT_THAT(withinBudget(items, 30), ElementsAre(1, 4));
    EXPECT_THAT(withinBudget(items, 5), IsEmpty());
    EXPECT_THAT(withinBudget(items, 1000), ElementsAre(0, 1, 2, 4));
    EXPECT_THAT(withinBudget({}, 10), IsEmpty());
}

TEST(Budget, OneLargeTableMayDecideMoreThanManySmallOnes) {
    EXPECT_THAT(withinBudget({{1, 1}, {100, 20}}, 100), ElementsAre(1));
}

TEST(Budget, TablesThatTakeNoTimeComeFirst) {
    EXPECT_THAT(withinBudget({{10, 5}, {0, 1}}, 10), ElementsAre(0, 1));
}

}  // namespace
}  // namespace gfxrepro::studies
