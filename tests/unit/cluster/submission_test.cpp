// What other machines are told: commands and scripts word by word, and how the queue is read.
#include "runner/cluster/submission.h"

#include "engine/core/files.h"
#include "engine/core/text.h"
#include "runner/cluster/predictions.h"
#include "tests/support/process.h"
#include "tests/support/support.h"
#include "tests/unit/run/plan_fixture.h"

namespace gfxrepro::test {
namespace {

using Source = cluster::Prediction::Source;
using cluster::Predictor;
using config::Case;

cluster::Submission makeSubmission() {
    return cluster::Submission{.name = "zju2005",
                               .program = "/opt/kept it/gfxrepro",
                               .runArguments = {"--assets", "/a b", "--jobs", "2"},
                               .out = "/out put",
                               .shardCount = 2,
                               .timeLimitMin = 12};
}

TEST(Submission, QuotesForTheShell) {
    EXPECT_EQ(shellQuoted("a-b_c./=:,+@%1"), "a-b_c./=:,+@%1");
    EXPECT_EQ(shellQuoted(""), "''");
    // The shell itself is the judge.
    const std::string hostile = "it's $HOME `x` \"y\" \\ * ; & |\n#";
    EXPECT_EQ(runProgram({"/bin/sh", "-c", "printf %s " + shellQuoted(hostile)}).out, hostile);
}

TEST(Submission, Commands) {
    EXPECT_EQ(cluster::shardCommand(makeSubmission(), 2),
              "env GFXREPRO_DATA='/opt/kept it' '/opt/kept it/gfxrepro' run --quiet --assets '/a "
              "b' --jobs 2 --resume '/out put/shards/2'");
    // As short for a thousand shards.
    EXPECT_EQ(cluster::mergeCommand(makeSubmission()),
              "env GFXREPRO_DATA='/opt/kept it' '/opt/kept it/gfxrepro' merge '/out put'");
}

TEST(Submission, Scripts) {
    cluster::Submission s = makeSubmission();
    s.isExclusive = true;
    s.sbatchFlags = {"--partition=p", "--gres=gpu:1", "--account=x", "--mem=8G"};
    EXPECT_EQ(cluster::taskScript(s),
              "#!/bin/sh\n#SBATCH --job-name=gfxrepro-zju2005\n#SBATCH --ntasks=1\n"
              "#SBATCH --time=12\n#SBATCH --requeue\n#SBATCH --open-mode=append\n"
              "#SBATCH --exclusive\n#SBATCH --partition=p\n#SBATCH --gres=gpu:1\n"
              "#SBATCH --account=x\n#SBATCH --mem=8G\n"
              "exec env GFXREPRO_DATA='/opt/kept it' '/opt/kept it/gfxrepro' run --quiet --assets "
              "'/a b' --jobs 2 --resume '/out put/shards'/\"$SLURM_ARRAY_TASK_ID\"\n");
    EXPECT_EQ(cluster::mergeScript(s),
              "#!/bin/sh\n#SBATCH --job-name=gfxrepro-zju2005-merge\n#SBATCH --ntasks=1\n"
              "#SBATCH --time=60\n#SBATCH --requeue\n#SBATCH --open-mode=append\n"
              "#SBATCH --partition=p\n#SBATCH --account=x\n"
              "exec env GFXREPRO_DATA='/opt/kept it' '/opt/kept it/gfxrepro' merge '/out put'\n");
}

TEST(Submission, ArrayIndices) {
    EXPECT_EQ(cluster::arrayIndices({1, 2, 3, 4}), "1-4");
    EXPECT_EQ(cluster::arrayIndices({2, 4, 5, 9}), "2,4-5,9");
    EXPECT_EQ(cluster::arrayIndices({}), "");
}

TEST(Submission, TimeLimits) {
    run::Plan plan{
        .cases = {makeCase("t/1", "a", 1), makeCase("t/1", "a", 2), makeCase("t/1", "a", 3)}};
    for (config::Case& item : plan.cases) item.measure.timeLimitS = 3600.0;
    const std::vector<int> shardOf = {0, 1, 1};
    // The second shard: twice 90 s and ten minutes.
    EXPECT_EQ(cluster::timeLimitMin(plan, shardOf, {60.0, 30.0, 60.0}, true), 13);
    // Unknown: two tries of each of the two cases, and the start.
    EXPECT_EQ(cluster::timeLimitMin(plan, shardOf, {1.0, 1.0, 1.0}, false), 240);
    // Never more than the cases may take themselves, and ten minutes.
    for (config::Case& item : plan.cases) item.measure.timeLimitS = 30.0;
    EXPECT_EQ(cluster::timeLimitMin(plan, shardOf, {0.0, 9000.0, 9000.0}, true), 12);
}

TEST(Submission, FilesFirstQueueSecond) {
    const auto queue = cluster::parseQueue(
        "squeue: maintenance tomorrow\n12_1 RUNNING\n12_2 NODE_FAIL\n13_N/A PENDING\n");
    EXPECT_EQ(queue.size(), 3U);
    EXPECT_EQ(queue.at("13"), "PENDING");
    const cluster::ShardProgress done{3, 2, 1};
    const cluster::ShardProgress half{3, 1, 0};
    EXPECT_EQ(cluster::stateOf(done, queue, "12_2"), "complete");
    EXPECT_EQ(cluster::stateOf(done, std::nullopt, "12_2"), "complete");
    EXPECT_EQ(cluster::stateOf(half, queue, "12_1"), "RUNNING");
    EXPECT_EQ(cluster::stateOf(half, queue, "12_2"), "stopped: NODE_FAIL");
    EXPECT_EQ(cluster::stateOf(half, queue, "12_3"), "lost: not complete and not in the queue");
    EXPECT_EQ(cluster::stateOf(half, std::nullopt, "12_1"), "unknown: the queue does not answer");
    EXPECT_EQ(cluster::stateOf(half, std::nullopt, ""), "not complete");
    EXPECT_TRUE(cluster::isUnderWay(queue, "12_1"));
    EXPECT_TRUE(cluster::isUnderWay(queue, "13"));
    EXPECT_FALSE(cluster::isUnderWay(queue, "12_2"));
    EXPECT_FALSE(cluster::isUnderWay(queue, "12_3"));
}

// Predictions by the same case, the same parameters, the median; and files.

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
    run::Plan plan{.cases = {makeCase("t/1", "a", 64), makeCase("t/1", "a", 70)}};
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
    run::Plan plan{.cases = {makeCase("t/1", "a", 1), makeCase("t/1", "a", 2)}};
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
