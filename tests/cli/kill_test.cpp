// The runner, its workers or both are killed at 25 random moments (GFXREPRO_TEST_KILLS: at as
// many), some of them on a disk that is nearly full, some with the write of a unit cut anywhere:
// nothing measured is lost but what was cut, nothing is left, and the tables end as those of a run
// that nobody touched.
#include <signal.h>

#include <chrono>
#include <cstdlib>
#include <random>
#include <thread>

#include "engine/core/files.h"
#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

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
