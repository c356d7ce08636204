// A worker seen from the runner: shells that speak its protocol stand for workers, and time is
// given.
#include "runner/run/worker_handle.h"

#include <signal.h>
#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>
#include <array>
#include <string>
#include <thread>

#include "engine/core/descriptor.h"
#include "runner/run/child_process.h"
#include "tests/support/support.h"
#include "tests/unit/run/plan_fixture.h"

namespace gfxrepro::run {
namespace {

using namespace std::chrono_literals;
using Clock = WorkerHandle::Clock;

/// Keeps a process from dying of SIGKILL, as a driver or a file system that is away does, for as
/// long as the object lives: a tracer holds it where it ends.
class HeldAtItsEnd {
  public:
    explicit HeldAtItsEnd(pid_t pid) {
        std::array<int, 2> ready{};
        if (::pipe(ready.data()) != 0) return;
        tracer_ = ::fork();
        if (tracer_ == 0) {
            const bool isHeld = ::ptrace(PTRACE_SEIZE, pid, 0, PTRACE_O_TRACEEXIT) == 0;
            const char answer = isHeld ? 'y' : 'n';
            if (::write(ready[1], &answer, 1) != 1 || !isHeld) ::_exit(1);
            while (true) ::pause();
        }
        char answer = 'n';
        isHeld_ = ::read(ready[0], &answer, 1) == 1 && answer == 'y';
        for (const int end : ready) ::close(end);
    }
    ~HeldAtItsEnd() {
        ::kill(tracer_, SIGKILL);
        ::waitpid(tracer_, nullptr, 0);
    }
    HeldAtItsEnd(const HeldAtItsEnd&) = delete;
    HeldAtItsEnd& operator=(const HeldAtItsEnd&) = delete;
    bool isHeld() const { return isHeld_; }

  private:
    pid_t tracer_ = -1;
    bool isHeld_ = false;
};

constexpr const char* kReady =
    R"({"ready": {"index": 0, "platform": "p", "vendor": "v", "renderer": "r", "version": "4.5",
"mesa_version": "", "uuid": "", "is_software": true, "counts_work": true, "timer_bits": 64, "timer_resolution_ns": 1.0}})";

class Worker : public testing::Test {
  protected:
    Worker() { item.measure.timeLimitS = 5.0; }

    /// Says that it is ready, and runs `script` when it has its case.
    std::vector<std::string> command(const std::string& script) const {
        std::string ready = kReady;
        std::ranges::replace(ready, '\n', ' ');
        return {"/bin/sh", "-c", "echo \"$0\" >&3; read -r line; " + script, ready};
    }
    static std::optional<CaseResult> receive(WorkerHandle& worker) {
        for (int i = 0; i < 1000; ++i, std::this_thread::sleep_for(10ms)) {
            if (auto result = worker.receive()) return result;
            if (worker.isGone()) break;
        }
        return std::nullopt;
    }
    static void waitUntilReady(WorkerHandle& worker) {
        for (int i = 0; i < 1000 && !worker.device(); ++i, std::this_thread::sleep_for(10ms)) {
            worker.receive();
        }
        ASSERT_TRUE(worker.device());
    }
    /// One that has its case, until the next.
    WorkerHandle& begun(const std::string& script) {
        worker_.emplace(command(script), config::Measure::Lane::Quality, false, phases);
        waitUntilReady(*worker_);
        worker_->assign({&item, 0});
        return *worker_;
    }
    static void signal(const WorkerHandle& worker, int number) {
        ::kill(worker.process().pid(), number);
        for (int i = 0; i < 1000 && worker.process().isSuspended() != (number == SIGSTOP); ++i) {
            std::this_thread::sleep_for(10ms);
        }
        ASSERT_EQ(worker.process().isSuspended(), number == SIGSTOP);
    }

    PhaseClock phases;
    Case item = test::makeCase("t/1", "a", 1);

  private:
    std::optional<WorkerHandle> worker_;
};

