#include "runner/regression/comparison.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/regression/nights.h"
#include "tests/unit/regression/recorded.h"

namespace gfxrepro::regression {
namespace {

constexpr int kNights = 20, kMethods = 8, kRounds = 10;

/// A night as `compare --binaries` measures it, alarms confirmed once.
std::vector<Difference> night(Random& random, double change) {
    const double factor = test::nightFactor(random);
    const auto measuredOnce = [&] {
        const SeriesMap before = test::measured(random, kMethods, kRounds, factor);
        const SeriesMap after = test::measured(random, kMethods, kRounds, factor, change);
        return compare(before, after, Pairing::ByTurns);
    };
    std::vector<Difference> differences = measuredOnce();
    confirm(differences, measuredOnce());
    return differences;
}

std::ptrdiff_t alarms(const std::vector<Difference>& differences) {
    return std::ranges::count_if(differences, &Difference::isAlarm);
}

TEST(Comparison, TwentyNightsOfTheSameBuildGiveAtMostOneAlarm) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        Random random(seed);
        std::ptrdiff_t count = 0;
        for (int i = 0; i < kNights; ++i) count += alarms(night(random, 1.0));
        EXPECT_LE(count, 1) << "seed " << seed;
    }
}

TEST(Comparison, FindsTenPercentSlower) {
    Random random(4);
    for (int i = 0; i < kNights; ++i) {
        const std::vector<Difference> differences = night(random, 1.1);
        EXPECT_GE(alarms(differences), kMethods - 2) << "night " << i;
        for (const Difference& difference : differences) {
            EXPECT_NEAR(difference.ratio, 1.1, 0.08);
        }
    }
}

/// Recorded times as a night of alternating runs, the second build's `change` times as long.
std::vector<Difference> recordedNight(int index, int rounds, double change) {
    const int nights = static_cast<int>(test::kRecordedMs.size()) / (2 * rounds);
    const auto measuredOnce = [&](int night) {
        Series before, after;
        for (int round = 0; round < rounds; ++round) {
            const auto first = static_cast<std::size_t>(2 * (night % nights * rounds + round));
            const std::size_t old = first + static_cast<std::size_t>(round % 2);
            before.push_back(test::kRecordedMs.at(old));
            after.push_back(change * test::kRecordedMs.at(2 * first + 1 - old));
        }
        const SeriesKey key = test::timeOf("recorded");
        return compare({{key, before}}, {{key, after}}, Pairing::ByTurns);
    };
    std::vector<Difference> differences = measuredOnce(index);
    confirm(differences, measuredOnce(index + 1));
    return differences;
}

TEST(Comparison, TwentyRecordedNightsOfTheSameBuildGiveAtMostOneAlarm) {
    static_assert(test::kRecordedMs.size() == 2 * kNights * kRounds);
    std::ptrdiff_t count = 0;
    for (int i = 0; i < kNights; ++i) count += alarms(recordedNight(i, kRounds, 1.0));
    EXPECT_LE(count, 1);
}

TEST(Comparison, FindsTenPercentInRecordedTimesWithEnoughRounds) {
    // Neighbours differ by 16 %: ten rounds tell a third, ten percent take a hundred.
    std::ptrdiff_t found = 0;
    for (int i = 0; i < kNights; ++i) found += alarms(recordedNight(i, kRounds, 1.35));
    EXPECT_GE(found, kNights - 4);
    for (int i = 0; i < 2; ++i) {
        EXPECT_EQ(alarms(recordedNight(i, 10 * kRounds, 1.1)), 1);
        EXPECT_EQ(alarms(recordedNight(i, 10 * kRounds, 1.0)), 0);
    }
}

TEST(Comparison, RunsOfTwoNightsAreNotToldApartByTheirMedians) {
    // What alternating is for: a night's factor of 15 % looks like a change of the build.
    Random random(5);
    const SeriesMap before = test::measured(random, kMethods, kRounds, 1.0);
    const SeriesMap after = test::measured(random, kMethods, kRounds, 1.15);
    EXPECT_EQ(alarms(compare(before, after, Pairing::Apart)), kMethods);
}

TEST(Comparison, FindsFasterAndTheSame) {
    Random random(6);
    const SeriesMap before = test::measured(random, 1, 40, 1.0);
    const auto verdict = [&](double change) {
        const SeriesMap after = test::measured(random, 1, 40, 1.0, change);
        return compare(before, after, Pairing::ByTurns).front().verdict;
    };
    EXPECT_EQ(verdict(0.8), Verdict::Faster);
    EXPECT_EQ(verdict(1.0), Verdict::Same);
    EXPECT_EQ(verdict(1.3), Verdict::Slower);
}

