// Any call that changes a file fails, or the program is killed there with half of a write done:
// what was measured stays, and the command that is given again ends as one that nothing befell. A
// few calls of each command; GFXREPRO_TEST_FAILURES: all of them.
#include <signal.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <random>
#include <thread>

#include "engine/core/files.h"
#include "runner/records/images.h"
#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

using Arguments = std::vector<std::string>;

constexpr int kKilled = -1;
constexpr int kCallsTried = 4;  // of a command and a failure, spread over all

struct FailingCalls : FolderTest {
    FailingCalls() {
        config_ = writeMockConfig(
            folder,
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
        expectSameTables(dir, fs::path(whole_));
    }

    fs::path place_ = folder.path() / "place";  // what is here may fail
    fs::path countFile_ = folder.path() / "calls";
    std::string whole_ = folder.path() / "whole";
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
    const fs::path dir = place_ / "run", half = folder.path() / "half";
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

// Folders that cannot be written to, and disks that are full.

/// The mock in a shell, where no file can grow beyond `blocks` of 512 bytes: what a full disk looks
/// like to a program that outlives the signal.
ProcessResult mockWithFullDisk(const std::string& arguments, int blocks) {
    return shell("trap '' XFSZ; ulimit -f " + std::to_string(blocks) + "; exec " +
                 GFXREPRO_MOCK_PROGRAM + " " + arguments);
}

using Disk = test::RunTest;

TEST_F(Disk, ALimitOnFilesIsAWriteThatFails) {
    const std::string config = writeMockConfig(folder, "sweep: {number: [1, 2]}\n");
    const ProcessResult run =
        endedWith(2, shell(std::string("ulimit -f 1; exec ") + GFXREPRO_MOCK_PROGRAM + " run " +
                           config + " --device software --out " + dir));
    EXPECT_THAT(run.err, HasSubstr("gfxrepro: cannot write " + dir));
    EXPECT_THAT(run.err, HasSubstr(": File too large\n"));
}

TEST_F(Disk, AFullDiskLosesNothingMeasured) {
    const std::string config = writeMockConfig(
        folder,
        "sweep:\n  number: {range: [1, 40]}\nmeasure: {lane: quality, repeats: 9}\n"
        "layout:\n  rows: number\n  columns:\n    n: {metric: number, format: \"{median:.0f}\"}\n");
    const std::string whole = folder.path() / "whole", full = folder.path() / "full";
    ASSERT_EQ(mockGfxrepro({"run", config, "--out", whole}).exitCode, 0);
    ASSERT_EQ(mockGfxrepro({"table", whole}).exitCode, 0);
    // The plan fits, the records of 40 cases do not.
    const auto planBlocks = static_cast<int>(fs::file_size(whole + "/plan.json") / 512 + 1);
    const auto recordBlocks = static_cast<int>(fs::file_size(whole + "/records.csv") / 512);
    ASSERT_LT(planBlocks, recordBlocks) << "the test needs records larger than the plan";
    const ProcessResult run = endedWith(
        2, mockWithFullDisk("run " + config + " --device software --out " + full, planBlocks));
    EXPECT_THAT(run.err,
                EndsWith("gfxrepro: cannot write " + full + "/records.csv: File too large\n"));
    const std::size_t measured = rowsOf(full, "number").size();
    EXPECT_GT(measured, 0U);
    EXPECT_LT(measured, 40U);
    const ProcessResult resumed = endedWith(0, mockGfxrepro({"run", "--resume", full}));
    const std::string left = std::to_string(40 - measured);
    EXPECT_EQ(resumed.out, left + " of " + left + " finished; records: " + full + "/records.csv\n");
    EXPECT_EQ(mockGfxrepro({"table", full}).exitCode, 0);
    expectSameTables(full, whole);
}

/// A folder stands where the picture of the first case belongs: a write that fails once.
TEST_F(Disk, AFailedWriteOfTheRunnerIsNoneOfTheCase) {
    const std::string config =
        writeMockConfig(folder, "sweep: {number: [1, 2]}\nmeasure: {lane: quality}\n");
    ASSERT_EQ(mockGfxrepro({"run", config, "--out", dir, "--jobs", "1"}).exitCode, 0);
    const fs::path picture = fs::path(dir) / records::readImages(dir).front().exr;
    for (const fs::path& file : {picture, fs::path(dir) / "records.csv"}) fs::remove(file);
    fs::create_directories(picture / "in-the-way");
    for (int i = 0; i < 3; ++i) {  // nor is it taken for what the runner did not survive
        EXPECT_THAT(
            endedWith(2, mockGfxrepro({"run", "--resume", dir, "--jobs", "1"})).err,
            EndsWith("gfxrepro: cannot rename to " + picture.string() + ": Is a directory\n"));
        EXPECT_TRUE(rowsOf(dir, "number").empty());
    }
    fs::remove_all(picture);
    EXPECT_EQ(endedWith(0, mockGfxrepro({"run", "--resume", dir})).out,
              "2 of 2 finished; records: " + dir + "/records.csv\n")
        << "none is flaky";
}

TEST_F(Disk, AnExportIsThereAsAWholeOrNotAtAll) {
    const std::string config = writeMockConfig(folder, "sweep: {number: {range: [1, 60]}}\n");
    ASSERT_EQ(mockGfxrepro({"run", config, "--out", dir}).exitCode, 0);
    for (const std::string tidy : {"", " --tidy"}) {
        const fs::path out = folder.path() / ("out" + tidy.substr(0, 1)) / "artifact";
        const std::string command = "export " + dir + tidy + " --out '" + out.string() + "'";
        endedWith(2, mockWithFullDisk(command, 8));
        EXPECT_TRUE(!fs::exists(out.parent_path()) || fs::is_empty(out.parent_path())) << command;
        endedWith(0, mockWithFullDisk(command, 1 << 20));
        EXPECT_TRUE(fs::exists(out / (tidy.empty() ? "SHA256SUMS" : "run.csv")));
        EXPECT_EQ(std::distance(fs::directory_iterator(out.parent_path()), {}), 1);
    }
}

TEST_F(Disk, AFolderThatCannotBeWrittenIsNamed) {
    const std::string config = writeMockConfig(folder, "");
    // Nobody, root either, makes folders there.
    const ProcessResult run =
        endedWith(2, mockGfxrepro({"run", config, "--out", "/proc/gfxrepro/run"}));
    EXPECT_THAT(
        run.err,
        EndsWith(
            "gfxrepro: cannot make the folder /proc/gfxrepro/run: No such file or directory\n"));
    EXPECT_EQ(run.out, "");
}

TEST_F(Disk, AReadOnlyRunIsNotContinued) {
    if (::geteuid() == 0) GTEST_SKIP() << "root writes to read-only folders";
    const std::string config = writeMockConfig(folder, "params: {number: 3}\n");
    ASSERT_EQ(mockGfxrepro({"run", config, "--out", dir}).exitCode, 0);
    fs::permissions(dir, fs::perms::owner_read | fs::perms::owner_exec);
    EXPECT_THAT(endedWith(2, mockGfxrepro({"table", dir})).err, HasSubstr("Permission denied"));
    fs::permissions(dir, fs::perms::owner_all);
    EXPECT_EQ(rowsOf(dir, "number").size(), 1U);
}

// The runner, its workers or both are killed at 25 random moments (GFXREPRO_TEST_KILLS: at as
// many), some of them on a disk that is nearly full, some with the write of a unit cut anywhere:
// nothing measured is lost but what was cut, nothing is left, and the tables end as those of a run
// that nobody touched.

constexpr int kMoments = 25;
constexpr int kMomentsInFolder = 5;
constexpr int kLatestMs = 700;  // a run that nobody kills takes a little more

enum class Victim { Runner, Workers, Both };

int folderCount() {
    const char* moments = std::getenv("GFXREPRO_TEST_KILLS");
    return (moments ? std::atoi(moments) : kMoments) / kMomentsInFolder;
}

/// Starts or continues the run in `dir` and kills something `delayMs` later. No file grows beyond
/// `blocks` of 512 bytes, if that is not 0.
void runAndKill(const std::string& config, const std::string& dir, int delayMs, Victim victim,
                int blocks) {
    std::vector<std::string> command = {GFXREPRO_MOCK_PROGRAM, "run"};
    if (blocks > 0) {
        command = {"/bin/sh", "-c",
                   "trap '' XFSZ; ulimit -f " + std::to_string(blocks) + "; exec \"$0\" \"$@\"",
                   GFXREPRO_MOCK_PROGRAM, "run"};
    }
    if (fs::exists(dir + "/plan.json")) {
        command.insert(command.end(), {"--resume", dir, "--retry"});
    } else {
        command.insert(command.end(), {config, "--device", "software", "--out", dir});
    }
    BackgroundProgram run(command);
    std::this_thread::sleep_for(std::chrono::milliseconds(delayMs));
    if (victim != Victim::Runner) {
        for (const pid_t worker : backgroundWorkers()) ::kill(worker, SIGKILL);
    }
    if (victim != Victim::Workers) run.signal(SIGKILL);
    run.wait();
}

/// Files that were being written.
std::vector<fs::path> temporaryFiles(const fs::path& dir) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(dir)) {
        const bool isTemporary = entry.path().string().find(".tmp") != std::string::npos;
        if (isTemporary) files.push_back(entry.path());
    }
    return files;
}

