// Predictions by the same case, the same parameters, the median; and files.
#include "runner/cluster/predictions.h"

#include "engine/core/files.h"
#include "tests/support/support.h"
#include "tests/unit/run/plan_fixture.h"

namespace gfxrepro::test {
namespace {

using cluster::Predictor;
using config::Case;
using Source = cluster::Prediction::Source;

TEST(Predictions, NothingIsKnownOfNothing) {
    EXPECT_FALSE(Predictor().predict(makeCase("t/1", "a", 1)));
}

TEST(Predictions, TheSameCaseFirstThenTheSameParameters) {
    const Case item = makeCase("t/1", "a", 64);
    Case otherBuild = item;
    otherBuild.id = "another build";
    const Predictor predictor({makePast(otherBuild, 9.0), makePast(item, 2.0)});
    EXPECT_EQ(predictor.predict(item)->source, Source::SameCase);
    EXPECT_DOUBLE_EQ(predictor.predict(item)->timeS, 2.0);
    EXPECT_EQ(predictor.predict(item)->memoryBytes, 1 << 20);
    Case thirdBuild = item;
    thirdBuild.id = "a third build";
    EXPECT_EQ(predictor.predict(thirdBuild)->source, Source::OtherRun);
    EXPECT_DOUBLE_EQ(predictor.predict(thirdBuild)->timeS, 9.0);  // the first that is given
}

/// The first process makes the pictures; all six together take what they take.
TEST(Predictions, TellWhatAllProcessesTake) {
    const run::Cost first{1.0, 0.5, 2.0, 12.0, 4000, 12.0}, other{1.0, 0.5, 2.0, 0.0, 1000, 0.0};
    const run::Cost usual = cluster::usualCost({first, other, other, other, other, other});
    EXPECT_DOUBLE_EQ(6.0 * usual.totalS(), first.totalS() + 5.0 * other.totalS());
    EXPECT_EQ(usual.peakBytes, 4000);
}

TEST(Predictions, FollowIterationsAndFrames) {
    Case item = makeCase("t/1", "a", 64, config::Measure::Lane::Timing);
    item.measure.repeats = 3;
    item.measure.frames = 1;
    const Predictor predictor({{item, {0.5, 0.25, 4.0, 1.0, 0}}});
    EXPECT_DOUBLE_EQ(predictor.predict(item)->timeS, 0.5 + 0.25 + 4.0 + 1.0);
    item.measure.repeats = 5;
    item.measure.frames = 3;
    // 16 iterations in place of 4, three recordings in place of one.
    EXPECT_DOUBLE_EQ(predictor.predict(item)->timeS, 0.5 + 0.25 + 16.0 + 3.0);
}

TEST(Predictions, MedianOfTheTechniqueElseOfAll) {
    Case other = makeCase("t/1", "x", 1);
    other.technique = "other";
    const Predictor predictor({makePast(makeCase("t/1", "a", 1), 1.0),
                               makePast(makeCase("t/1", "b", 2), 3.0),
                               makePast(makeCase("t/1", "c", 3), 4.0), makePast(other, 50.0)});
    const auto sameTechnique = predictor.predict(makeCase("t/1", "d", 1));
    EXPECT_EQ(sameTechnique->source, Source::Median);
    EXPECT_DOUBLE_EQ(sameTechnique->timeS, 3.0);
    EXPECT_FALSE(sameTechnique->isTold);
    Case third = makeCase("t/1", "x", 1);
    third.id = third.technique = "third";
    EXPECT_DOUBLE_EQ(predictor.predict(third)->timeS, 3.5);
}

TEST(Predictions, SurviveAFile) {
    const TemporaryFolder folder;
    run::Plan plan;
    plan.cases = {makeCase("t/1", "a", 64), makeCase("t/1", "a", 70)};
    plan.cases[1].measure.processes = 3;
    const Predictor predictor({makePast(plan.cases[0], 1.0 / 3.0)});
    const auto file = folder.path() / "predictions.csv";
    cluster::writePredictions(file, plan, predictor);
    EXPECT_EQ(readFile(file),
              "title,time_s,memory_bytes,source\n"
              "t/1 method=a size=64,0.3333333333333333,1048576,same case\n"
              "t/1 method=a size=70,0.3333333333333333,1048576,median\n");
    const Predictor again = Predictor::from({file});
    EXPECT_EQ(again.predict(plan.cases[1])->source, Source::File);
    EXPECT_TRUE(again.predict(plan.cases[0])->isTold);
    EXPECT_FALSE(again.predict(plan.cases[1])->isTold);
    EXPECT_EQ(cluster::caseTimesS(plan, again), cluster::caseTimesS(plan, predictor));
    EXPECT_DOUBLE_EQ(cluster::caseTimesS(plan, again)[1], 1.0);  // three processes
    // The class of the device is in the hash, not in the title: a plan for another is cut alike.
    plan.cases[0].id = "on another class of device";
    EXPECT_EQ(again.predict(plan.cases[0])->source, Source::File);
}

TEST(Predictions, RefuseWhatIsNeitherRunNorFile) {
    const TemporaryFolder folder;
    const auto text = [&](const fs::path& path) {
        return errorText([&] { Predictor::from({path}); }, folder.path());
    };
    EXPECT_EQ(text(folder.path()), "DIR: is not a run directory (it has no plan.json)");
    EXPECT_EQ(text(folder.write("a.csv", "a,b\n")),
              "DIR/a.csv: neither a run directory nor a file of predictions");
    EXPECT_EQ(text(folder.write("b.csv", "title,time_s,memory_bytes,source\nx,y,1,file\n")),
              "DIR/b.csv:2: is no line of predictions");
}

TEST(Predictions, WithoutAPastIterationsCountAlike) {
    run::Plan plan;
    plan.cases = {makeCase("t/1", "a", 1), makeCase("t/1", "a", 2)};
    plan.cases[1].measure.repeats = 5;
    plan.cases[1].measure.processes = 2;
    EXPECT_EQ(cluster::caseTimesS(plan, Predictor()), (std::vector<double>{1.0, 10.0}));
}

TEST(Predictions, TimeLeftLearnsFromWhatWasDone) {
    EXPECT_DOUBLE_EQ(cluster::remainingS(60.0, 0.0, 5.0, 2), 30.0);    // nothing done: as predicted
    EXPECT_DOUBLE_EQ(cluster::remainingS(60.0, 20.0, 40.0, 2), 80.0);  // twice as slow as predicted
    EXPECT_DOUBLE_EQ(cluster::remainingS(60.0, 70.0, 40.0, 1), 0.0);
}

}  // namespace
}  // namespace gfxrepro::test