TEST(Comparison, RatesCountAsTheirReciprocal) {
    SeriesKey key = test::timeOf("m");
    key.metric = "frame_rate";
    const Series before = {100, 101, 99, 100, 100, 101};
    const Series after = {50, 51, 49, 50, 50, 50};
    const Difference difference = compareTimes(key, before, after, Pairing::ByTurns, 0.95, Rules{});
    EXPECT_EQ(difference.verdict, Verdict::Slower);
    EXPECT_NEAR(difference.ratio, 2.0, 0.05);
    EXPECT_EQ(difference.before, 100.0);
}

TEST(Comparison, FewProcessesCannotTell) {
    const Difference one =
        compareTimes(test::timeOf("m"), {10}, {20}, Pairing::Apart, 0.95, Rules{});
    EXPECT_EQ(one.verdict, Verdict::CannotTell);
    EXPECT_EQ(one.reason, "1 process a side; 5 are needed");
    const Difference zero =
        compareTimes(test::timeOf("m"), {0, 1, 1, 1, 1}, {1, 1, 1, 1, 1}, Pairing::Apart, 0.95, {});
    EXPECT_EQ(zero.reason, "a time of zero or less");
}

TEST(Comparison, AnUnsteadyBuildRaisesTheFloor) {
    const Series steady = {10, 10.01, 9.99, 10, 10.02, 10, 10, 9.98};
    const Series unsteady = {10, 13, 9, 14, 8, 12, 10, 15};
    EXPECT_EQ(detectableChange(steady, {}), Rules{}.effectFloor);
    EXPECT_GT(detectableChange(unsteady, {}), 0.05);
}

TEST(Comparison, AParameterThatOneBuildDoesNotKnowIsNoDifference) {
    const auto key = [](const char* params) {
        SeriesKey key = test::timeOf("m");
        key.params = params;
        return key;
    };
    const Series values = {10, 10, 10, 10, 10};
    const auto matched = compare(
        {{key(R"({"size":1})"), values}, {key(R"({"size":2})"), values}},
        {{key(R"({"size":1,"new":false})"), values}, {key(R"({"size":2,"new":false})"), values}},
        Pairing::Apart);
    ASSERT_EQ(matched.size(), 2U);
    EXPECT_EQ(matched[0].verdict, Verdict::Same);
    EXPECT_EQ(matched[0].key.params, R"({"size":1})");
    // Varied by one side: it cannot be left away.
    const auto varied = compare(
        {{key(R"({"size":1})"), values}},
        {{key(R"({"size":1,"new":false})"), values}, {key(R"({"size":1,"new":true})"), values}},
        Pairing::Apart);
    ASSERT_EQ(varied.size(), 3U);
    for (const Difference& difference : varied) EXPECT_EQ(difference.verdict, Verdict::Missing);
}

TEST(Comparison, QualityIsTheSameOrChanged) {
    SeriesKey key = test::timeOf("m");
    key.metric = "psnr_db";
    key.unit = "dB";
    const auto verdict = [&](double after) {
        return compare({{key, {40.0}}}, {{key, {after}}}, Pairing::Apart).front().verdict;
    };
    EXPECT_EQ(verdict(40.0), Verdict::Same);
    EXPECT_EQ(verdict(39.9), Verdict::Changed);
    EXPECT_EQ(compare({{key, {40.0}}}, {}, Pairing::Apart).front().reason, "measured before only");
    EXPECT_EQ(compare({}, {{key, {40.0}}}, Pairing::Apart).front().reason, "measured after only");
}

TEST(Comparison, AnAlarmThatDoesNotComeBackCannotTell) {
    Difference alarm{.key = test::timeOf("m"), .verdict = Verdict::Slower};
    std::vector<Difference> once = {alarm};
    confirm(once, {alarm});
    EXPECT_EQ(once[0].verdict, Verdict::Slower);
    alarm.verdict = Verdict::Same;
    confirm(once, {alarm});
    EXPECT_EQ(once[0].verdict, Verdict::CannotTell);
    EXPECT_EQ(once[0].reason, "slower once, not when measured again");
}

TEST(SeriesOf, TakesTimesOfTheTimingLaneOnly) {
    report::Record record;
    record.table = "p/1";
    record.metric = "gpu_time_ms";
    record.unit = "ms";
    std::vector<report::Record> records;
    for (const double value : {3.0, 1.0, 2.0}) {
        record.lane = "timing";
        record.repeat = static_cast<int>(records.size());
        record.value = value;
        records.push_back(record);
    }
    record.process = 1;
    records.push_back(record);
    record.frame = 1;
    record.value = 6.0;
    records.push_back(record);
    record.lane = "quality";
    records.push_back(record);
    record.status = report::Status::Crash;
    records.push_back(record);
    const SeriesMap series = seriesOf(records);
    ASSERT_EQ(series.size(), 1U);
    EXPECT_EQ(series.begin()->second, (Series{2.0, 4.0}));
    EXPECT_EQ(series.begin()->first.title(), "p/1  gpu_time_ms");
}

}  // namespace
}  // namespace gfxrepro::regression
