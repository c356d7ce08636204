#include "runner/regression/history.h"

#include <gtest/gtest.h>

#include "engine/core/files.h"
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

constexpr StepRules kRules{};

TEST(History, FindsWhenALevelChanged) {
    const std::optional<Step> step = findStep(nights(1, 30, 17, 1.1, 0.03), 1e-5, 0.02);
    ASSERT_TRUE(step);
    EXPECT_NEAR(static_cast<double>(step->first), 17.0, 1.0);
    EXPECT_NEAR(step->ratio, 1.1, 0.03);
    EXPECT_LE(step->chance, 1e-5);
}

TEST(History, TheChanceOfAStepIsExact) {
    // 5 and 5 without an overlap: 2 of the 252 ways to choose; the only split that is looked at.
    const std::optional<Step> step = findStep({1, 2, 3, 4, 5, 16, 17, 18, 19, 20}, 0.01, 0.02);
    ASSERT_TRUE(step);
    EXPECT_NEAR(step->chance, 2.0 / 252.0, 1e-12);
    EXPECT_FALSE(findStep({1, 2, 3, 4, 5, 16, 17, 18, 19, 20}, 0.001, 0.02));
}

TEST(History, AYearOfNoiseHasNoStep) {
    int alarms = 0;
    for (std::uint64_t seed = 0; seed < (gfxrepro::test::kIsSanitized ? 1 : 5); ++seed) {
        SeriesMap history;
        for (int method = 0; method < 20; ++method) {
            Series& own = history[test::timeOf(std::to_string(method))];
            own = nights(100 * seed + static_cast<std::uint64_t>(method), 120, 120, 1.0, 0.15);
        }
        for (std::size_t night = 10; night <= 120;
             night += gfxrepro::test::kIsSanitized ? 55 : 10) {
            SeriesMap until = history;
            for (auto& [key, values] : until) values.resize(night);
            alarms += static_cast<int>(findSteps(until).size());
        }
    }
    EXPECT_EQ(alarms, 0);
}

TEST(History, FindsTheStepOfOneSeriesOfTwenty) {
    SeriesMap history;
    for (int method = 0; method < 20; ++method) {
        const int first = method == 7 ? 20 : 40;
        history[test::timeOf(std::to_string(method))] =
            nights(static_cast<std::uint64_t>(method), 40, first, 1.15, 0.03);
    }
    SeriesKey quality = test::timeOf("q");
    quality.metric = "psnr_db";
    history[quality] = nights(1, 40, 20, 2.0, 0.0);
    const std::vector<SeriesStep> steps = findSteps(history);
    ASSERT_EQ(steps.size(), 1U);
    EXPECT_EQ(steps[0].key.method, "7");
    EXPECT_EQ(steps[0].nights, 40U);
    EXPECT_NEAR(static_cast<double>(steps[0].step.first), 20.0, 2.0);
    EXPECT_TRUE(steps[0].isAlarm());
}

TEST(History, NeedsNightsOnEitherSideAndAnEffect) {
    const auto found = [](const Series& values) {
        return findStep(values, 0.01, kRules.effectFloor).has_value();
    };
    EXPECT_FALSE(found(nights(1, 9, 4, 2.0, 0.0)));
    EXPECT_FALSE(found(nights(1, 30, 15, 1.01, 0.0)));
    EXPECT_FALSE(found(Series(30, 1.0)));
    EXPECT_FALSE(found({}));
    // Among 20 series, 24 nights cannot tell and 26 can.
    const double significance = kRules.familyError / (20 * kRules.nightsAYear);
    EXPECT_FALSE(findStep(nights(1, 24, 12, 2.0, 0.01), significance, 0.02));
    EXPECT_TRUE(findStep(nights(1, 26, 13, 2.0, 0.01), significance, 0.02));
}

}  // namespace
}  // namespace gfxrepro::regression
