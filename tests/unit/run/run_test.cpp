#include "runner/run/run.h"

#include <nlohmann/json.hpp>

#include "tests/support/support.h"
#include "tests/unit/run/plan_fixture.h"

namespace gfxrepro::test {
namespace {

using run::Json;

constexpr const char* kA = "p/1 a 1";     // a case of the first table,
constexpr const char* kTwin = "p/2 a 1";  // its twin in the second,
constexpr const char* kB = "p/1 b 1";     // and another case

struct NotSurvived : ::testing::Test {
    NotSurvived() {
        plan.cases = {makeCase("p/1", "a", 1), makeCase("p/1", "b", 1), makeCase("p/2", "a", 1)};
    }
    void say(const char* event) { log.push_back({{"event", event}}); }
    void say(const char* event, const char* id, int process = 0) {
        log.push_back({{"event", event}, {"case", id}, {"process", process}});
    }
    /// An invocation whose last words are that it starts this unit.
    void die(const char* id, int process = 0) {
        say("begin");
        say("start", id, process);
    }
    std::map<std::string, std::string> lost() const { return run::casesNotSurvived(plan, log); }

    run::Plan plan;
    std::vector<Json> log;
    const std::string twice =
        "the runner did not survive it, 2 times; resume with --retry to try it again";
    const std::string twinTwice =
        "the runner did not survive its twin p/1 method=a size=1, 2 times; resume with --retry to "
        "try it again";
};

TEST_F(NotSurvived, OnceIsNothing) {
    die(kA);
    EXPECT_THAT(lost(), IsEmpty());
    say("begin");
    EXPECT_THAT(lost(), IsEmpty()) << "the second was not in it";
}

TEST_F(NotSurvived, ACaseIsOneInWhicheverProcess) {
    die(kB, 0);
    die(kB, 1);
    EXPECT_THAT(lost(), ElementsAre(Pair(kB, twice)));
}

TEST_F(NotSurvived, ASecondTryThatIsNotSurvivedCountsLikeTheFirst) {
    for (int i = 0; i < 2; ++i) {
        die(kB);
        say("retry", kB);
        say("start", kB);
    }
    EXPECT_THAT(lost(), ElementsAre(Pair(kB, twice)));
    say("case", kB);
    EXPECT_THAT(lost(), IsEmpty()) << "it ended after all";
}

TEST_F(NotSurvived, OneEndOfTheRunnerIsOneHoweverManyProcessesRan) {
    die(kB, 0);
    say("start", kB, 1);
    EXPECT_THAT(lost(), IsEmpty());
}

TEST_F(NotSurvived, TwinsAreGivenUpTogetherWhicheverBegan) {
    die(kA);
    die(kA);
    EXPECT_THAT(lost(), ElementsAre(Pair(kA, twice), Pair(kTwin, twinTwice)));
    log.clear();
    die(kA);
    die(kTwin);  // the one that saves pictures goes first
    EXPECT_THAT(lost(), ElementsAre(Pair(kA, twice), Pair(kTwin, twice)));
}

TEST_F(NotSurvived, TimesOfSeveralProcessesHaveNoTwins) {
    for (config::Case& item : plan.cases) {
        item.measure.lane = config::Measure::Lane::Timing;
        item.measure.processes = 2;
    }
    die(kA);
    die(kA);
    EXPECT_THAT(lost(), ElementsAre(Pair(kA, twice)));
}

TEST_F(NotSurvived, WhatEndsAfterAllIsSurvived) {
    die(kA);
    die(kA);
    say("begin");
    say("start", kTwin);
    say("case", kTwin);
    EXPECT_THAT(lost(), IsEmpty());
    die(kA, 1);  // that process 0 ended counts for it alone
    die(kA, 1);
    say("begin");
    say("start", kA, 0);
    say("case", kA, 0);
    EXPECT_EQ(lost().size(), 2U);
}

TEST_F(NotSurvived, InterruptionsAndStopsCountNothingAndClearNothing) {
    for (const char* end : {"end", "interrupted"}) {
        log.clear();
        die(kB);
        die(kB);
        say(end);
        EXPECT_THAT(lost(), IsEmpty()) << end;
        die(kB);
        EXPECT_THAT(lost(), ElementsAre(Pair(kB, twice))) << end;
    }
}

}  // namespace
}  // namespace gfxrepro::test
