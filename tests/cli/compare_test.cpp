// Two builds measured alternately, and two runs compared.

#include <array>
#include <filesystem>

#include "engine/core/files.h"
#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

struct Compare : FolderTest {
    /// The mock program, slower by `extraMs` in each iteration, whose picture is of this shade.
    std::string program(const std::string& name, int extraMs,
                        const std::string& shade = "0.5") const {
        const fs::path path = writeProgram(
            folder, name,
            "#!/bin/sh\nGFXREPRO_MOCK_EXTRA_MS=" + std::to_string(extraMs) +
                " GFXREPRO_MOCK_SHADE=" + shade + " exec " + GFXREPRO_MOCK_PROGRAM + " \"$@\"\n");
        return path;
    }
    ProcessResult byTurns(int extraMs) const {
        const fs::path config =
            writeMockConfig(folder,
                            "params: {busy_ms: 20}\n"
                            "measure: {lane: timing, processes: 1, repeats: 2}\n");
        return mockGfxrepro({"compare", "--binaries", "--rounds", "8", "--profile", "full",
                             "--device", "software", "--history", history, "--out", out,
                             program("old", 0), program("new", extraMs), config});
    }
    /// Two rounds, in a new folder.
    ProcessResult compared(const std::string& older, const std::string& newer,
                           const fs::path& config) const {
        fs::remove_all(out);
        return mockGfxrepro({"compare", "--binaries", "--rounds", "2", "--device", "software",
                             "--out", out, older, newer, config});
    }
    /// Runs of the config in folders a and b.
    std::array<std::string, 2> twoRuns(const fs::path& config, int exitCode = 0) const {
        std::array<std::string, 2> dirs{folder.path() / "a", folder.path() / "b"};
        for (const std::string& dir : dirs) {
            EXPECT_EQ(mockGfxrepro({"run", config, "--out", dir}).exitCode, exitCode);
        }
        return dirs;
    }

    std::string out = folder.path() / "out";
    std::string history = folder.path() / "history.csv";
};

TEST_F(Compare, FindsASlowerBuildAndConfirmsIt) {
    const ProcessResult result = endedWith(1, byTurns(40));
    EXPECT_EQ(result.out.find("alarm; measuring again\n"), 0U) << result.out;
    EXPECT_THAT(result.out, HasSubstr("_time_ms: slower"));
    EXPECT_THAT(readFile(out + "/comparison.md"), HasSubstr("| slower |"));
    EXPECT_THAT(readFile(out + "/junit.xml"), HasSubstr("<failure message=\"slower"));
    EXPECT_THAT(readFile(out + "/benchmark.json"), HasSubstr("_time_ms"));
    EXPECT_TRUE(fs::exists(out + "/old-15/records.csv")) << "confirmed in fresh processes";
    EXPECT_THAT(readFile(history), HasSubstr("_time_ms"));
}

TEST_F(Compare, TheSameBuildRaisesNoAlarm) {
    endedWith(0, byTurns(0));
}

TEST_F(Compare, RunsOfOneProcessCannotTellTimes) {
    const fs::path config =
        writeMockConfig(folder, "measure: {lane: timing, processes: 1, repeats: 2}\n");
    const auto [a, b] = twoRuns(config);
    EXPECT_THAT(endedWith(0, mockGfxrepro({"compare", a, b, "--out", out})).out,
                HasSubstr("by turns 2 % are: gfxrepro compare --binaries OLD NEW CONFIG\n"));
    EXPECT_THAT(readFile(out + "/comparison.md"), HasSubstr("1 and 1 processes cannot decide"));
}