/// Cuts the file somewhere in its last `rows` lines, as a kernel that stops a write at a page does.
void tear(const fs::path& file, std::size_t rows, std::mt19937& random) {
    const std::string text = fs::exists(file) ? readFile(file) : "";
    std::size_t begin = text.size();
    for (std::size_t i = 0; i <= rows && begin != text.npos && begin > 0; ++i) {
        begin = text.rfind('\n', begin - 1);
    }
    if (begin == text.npos || begin == 0) return;  // not that many
    fs::resize_file(file, begin + 1 + random() % (text.size() - begin - 1));
}

std::size_t countMeasured(const std::string& dir) {
    return fs::exists(dir + "/records.csv") ? rowsOf(dir, "number").size() : 0;
}

TEST(Kill, AnyProcessAtAnyMomentLosesNothing) {
    const TemporaryFolder folder;
    const std::string config = writeMockConfig(
        folder,
        "params: {pause_ms: 30}\nsweep:\n  number: {range: [1, 12]}\n"
        "layout:\n  rows: number\n  columns:\n    n: {metric: number, format: \"{median:.0f}\"}\n");
    const std::string whole = folder.path() / "whole";
    ASSERT_EQ(mockGfxrepro({"run", config, "--out", whole}).exitCode, 0);
    ASSERT_EQ(mockGfxrepro({"table", whole}).exitCode, 0);
    std::mt19937 random(20261121);
    const std::size_t unitRows = records::readRecords(whole + "/records.csv").size() / 12;
    std::size_t unfinished = 0;
    for (int i = 0; i < folderCount(); ++i) {
        const std::string dir = folder.path() / ("killed" + std::to_string(i));
        std::size_t measured = 0;
        for (int moment = 0; moment < kMomentsInFolder; ++moment) {
            const int delayMs = static_cast<int>(random() % kLatestMs);
            const int blocks = random() % 4 == 0 ? static_cast<int>(8 + random() % 40) : 0;
            runAndKill(config, dir, delayMs, static_cast<Victim>(random() % 3), blocks);
            const std::size_t now = countMeasured(dir);
            EXPECT_GE(now, measured) << dir << ", " << delayMs << " ms";
            const bool isTorn = now < 12 && random() % 4 == 0;  // not of a run that has ended
            if (isTorn) tear(dir + "/records.csv", unitRows, random);
            measured = countMeasured(dir);
            EXPECT_GE(measured + 1, now) << "one unit was cut";
            unfinished += now < 12 ? 1 : 0;
        }
        // A run that was killed before its plan was frozen is begun, not continued.
        endedWith(0, fs::exists(dir + "/plan.json")
                         ? mockGfxrepro({"run", "--resume", dir, "--retry"})
                         : mockGfxrepro({"run", config, "--out", dir}));
        EXPECT_TRUE(temporaryFiles(dir).empty()) << dir;
        EXPECT_EQ(rowsOf(dir, "number").size(), 12U) << dir;
        EXPECT_EQ(mockGfxrepro({"table", dir}).exitCode, 0);
        expectSameTables(dir, whole);
    }
    RecordProperty("unfinished", static_cast<int>(unfinished));
    EXPECT_GT(unfinished, 0U) << "every kill came too late to test anything";
}

}  // namespace
}  // namespace gfxrepro::test
