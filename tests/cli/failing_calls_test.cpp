// Any call that changes a file fails, or the program is killed there with half of a write done:
// what was measured stays, and the command that is given again ends as one that nothing befell. A
// few calls of each command; GFXREPRO_TEST_FAILURES: all of them.
#include <signal.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <functional>

#include "engine/core/files.h"
#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

using Arguments = std::vector<std::string>;

constexpr int kKilled = -1;
constexpr int kCallsTried = 4;  // of a command and a failure, spread over all

struct FailingCalls : testing::Test {
    FailingCalls() {
        config_ = writeMockConfig(
            folder_,
            "sweep:\n  number: {range: [1, 4]}\n"
            "layout:\n  rows: number\n  columns:\n    n: {metric: number, format: "
            "\"{median:.0f}\"}\n"
            "claims:\n  a: {says: it grows, trend: n, over: number, direction: increasing}\n");
        EXPECT_EQ(run(config_, whole_).exitCode, 0);
        EXPECT_EQ(mockGfxrepro({"table", whole_}).exitCode, 0);
    }

    ProcessResult failing(Arguments command, long call, int failure, Arguments more = {}) const {
        command.insert(command.begin(), GFXREPRO_MOCK_PROGRAM);
        more.insert(
            more.end(),
            {"LD_PRELOAD=" GFXREPRO_FAILING_CALLS, "FAILING_UNDER=" + place_.string(),
             "FAILING_CALL=" + std::to_string(call), "FAILING_ERRNO=" + std::to_string(failure),
             "FAILING_COUNT=" + countFile_.string()});
        return runProgram(command, more);
    }

    static ProcessResult run(const std::string& config, const std::string& dir) {
        return mockGfxrepro({"run", config, "--jobs", "1", "--out", dir});
    }

    /// Prepares, lets `command` fail at each call that is tried, and asks `check` after each.
    void tryAll(const Arguments& command, const std::function<void()>& prepare,
                const std::function<void()>& check) {
        prepare();
        const ProcessResult sound = failing(command, 0, 0);
        ASSERT_EQ(sound.exitCode, 0) << command[0] << ": " << sound.err;
        const long calls = std::stol(readFile(countFile_));
        ASSERT_GT(calls, 3) << command[0] << " changes files";
        const char* tries = std::getenv("GFXREPRO_TEST_FAILURES");
        const long step = std::max(1L, calls / (tries ? std::atol(tries) : kCallsTried));
        for (const int failure : {ENOSPC, EIO, kKilled}) {
            for (long call = 1; call <= calls; call += step) {
                const testing::Message where = testing::Message()
                                               << command[0] << ", call " << call << " of " << calls
                                               << ", errno " << failure;
                SCOPED_TRACE(where);
                prepare();
                const ProcessResult result = failing(command, call, failure);
                if (failure == kKilled) {
                    EXPECT_EQ(result.exitCode, 128 + SIGKILL) << result.err;
                } else {
                    // What only helps, such as a journal's flush, may fail without an end.
                    EXPECT_TRUE(result.exitCode == 0 || result.exitCode == 2) << result.exitCode;
                    const bool says = result.err.find("gfxrepro: ") != std::string::npos;
                    EXPECT_TRUE(says || result.exitCode == 0) << result.err;
                }
                check();
                ++tried_;
            }
        }
        RecordProperty("tried", static_cast<int>(tried_));
    }

    void expectAsUntouched(const fs::path& dir) const {
        EXPECT_EQ(rowsOf(dir, "number").size(), 4U);
        for (const records::Record& row : records::readRecords(dir / "records.csv")) {
            EXPECT_EQ(row.status, records::Status::Ok) << row.message;
        }
        endedWith(0, mockGfxrepro({"table", dir}));
        for (const char* file : {"csv", "md", "tex"}) {
            const std::string name = std::string("tables/sweep-mock.") + file;
            EXPECT_EQ(readFile(dir / name), readFile(fs::path(whole_) / name));
        }
    }