TEST_F(Compare, ABuildThatCrashesIsAnAlarm) {
    const fs::path config = writeMockConfig(folder, "measure: {lane: quality}\n");
    const fs::path crashing =
        writeProgram(folder, "crashing",
                     "#!/bin/sh\nexec " GFXREPRO_MOCK_PROGRAM " \"$@\" --set behaviour=crash\n");
    const ProcessResult lost = endedWith(1, compared(program("old", 0), crashing, config));
    EXPECT_THAT(lost.out, HasSubstr(": lost: crash: "));
    EXPECT_THAT(readFile(out + "/junit.xml"), HasSubstr("<failure message=\"lost: crash: "));
    const ProcessResult both = endedWith(4, compared(crashing, crashing, config));
    EXPECT_THAT(both.out, HasSubstr("sweep/mock mock status: failed on both sides: crash: "));
    EXPECT_THAT(both.out, HasSubstr("\n1 failed on both sides; "));
    EXPECT_THAT(readFile(out + "/junit.xml"),
                HasSubstr("<skipped message=\"failed on both sides: crash: "));
}

/// To confirm it only what is lost is measured again, of which that build knows nothing.
TEST_F(Compare, ATableThatABuildLeavesOutIsAnErrorWithAName) {
    const std::string one = writeMockConfig(folder, "sweep: {number: [1]}\n");
    const std::string two = folder.write("two.yaml",
                                         "sweep_of: two\ntitle: T\ntechnique: mock\n"
                                         "measure: {lane: quality}\n");
    const fs::path program =
        writeProgram(folder, "fewer",
                     "#!/bin/sh\nfor a; do shift; case $a in */two.yaml) ;; *) set -- \"$@\" "
                     "\"$a\";; esac; done\nexec " GFXREPRO_MOCK_PROGRAM " \"$@\"\n");
    EXPECT_THAT(endedWith(2, mockGfxrepro({"compare", "--binaries", "--rounds", "2", "--device",
                                           "software", "--out", folder.path() / "turns",
                                           GFXREPRO_MOCK_PROGRAM, program, one, two}))
                    .err,
                HasSubstr("/fewer: exit code 2: gfxrepro: run: give PAPER"));
}

TEST_F(Compare, ACaseThatNeitherSideMeasuredWeighsMoreThanAnAlarm) {
    const fs::path config =
        writeMockConfig(folder, "sweep: {behaviour: [ok, throw]}\nmeasure: {lane: quality}\n");
    const ProcessResult both =
        endedWith(4, compared(program("old", 0), program("new", 0, "0.75"), config));
    EXPECT_THAT(both.out, HasSubstr("picture/flat: changed: "));
    EXPECT_THAT(both.out, HasSubstr("status: failed on both sides: "));
}

TEST_F(Compare, TimesThatAreVoidOnBothSidesAreNamed) {
    const fs::path config = writeMockConfig(
        folder, "params: {behaviour: blank}\nmeasure: {lane: timing, processes: 1, repeats: 2}\n");
    const auto [a, b] = twoRuns(config, 4);
    const ProcessResult result = endedWith(0, mockGfxrepro({"compare", a, b, "--out", out}));
    EXPECT_THAT(result.out, HasSubstr("_time_ms: void on both sides: frame 0: the picture of "
                                      "repeat 0 is blank: all its pixels are the same\n"));
    EXPECT_THAT(result.out, HasSubstr("1 void on both sides; "));
}

TEST_F(Compare, SaysThatTimesOfTheQualityLaneAreNotCompared) {
    const fs::path config = writeMockConfig(folder, "measure: {lane: quality}\n");
    const std::string a = folder.path() / "a";
    ASSERT_EQ(mockGfxrepro({"run", config, "--out", a}).exitCode, 0);
    EXPECT_THAT(endedWith(0, mockGfxrepro({"compare", a, a, "--out", out})).out,
                HasSubstr("one case is of the quality lane: times that are not compared\n"));
}

