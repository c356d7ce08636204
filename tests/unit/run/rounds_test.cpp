#include "runner/run/rounds.h"

#include "tests/support/support.h"
#include "tests/unit/run/plan_fixture.h"

namespace gfxrepro::test {
namespace {

using Lane = config::Measure::Lane;
using TimePoint = run::Rounds::TimePoint;

/// q/1 with two cases, t/1 with three that are timed in six rounds or more.
run::Plan timedPlan() {
    run::Plan plan{.cases = {makeCase("q/1", "a", 1), makeCase("q/1", "b", 1),
                             makeCase("t/1", "a", 1, Lane::Timing),
                             makeCase("t/1", "b", 1, Lane::Timing),
                             makeCase("t/1", "c", 1, Lane::Timing)}};
    for (config::Case& item : plan.cases) {
        if (item.measure.lane == Lane::Quality) continue;
        item.measure.processes = 6;
        item.measure.timeBudgetS = 100.0;
    }
    return plan;
}

records::Record timeRow(const config::Case& item, double timeMs, int process) {
    records::Record row = makeRow(item, timeMs, process);
    row.metric = "wall_time_ms";
    return row;
}

/// Rounds 0 … `count` − 1 of t/1; `noise` is the last one's, as a share.
std::vector<records::Record> rows(const run::Plan& plan, int count, double noise) {
    std::vector<records::Record> rows;
    for (int process = 0; process < count; ++process) {
        for (std::size_t i = 2; i < plan.cases.size(); ++i) {
            const double factor = process == count - 1 ? 1.0 + noise : 1.0;
            rows.push_back(timeRow(plan.cases[i], 10.0 * factor, process));
        }
    }
    return rows;
}

std::vector<std::string> namesOf(const std::vector<run::Unit>& units) {
    std::vector<std::string> names;
    for (const run::Unit& unit : units) {
        names.push_back(unit.item->id + " #" + std::to_string(unit.process));
    }
    return names;
}

TimePoint after(double seconds) {
    return TimePoint() + std::chrono::milliseconds(static_cast<int>(1e3 * seconds));
}

TEST(Units, GoForthAndBackByRounds) {
    run::Plan plan = timedPlan();
    for (config::Case& item : plan.cases) item.measure.processes = 3;
    EXPECT_THAT(namesOf(run::unitsOf(plan)),
                ElementsAre("q/1 a 1 #0", "q/1 b 1 #0", "q/1 a 1 #1", "q/1 b 1 #1", "q/1 a 1 #2",
                            "q/1 b 1 #2", "t/1 a 1 #0", "t/1 b 1 #0", "t/1 c 1 #0", "t/1 c 1 #1",
                            "t/1 b 1 #1", "t/1 a 1 #1", "t/1 a 1 #2", "t/1 b 1 #2", "t/1 c 1 #2"));
}

TEST(Units, SpreadTheRoundsOfATableOverTheRun) {
    run::Plan plan{.cases = {makeCase("t/1", "a", 1, Lane::Timing),
                             makeCase("t/1", "b", 1, Lane::Timing), makeCase("q/1", "a", 1),
                             makeCase("t/2", "a", 1, Lane::Timing),
                             makeCase("t/3", "a", 1, Lane::Timing)}};
    for (const std::size_t i : {0, 1, 4}) plan.cases[i].measure.processes = 2;
    EXPECT_THAT(namesOf(run::unitsOf(plan)),
                ElementsAre("q/1 a 1 #0", "t/1 a 1 #0", "t/1 b 1 #0", "t/3 a 1 #0", "t/2 a 1 #0",
                            "t/1 b 1 #1", "t/1 a 1 #1", "t/3 a 1 #1"))
        << "the only round of t/2 is in the middle";
}

TEST(Units, OfARoundThatWasBegun) {
    const run::Plan plan = timedPlan();
    std::vector<records::Record> records = rows(plan, 6, 0.0);
    EXPECT_EQ(run::unitsOf(plan, records).size(), 2U + 18U);
    records.push_back(timeRow(plan.cases[2], 10.0, 6));
    EXPECT_EQ(run::unitsOf(plan, records).size(), 2U + 21U);
    // A case that failed in an earlier round takes no part in further ones.
    records[1].status = records::Status::Crash;
    EXPECT_EQ(run::unitsOf(plan, records).size(), 2U + 20U);
}

TEST(Rounds, EndAtTheRelativeError) {
    const run::Plan plan = timedPlan();
    run::Rounds rounds(plan, {}, {});
    EXPECT_THAT(rounds.undecided(), ElementsAre("t/1"));
    rounds.add(rows(plan, 14, 0.04));
    rounds.begin("t/1", after(0));
    rounds.end("t/1", after(2));
    // Units of other tables run in between, and a first try is time that was spent.
    rounds.begin("t/1", after(50));
    rounds.begin("t/1", after(53));
    rounds.end("t/1", after(54));
    EXPECT_THAT(rounds.next("t/1"), IsEmpty());
    EXPECT_THAT(rounds.undecided(), IsEmpty());
    const run::Json ending = rounds.ending("t/1");
    EXPECT_EQ(ending["ended_by"], "relative_error");
    EXPECT_EQ(ending["rounds"], 14);
    EXPECT_NEAR(ending["relative_error"].get<double>(), 0.0, 1e-9) << "of 14 the outermost is out";
    EXPECT_EQ(ending["seconds"], 6.0);
    EXPECT_EQ(rounds.endings()["t/1"]["ended_by"], "relative_error");
}

/// It is small enough at once, and rounds follow (FrameTimes::isKnownTo).
TEST(Rounds, GoOnToTheLastOfEqualDepth) {
    run::Plan plan = timedPlan();
    run::Rounds rounds(plan, rows(plan, 6, 0.08), {});
    for (int process = 6; process < 14; ++process) {
        EXPECT_EQ(rounds.next("t/1").size(), 3U);
        for (std::size_t i = 2; i < 5; ++i) rounds.add({timeRow(plan.cases[i], 10.0, process)});
    }
    EXPECT_THAT(rounds.next("t/1"), IsEmpty());
    EXPECT_EQ(rounds.ending("t/1")["ended_by"], "relative_error");
    EXPECT_EQ(rounds.ending("t/1")["rounds"], 14);
}

TEST(Rounds, GoOnWhileTheErrorIsLarge) {
    const run::Plan plan = timedPlan();
    run::Rounds rounds(plan, rows(plan, 6, 0.5), {});
    EXPECT_THAT(namesOf(rounds.next("t/1")), ElementsAre("t/1 a 1 #6", "t/1 b 1 #6", "t/1 c 1 #6"));
    for (std::size_t i = 2; i < 5; ++i) rounds.add({timeRow(plan.cases[i], 15.0, 6)});
    EXPECT_THAT(namesOf(rounds.next("t/1")), ElementsAre("t/1 c 1 #7", "t/1 b 1 #7", "t/1 a 1 #7"));
    for (int process = 7; process < 20; ++process) {
        const double timeMs = process % 2 == 0 ? 15.0 : 10.0;
        for (std::size_t i = 2; i < 5; ++i) rounds.add({timeRow(plan.cases[i], timeMs, process)});
        EXPECT_EQ(rounds.next("t/1").size(), process == 19 ? 0U : 3U);
    }
    EXPECT_EQ(rounds.ending("t/1")["ended_by"], "most_rounds");
}

TEST(Rounds, OfAProgramGoOnWhileItsClockIsUnknown) {
    for (const bool isProgram : {false, true}) {
        run::Plan plan = timedPlan();
        std::vector<records::Record> records;
        for (std::size_t i = 2; i < plan.cases.size(); ++i) {
            if (isProgram) plan.cases[i].program = Node::map({});
            for (int process = 0; process < 14; ++process) {
                records.push_back(
                    timeRow(plan.cases[i], process % 2 == 0 ? 500.0 : 750.0, process));
                records.push_back(timeRow(plan.cases[i], 2.0, process));
                records.back().metric = "process_time_ms";
            }
        }
        run::Rounds rounds(plan, records, {});
        EXPECT_EQ(rounds.next("t/1").size(), isProgram ? 3U : 0U);
    }
}

TEST(Rounds, EndBeforeTheBudgetIsOverdrawn) {
    const run::Plan plan = timedPlan();
    run::Rounds rounds(plan, {}, {});
    rounds.add(rows(plan, 6, 0.5));
    rounds.begin("t/1", after(0));
    rounds.end("t/1", after(90));
    EXPECT_THAT(rounds.next("t/1"), IsEmpty()) << "a round takes 15 s";
    EXPECT_EQ(rounds.ending("t/1")["ended_by"], "time_budget_s");
}

/// Five rounds have no interval: half more time is taken for the sixth, and no more.
TEST(Rounds, TheSixthMayTakeHalfMore) {
    run::Plan plan = timedPlan();
    for (config::Case& item : plan.cases) {
        item.measure.isWithinBudget = true;
    }
    const auto roundsOf = [&](int secondsEach) {
        run::Rounds own(plan, {}, {});
        for (int round = 0;; ++round) {
            for (const records::Record& row : rows(plan, round + 1, 0.0)) {
                if (row.process == round) own.add({row});
            }
            own.begin("t/1", after(round * secondsEach));
            own.end("t/1", after((round + 1) * secondsEach));
            if (own.next("t/1").empty()) return round + 1;
        }
    };
    EXPECT_EQ(roundsOf(16), 6);
    EXPECT_EQ(roundsOf(25), 6);
    EXPECT_EQ(roundsOf(26), 3);
    EXPECT_EQ(roundsOf(60), 1);
}

/// A truth, a first start and pictures took most of it; no further round makes them.
TEST(Rounds, WhatIsMadeOnceIsNoPartOfTheNext) {
    const run::Plan plan = timedPlan();
    run::Rounds rounds(plan, {}, {});
    rounds.add(rows(plan, 6, 0.5));
    rounds.begin("t/1", after(0));
    rounds.end("t/1", after(90), 60.0);
    EXPECT_FALSE(rounds.next("t/1").empty());
    EXPECT_TRUE(rounds.isUndecided("t/1"));
}

TEST(Rounds, ACaseThatFailedTakesNoPartInFurtherOnes) {
    const run::Plan plan = timedPlan();
    std::vector<records::Record> records = rows(plan, 6, 0.5);
    std::erase_if(records, [&](const records::Record& row) {
        return row.caseId == plan.cases[3].id && row.process == 2;
    });
    run::Rounds rounds(plan, records, {});
    EXPECT_THAT(namesOf(rounds.next("t/1")), ElementsAre("t/1 a 1 #6", "t/1 c 1 #6"));
}

TEST(Rounds, AreAsManyAsAskedForWithoutATarget) {
    run::Plan plan = timedPlan();
    for (config::Case& item : plan.cases) item.measure.processes = 5;  // too few for an interval
    run::Rounds rounds(plan, rows(plan, 5, 0.5), {});
    EXPECT_THAT(rounds.next("t/1"), IsEmpty());
    EXPECT_EQ(rounds.ending("t/1")["ended_by"], "processes");
    EXPECT_TRUE(rounds.ending("t/1")["relative_error"].is_null());
    EXPECT_FALSE(rounds.isUndecided("q/1")) << "the quality lane has no rounds";
}

TEST(Rounds, WhatWasDecidedStays) {
    const run::Plan plan = timedPlan();
    const run::Json ended = {{"time", "t"},
                             {"event", "rounds"},
                             {"table", "t/1"},
                             {"rounds", 6},
                             {"ended_by", "time_budget_s"}};
    run::Rounds resumed(plan, rows(plan, 6, 0.5), {ended});
    EXPECT_THAT(resumed.undecided(), IsEmpty());
    EXPECT_EQ(resumed.endings().dump(), R"({"t/1":{"rounds":6,"ended_by":"time_budget_s"}})");
    // But for a run whose times are measured again on another machine.
    const run::Json moved = {{"event", "machine"}, {"table", "t/1"}};
    EXPECT_THAT(run::Rounds(plan, {}, {ended, moved}).undecided(), ElementsAre("t/1"));
}

TEST(Rounds, SayWhoseTimesATableHas) {
    run::Plan plan = timedPlan();
    for (config::Case& item : plan.cases) item.measure.processes = 1;
    const auto noteOf = [](const run::Rounds& rounds) {
        return run::takenTimesNote({{"rounds", rounds.endings()}}, "t/1");
    };
    const auto event = [&](std::size_t item, const char* from) {
        run::Json json = {{"event", "case"}, {"case", plan.cases[item].id}, {"process", 0}};
        if (from) json["times_of"] = from;
        return json;
    };
    run::Rounds rounds(plan, rows(plan, 1, 0.0), {event(2, "t/9"), event(3, "t/9")});
    rounds.takenFrom(plan.cases[4], "t/9");
    EXPECT_EQ(noteOf(rounds), "") << "undecided";
    EXPECT_THAT(rounds.next("t/1"), IsEmpty());
    EXPECT_EQ(noteOf(rounds), "Times are those of t/9, which has these cases, too");
    // One of the three was measured by itself, after all.
    run::Rounds mixed(plan, rows(plan, 1, 0.0),
                      {event(2, "t/9"), event(3, "t/9"), event(4, "t/9"), event(4, nullptr)});
    EXPECT_THAT(mixed.next("t/1"), IsEmpty());
    EXPECT_EQ(noteOf(mixed),
              "Times of 2 of 3 cases are those of t/9, which has these cases, too; the others' "
              "were measured at another moment");
    // All were measured again on another machine.
    run::Rounds own(plan, rows(plan, 1, 0.0),
                    {event(2, "t/9"), {{"event", "machine"}, {"table", "t/1"}}});
    EXPECT_THAT(own.next("t/1"), IsEmpty());
    EXPECT_EQ(noteOf(own), "");
    EXPECT_EQ(run::takenTimesNote(run::Json::object(), "t/1"), "");
}

TEST(Rounds, WarnOfOutliers) {
    const run::Plan plan = timedPlan();
    const run::Rounds rounds(plan, rows(plan, 6, 9.0), {});
    EXPECT_EQ(rounds.warnings().size(), 3U);
    EXPECT_EQ(rounds.warnings()[0],
              "t/1: Outlier: frame 0 of a, size 1 took 100 ms in process 6, 10 times its fellows.");
}

}  // namespace
}  // namespace gfxrepro::test
