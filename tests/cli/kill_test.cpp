// The runner, its workers or both are killed at 25 random moments (GFXREPRO_TEST_KILLS: at as
// many): nothing measured is lost, nothing is left, and the tables end as those of a run that
// nobody touched.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <random>
#include <thread>

#include "runner/core/files.h"
#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

namespace fs = std::filesystem;

constexpr int kMoments = 25;
constexpr int kMomentsInFolder = 5;
constexpr int kLatestMs = 700;  // a run that nobody kills takes a little more

enum class Victim { Runner, Workers, Both };

int folderCount() {
    const char* moments = std::getenv("GFXREPRO_TEST_KILLS");
    return (moments ? std::atoi(moments) : kMoments) / kMomentsInFolder;
}

/// Starts or continues the run in `dir` and kills something `delayMs` later.
void runAndKill(const std::string& config, const std::string& dir, int delayMs, Victim victim) {
    std::vector<std::string> command = {GFXREPRO_MOCK_PROGRAM, "run"};
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
    for (int i = 0; i < folderCount(); ++i) {
        const std::string dir = folder.path() / ("killed" + std::to_string(i));
        std::size_t measured = 0;
        for (int moment = 0; moment < kMomentsInFolder; ++moment) {
            const int delayMs = static_cast<int>(random() % kLatestMs);
            runAndKill(config, dir, delayMs, static_cast<Victim>(random() % 3));
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
        EXPECT_TRUE(temporaryFiles(dir).empty()) << dir;
        EXPECT_EQ(rowsOf(dir, "number").size(), 12U) << dir;
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
