#include "runner/regression/nightly_history.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/files.h"
#include "tests/support/support.h"
#include "tests/unit/regression/nights.h"

namespace gfxrepro::regression {
namespace {

TEST(History, KeepsNightsByMachine) {
    const TemporaryFolder folder;
    const fs::path path = folder.path() / "history.csv";
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
    const fs::path path = folder.path() / "history.csv";
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
        return findStep(values, 0.01, kStepRules.effectFloor).has_value();
    };
    EXPECT_FALSE(found(nights(1, 9, 4, 2.0, 0.0)));
    EXPECT_FALSE(found(nights(1, 30, 15, 1.01, 0.0)));
    EXPECT_FALSE(found(Series(30, 1.0)));
    EXPECT_FALSE(found({}));
    // Among 20 series, 24 nights cannot tell and 26 can.
    const double significance = kStepRules.familyError / (20 * kStepRules.nightsAYear);
    EXPECT_FALSE(findStep(nights(1, 24, 12, 2.0, 0.01), significance, 0.02));
    EXPECT_TRUE(findStep(nights(1, 26, 13, 2.0, 0.01), significance, 0.02));
}

constexpr double kSignificance = 1e-5;
constexpr double kFloor = 0.05;

/// Levels of `length` nights each, with noise.
Series levels(std::uint64_t seed, const std::vector<double>& values, int length,
              double noise = 0.02) {
    Random random(seed);
    Series nights;
    for (const double value : values) {
        for (int i = 0; i < length; ++i) {
            nights.push_back(value * std::exp(noise * test::normal(random)));
        }
    }
    return nights;
}

std::vector<std::size_t> firstNights(const Series& nights) {
    std::vector<std::size_t> firsts;
    for (const Step& step : findAllSteps(nights, kSignificance, kFloor)) {
        firsts.push_back(step.first);
    }
    return firsts;
}

TEST(AllSteps, FindsEachChangeOfLevel) {
    const Series nights = levels(1, {10, 12, 9, 9.9}, 30);
    const std::vector<Step> steps = findAllSteps(nights, kSignificance, kFloor);
    ASSERT_EQ(steps.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(static_cast<double>(steps[i].first), 30.0 * static_cast<double>(i + 1), 1.0);
    }
    EXPECT_NEAR(steps[0].ratio, 1.2, 0.03);
    EXPECT_NEAR(steps[1].ratio, 0.75, 0.03);
    EXPECT_NEAR(steps[2].ratio, 1.1, 0.03);
}

// The nightly looks at its last hundred nights alone: what is older must be found all the same.
TEST(AllSteps, FindsWhatLiesFarBack) {
    const Series old = levels(2, {10, 13}, 40), later = levels(3, {13}, 400);
    Series nights = old;
    nights.insert(nights.end(), later.begin(), later.end());
    ASSERT_FALSE(findStep(nights, kSignificance, kFloor));
    const std::vector<std::size_t> firsts = firstNights(nights);
    ASSERT_EQ(firsts.size(), 1U);
    EXPECT_NEAR(static_cast<double>(firsts[0]), 40.0, 2.0);
}

TEST(AllSteps, TwoYearsOfNoiseHaveNone) {
    for (std::uint64_t seed = 0; seed < (gfxrepro::test::kIsSanitized ? 1 : 5); ++seed) {
        EXPECT_EQ(firstNights(levels(seed, {10}, 730, 0.15)), std::vector<std::size_t>{}) << seed;
    }
    EXPECT_TRUE(firstNights({}).empty());
    EXPECT_TRUE(firstNights({1, 2, 3}).empty());
}

TEST(Changes, WholeNumbersExactlyAndOthersBeyondRounding) {
    EXPECT_EQ(findChanges({100000, 100000, 100001, 100001}), std::vector<std::size_t>{2});
    EXPECT_EQ(findChanges({0.5, 0.50001, 0.501, 0.501}), std::vector<std::size_t>{2});
    const double infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(findChanges({infinity, infinity, 40.5}), std::vector<std::size_t>{2});
    EXPECT_TRUE(findChanges({7.5}).empty());
}

HistoryRow rowOf(int night, const SeriesKey& key, double value,
                 const std::string& machine = "a <machine>") {
    return {fmt::format("2026-{:02}-{:02}T03:00:00Z", 1 + night / 28, 1 + night % 28),
            fmt::format("c{:03}", night), machine, key, value};
}

/// A time with a step at night 20, a value that changes at night 12, one that does not.
std::vector<HistoryRow> someRows() {
    SeriesKey value = test::timeOf("m"), constant = value;
    value.metric = "triangles";
    value.unit = "count";
    constant.metric = "psnr_db";
    std::vector<HistoryRow> rows;
    const Series times = levels(4, {10, 12}, 20);
    for (int night = 0; night < 40; ++night) {
        rows.push_back(rowOf(night, test::timeOf("m"), times[static_cast<std::size_t>(night)]));
        if (night != 30) rows.push_back(rowOf(night, value, night < 12 ? 500 : 512));
        rows.push_back(rowOf(night, constant, 40.5));
    }
    rows.push_back(rowOf(0, test::timeOf("m"), 3.0, "b"));
    return rows;
}

TEST(HistoryPage, EachMachineHasItsNightsAndChanges) {
    std::vector<HistoryRow> rows = someRows();
    std::ranges::reverse(rows);  // of several files, the newest first
    const std::vector<MachineHistory> histories = historiesOf(rows);
    ASSERT_EQ(histories.size(), 2U);
    const MachineHistory& first = histories[0];
    EXPECT_EQ(first.machine, "a <machine>");
    ASSERT_EQ(first.nights.size(), 40U);
    EXPECT_EQ(first.nights[20].commit, "c020");
    ASSERT_EQ(first.series.size(), 3U);
    const SeriesHistory& constant = first.series[0];
    EXPECT_EQ(constant.key.metric, "psnr_db");
    EXPECT_TRUE(constant.changes.empty());
    const SeriesHistory& value = first.series[1];
    EXPECT_EQ(value.nights.size(), 39U);
    ASSERT_EQ(value.changes.size(), 1U);
    EXPECT_EQ(value.changes[0].before, 11U);
    EXPECT_EQ(value.changes[0].night, 12U);
    const SeriesHistory& time = first.series[2];
    ASSERT_EQ(time.changes.size(), 1U);
    EXPECT_EQ(time.changes[0].before, 19U);
    EXPECT_EQ(time.changes[0].night, 20U);
    EXPECT_NEAR(time.changes[0].ratio, 1.2, 0.03);
    EXPECT_LT(time.changes[0].chance, significanceOf(1));
    EXPECT_EQ(histories[1].nights.size(), 1U);
}

TEST(HistoryPage, ShowsCurvesMarksAndCommitsWithoutAScript) {
    const TemporaryFolder folder;
    const auto file = folder.path() / "history.html";
    writeHistoryPage(file, "Nights & days", historiesOf(someRows()));
    const std::string page = readFile(file);
    EXPECT_THAT(page, HasSubstr("<title>gfxrepro: Nights &amp; days</title>"));
    EXPECT_THAT(page, HasSubstr("<h2>a &lt;machine&gt;</h2>"));
    EXPECT_THAT(page, HasSubstr("<td>c019</td><td>c020</td>"));  // of the step
    EXPECT_THAT(page, HasSubstr("500 → 512"));
    EXPECT_THAT(page, HasSubstr("<td>c011</td><td>c012</td>"));
    EXPECT_THAT(page, HasSubstr("One series that is no time never changed."));
    EXPECT_THAT(page, HasSubstr("<title>2026-01-21T03:00:00Z, c020: "));
    EXPECT_THAT(page, Not(HasSubstr("<script")));
    EXPECT_THAT(page, Not(HasSubstr("href=\"http")));
    std::size_t curves = 0;
    for (std::size_t at = 0; (at = page.find("<svg", at)) != page.npos; ++at) ++curves;
    EXPECT_EQ(curves, 6U);  // two of the first machine, one of the second; wide and narrow
}

TEST(HistoryPage, ANightWithoutAValueIsAGap) {
    const TemporaryFolder folder;
    const auto file = folder.path() / "history.html";
    writeHistoryPage(file, "Nights", historiesOf(someRows()));
    const std::string page = readFile(file);
    const std::size_t svg = page.find("<svg", page.find("id=\"series-0-1\""));  // not on night 30
    const std::size_t last = page.find("\" fill=\"none\"", svg);
    const std::size_t path = page.rfind("<path d=\"", last) + 9;
    const std::string line = page.substr(path, page.find('"', path) - path);
    EXPECT_EQ(std::ranges::count(line, 'M'), 2);
    EXPECT_EQ(std::ranges::count(line, 'L'), 37);
    EXPECT_THAT(page.substr(svg, page.find("</svg>", svg) - svg), Not(HasSubstr("c030")));
}

TEST(HistoryRows, AFileThatIsNoHistoryIsRefused) {
    const TemporaryFolder folder;
    const auto file = folder.write("a.csv", "samples,mse\n4,1\n");
    EXPECT_EQ(errorText([&] { readHistoryRows(file); }, folder.path()),
              "DIR/a.csv:1: is no history; expected the header "
              "'time,commit,machine,table,technique,method,scene,params,pass,metric,unit,value'");
    EXPECT_EQ(errorText([&] { readHistoryRows(folder.path() / "none.csv"); }, folder.path()),
              "cannot read DIR/none.csv: No such file or directory");
}

TEST(HistoryRows, AHeaderThatWasTornIsWrittenAgain) {
    const TemporaryFolder folder;
    const auto file = folder.write("history.csv", "time,com");
    appendNight(file, {"2026-01-01T00:00:00Z", "abc", "a", {{test::timeOf("m"), {1.0}}}});
    ASSERT_EQ(readHistoryRows(file).size(), 1U);
    EXPECT_EQ(readHistoryRows(file)[0].commit, "abc");
}

}  // namespace
}  // namespace gfxrepro::regression
