// A device whose clock is broken: no number of it is believed, and that is said.

#include <map>

#include "engine/core/files.h"
#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

struct BrokenClock : FolderTest {
    BrokenClock() {
        writeFileAtomic(folder.path() / "torus.yaml",
                        "sweep_of: torus\ntitle: A torus\ntechnique: voxelization\n"
                        "scene: shapes/torus\nparams: {resolution: 32}\n"
                        "output: {width: 32, height: 32}\n"
                        "measure: {lane: timing, processes: 1, repeats: 20}\n");
    }
    ProcessResult with(const std::string& clock, std::vector<std::string> arguments,
                       const std::string& more = "") const {
        arguments.insert(arguments.begin(), GFXREPRO_PROGRAM);
        return runProgram(arguments,
                          {"LD_PRELOAD=" GFXREPRO_BROKEN_CLOCK + more, "BROKEN_CLOCK=" + clock});
    }
    ProcessResult measured(const std::string& clock, const std::string& device = "software",
                           const std::string& more = "") const {
        return with(clock,
                    {"run", folder.path() / "torus.yaml", "--device", device, "--quiet", "--out",
                     runOf(clock)},
                    more);
    }
    fs::path runOf(const std::string& clock) const { return folder.path() / clock; }
};

TEST_F(BrokenClock, OneThatGoesOtherwiseThanTheProcessorsGivesNoTimesOfTheDevice) {
    for (const std::string clock : {"none", "zero", "slow", "fast"}) {
        EXPECT_THAT(endedWith(0, measured(clock)).err,
                    HasSubstr("; it has no clock for GPU times\n"))
            << clock;
        EXPECT_TRUE(rowsOf(runOf(clock), "gpu_time_ms").empty()) << clock;
        // What other clocks told is kept.
        EXPECT_FALSE(rowsOf(runOf(clock), "wall_time_ms").empty()) << clock;
        EXPECT_FALSE(rowsOf(runOf(clock), "process_time_ms").empty()) << clock;
        const ProcessResult doctor = with(clock, {"doctor"});
        EXPECT_THAT(doctor.out, HasSubstr(", no clock for GPU times\n")) << clock;
        EXPECT_THAT(doctor.out, HasSubstr("it has no clock for GPU times, or one that")) << clock;
    }
}

TEST_F(BrokenClock, OneThatBreaksEndsTheCase) {
    const std::map<std::string, std::string> words = {
        {"back", "runs backwards"}, {"still", "stands still"}, {"stuck", "stands still"},
        {"late", "runs slowly"},    {"ahead", "runs ahead"},   {"short", "wraps"}};
    for (const auto& [clock, what] : words) {
        const ProcessResult run = measured(clock);
        EXPECT_EQ(run.exitCode, 4) << clock << run.err;
        EXPECT_TRUE(rowsOf(runOf(clock), "gpu_time_ms").empty()) << clock;
        EXPECT_THAT(readFile(runOf(clock) / "records.csv"),
                    ContainsRegex("pass '[a-z_]+': the device's clock " + what + ": "));
    }
}

/// Its passes are not waited for one by one, and may be shorter than a step of the clock.
TEST_F(BrokenClock, OneOfAGpuThatStandsStillEndsTheCase) {
    constexpr const char* kPretended = "00112233-4455-6677-8899-aabbccddeeff";
    const ProcessResult run = measured("stuck", kPretended, ":" GFXREPRO_PRETENDED_GPU);
    EXPECT_EQ(run.exitCode, 4) << run.err;
    EXPECT_THAT(run.err, HasSubstr("Pretended GPU"));
    EXPECT_TRUE(rowsOf(runOf("stuck"), "gpu_time_ms").empty());
    EXPECT_THAT(readFile(runOf("stuck") / "records.csv"),
                HasSubstr("the device's clock stands still: "));
}

TEST_F(BrokenClock, OneOfFewBitsIsReadPastItsEnd) {
    endedWith(0, measured("wraps"));
    std::map<int, double> wallMs;
    for (const auto& row : rowsOf(runOf("wraps"), "wall_time_ms")) wallMs[row.repeat] = row.value;
    EXPECT_EQ(wallMs.size(), 20U);
    const std::vector<records::Record> rows = rowsOf(runOf("wraps"), "gpu_time_ms");
    EXPECT_GE(rows.size(), 20U);
    for (const records::Record& row : rows) {
        if (row.repeat == records::kSetup) continue;
        EXPECT_GT(row.value, 0.0) << row.repeat;
        EXPECT_LE(row.value, wallMs[row.repeat]) << row.repeat;
    }
}

TEST_F(BrokenClock, DoctorSaysWhatAGoodOneIsWorth) {
    EXPECT_THAT(with("", {"doctor"}).out,
                ContainsRegex("GPU times of [0-9]+ bits in steps of [1-9][0-9]* ns"));
}

}  // namespace
}  // namespace gfxrepro::test
