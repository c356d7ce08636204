// What other machines are told: commands and scripts word by word, and how the queue is read.
#include "runner/cluster/submission.h"

#include <gtest/gtest.h>

#include "engine/core/text.h"
#include "tests/support/process.h"
#include "tests/unit/run/plan_fixture.h"

namespace gfxrepro::test {
namespace {

cluster::Submission makeSubmission() {
    cluster::Submission s;
    s.name = "zju2005";
    s.program = "/opt/kept it/gfxrepro";
    s.runArguments = {"--assets", "/a b", "--jobs", "2"};
    s.out = "/out put";
    s.shardCount = 2;
    s.timeLimitMin = 12;
    return s;
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
    run::Plan plan;
    plan.cases = {makeCase("t/1", "a", 1), makeCase("t/1", "a", 2), makeCase("t/1", "a", 3)};
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

}  // namespace
}  // namespace gfxrepro::test