TEST_F(Worker, SuspendedAloneItsLimitMovesBySixtySecondsAtMost) {
    WorkerHandle& worker = begun("sleep 1000");
    const Clock::time_point begin = Clock::now();
    signal(worker, SIGSTOP);
    for (const auto at : {1s, 30s, 59s, 61s, 64s}) {
        EXPECT_FALSE(worker.checkLimits(begin + at)) << at.count();
    }
    const auto result = worker.checkLimits(begin + 66s);
    ASSERT_TRUE(result);
    EXPECT_EQ(result->status, records::Status::Timeout);
    EXPECT_EQ(result->message, "suspended from outside for more than 60 s");
    EXPECT_TRUE(result->isOutsideKill) << "the case is measured again, and not marked";
    EXPECT_TRUE(worker.isGone());
}

TEST_F(Worker, WhileItWaitsForItsTurnItsLimitDoesNotRun) {
    WorkerHandle worker(
        command("echo '{\"prepared\": true}' >&3; read -r line; echo \"$line\"; sleep 60"),
        config::Measure::Lane::Timing, true, phases);
    worker.assign({&item, 0, {}}, true);
    EXPECT_TRUE(worker.isPreparing());
    for (int i = 0; i < 1000 && !worker.isPrepared(); ++i, std::this_thread::sleep_for(10ms)) {
        worker.receive();
    }
    ASSERT_TRUE(worker.isPrepared());
    EXPECT_FALSE(worker.isPreparing());
    EXPECT_EQ(worker.nextCheck(Clock::now()), Clock::time_point::max());
    EXPECT_FALSE(worker.checkLimits(Clock::now() + 1h));
    worker.postpone(1h);
    worker.postpone(-1h);
    worker.mayRender();
    EXPECT_FALSE(worker.isPrepared() || worker.isPreparing());
    for (int i = 0; i < 1000 && worker.output().empty(); ++i, std::this_thread::sleep_for(10ms)) {
        worker.receive();
    }
    EXPECT_EQ(worker.output(), "{\"render\":true}\n");
    EXPECT_FALSE(worker.checkLimits(Clock::now() + 3s));
    const auto result = worker.checkLimits(Clock::now() + 6s);
    ASSERT_TRUE(result);
    EXPECT_EQ(result->status, records::Status::Timeout);
}

TEST_F(Worker, WhoSpeaksInItsPlaceEndsTheCaseAlone) {
    for (const auto& [said, why] :
         {std::pair{R"({"ready": {}})",
                    "the worker was ready already: descriptor 3 is not a technique's"},
          std::pair{R"({"done": {}})", "the worker's answer: '/status' is missing"}}) {
        WorkerHandle& worker = begun(std::string("echo '") + said + "' >&3; sleep 1000");
        const auto result = receive(worker);
        ASSERT_TRUE(result) << said;
        EXPECT_EQ(result->status, records::Status::Error);
        EXPECT_EQ(result->message, why);
        EXPECT_FALSE(worker.release(*result)) << "its next words would be another case's";
    }
}

TEST_F(Worker, AFileThatItCannotWriteIsNoneOfTheCase) {
    WorkerHandle& worker =
        begun(R"(echo '{"unwritable": "cannot write x: full"}' >&3; sleep 1000)");
    const auto result = receive(worker);
    ASSERT_TRUE(result);
    EXPECT_TRUE(result->isUnwritable);
    EXPECT_EQ(result->message, "cannot write x: full");
}

TEST_F(Worker, AfterASuspensionItHasItsOwnTime) {
    WorkerHandle& worker = begun("sleep 1000");
    const Clock::time_point begin = Clock::now();
    signal(worker, SIGSTOP);
    EXPECT_FALSE(worker.checkLimits(begin + 1s));
    EXPECT_FALSE(worker.checkLimits(begin + 20s));
    signal(worker, SIGCONT);
    EXPECT_FALSE(worker.checkLimits(begin + 21s));
    EXPECT_FALSE(worker.checkLimits(begin + 25s));
    const auto result = worker.checkLimits(begin + 27s);
    ASSERT_TRUE(result);
    EXPECT_EQ(result->message, "not finished after 5 s");
    EXPECT_FALSE(result->isOutsideKill);
}

