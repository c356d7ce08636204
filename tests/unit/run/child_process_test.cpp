#include "runner/run/child_process.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>
#include <thread>

#include "engine/core/descriptor.h"
#include "tests/support/support.h"
#include "tests/unit/run/held_at_its_end.h"

namespace gfxrepro::run {
namespace {

using namespace std::chrono_literals;

TEST(ChildProcess, OneThatCannotBeKilledIsLeftBehind) {
    ChildProcess child({"/bin/sleep", "1000"});
    {
        const test::HeldAtItsEnd hold(child.pid());
        if (!hold.isHeld()) GTEST_SKIP() << "processes cannot be traced here";
        const auto begin = std::chrono::steady_clock::now();
        EXPECT_FALSE(child.kill());
        const auto taken = std::chrono::steady_clock::now() - begin;
        EXPECT_GE(taken, ChildProcess::kKillPatience);
        EXPECT_LT(taken, 2 * ChildProcess::kKillPatience);
    }
    const std::optional<int> status = child.wait(5s);
    ASSERT_TRUE(status);
    EXPECT_TRUE(WIFSIGNALED(*status));
}

TEST(ChildProcess, WhatLeftItsGroupIsKilledToo) {
    ChildProcess child({"/bin/sh", "-c", "setsid sleep 1000 & echo $!; sleep 1000"});
    std::string said;
    for (int i = 0; i < 5000 && !said.ends_with('\n'); ++i) {
        readAvailable(child.outputFd(), said);
        std::this_thread::sleep_for(1ms);
    }
    const pid_t other = std::stoi(said);
    for (int i = 0; i < 5000 && ::getsid(other) != other; ++i) std::this_thread::sleep_for(1ms);
    ASSERT_EQ(::getsid(other), other);
    EXPECT_TRUE(child.kill());
    for (int i = 0; i < 5000 && ::kill(other, 0) == 0; ++i) std::this_thread::sleep_for(1ms);
    const bool isLeft = ::kill(other, 0) == 0;
    if (isLeft) ::kill(other, SIGKILL);
    EXPECT_FALSE(isLeft);
}

TEST(ChildProcess, AProgramIsNotWaitedForBeyondItsLimit) {
    EXPECT_EQ(runToEnd({"/bin/sh", "-c", "echo word; exit 3"}, 60s).exitCode, 3);
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_THROW(runToEnd({"/bin/sleep", "1000"}, 1s), std::exception);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, 10s);
}

TEST(ChildProcess, AnEndThatNobodyToldIsAnError) {
    const auto before = ::signal(SIGCHLD, SIG_IGN);
    EXPECT_EQ(errorText([] {
                  runToEnd({"/bin/sh", "-c", "exit 3"}, 60s);
              }),
              "cannot wait for a worker: No child processes");
    ::signal(SIGCHLD, before);
}

TEST(ChildProcess, AProgramThatPrintsWithoutEndIsEnded) {
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_EQ(errorText([] {
                  runToEnd({"/bin/sh", "-c", "exec yes"}, 60s);
              }),
              "/bin/sh: ended, as it prints more than 64 MiB");
    EXPECT_LT(std::chrono::steady_clock::now() - begin, 60s);
    const std::string most = "head -c 67108864 /dev/zero";
    EXPECT_EQ(runToEnd({"/bin/sh", "-c", most}, 60s).output.size(), std::size_t{64} << 20);
    EXPECT_THROW(runToEnd({"/bin/sh", "-c", most + "; echo"}, 60s), Error);
}

TEST(ChildProcess, OneThatReadsNothingIsNotWaitedFor) {
    ChildProcess child({"/bin/sleep", "1000"});
    child.sendLine(std::string(2'000'000, 'x'));  // more than a socket holds
    EXPECT_FALSE(child.sendRest());
    child.kill();
    EXPECT_TRUE(child.sendRest()) << "one that is gone takes nothing more";
}

TEST(ChildProcess, ALongLineArrivesWhole) {
    ChildProcess child({"/bin/cat"});
    const std::string line(2'000'000, 'x');
    child.sendLine(line);
    child.sendLine("end");
    std::string echo;
    for (int i = 0; i < 5000 && echo.size() < line.size() + 5; ++i) {
        child.sendRest();
        readAvailable(child.outputFd(), echo);
        std::this_thread::sleep_for(1ms);
    }
    EXPECT_TRUE(echo == line + "\nend\n") << echo.size() << " bytes";
}

TEST(ChildProcess, KnowsThatItIsSuspended) {
    ChildProcess child({"/bin/sleep", "1000"});
    EXPECT_FALSE(child.isSuspended());
    const auto becomes = [&](int signal, bool isSuspended) {
        ::kill(child.pid(), signal);
        for (int i = 0; i < 5000 && child.isSuspended() != isSuspended; ++i) {
            std::this_thread::sleep_for(1ms);
        }
        EXPECT_EQ(child.isSuspended(), isSuspended);
    };
    becomes(SIGSTOP, true);
    becomes(SIGCONT, false);
}

}  // namespace
}  // namespace gfxrepro::run
