// The runner or one of its workers is killed at 25 random moments: nothing measured is lost, and
// the tables end as those of a run that nobody touched.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <random>
#include <thread>

#include "runner/core/files.h"
#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

namespace fs = std::filesystem;

constexpr int kFolders = 5;
constexpr int kMomentsInFolder = 5;
constexpr int kLatestMs = 700;  // a run that nobody kills takes a little more

/// Starts or continues the run in `dir` and kills something `delayMs` later.
void runAndKill(const std::string& config, const std::string& dir, int delayMs, bool isRunner) {
    std::vector<std::string> command = {GFXREPRO_MOCK_PROGRAM, "run"};
    if (fs::exists(dir + "/plan.json")) {
        command.insert(command.end(), {"--resume", dir, "--retry"});
    } else {
        command.insert(command.end(), {config, "--device", "software", "--out", dir});
    }
    BackgroundProgram run(command);
    std::this_thread::sleep_for(std::chrono::milliseconds(delayMs));
    if (isRunner) {
        run.signal(SIGKILL);
    } else {
        for (const pid_t worker : backgroundWorkers()) ::kill(worker, SIGKILL);
    }
    run.wait();
}

std::size_t measuredCount(const std::string& dir) {
    return fs::exists(dir + "/records.csv") ? rowsOf(dir, "number").size() : 0;
}

TEST(Kill, AnyProcessAtAnyMomentLosesNothing) {
    const TemporaryFolder folder;
    const std::string config = writeMockConfig(
        folder,
        "params: {pause_ms: 30}\nsweep:\n  number: {range: [1, 12]}\n"
        "layout:\n  rows: number\n  columns:\n    n: {metric: number, format: \"{median:.0f}\"}\n");
    const std::string whole = folder.path() / "whole";
    ASSERT_EQ(mockGfxrepro({"run", config, "--device", "software", "--out", whole}).exitCode, 0);
    ASSERT_EQ(mockGfxrepro({"table", whole}).exitCode, 0);
    std::mt19937 random(20261121);
    std::size_t unfinished = 0;
    for (int i = 0; i < kFolders; ++i) {
        const std::string dir = folder.path() / ("killed" + std::to_string(i));
        std::size_t measured = 0;
        for (int moment = 0; moment < kMomentsInFolder; ++moment) {
            const int delayMs = static_cast<int>(random() % kLatestMs);
            const bool isRunner = random() % 2 == 0;
            runAndKill(config, dir, delayMs, isRunner);
            const std::size_t now = measuredCount(dir);
            EXPECT_GE(now, measured) << dir << ", " << delayMs << " ms";
            measured = now;
            unfinished += now < 12 ? 1 : 0;
        }
        // A run that was killed before its plan was frozen is begun, not continued.
        const ProcessResult last =
            fs::exists(dir + "/plan.json")
                ? mockGfxrepro({"run", "--resume", dir, "--retry"})
                : mockGfxrepro({"run", config, "--device", "software", "--out", dir});
        EXPECT_EQ(last.exitCode, 0) << last.err;
        EXPECT_EQ(mockGfxrepro({"table", dir}).exitCode, 0);
        for (const char* file : {"csv", "md", "tex"}) {
            const std::string name = std::string("/tables/sweep-mock.") + file;
            EXPECT_EQ(readFile(dir + name), readFile(whole + name)) << dir;
        }
    }
    RecordProperty("unfinished", static_cast<int>(unfinished));
    EXPECT_GT(unfinished, 0U) << "every kill came too late to test anything";
}

}  // namespace
}  // namespace gfxrepro::test
