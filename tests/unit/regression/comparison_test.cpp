#include "runner/regression/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "tests/support/support.h"
#include "tests/unit/regression/nights.h"
#include "tests/unit/regression/recorded.h"
#include "tests/unit/regression/recorded_watch.h"

namespace gfxrepro::regression {
namespace {

constexpr int kNights = gfxrepro::test::kIsSanitized ? 4 : 20, kMethods = 20;

std::ptrdiff_t alarms(const std::vector<Difference>& differences) {
    return std::ranges::count_if(differences, &Difference::isAlarm);
}

/// Nights of 20 series of nine tables with even noise, twenty rounds a look. The
/// first series takes `change` times as long.
class Nights {
  public:
    Nights(std::uint64_t seed, double noise, double change)
        : random_(seed), noise_(noise), change_(change) {}

    std::vector<Difference> next() {
        const double factor = test::nightFactor(random_);
        double minutes = 0.0;
        std::vector<Difference> differences =
            compareByTurns([&](Sides& sides, const std::set<std::string>& tables) {
                take(sides.before, tables, factor, 1.0);
                take(sides.after, tables, factor, change_);
                const double share =
                    tables.empty() ? 1.0 : static_cast<double>(tables.size()) / 9.0;
                minutes += kRounds * kMinutesARound * share;
            });
        longestMinutes_ = std::max(longestMinutes_, minutes);
        return differences;
    }
    double longestMinutes() const { return longestMinutes_; }

  private:
    static constexpr int kRounds = 20;
    static constexpr double kMinutesARound = 2.0 * 13.0 / 60.0;

    void take(SeriesMap& series, const std::set<std::string>& tables, double factor,
              double change) {
        SeriesMap all = test::measured(random_, kMethods, kRounds, factor, 1.0, noise_, change);
        std::erase_if(all, [&](const auto& entry) {
            return !tables.empty() && !tables.contains(entry.first.table);
        });
        append(series, all);
    }

    Random random_;
    double noise_;
    double change_;
    double longestMinutes_ = 0.0;
};

TEST(Comparison, TwentyNightsOfTheSameBuildGiveAtMostOneAlarm) {
    for (const double noise : {test::kCpuNoise, 2.0 * test::kCpuNoise, 0.12}) {
        for (const std::uint64_t seed : {1U, 2U, 3U}) {
            Nights nights(seed, noise, 1.0);
            std::ptrdiff_t count = 0;
            for (int i = 0; i < kNights; ++i) count += alarms(nights.next());
            EXPECT_LE(count, 1) << "seed " << seed << ", noise " << noise;
        }
    }
}

TEST(Comparison, FindsTenPercentSlowerInNineNightsOfTen) {
    Nights nights(4, test::kCpuNoise, 1.1);
    int found = 0;
    for (int i = 0; i < 10 * kNights; ++i) {
        const std::vector<Difference> differences = nights.next();
        if (differences.front().verdict != SeriesVerdict::Slower) continue;
        ++found;
        EXPECT_NEAR(differences.front().ratio, 1.1, 0.1);
    }
    EXPECT_GE(found, 9 * kNights);
    EXPECT_LE(nights.longestMinutes(), 30.0);
}

/// Nights of the watch itself: each time is one that was recorded of its series, at random. The
/// series `changed` takes `change` times as long.
class WatchedNights {
  public:
    explicit WatchedNights(std::uint64_t seed) : random_(seed) {}

    std::vector<Difference> next(std::size_t changed, double change) {
        double seconds = 0.0;
        std::vector<Difference> differences =
            compareByTurns([&](Sides& sides, const std::set<std::string>& tables) {
                for (int round = 0; round < kRounds; ++round) {
                    for (std::size_t i = 0; i < test::kWatched.size(); ++i) {
                        const test::WatchedSeries& watched = test::kWatched[i];
                        SeriesKey key = test::timeOf(watched.method);
                        key.table = watched.table;
                        key.metric = "process_time_ms";
                        sides.byProcess.insert(key.table);
                        if (!tables.empty() && !tables.contains(key.table)) continue;
                        sides.before[key].push_back(draw(watched));
                        sides.after[key].push_back(draw(watched) * (i == changed ? change : 1.0));
                    }
                }
                const double share =
                    tables.empty() ? 1.0 : static_cast<double>(tables.size()) / 8.0;
                seconds += 2.0 * kRounds * test::kSecondsARound * share;
            });
        longestMinutes_ = std::max(longestMinutes_, seconds / 60.0);
        return differences;
    }
    double longestMinutes() const { return longestMinutes_; }

  private:
    static constexpr int kRounds = 50;  // a look, as in scripts/nightly

    double draw(const test::WatchedSeries& watched) {
        const auto count = static_cast<double>(watched.ms.size());
        return watched.ms[static_cast<std::size_t>(count * double{random_.uniform()})];
    }

