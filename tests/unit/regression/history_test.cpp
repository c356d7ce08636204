#include "runner/regression/history.h"

#include <gtest/gtest.h>

#include "runner/core/files.h"
#include "tests/support/support.h"
#include "tests/unit/regression/nights.h"

namespace gfxrepro::regression {
namespace {

using gfxrepro::test::errorText;
using gfxrepro::test::TemporaryFolder;

TEST(History, KeepsNightsByMachine) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.path() / "history.csv";
    EXPECT_TRUE(readHistory(path, "a").empty());
    const SeriesKey key = test::timeOf("m, \"quoted\"");
    appendNight(path, {"2026-01-01T00:00:00Z", "abc", "a", {{key, {1.0, 3.0, 2.0}}}});
    appendNight(path, {"2026-01-02T00:00:00Z", "abd", "b", {{key, {9.0}}}});
    appendNight(path, {"2026-01-03T00:00:00Z", "abe", "a", {{key, {0.1}}}});
    const SeriesMap history = readHistory(path, "a");
    ASSERT_EQ(history.size(), 1U);
    EXPECT_EQ(history.at(key), (Series{2.0, 0.1}));
}

TEST(History, CutsOffATornNightAndNamesABadRow) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.path() / "history.csv";
    appendNight(path, {"t", "abc", "a", {{test::timeOf("m"), {1.0}}}});
    const std::string whole = readFile(path);
    folder.write("history.csv", whole + "2026,torn");
    EXPECT_EQ(readHistory(path, "a").size(), 1U);
    appendNight(path, {"t", "abd", "a", {{test::timeOf("m"), {2.0}}}});
    EXPECT_EQ(readHistory(path, "a").begin()->second, (Series{1.0, 2.0}));
    folder.write("history.csv", whole + "a,b\n");
    EXPECT_EQ(errorText([&] { readHistory(path, "a"); }),
              path.string() + ":3: 2 columns; a history has 12");
    folder.write("history.csv", whole + "t,c,a,,,,,,,,ms,fast\n");
    EXPECT_EQ(errorText([&] { readHistory(path, "a"); }),
              path.string() + ":3: 'fast' is no number");
}

/// `count` nights of which those from `first` on are slower.
Series nights(std::uint64_t seed, int count, int first, double change, double noise) {
    Random random(seed);
    Series values;
    for (int i = 0; i < count; ++i) {
        values.push_back(10.0 * (i >= first ? change : 1.0) *
                         std::exp(noise * test::normal(random)));
    }
    return values;
}

TEST(History, FindsWhenALevelChanged) {
    const std::optional<Step> step = findStep(nights(1, 30, 18, 1.1, 0.03));
    ASSERT_TRUE(step);
    EXPECT_NEAR(static_cast<double>(step->first), 18.0, 1.0);
    EXPECT_NEAR(step->ratio, 1.1, 0.03);
    EXPECT_LE(step->chance, 0.01);
}

TEST(History, FindsNoStepInNoise) {
    int found = 0;
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        if (findStep(nights(seed, 30, 30, 1.0, 0.15))) ++found;
    }
    EXPECT_LE(found, 4);  // one expected; more than four by chance: 0.4 %
}

TEST(History, NeedsNightsOnEitherSideAndAnEffect) {
    EXPECT_FALSE(findStep(nights(1, 9, 4, 2.0, 0.0)));
    EXPECT_FALSE(findStep(nights(1, 30, 15, 1.01, 0.0)));
    EXPECT_FALSE(findStep(Series(30, 1.0)));
    EXPECT_FALSE(findStep({}));
}

}  // namespace
}  // namespace gfxrepro::regression
