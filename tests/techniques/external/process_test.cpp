#include "techniques/external/process.h"

#include <signal.h>

#include <chrono>
#include <fstream>

#include "engine/core/files.h"
#include "tests/support/support.h"

namespace gfxrepro::external {
namespace {

ProcessEnd runShell(const TemporaryFolder& folder, const std::string& script,
                    std::vector<std::pair<std::string, std::string>> environment = {}) {
    return runProcess({{"/bin/sh", "-c", script},
                       std::move(environment),
                       folder.path(),
                       folder.path() / "metrics.jsonl"});
}

using Process = FolderTest;

TEST_F(Process, SaysHowItEnded) {
    EXPECT_EQ(whyEnded(runShell(folder, "true").waitStatus), "");
    EXPECT_EQ(whyEnded(runShell(folder, "exit 3").waitStatus), "exit code 3");
    EXPECT_EQ(whyEnded(runShell(folder, "kill -SEGV $$").waitStatus), "SIGSEGV");
}

TEST_F(Process, AnEndThatNobodyToldIsAnError) {
    const auto before = ::signal(SIGCHLD, SIG_IGN);
    EXPECT_EQ(errorText([&] { runShell(folder, "exit 3"); }),
              "cannot wait for /bin/sh: No child processes");
    ::signal(SIGCHLD, before);
}

/// The kernel's count stands for the kernel.
TEST_F(Process, KilledAsMemoryRanOutItSaysSo) {
    const auto end = [&](const std::string& script) {
        folder.write("proc/vmstat", "nr_free_pages 1\noom_kill 4\n");
        return runProcess({{"/bin/sh", "-c", script},
                           {},
                           folder.path(),
                           folder.path() / "metrics.jsonl",
                           folder.path()});
    };
    const std::string count = "echo oom_kill 5 >proc/vmstat; ";
    EXPECT_TRUE(end(count + "kill -KILL $$").isOutOfMemory);
    EXPECT_FALSE(end("kill -KILL $$").isOutOfMemory);
    EXPECT_TRUE(end(count + "exit 137").isOutOfMemory) << "a child's, as a shell tells it";
    EXPECT_FALSE(end("exit 137").isOutOfMemory);
    EXPECT_FALSE(end(count + "kill -SEGV $$").isOutOfMemory);
    EXPECT_FALSE(end(count + "exit 1").isOutOfMemory) << "it may be a neighbour's";
    EXPECT_FALSE(end(count).isOutOfMemory);
    // In its own control group nobody else is killed.
    const std::string v1 = "7:blkio:/\n4:memory:/job\n0::/\n";
    for (const auto& [groups, file] : {std::pair{"0::/job\n", "job/memory.events"},
                                       {v1.c_str(), "memory/job/memory.oom_control"},
                                       {v1.c_str(), "memory/memory.oom_control"}}) {  // a container
        SCOPED_TRACE(file);
        folder.write("proc/self/cgroup", groups);
        const std::string counts = std::string("sys/fs/cgroup/") + file;
        const auto inGroup = [&](const std::string& script) {
            folder.write(counts, "under_oom 0\noom_kill 1\n");
            return end("echo oom_kill 2 >" + counts + "; " + script).isOutOfMemory;
        };
        EXPECT_TRUE(inGroup("exit 1"));
        EXPECT_FALSE(inGroup("exit 0")) << "it went on without";
        fs::remove_all(folder.path() / "sys");
    }
}

TEST_F(Process, RunsInItsFolderAndPrints) {
    const ProcessEnd end = runShell(folder, "pwd; echo $WORD >&2; cat", {{"WORD", "of mine"}});
    EXPECT_EQ(end.output, folder.path().string() + "\nof mine\n");
}

TEST_F(Process, ItsMetricsComeThroughDescriptorAndFile) {
    runShell(folder,
             "eval \"echo one >&$GFXREPRO_METRICS_FD\"; echo two >>\"$GFXREPRO_METRICS_FILE\"");
    EXPECT_EQ(readFile(folder.path() / "metrics.jsonl"), "one\ntwo\n");
    runShell(folder, "true");  // each run begins anew
    EXPECT_EQ(readFile(folder.path() / "metrics.jsonl"), "");
}

TEST_F(Process, TakesItsTimeAndMemory) {
    const ProcessEnd idle = runShell(folder, "sleep 0.3");
    EXPECT_LT(idle.processTimeMs, 200.0);
    // Of a child of the child, too: 64 MiB in a variable of a shell.
    const ProcessEnd busy =
        runShell(folder, "sh -c 'x=$(head -c 67108864 /dev/zero | tr \"\\\\0\" x); echo ${#x}'");
    EXPECT_EQ(busy.output, "67108864\n");
    EXPECT_GT(busy.processTimeMs, idle.processTimeMs);
    EXPECT_GE(busy.peakBytes, 64LL << 20);
    EXPECT_LT(idle.peakBytes, 64LL << 20);
}

TEST_F(Process, WhatItLeavesBehindEnds) {
    const auto begin = std::chrono::steady_clock::now();
    // Neither waits for the pipe, nor is in the group of a shell any more.
    runShell(folder, "setsid sleep 100 & echo $! >pid; exit 0");
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(30));
    pid_t pid = 0;
    std::ifstream(folder.path() / "pid") >> pid;
    ASSERT_GT(pid, 0);
    EXPECT_EQ(::kill(pid, 0), -1) << pid;
}

TEST_F(Process, IsEndedWhenItPrintsWithoutEnd) {
    EXPECT_EQ(errorText([&] { runShell(folder, "yes"); }), "ended, as it prints more than 16 MiB");
}

TEST_F(Process, ThatCannotBeStarted) {
    const ProcessEnd end =
        runProcess({{"/no/such/program"}, {}, folder.path(), folder.path() / "m"});
    EXPECT_EQ(whyEnded(end.waitStatus), "exit code 127");
    EXPECT_EQ(end.output, "cannot start: No such file or directory");
}

}  // namespace
}  // namespace gfxrepro::external