    Random random_;
    double longestMinutes_ = 0.0;
};

TEST(Comparison, TwentyNightsOfTheWatchGiveAtMostOneAlarm) {
    for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
        WatchedNights nights(seed);
        std::ptrdiff_t count = 0;
        for (int i = 0; i < kNights; ++i) count += alarms(nights.next(0, 1.0));
        EXPECT_LE(count, 1) << "seed " << seed;
    }
}

TEST(Comparison, TheWatchFindsTenPercentInNineNightsOfTenWhicheverSeriesItIs) {
    constexpr int kManyNights = gfxrepro::test::kIsSanitized ? kNights : 2 * kNights;
    for (std::size_t changed = 0; changed < test::kWatched.size(); ++changed) {
        const test::WatchedSeries& watched = test::kWatched[changed];
        WatchedNights nights(100 + changed);
        int found = 0;
        for (int i = 0; i < kManyNights; ++i) {
            for (const Difference& difference : nights.next(changed, 1.1)) {
                const bool isChanged = difference.key.table == watched.table &&
                                       difference.key.method == watched.method;
                if (isChanged && difference.verdict == SeriesVerdict::Slower) ++found;
            }
        }
        std::printf("  %s %s: %d of %d nights, %.1f minutes at most\n", watched.table,
                    watched.method, found, kManyNights, nights.longestMinutes());
        EXPECT_GE(found, kManyNights * 9 / 10) << watched.table << ' ' << watched.method;
        EXPECT_LE(nights.longestMinutes(), 30.0);
    }
}

/// Recorded times as a night of alternating runs, the second build's `change` times as long.
std::vector<Difference> recordedNight(std::size_t first, int rounds, double change) {
    std::size_t next = first;
    const auto take = [&] { return test::kRecordedMs[next++ % std::size(test::kRecordedMs)]; };
    return compareByTurns([&](Sides& sides, const std::set<std::string>&) {
        for (int round = 0; round < rounds; ++round) {
            const double a = take(), b = take();
            const SeriesKey key = test::timeOf("recorded");
            sides.before[key].push_back(round % 2 == 0 ? a : b);
            sides.after[key].push_back(change * (round % 2 == 0 ? b : a));
        }
    });
}

TEST(Comparison, TwentyRecordedNightsOfTheSameBuildGiveAtMostOneAlarm) {
    std::ptrdiff_t count = 0;
    for (int i = 0; i < kNights; ++i) {
        count += alarms(recordedNight(static_cast<std::size_t>(20 * i), 8, 1.0));
    }
    EXPECT_LE(count, 1);
}

TEST(Comparison, FindsInRecordedTimesWhatItsRoundsCan) {
    // By the clock neighbours differ by 16 %: 24 rounds tell a third, ten percent take a hundred.
    std::ptrdiff_t found = 0;
    for (int i = 0; i < kNights; ++i) {
        found += alarms(recordedNight(static_cast<std::size_t>(20 * i), 8, 1.35));
    }
    EXPECT_GE(found, kNights - kNights / 5);
    for (const std::size_t first : {0U, 200U}) {
        EXPECT_EQ(alarms(recordedNight(first, 100, 1.1)), 1);
        EXPECT_EQ(alarms(recordedNight(first, 100, 1.0)), 0);
    }
}

TEST(Comparison, RunsMeasuredApartShowADriftAndNoVerdict) {
    // What alternating is for: a night's factor looks like a change of the build.
    Random random(5);
    const SeriesMap before = test::measured(random, kMethods, 30, 1.0);
    for (const double drift : {0.7, 1.0, 1.4}) {
        const SeriesMap after = test::measured(random, kMethods, 30, drift);
        for (const Difference& difference : compare(before, after, Pairing::Apart)) {
            EXPECT_EQ(difference.verdict, SeriesVerdict::CannotTell);
            EXPECT_EQ(difference.reason, "measured apart: a machine may drift by 50 %");
        }
    }
    const SeriesMap after = test::measured(random, kMethods, 30, 1.0, 2.0);
    EXPECT_EQ(alarms(compare(before, after, Pairing::Apart)), kMethods);
}

/// As many as a quick run has: two series of six processes that became twice as slow, beside
/// thirty that did not and a hundred of one process, which nothing decides.
TEST(Comparison, SixProcessesApartDecideAmongThoseThatHaveAsMany) {
    Random random(7);
    SeriesMap before, after;
    for (int i = 0; i < 132; ++i) {
        const std::size_t processes = i < 32 ? 6 : 1;
        const SeriesKey key = test::timeOf("m" + std::to_string(i));
        for (auto* side : {&before, &after}) {
            const double factor = side == &after && (i < 2 || i >= 32) ? 2.0 : 1.0;
            for (std::size_t process = 0; process < processes; ++process) {
                (*side)[key].push_back(factor * (10.0 + static_cast<double>(random.uniform())));
            }
        }
    }
    EXPECT_EQ(alarms(compare(before, after, Pairing::Apart)), 2);
}

/// How often `compare` gives an alarm of two runs of 36 series, six processes each; the machine is
/// faster or slower in the second by a normal exponent of this size, and the first series takes
/// `change` times as long.
double alarmShare(double noise, double movement, double change, int runs) {
    Random random(11);
    int found = 0;
    for (int i = 0; i < runs; ++i) {
        const double drift = std::exp(movement * test::normal(random));
        const SeriesMap before = test::measured(random, 36, 6, 1.0, 1.0, noise);
        const SeriesMap after = test::measured(random, 36, 6, drift, 1.0, noise, change);
        const std::vector<Difference> differences = compare(before, after, Pairing::Apart);
        const bool isFound = change == 1.0 ? alarms(differences) > 0 : differences[0].isAlarm();
        if (isFound) ++found;
    }
    return static_cast<double>(found) / runs;
}

TEST(Comparison, SixProcessesApartFindOneOfManyTwiceAsSlow) {
    constexpr int kRuns = gfxrepro::test::kIsSanitized ? 10 : 60;
    for (const double noise : {0.05, test::kCpuNoise, 0.12}) {
        const double share = alarmShare(noise, 0.0, 2.0, kRuns);
        std::printf("  noise %.2f: twice as slow found in %.2f\n", noise, share);
        EXPECT_GE(share, 0.9) << noise;
    }
}

/// No more than by rank sums and the ratio alone, which gave alarms in so many of the same runs.
TEST(Comparison, ADriftOfTheMachineIsSeldomAnAlarm) {
    constexpr int kRuns = gfxrepro::test::kIsSanitized ? 10 : 100;
    const double most[] = {0.0, 0.0, 0.16, 0.27}, movements[] = {0.0, 0.1, 0.3, 0.6};
    for (int i = 0; i < 4; ++i) {
        const double share = alarmShare(test::kCpuNoise, movements[i], 1.0, kRuns);
        std::printf("  drift %.1f: alarms in %.2f\n", movements[i], share);
        if (!gfxrepro::test::kIsSanitized) EXPECT_LE(share, most[i]) << movements[i];
    }
}

/// As of a program that seeds itself: what differs by as much within one side is no change.
TEST(Comparison, NumbersThatScatterAreNotChangedByChance) {
    SeriesKey key = test::timeOf("m");
    key.metric = "rmse";
    key.unit = "1";
    const auto told = [&](const Series& before, const Series& after) {
        return compare({{key, before}}, {{key, after}}, Pairing::Apart).front();
    };
    const Difference alike = told({1, 2, 3, 4, 5, 6}, {1.5, 2.5, 3.5, 4.5, 5.5, 6.5});
    EXPECT_EQ(alike.verdict, SeriesVerdict::CannotTell);
    EXPECT_EQ(alike.reason, "numbers that differ between processes of one side");
    EXPECT_EQ(told({1, 2}, {3, 4}).verdict, SeriesVerdict::CannotTell) << "by chance in a third";
    EXPECT_EQ(told({1, 2}, {3, 4}).reason,
              "numbers that differ between processes of one side; 6 a side tell: `measure: "
              "{processes: 6}`");
    EXPECT_EQ(told({1, 2, 3, 4, 5, 6}, {7, 8, 9, 10, 11, 12}).verdict, SeriesVerdict::Changed);
    EXPECT_EQ(told({1, 2, 3}, {1, 2, 3}).verdict, SeriesVerdict::Same) << "of the same seeds";
    EXPECT_EQ(told({1, 1, 1}, {2, 2, 2}).verdict, SeriesVerdict::Changed);
}

/// A thousand coins: of some all six of one side are heads, and all of the other tails.
TEST(Comparison, CoinsAreNotChangedByChance) {
    constexpr int kRuns = gfxrepro::test::kIsSanitized ? 1 : 100;
    SeriesKey key = test::timeOf("m");
    key.metric = "e";
    key.unit = "1";
    const auto alarms = [&](std::size_t processes, double last) {
        int count = 0;
        for (int run = 0; run < kRuns; ++run) {
            Random random(static_cast<std::uint64_t>(run));
            SeriesMap sides[2];
            for (int i = 0; i < 1000; ++i) {
                key.params = fmt::format(R"({{"i":{}}})", i);
                for (SeriesMap& side : sides) {
                    Series& coins = side[key];
                    for (std::size_t k = 0; k < processes; ++k)
                        coins.push_back(double{random.uniform()} < 0.5 ? 4.0 : 5.0);
                }
            }
            key.params = "{}";
            sides[0][key] = Series(processes, 100.0);
            sides[1][key] = Series(processes, last);
            const auto told =
                compare(sides[0], sides[1], Pairing::Apart, {.unseeded = {{key.table, "p"}}});
            count += std::ranges::count(told, SeriesVerdict::Changed, &Difference::verdict) > 0;
        }
        return count;
    };
    if (!gfxrepro::test::kIsSanitized) {
        EXPECT_LE(alarms(6, 100.0), 0.05 * kRuns);
        EXPECT_LE(alarms(8, 100.0), 0.05 * kRuns);
    }
    EXPECT_EQ(alarms(8, 300.0), kRuns) << "what is alike on either side has changed";
}

/// x = choice(4, 5): two processes are alike in half of the cases.
TEST(Comparison, WhatDiffersInOneCaseIsInDoubtInAll) {
    SeriesKey differs = test::timeOf("m"), alike = differs;
    differs.metric = alike.metric = "x";
    alike.params = R"({"n":2})";
    SeriesKey other = alike;
    other.metric = "y";
    using Programs = std::map<std::string, std::string>;
    const auto told = [&](const Programs& unseeded, const MetricsOfTables& ofSetup = {}) {
        return compare({{differs, {4, 5}}, {alike, {4, 4}}, {other, {4}}},
                       {{differs, {4, 4}}, {alike, {5, 5}}, {other, {5, 5}}}, Pairing::Apart,
                       {.unseeded = unseeded, .ofSetup = ofSetup});
    };
    const std::vector<Difference> differences = told({{differs.table, "p"}});
    const std::string six = "; 6 a side tell: `measure: {processes: 6}`";
    EXPECT_EQ(differences[2].reason, "numbers that differ between processes of one side" + six);
    EXPECT_EQ(differences[0].verdict, SeriesVerdict::CannotTell);
    EXPECT_EQ(differences[0].reason,
              "in other cases it differs between processes of one side" + six);
    EXPECT_EQ(differences[1].verdict, SeriesVerdict::CannotTell) << "one process against two";
    EXPECT_EQ(differences[1].reason,
              "other numbers of the program differ between processes of one side" + six);
    EXPECT_EQ(told({{differs.table, "p"}}, {{other.table, "y"}})[1].verdict, SeriesVerdict::Changed)
        << "of the set-up";
    // As in claims, six processes decide: of two values by chance one in 1,024 is alike in each
    // side and another in the other.
    for (const auto& [count, verdict] :
         {std::pair(5U, SeriesVerdict::CannotTell), {6U, SeriesVerdict::Changed}}) {
        SeriesMap before{{differs, {4, 5}}}, after{{differs, {4, 4}}};
        for (int i = 0; i < 40; ++i) {
            SeriesKey one = other;
            one.params = fmt::format(R"({{"i":{}}})", i);
            before[one] = Series(count, 4.0);
            after[one] = Series(count, i == 0 ? 12.0 : 4.0);
            if (i == 0) other = one;
        }
        const auto often =
            compare(before, after, Pairing::Apart, {.unseeded = {{differs.table, "p"}}});
        EXPECT_EQ(std::ranges::find(often, other, &Difference::key)->verdict, verdict) << count;
        EXPECT_EQ(std::ranges::count(often, SeriesVerdict::Changed, &Difference::verdict),
                  verdict == SeriesVerdict::Changed);
    }
    other.params = alike.params;
    EXPECT_EQ(told({})[0].verdict, SeriesVerdict::Changed) << "of the same seeds";
    EXPECT_EQ(told({})[1].verdict, SeriesVerdict::Changed) << "of the same seeds";
    // Of another table, and of other names.
    const auto beside = [&](const std::string& table, const std::string& metric,
                            const Programs& unseeded) {
        SeriesKey one = other;
        one.table = table;
        one.metric = metric;
        const auto told =
            compare({{differs, {4, 5}}, {one, {4, 4}}}, {{differs, {4, 4}}, {one, {5, 5}}},
                    Pairing::Apart, {.unseeded = unseeded});
        return std::ranges::find(told, one, &Difference::key)->verdict;
    };
    for (const auto& [program, verdict] :
         {std::pair("p", SeriesVerdict::CannotTell), {"q", SeriesVerdict::Changed}}) {
        EXPECT_EQ(beside("t2", "y", {{differs.table, "p"}, {"t2", program}}), verdict);
    }
    EXPECT_EQ(beside("t2", "y", {{differs.table, ""}, {"t2", ""}}), SeriesVerdict::Changed)
        << "of two imports";
    EXPECT_EQ(beside(differs.table, "rmse", {{differs.table, "p"}}), SeriesVerdict::Changed);
    EXPECT_EQ(beside(differs.table, "rmse", {{differs.table, ""}}), SeriesVerdict::CannotTell);
}

/// As the pictures beside it; of a case that declares a seed, or was measured again, it is a
/// change.
TEST(Comparison, ANumberOfOneProcessASideWithoutASeedCannotTell) {
    records::Record record{.caseId = "a",
                           .table = "t",
                           .technique = "external",
                           .lane = "quality",
                           .metric = "rmse",
                           .unit = "1"};
    const auto sideOf = [&](std::vector<double> values) {
        std::vector<records::Record> side;
        for (std::size_t i = 0; i < values.size(); ++i) {
            record.process = static_cast<int>(i);
            record.value = values[i];
            side.push_back(record);
        }
        return side;
    };
    const auto told = [](const std::vector<records::Record>& before,
                         const std::vector<records::Record>& after,
                         const std::set<std::string>& unseeded) {
        std::vector<Difference> differences =
            compare(seriesOf(before, {}), seriesOf(after, {}), Pairing::Apart);
        noteOnce(differences, onceOf(before, {}, unseeded), onceOf(after, {}, unseeded));
        return differences.front();
    };
    const Difference once = told(sideOf({0.5}), sideOf({0.6}), {"a"});
    EXPECT_EQ(once.verdict, SeriesVerdict::CannotTell);
    EXPECT_EQ(
        once.reason,
        "one process of each side, and no seed is declared; two a side tell whether they differ");
    EXPECT_EQ(told(sideOf({0.5}), sideOf({0.6}), {}).verdict, SeriesVerdict::Changed)
        << "of a seed";
    EXPECT_EQ(told(sideOf({0.5, 0.5}), sideOf({0.6}), {"a"}).verdict, SeriesVerdict::Changed);
    EXPECT_EQ(told(sideOf({0.5}), sideOf({0.5}), {"a"}).verdict, SeriesVerdict::Same);
}

TEST(Comparison, TellsWhyRunsMeasuredApartCannotDecide) {
    const auto reason = [](const Series& after) {
        SeriesMap before, later;
        for (int i = 0; i < 36; ++i) {
            const SeriesKey key = test::timeOf("m" + std::to_string(i));
            before[key] = later[key] = {10, 10.1, 10.2, 9.9};
        }
        later[test::timeOf("m0")] = after;
        return compare(before, later, Pairing::Apart).front().reason;
    };
    EXPECT_EQ(reason({20, 20.2, 20.4, 19.8}), "") << "slower";
    EXPECT_EQ(reason({12, 12.1, 12.2, 11.9}), "measured apart: a machine may drift by 50 %");
    EXPECT_EQ(reason({20, 21, 22, 14}),
              "the interval reaches into the 50 % by which a machine may drift");
    EXPECT_EQ(reason({16, 30, 60, 90}),
              "4 and 4 processes cannot decide among 36 series: 6 a side are needed");
    EXPECT_EQ(reason({20, 20.1, 20.2}),
              "4 and 3 processes cannot decide: 4 a side are needed, 5 beside 3, or 8 beside 2");
}

TEST(Comparison, SaysHowManyProcessesDecideMeasuredApart) {
    const auto decides = [](int before, int after) {
        Series times[2];
        for (double i = 0; i < before; ++i) times[0].push_back(10.0 + 0.1 * i);
        for (double i = 0; i < after; ++i) times[1].push_back(40.0 + 0.1 * i);
        const SeriesKey key = test::timeOf("m");
        const auto told = compare({{key, times[0]}}, {{key, times[1]}}, Pairing::Apart);
        return told.front().verdict == SeriesVerdict::Slower;
    };
    EXPECT_TRUE(decides(4, 4) && decides(5, 3) && decides(3, 5) && decides(8, 2) && decides(2, 8));
    EXPECT_FALSE(decides(4, 3) || decides(7, 2) || decides(20, 1));
}

TEST(Comparison, FindsFasterAndTheSame) {
    Random random(6);
    const SeriesMap before = test::measured(random, 1, 40, 1.0);
    const auto verdict = [&](double change) {
        const SeriesMap after = test::measured(random, 1, 40, 1.0, change);
        return compare(before, after, Pairing::ByTurns).front().verdict;
    };
    EXPECT_EQ(verdict(0.8), SeriesVerdict::Faster);
    EXPECT_EQ(verdict(1.0), SeriesVerdict::Same);
    EXPECT_EQ(verdict(1.3), SeriesVerdict::Slower);
}

TEST(Comparison, StopsWhenAllIsDecided) {
    int looks = 0;
    const auto measure = [&](Sides& sides, const std::set<std::string>&) {
        ++looks;
        for (const char* method : {"a", "b", "c"}) {
            for (int i = 0; i < 8; ++i) {
                sides.before[test::timeOf(method)].push_back(10.0 + 0.01 * (i % 3));
                sides.after[test::timeOf(method)].push_back(10.0 + 0.01 * (i % 5));
            }
        }
    };
    for (const Difference& difference : compareByTurns(measure)) {
        EXPECT_EQ(difference.verdict, SeriesVerdict::Same);
    }
    EXPECT_EQ(looks, 1);
}

TEST(Comparison, ConfirmsTheTablesWithAlarmsAlone) {
    std::vector<std::set<std::string>> asked;
    const auto measure = [&](Sides& sides, const std::set<std::string>& tables) {
        asked.push_back(tables);
        for (const char* table : {"a/1", "b/1"}) {
            if (!tables.empty() && !tables.contains(table)) continue;
            SeriesKey key = test::timeOf("m");
            key.table = table;
            for (int i = 0; i < 8; ++i) {
                sides.before[key].push_back(10.0 + 0.01 * i);
                sides.after[key].push_back((key.table == "a/1" ? 12.0 : 10.01) + 0.01 * i);
            }
        }
    };
    const std::vector<Difference> differences = compareByTurns(measure);
    EXPECT_EQ(differences[0].verdict, SeriesVerdict::Slower);
    EXPECT_EQ(differences[1].verdict, SeriesVerdict::Same);
    // Eight rounds cannot decide among two series: those of a/1 go on, and are confirmed.
    EXPECT_EQ(asked, (std::vector<std::set<std::string>>{{}, {"a/1"}, {"a/1"}}));
}

TEST(Comparison, FewRoundsCannotTell) {
    const auto reason = [](const Series& before, const Series& after, Pairing pairing) {
        return compare({{test::timeOf("m"), before}}, {{test::timeOf("m"), after}}, pairing)
            .front()
            .reason;
    };
    EXPECT_EQ(reason({10}, {20}, Pairing::Apart),
              "1 and 1 processes cannot decide: 4 a side are needed, 5 beside 3, or 8 beside 2");
    EXPECT_EQ(reason({10}, {20}, Pairing::ByTurns),
              "1 rounds cannot decide among one series: 8 are needed");
    EXPECT_EQ(reason({0, 1, 1, 1, 1}, {1, 1, 1, 1, 1}, Pairing::Apart), "a time of zero or less");
    EXPECT_EQ(reason({10, 10}, {20}, Pairing::ByTurns), "measured in 2 and 1 rounds: no pairs");
    // Eight rounds of which all are slower: a chance of 1/128.
    Random random(8);
    const SeriesMap before = test::measured(random, 10, 8, 1.0);
    for (const Difference& difference :
         compare(before, test::measured(random, 10, 8, 1.0, 1.5), Pairing::ByTurns)) {
        EXPECT_EQ(difference.verdict, SeriesVerdict::CannotTell);
        EXPECT_EQ(difference.reason, "8 rounds cannot decide among 10 series: 11 are needed");
    }
}

TEST(Comparison, AnUnsteadyBuildRaisesTheFloor) {
    const Series steady = {10, 10.01, 9.99, 10, 10.02, 10, 10, 9.98, 10, 10, 10.01, 10};
    const Series unsteady = {10, 13, 9, 14, 8, 12, 10, 15, 9, 11, 12, 10};
    EXPECT_EQ(detectableChange(steady, {}), Rules{}.effectFloor);
    EXPECT_GT(detectableChange(unsteady, {}), 0.05);
    EXPECT_EQ(detectableChange({10, 13, 9, 14}, {}), Rules{}.effectFloor) << "too few to say";
}

TEST(Comparison, AParameterThatOneBuildDoesNotKnowIsNoDifference) {
    const auto key = [](const char* params) {
        SeriesKey key = test::timeOf("m");
        key.params = params;
        return key;
    };
    const Series values = {10, 10, 10, 10, 10, 10};
    const auto matched = compare(
        {{key(R"({"size":1})"), values}, {key(R"({"size":2})"), values}},
        {{key(R"({"size":1,"new":false})"), values}, {key(R"({"size":2,"new":false})"), values}},
        Pairing::ByTurns);
    ASSERT_EQ(matched.size(), 2U);
    EXPECT_EQ(matched[0].verdict, SeriesVerdict::Same);
    EXPECT_EQ(matched[0].key.params, R"({"size":1})");
    // Varied by one side: it cannot be left away.
    const auto varied = compare(
        {{key(R"({"size":1})"), values}},
        {{key(R"({"size":1,"new":false})"), values}, {key(R"({"size":1,"new":true})"), values}},
        Pairing::Apart);
    ASSERT_EQ(varied.size(), 3U);
    EXPECT_EQ(std::ranges::count(varied, SeriesVerdict::Missing, &Difference::verdict), 2);
    EXPECT_EQ(std::ranges::count(varied, SeriesVerdict::Lost, &Difference::verdict), 1);
}

TEST(Comparison, WhatIsThereOnOneSideAloneHasNoNumberOnTheOther) {
    const Series values = {10, 10, 10, 10, 10, 10};
    Comparison comparison;
    comparison.differences =
        compare({{test::timeOf("a"), values}}, {{test::timeOf("b"), values}}, Pairing::ByTurns);
    const std::string text = markdown(comparison);
    EXPECT_THAT(text, HasSubstr(" | 10 |  | ")) << "a";
    EXPECT_THAT(text, HasSubstr(" |  | 10 ms | ")) << "b";
    EXPECT_THAT(text, Not(HasSubstr("| 0 ms |")));
}

TEST(Comparison, WhatFailsAfterwardsAloneIsAnAlarm) {
    const SeriesKey a = test::timeOf("a"), b = test::timeOf("b"), c = test::timeOf("c");
    const Series values = {10, 10, 10, 10, 10, 10};
    const auto failed = [](SeriesKey key) {
        key.metric = "status";
        key.unit = "";
        return std::pair{key, std::string("crash: SIGSEGV")};
    };
    std::vector<Difference> differences =
        compare({{a, values}, {b, values}}, {{b, values}, {c, values}}, Pairing::ByTurns);
    EXPECT_EQ(std::ranges::count_if(differences, &Difference::isAlarm), 1);
    EXPECT_EQ(differences[0].reason, "measured before only");
    noteFailures(differences, {failed(c)}, {failed(a), failed(b), failed(c)});
    ASSERT_EQ(differences.size(), 5U) << "that of b had some rounds only";
    for (const Difference& difference : differences) {
        const bool isLost = difference.verdict == SeriesVerdict::Lost;
        EXPECT_EQ(difference.isAlarm(), isLost);
        if (isLost) EXPECT_EQ(difference.reason, "crash: SIGSEGV");
    }
    EXPECT_EQ(std::ranges::count_if(differences, &Difference::isAlarm), 2);
    EXPECT_EQ(differences[3].verdict, SeriesVerdict::Failed);
    EXPECT_EQ(differences[4].reason, "measured after only: crash: SIGSEGV") << "c";
}

TEST(Comparison, WhatFailedOnBothSidesIsNamed) {
    SeriesKey a = test::timeOf("a"), b = a;
    a.metric = b.metric = "status";
    a.unit = b.unit = "";
    a.params = R"({"size":1})";
    b.params = R"({"size":1,"new":true})";  // of a build that knows more
    std::vector<Difference> differences;
    noteFailures(differences, {{a, "timeout"}}, {{b, "crash: SIGSEGV"}});
    ASSERT_EQ(differences.size(), 1U);
    EXPECT_EQ(differences[0].verdict, SeriesVerdict::Failed);
    EXPECT_EQ(differences[0].reason, "before timeout; after crash: SIGSEGV");
    EXPECT_FALSE(differences[0].isAlarm());
    // What passed at the second try had been measured.
    differences.clear();
    noteFailures(differences, {{a, "flaky: timeout"}}, {{a, "crash: SIGSEGV"}});
    ASSERT_EQ(differences.size(), 1U);
    EXPECT_EQ(differences[0].verdict, SeriesVerdict::Lost);
    differences.clear();
    noteFailures(differences, {{a, "flaky: timeout"}}, {{a, "flaky: timeout"}});
    EXPECT_FALSE(differences.at(0).isAlarm());
    // Another case of the same title is no excuse.
    SeriesKey other = a;
    other.params = R"({"size":2})";
    differences.clear();
    noteFailures(differences, {{a, "timeout"}}, {{a, "timeout"}, {other, "timeout"}});
    ASSERT_EQ(differences.size(), 2U);
    EXPECT_EQ(differences[0].reason, "timeout");
    EXPECT_EQ(differences[1].verdict, SeriesVerdict::Lost);
}

TEST(Comparison, ATimeThatIsVoidOnBothSidesIsNoTime) {
    const SeriesKey key = test::timeOf("m");
    SeriesKey status = key;
    status.metric = "status";
    status.unit = "";
    const double none = std::numeric_limits<double>::quiet_NaN();
    const Series voided(6, none), stands(6, 10.0);
    const CaseTexts why = {{status, "frame 0: blank"}};
    const auto compared = [&](const Series& before, const Series& after, Pairing pairing) {
        std::vector<Difference> all = compare({{key, before}}, {{key, after}}, pairing);
        const auto isVoid = [](const Series& side) { return standing(side).size() < side.size(); };
        noteVoidTimes(all, isVoid(before) ? why : CaseTexts(), isVoid(after) ? why : CaseTexts());
        EXPECT_EQ(all.size(), 1U);
        return all.front();
    };
    for (const Pairing pairing : {Pairing::ByTurns, Pairing::Apart}) {
        const Difference both = compared(voided, voided, pairing);
        EXPECT_EQ(both.verdict, SeriesVerdict::Void);
        EXPECT_EQ(both.reason, "frame 0: blank");
        EXPECT_FALSE(both.isAlarm());
        const Difference after = compared(stands, voided, pairing);
        EXPECT_EQ(after.verdict, SeriesVerdict::Lost);
        EXPECT_EQ(after.reason, "its times are void: frame 0: blank");
        const Difference before = compared(voided, stands, pairing);
        EXPECT_EQ(before.verdict, SeriesVerdict::Missing);
        EXPECT_EQ(before.reason, "measured after only: void before: frame 0: blank");
    }
    // Rounds in which one side is void are left out: the others are the pairs that they were.
    const Series a = {10, none, 20, 10, 20, 10, 20, 10}, b = {10, 20, none, 10, 20, 10, 20, 10};
    EXPECT_EQ(compared(a, b, Pairing::ByTurns).verdict, SeriesVerdict::Same);
    const Difference apart = compared({10, none}, {none, 10}, Pairing::ByTurns);
    EXPECT_EQ(apart.verdict, SeriesVerdict::CannotTell);
    EXPECT_EQ(apart.reason,
              "no round in which both sides' times stand (void in some rounds: frame 0: blank)");
}

TEST(Comparison, QualityIsTheSameOrChanged) {
    SeriesKey key = test::timeOf("m");
    key.metric = "psnr_db";
    key.unit = "dB";
    const auto verdict = [&](double after) {
        return compare({{key, {40.0}}}, {{key, {after}}}, Pairing::Apart).front().verdict;
    };
    EXPECT_EQ(verdict(40.0), SeriesVerdict::Same);
    EXPECT_EQ(verdict(40.001), SeriesVerdict::Same) << "what the order of parallel sums may do";
    EXPECT_EQ(verdict(39.9), SeriesVerdict::Changed);
    const auto count = [&](double after) {
        return compare({{key, {1e6}}}, {{key, {after}}}, Pairing::Apart).front().verdict;
    };
    EXPECT_EQ(count(1e6 + 1), SeriesVerdict::Changed) << "counts are exact";
    const double infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(verdict(infinity), SeriesVerdict::Changed);
    EXPECT_EQ(compare({{key, {infinity}}}, {{key, {infinity}}}, Pairing::Apart).front().verdict,
              SeriesVerdict::Same);
    EXPECT_EQ(compare({{key, {40.0}}}, {}, Pairing::Apart).front().reason, "measured before only");
    EXPECT_EQ(compare({}, {{key, {40.0}}}, Pairing::Apart).front().reason, "measured after only");
}

TEST(Comparison, AnAlarmThatDoesNotComeBackCannotTell) {
    Difference alarm{.key = test::timeOf("m"), .verdict = SeriesVerdict::Slower};
    std::vector<Difference> once = {alarm};
    confirm(once, {alarm});
    EXPECT_EQ(once[0].verdict, SeriesVerdict::Slower);
    alarm.verdict = SeriesVerdict::Same;
    confirm(once, {alarm});
    EXPECT_EQ(once[0].verdict, SeriesVerdict::CannotTell);
    EXPECT_EQ(once[0].reason, "slower once, not when measured again");
}

TEST(Comparison, CpuTimeStandsForTheClockOnASoftwareDevice) {
    const SeriesKey clock = test::timeOf("m");
    SeriesKey process = clock;
    process.metric = "process_time_ms";
    const Series ten(12, 10.0), twenty(12, 20.0);
    const SeriesMap before = {{clock, ten}, {process, ten}};
    const SeriesMap after = {{clock, twenty}, {process, ten}};
    const auto keys = [&](const SeriesMap& newer, bool isByProcess) {
        Rules rules;
        if (isByProcess) rules.byProcess = {clock.table};
        std::vector<std::string> metrics;
        for (const Difference& difference : compare(before, newer, Pairing::ByTurns, rules)) {
            metrics.push_back(difference.key.metric + ": " +
                              std::string(verdictName(difference.verdict)));
        }
        return metrics;
    };
    using Metrics = std::vector<std::string>;
    EXPECT_EQ(keys(after, true), Metrics{"process_time_ms: same"});
    // A program may wait: all of its times are watched.
    EXPECT_EQ(keys(after, false), (Metrics{"process_time_ms: same", "wall_time_ms: slower"}));
    // A build that does not record it yet.
    EXPECT_EQ(keys({{clock, twenty}}, true), Metrics{"wall_time_ms: slower"});
}

records::Record recordOf(const std::string& metric, const std::string& unit, double value) {
    return records::Record{
        .table = "p/1", .lane = "timing", .metric = metric, .unit = unit, .value = value};
}

TEST(SeriesOf, TakesFramesTimesOfTheTimingLaneOnly) {
    records::Record record = recordOf("wall_time_ms", "ms", 0.0);
    std::vector<records::Record> records;
    for (const double value : {3.0, 1.0, 2.0}) {
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
    record.status = records::Status::Crash;
    records.push_back(record);
    const SeriesMap series = seriesOf(records, {});
    ASSERT_EQ(series.size(), 1U);
    EXPECT_EQ(series.begin()->second, (Series{2.0, 4.0}));
    EXPECT_EQ(series.begin()->first.title(), "p/1  wall_time_ms");
}

TEST(SeriesOf, ATimeWithAFrameThatIsVoidIsVoid) {
    std::vector<records::Record> records(2, recordOf("wall_time_ms", "ms", 3.0));
    records[1].frame = 1;
    records[1].status = records::Status::Ambiguous;
    records[1].message = "frame 1: blank";
    SeriesMap series = seriesOf(records, {});
    ASSERT_EQ(series.size(), 1U);
    ASSERT_EQ(series.begin()->second.size(), 1U);
    EXPECT_TRUE(standing(series.begin()->second).empty()) << "the other frames are another time";
    const CaseTexts texts = voidTimesOf(records, {});
    ASSERT_EQ(texts.size(), 1U);
    EXPECT_EQ(texts.begin()->second, "frame 1: blank");
    EXPECT_TRUE(failuresOf(records, {}).empty());
    EXPECT_EQ(untimedCases(records), 0U);
    records[1].lane = "quality";
    EXPECT_EQ(untimedCases(records), 1U);
    EXPECT_EQ(seriesOf(records, {}).begin()->second, Series{3.0});
}

TEST(SeriesOf, TakesNothingElseThatIsMadeOfTimes) {
    std::vector<records::Record> records = {recordOf("frame_rate", "1/s", 1),
                                            recordOf("setup_time_ms", "ms", 1),
                                            recordOf("load_time_ms", "ms", 1),
                                            recordOf("preprocess_ms", "ms", 1),
                                            recordOf("points_per_second", "point/s", 1),
                                            recordOf("time_fit_r_squared", "1", 1),
                                            recordOf("work_fragments", "fragment", 1),
                                            recordOf("peak_memory_bytes", "byte", 1),
                                            recordOf("wall_time_ms", "ms", 1),
                                            recordOf("voxels", "voxel", 7)};
    records[8].pass = "draw";
    const SeriesMap series = seriesOf(records, {});
    ASSERT_EQ(series.size(), 1U);
    EXPECT_EQ(series.begin()->first.metric, "voxels");
}

TEST(SeriesOf, OfAProgramTakesItsOwnTimesToo) {
    std::vector<records::Record> records = {
        recordOf("wall_time_ms", "ms", 1), recordOf("render_ms", "ms", 2),
        recordOf("rays_per_second", "ray/s", 3), recordOf("setup_time_ms", "ms", 4)};
    records[3].frame = records[3].repeat = records::kSetup;
    const auto titles = [&](const Tables& byClock) {
        std::vector<std::string> all;
        for (const auto& [key, values] : seriesOf(records, {}, byClock)) {
            EXPECT_TRUE(key.isTime());
            all.push_back(key.metric);
        }
        return all;
    };
    using Titles = std::vector<std::string>;
    EXPECT_EQ(titles({"p/1"}), (Titles{"render_ms", "wall_time_ms"}));
    EXPECT_EQ(titles({"p/2"}), Titles{"wall_time_ms"});
    records[1].lane = "quality";
    EXPECT_EQ(titles({"p/1"}), Titles{"wall_time_ms"});
}

TEST(SeriesOf, TheLastOfTwoValuesOfOnePlaceCounts) {
    const std::vector<records::Record> records = {recordOf("triangles", "triangle", 5),
                                                  recordOf("triangles", "triangle", 7)};
    EXPECT_EQ(seriesOf(records, {}).begin()->second, Series{7.0});
}

TEST(SeriesOf, SetUpCountsWhereNoFrameHasTheSame) {
    std::vector<records::Record> records = {recordOf("nodes", "node", 5),
                                            recordOf("nodes", "node", 7)};
    records[0].frame = records[0].repeat = records::kSetup;
    EXPECT_EQ(seriesOf(records, {}).begin()->second, Series{7.0});
    records.pop_back();
    EXPECT_EQ(seriesOf(records, {}).begin()->second, Series{5.0});
}

}  // namespace
}  // namespace gfxrepro::regression