TEST_F(Compare, APictureThatChangedIsAnAlarmAndIsKept) {
    const fs::path config = writeMockConfig(folder, "sweep: {number: [1, 2]}\n");
    const ProcessResult result =
        endedWith(1, compared(program("old", 0), program("new", 0, "0.75"), config));
    EXPECT_THAT(result.out, HasSubstr("alarm; measuring again\n"));
    EXPECT_THAT(result.out, HasSubstr("sweep/mock mock picture/flat, number=1: changed: FLIP "));
    EXPECT_THAT(result.out, HasSubstr("largest difference 0.25 (0 allowed)"));
    EXPECT_THAT(result.out, Not(HasSubstr("picture/truth: changed"))) << "it is the same";
    std::size_t kept = 0;
    for (const auto& entry : fs::directory_iterator(out + "/pictures/sweep-mock")) {
        kept += entry.path().string().ends_with("-flat-flip.png") ? 1 : 0;
    }
    EXPECT_EQ(kept, 2U) << "a map a case";
    const std::string junit = readFile(out + "/junit.xml");
    EXPECT_THAT(junit, HasSubstr("<failure message=\"changed: FLIP "));
    EXPECT_THAT(junit, HasSubstr(", number=2\"")) << "cases with names of their own";
    EXPECT_THAT(readFile(out + "/comparison.md"), HasSubstr("[difference](pictures/sweep-mock/"));
    EXPECT_FALSE(fs::exists(out + "/benchmark.json")) << "a file without times";
}

TEST_F(Compare, PicturesThatABuildNoLongerRecordsAreAnAlarm) {
    const fs::path config = writeMockConfig(folder, "params: {number: 1}\n");
    EXPECT_THAT(endedWith(1, compared(program("old", 0), program("new", 0, "none"), config)).out,
                HasSubstr("sweep/mock mock picture/flat: lost: recorded before only\n"));
}

TEST_F(Compare, ARunThatLostItsPicturesIsAnAlarmAndOneThatNeverHadThemIsNot) {
    const fs::path config = writeMockConfig(folder, "params: {number: 1}\n");
    const auto [a, b] = twoRuns(config);
    fs::remove_all(b + "/images");
    const ProcessResult lost = endedWith(1, mockGfxrepro({"compare", a, b, "--out", out}));
    EXPECT_THAT(lost.out, HasSubstr("sweep/mock mock picture/flat: lost: recorded before only\n"));
    EXPECT_THAT(readFile(out + "/junit.xml"),
                HasSubstr("<failure message=\"lost: recorded before only"));
    const ProcessResult never =
        mockGfxrepro({"compare", b, a, "--out", out + "2"});  // kept results
    EXPECT_EQ(never.exitCode, 0) << never.out << never.err;
    EXPECT_THAT(never.out,
                HasSubstr("warning: the older run has no pictures: none are compared\n"));
    EXPECT_EQ(mockGfxrepro({"compare", b, b, "--out", out + "3"}).exitCode, 0);
}

TEST_F(Compare, ADriverThatDoesNotAnswerIsNoDevice) {
    const fs::path config = writeMockConfig(folder, "params: {number: 1}\n");
    EXPECT_EQ(endedWith(3, runProgram({GFXREPRO_MOCK_PROGRAM, "compare", "--binaries", "--device",
                                       "software", "--out", out, program("old", 0),
                                       program("new", 0), config},
                                      {"GFXREPRO_MOCK_DRIVER_HANGS=1", "GFXREPRO_START_LIMIT_S=1"}))
                  .err,
              "gfxrepro: " + program("old", 0) +
                  ": exit code 3: gfxrepro: the driver did not open a device within 1 s\n\n");
}

TEST_F(Compare, RefusesWhatIsNoPair) {
    EXPECT_EQ(mockGfxrepro({"compare", "a"}).err, "gfxrepro: compare: needs two run directories\n");
    EXPECT_EQ(mockGfxrepro({"compare", "--binaries", "a", "b"}).err,
              "gfxrepro: compare: --binaries needs OLD NEW CONFIG…\n");
    const ProcessResult result = endedWith(2, mockGfxrepro({"compare", "--binaries", "--out", out,
                                                            "/bin/false", "/bin/false", "c.yaml"}));
    EXPECT_THAT(result.err, StartsWith("device "));
    EXPECT_THAT(result.err, EndsWith("\ngfxrepro: /bin/false: exit code 1: \n"));
}

}  // namespace
}  // namespace gfxrepro::test
