// Folders that cannot be written to, and disks that are full.
#include <unistd.h>

#include "engine/core/files.h"
#include "runner/records/images.h"
#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

/// The mock in a shell, where no file can grow beyond `blocks` of 512 bytes: what a full disk looks
/// like to a program that outlives the signal.
ProcessResult mockWithFullDisk(const std::string& arguments, int blocks) {
    return runProgram({"/bin/sh", "-c",
                       "trap '' XFSZ; ulimit -f " + std::to_string(blocks) + "; exec " +
                           GFXREPRO_MOCK_PROGRAM + " " + arguments});
}

using Disk = test::RunTest;

TEST_F(Disk, ALimitOnFilesIsAWriteThatFails) {
    const std::string config = writeMockConfig(folder, "sweep: {number: [1, 2]}\n");
    const ProcessResult run =
        endedWith(2, runProgram({"/bin/sh", "-c",
                                 std::string("ulimit -f 1; exec ") + GFXREPRO_MOCK_PROGRAM +
                                     " run " + config + " --device software --out " + dir}));
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
    for (const char* file : {"csv", "md", "tex"}) {
        const std::string name = std::string("/tables/sweep-mock.") + file;
        EXPECT_EQ(readFile(full + name), readFile(whole + name));
    }
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

}  // namespace
}  // namespace gfxrepro::test
