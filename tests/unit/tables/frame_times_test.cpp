#include "runner/tables/frame_times.h"

#include <algorithm>
#include <vector>

#include "tests/support/support.h"
#include "tests/unit/tables/fixture.h"

namespace gfxrepro::tables {
namespace {

FrameTimes timesOf(const RecordMaker& maker) {
    FrameTimes times;
    for (const records::Record& record : maker.records()) times.add(record);
    return times;
}

config::Measure measureOf(int processes, double timeBudgetS = 0.0) {
    return config::Measure{
        .lane = config::Measure::Lane::Timing, .processes = processes, .timeBudgetS = timeBudgetS};
}

/// One case, a process a value; CPU time is half of the time on the wall.
RecordMaker rounds(const std::vector<double>& valuesMs) {
    RecordMaker maker;
    maker.beginCase("models/duck");
    int process = 0;
    for (const double value : valuesMs) {
        maker.process(process++).add("wall_time_ms", {value});
        maker.add("process_time_ms", {value / 2.0});
    }
    return maker;
}

TEST(FrameTimes, SumsTheFramesOfARound) {
    RecordMaker maker;
    maker.beginCase("a").process(0).frame(0).add("wall_time_ms", {10, 12, 90});
    maker.frame(1).add("wall_time_ms", {20});
    maker.process(1).frame(0).add("wall_time_ms", {11});  // a frame is missing
    maker.beginCase("b").add("wall_time_ms", {5}, "draw").add("gpu_time_ms", {4});
    const FrameTimes times = timesOf(maker);
    EXPECT_THAT(times.times(Clock::Wall), ElementsAre(ElementsAre(Pair(0, 32.0))));
    EXPECT_EQ(times.roundCount(), 2U);
    EXPECT_TRUE(times.hasRounds(maker.records()[0].caseId, 2));
    EXPECT_FALSE(times.hasRounds(maker.records()[0].caseId, 3));
    EXPECT_FALSE(times.hasRounds("another", 1));
}

TEST(FrameTimes, PassesOverWhatIsNoTimeOfAFrame) {
    RecordMaker maker;
    maker.beginCase("a").lane("quality").add("wall_time_ms", {10});
    EXPECT_EQ(timesOf(maker).roundCount(), 0U);
    EXPECT_TRUE(timeNotes(timesOf(maker), measureOf(1)).empty());
}

TEST(FrameTimes, RelativeErrorNeedsSixRounds) {
    EXPECT_EQ(timesOf(rounds({10, 10, 10, 10, 10})).relativeError(), std::nullopt);
    // The interval of six is their range.
    EXPECT_DOUBLE_EQ(*timesOf(rounds({9, 10, 10, 10, 10, 11})).relativeError(), 0.1);
    RecordMaker two = rounds({9, 10, 10, 10, 10, 11});
    two.beginCase("models/bunny").process(0).add("wall_time_ms", {1});
    two.add("process_time_ms", {1});
    EXPECT_DOUBLE_EQ(*timesOf(two).relativeError(), 0.1) << "a case that failed is left out";
}

TEST(FrameTimes, EndsAtARelativeErrorWithNewValuesInTheInterval) {
    const auto isKnown = [](const std::vector<double>& valuesMs, int asked = 6) {
        return timesOf(rounds(valuesMs)).isKnownTo(0.1, asked);
    };
    // Rounds of 10 ms, but for those that are given: the first, the sixth, and so on.
    const auto values = [](std::size_t count, std::initializer_list<double> lows,
                           std::initializer_list<double> highs) {
        std::vector<double> all(count, 10.0);
        std::ranges::copy(lows, all.begin());
        std::ranges::copy(highs, all.end() - static_cast<std::ptrdiff_t>(highs.size()));
        return all;
    };
    EXPECT_FALSE(isKnown(values(5, {}, {}))) << "no interval";
    for (const std::size_t few : {6U, 8U, 11U, 13U}) EXPECT_FALSE(isKnown(values(few, {}, {})));
    EXPECT_TRUE(isKnown(values(14, {}, {})));
    EXPECT_FALSE(isKnown(values(15, {}, {}))) << "sixteen end as far from their ends";
    EXPECT_TRUE(isKnown(values(16, {}, {})));
    EXPECT_TRUE(isKnown(values(14, {}, {20, 20}))) << "whatever followed";
    // Three of either side leave the interval only when a fourth value is left out: from 15 on.
    EXPECT_FALSE(isKnown(values(14, {8, 8, 8, 12, 12, 12}, {})));
    EXPECT_FALSE(isKnown(values(16, {8, 8, 8, 12, 12, 12}, {}))) << "found at the fifteenth";
    EXPECT_TRUE(isKnown(values(19, {8, 8, 8, 12, 12, 12}, {})));
    // The first look is after as many as were asked for.
    EXPECT_FALSE(isKnown(values(14, {}, {}), 13));
    EXPECT_TRUE(isKnown(values(14, {}, {}), 12));
    EXPECT_FALSE(timesOf(RecordMaker()).isKnownTo(0.1, 6));
}

/// A program that waits: its CPU time is known, and the clock that its table shows is not.
TEST(FrameTimes, OfAProgramTheClockIsKnown) {
    const auto known = [](bool isOfProgram, bool isWallEven, bool isCpuEven) {
        FrameTimes times(isOfProgram);
        RecordMaker maker;
        maker.beginCase("models/duck");
        for (int process = 0; process < 14; ++process) {
            const double uneven = process % 2 == 0 ? 1.0 : 1.5;
            maker.process(process).add("wall_time_ms", {isWallEven ? 500.0 : 500.0 * uneven});
            maker.add("process_time_ms", {isCpuEven ? 2.0 : 2.0 * uneven});
        }
        for (const records::Record& record : maker.records()) times.add(record);
        EXPECT_THAT(
            timeNotes(times, measureOf(6, 60)).at(0),
            HasSubstr(isOfProgram ? "; the time of a frame is " : "; the CPU time of a frame is "));
        return times.isKnownTo(0.1, 6);
    };
    EXPECT_TRUE(known(true, true, true));
    EXPECT_FALSE(known(true, false, true));
    EXPECT_TRUE(known(true, true, false));
    EXPECT_TRUE(known(false, false, true)) << "what draws on all cores is judged by its work";
}

TEST(FrameTimes, NoiseIsOfPairsMeasuredByTurns) {
    RecordMaker maker;
    const double drift[] = {1.0, 1.5, 2.0, 1.2, 3.0, 1.1};  // of the machine, alike for both
    for (const char* scene : {"a", "b"}) {
        maker.beginCase(scene);
        for (int i = 0; i < 6; ++i) {
            const double own = *scene == 'b' ? 2.0 : 1.0;
            maker.process(i).add("wall_time_ms", {10.0 * own * drift[i]});
        }
    }
    EXPECT_NEAR(*timesOf(maker).noise(Clock::Wall), 0.0, 1e-12);
    EXPECT_EQ(timesOf(maker).noise(Clock::Process), std::nullopt);
    // One case alone: its own interval, as if there were another.
    EXPECT_GT(*timesOf(rounds({9, 10, 10, 10, 10, 11})).noise(Clock::Wall), 0.1);
    EXPECT_EQ(timesOf(rounds({9, 10, 11})).noise(Clock::Wall), std::nullopt);
}

TEST(FrameTimes, OutliersAmongRoundsAndAmongFrames) {
    EXPECT_THAT(outlierTexts(timesOf(rounds({10, 10, 49, 10}))), ElementsAre());
    EXPECT_THAT(
        outlierTexts(timesOf(rounds({10, 10, 55, 10}))),
        ElementsAre(
            "Outlier: frame 0 of models/duck took 55 ms in process 3, 5.5 times its fellows."));
    // One process of a path: its frames are fellows.
    RecordMaker path;
    path.beginCase("bathroom", R"({"method":"reuse"})");
    const double times[] = {88, 775, 286, 88, 72};
    for (int frame = 0; frame < 5; ++frame) path.frame(frame).add("wall_time_ms", {times[frame]});
    EXPECT_THAT(outlierTexts(timesOf(path)),
                ElementsAre("Outlier: frame 1 of bathroom reuse took 775 ms in process 1, 8.81 "
                            "times its fellows."));
    EXPECT_THAT(outlierTexts(timesOf(rounds({10, 99}))), ElementsAre()) << "which of the two?";
}

TEST(FrameTimes, ARowNamesTheOutlierOfAUsersOwnTable) {
    const config::Experiment experiment = experimentFrom(
        "scene: /home/me/room.glb\nsweep: {light_grid: [4, 8]}\n"
        "measure: {lane: timing, processes: 4}\n"
        "layout:\n  rows: light_grid\n  columns: {ms: {metric: wall_time_ms}}\n");
    RecordMaker maker;
    for (const char* params :
         {R"({"light_grid":4,"method":"x"})", R"({"light_grid":8,"method":"x"})"}) {
        maker.beginCase("/home/me/room.glb", params);
        for (int i = 0; i < 4; ++i) {
            const bool isLate = i == 2 && std::string(params).find('8') != std::string::npos;
            maker.process(i).add("wall_time_ms", {isLate ? 60.0 : 10.0});
        }
    }
    EXPECT_THAT(
        buildTable(experiment, maker.records()).notes,
        Contains("Outlier: frame 0 of light grid 8 took 60 ms in process 3, 6 times its fellows."));
}

TEST(FrameTimes, NotesSayWhatEndedTheRounds) {
    const auto first = [](std::initializer_list<double> valuesMs, const config::Measure& measure) {
        return timeNotes(timesOf(rounds(valuesMs)), measure).at(0);
    };
    EXPECT_EQ(first({10, 11}, measureOf(2)),
              "Times of 2 processes: bounds are a range, no interval (which takes 6), and no claim "
              "about a time is decided.");
    config::Measure own = measureOf(6, 60);  // of who names no lane
    own.isWithinBudget = true;
    EXPECT_EQ(first({10, 11}, own),
              "Times of 2 processes: bounds are a range, no interval (which takes 6), and no claim "
              "about a time is decided. All rounds together have 60 s; `--set "
              "measure.time_budget_s=…` allows more.");
    EXPECT_EQ(first({9, 10, 10, 10, 10, 11}, measureOf(6)),
              "Times of 6 rounds, as many as asked for; the CPU time of a frame is known to ±10 % "
              "or better.");
    EXPECT_EQ(
        first({9.9, 9.9, 9.9, 10, 10, 10, 10, 10, 10, 10, 10, 10.1, 10.1, 10.1}, measureOf(6, 60)),
        "Times of 14 rounds, until the times were known; the CPU time of a frame is known to ±1 % "
        "or better (asked for: 5 %).");
    EXPECT_THAT(first({9, 10, 10, 10, 10, 11}, measureOf(6, 60)),
                HasSubstr("as many as the time allowed"));
    EXPECT_THAT(first({9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 12, 12, 12, 12, 12, 12, 12, 12, 12, 12},
                      measureOf(6, 60)),
                HasSubstr("the most that are allowed"));
    EXPECT_THAT(
        timeNotes(timesOf(rounds({10, 10, 10, 10, 10, 10})), measureOf(6)).at(1),
        HasSubstr(
            "Noise of this table: two equal cases would differ by up to 0 %, by CPU time 0 %."));
}

TEST(FrameTimes, NotesStandUnderTablesOfTimes) {
    const config::Experiment experiment = experimentFrom(
        "sweep: {scene: [models/duck]}\nmeasure: {lane: timing, processes: 6}\n"
        "layout:\n  rows: scene\n  columns: {ms: {metric: wall_time_ms, format: "
        "\"{median:.0f}\"}}\n");
    const RecordMaker maker = rounds({9, 10, 10, 10, 10, 11});
    const Table table = buildTable(experiment, maker.records());
    EXPECT_EQ(table.rows.at(0).cells.at(0).measured, "10");
    EXPECT_EQ(table.rows.at(0).cells.at(0).low, "9");
    EXPECT_EQ(table.notes.size(), 2U);
    EXPECT_GT(table.noise(Clock::Process), 0.1);
}

}  // namespace
}  // namespace gfxrepro::tables