    TemporaryFolder folder_;
    fs::path place_ = folder_.path() / "place";  // what is here may fail
    fs::path countFile_ = folder_.path() / "calls";
    std::string whole_ = folder_.path() / "whole";
    std::string config_;
    std::size_t tried_ = 0;
};

TEST_F(FailingCalls, OfARunLoseNothing) {
    const std::string dir = place_ / "run";
    tryAll(
        {"run", config_, "--device", "software", "--jobs", "1", "--out", dir},
        [&] { fs::remove_all(place_); },
        [&] {
            const bool isPlanned = fs::exists(dir + "/plan.json");
            endedWith(0, isPlanned ? mockGfxrepro({"run", "--resume", dir}) : run(config_, dir));
            expectAsUntouched(dir);
        });
}

TEST_F(FailingCalls, OfAResumeLoseNothing) {
    const fs::path dir = place_ / "run", half = folder_.path() / "half";
    const Arguments begin = {"run", config_, "--device", "software", "--jobs", "1", "--out", dir};
    constexpr long kInTheMiddle = 30;
    ASSERT_EQ(failing(begin, kInTheMiddle, kKilled).exitCode, 128 + SIGKILL);
    const std::size_t measured = rowsOf(dir, "number").size();
    ASSERT_TRUE(measured > 0 && measured < 4) << measured;
    fs::rename(dir, half);
    const auto prepare = [&] {
        fs::remove_all(place_);
        fs::create_directories(place_);
        fs::copy(half, dir, fs::copy_options::recursive);
    };
    tryAll({"run", "--resume", dir, "--jobs", "1"}, prepare, [&] {
        // What was begun when the runner was killed, twice now, is left to --retry.
        endedWith(0, mockGfxrepro({"run", "--resume", dir, "--retry"}));
        expectAsUntouched(dir);
    });
}

/// What is made of a finished run is there as a whole when the command is given again.
TEST_F(FailingCalls, OfWhatReadsARunLeaveItAsItIs) {
    const fs::path dir = place_ / "run", out = place_ / "out";
    const std::vector<Arguments> commands = {
        {"table", dir},
        {"claims", dir},
        {"report", dir, "--out", out.string() + ".html"},
        {"export", dir, "--out", out},
        {"export", dir, "--tidy", "--out", out},
        {"merge", "--out", out, dir},
        {"submit", config_, "--engine", "commands", "--shards", "2", "--device", "software",
         "--out", out},
    };
    const auto prepare = [&] {
        fs::remove_all(place_);
        fs::create_directories(place_);
        fs::copy(whole_, dir, fs::copy_options::recursive);
    };
    for (const Arguments& command : commands) {
        tryAll(command, prepare, [&] {
            endedWith(0, mockGfxrepro(command));
            expectAsUntouched(dir);
        });
    }
}

/// A folder that cannot be read to its end is named, wherever it is not only looked into.
TEST_F(FailingCalls, OfFoldersAreSaidWithTheFolder) {
    const fs::path dir = place_ / "run", out = place_ / "out";
    const std::vector<Arguments> commands = {{"run", "--resume", dir, "--jobs", "1"},
                                             {"export", dir, "--out", out},
                                             {"merge", "--out", out, dir}};
    for (const Arguments& command : commands) {
        long calls = 1, said = 0, step = 1;
        for (long call = 0; call <= calls; call += step) {
            SCOPED_TRACE(testing::Message() << command[0] << ", call " << call << " of " << calls);
            fs::remove_all(place_);
            fs::create_directories(place_);
            fs::copy(whole_, dir, fs::copy_options::recursive);
            const ProcessResult result = failing(command, call, EIO, {"FAILING_FOLDERS=1"});
            if (call == 0) calls = std::stol(readFile(countFile_));
            if (call == 1) step = std::max(1L, calls / (4 * kCallsTried));
            const std::string message = "gfxrepro: cannot read " + place_.string();
            const bool isSaid = result.err.find(message) != std::string::npos;
            EXPECT_EQ(result.exitCode, isSaid ? 2 : 0) << result.err;
            said += isSaid ? 1 : 0;
        }
        EXPECT_GT(said, 3) << command[0];
    }
}

}  // namespace
}  // namespace gfxrepro::test