TEST_F(Worker, OneThatCannotBeKilledIsLeftBehindAndTheRowSaysSo) {
    for (const bool isEndless : {false, true}) {
        WorkerHandle worker(command(isEndless ? "cat /dev/zero >&3" : "sleep 1000"),
                            config::Measure::Lane::Quality, false, phases);
        waitUntilReady(worker);
        const HeldAtItsEnd hold(worker.process().pid());
        if (!hold.isHeld()) GTEST_SKIP() << "processes cannot be traced here";
        worker.assign({&item, 0});
        const auto result = isEndless ? receive(worker) : worker.checkLimits(Clock::now() + 6s);
        ASSERT_TRUE(result);
        EXPECT_EQ(result->message,
                  std::string(isEndless ? "the worker's answer had 64 MiB and no end"
                                        : "not finished after 5 s") +
                      "; its process could not be killed and was left behind");
        EXPECT_FALSE(worker.release(*result));
    }
}

TEST_F(Worker, AnAnswerOfAnotherShapeIsAnErrorOfTheCase) {
    const auto messageOf = [&](const std::string& done) {
        WorkerHandle& worker = begun(
            "echo a library >&3; echo '[1]' >&3; echo '{\"begin\": 3}' >&3; echo '{\"done\": " +
            done + "}' >&3; sleep 1000");
        const auto result = receive(worker);
        EXPECT_TRUE(result && result->status == records::Status::Error);
        return result ? result->message : "";
    };
    const auto done = [](const std::string& status, const std::string& samples) {
        return "{\"status\": " + status +
               ", \"message\": \"\", \"void\": \"\", \"cost\": {\"load_s\": 0, \"setup_s\": 0, "
               "\"render_s\": 0, \"record_s\": 0, \"peak_bytes\": 1}, \"images\": [], \"scenes\": "
               "[], \"samples\": " +
               samples + "}";
    };
    EXPECT_EQ(messageOf(done("3", "[]")),
              "the worker's answer: '/status' is number; expected text");
    EXPECT_EQ(
        messageOf(done("\"ok\"", "[[0, 0, \"\", \"m\", \"ms\", null, false]]")),
        "the worker's answer: '/samples/0/5' is null; expected a number, \"inf\" or \"-inf\"");
    EXPECT_EQ(messageOf(done("\"ok\"", "[[0, 0]]")),
              "the worker's answer: '/samples/0' has 2 values; expected 7");
    EXPECT_EQ(messageOf("{}"), "the worker's answer: '/status' is missing");
}

TEST_F(Worker, AnAnswerWithoutEndIsACrashOfTheCase) {
    for (const char* script : {"cat /dev/zero >&3", "head -c 70000000 /dev/zero >&3; sleep 1000"}) {
        WorkerHandle& worker = begun(script);
        const auto result = receive(worker);
        ASSERT_TRUE(result) << script;
        EXPECT_EQ(result->status, records::Status::Crash);
        EXPECT_EQ(result->message, "the worker's answer had 64 MiB and no end");
        EXPECT_TRUE(worker.isGone());
        EXPECT_FALSE(worker.release(*result)) << "the next case has another worker";
    }
}

TEST_F(Worker, ALongAnswerIsReadWhole) {
    WorkerHandle& worker = begun(
        "printf '{\"unavailable\": \"' >&3; head -c 60000000 /dev/zero | tr '\\0' x >&3; echo "
        "'\"}' >&3");
    const auto result = receive(worker);
    ASSERT_TRUE(result);
    EXPECT_EQ(result->status, records::Status::Unsupported);
    EXPECT_EQ(result->message, std::string(60'000'000, 'x'));
}

using namespace std::chrono_literals;

TEST(ChildProcess, OneThatCannotBeKilledIsLeftBehind) {
    ChildProcess child({"/bin/sleep", "1000"});
    {
        const HeldAtItsEnd hold(child.pid());
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
