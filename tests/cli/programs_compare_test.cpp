// Two builds of a program of one's own, measured by turns.

#include "engine/core/files.h"
#include "engine/core/hash.h"
#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

struct TwoBuilds : FolderTest {
    /// A build in `place` that says how long it takes, and leaves a picture of 64 × 64 pixels.
    void build(const std::string& place, int ms, char first = 'a', char others = 'd') const {
        writeProgram(folder, place,
                     "#!/bin/sh\necho '{\"metric\": \"own_ms\", \"value\": " + std::to_string(ms) +
                         ", \"unit\": \"ms\"}' >&3\n{ printf 'P5 64 64 255\\n" + first +
                         "'; head -c 4095 /dev/zero | tr '\\0' " + others +
                         "; } >\"$1/result.pgm\"\n");
    }
    std::string config(const std::string& command, const std::string& name = "mine") const {
        return folder.write(name + ".yaml",
                            "sweep_of: " + name + "\ntitle: Mine\nprogram:\n  command: " + command +
                                "\n  metrics: {own_ms: ms}\n  images: {result: result.pgm}\n");
    }
    ProcessResult compared(const std::vector<std::string>& configs,
                           const std::string& newer = "new") const {
        fs::remove_all(out);
        return gfxrepro(
            {"compare", "--programs", "--rounds", "2", "--out", out, "--history",
             folder.path() / "history.csv", folder.path() / "old", folder.path() / newer},
            configs);
    }
    std::string refusal(const std::vector<std::string>& configs) const {
        return refusalOf(compared(configs), folder);
    }

    std::string out = folder.path() / "out";
};

TEST_F(TwoBuilds, AProgramThatIsCalledByNameIsTheBuildsOwn) {
    build("old/renderer", 40);
    build("new/bin/renderer", 50);
    build("elsewhere/renderer", 60);
    const std::string mine = config("renderer {out}");
    const ProcessResult slower = endedWith(1, compared({mine}));
    EXPECT_THAT(slower.out, HasSubstr("alarm; measuring again\n"));
    EXPECT_THAT(slower.out,
                HasSubstr("sweep/mine external own_ms: slower × 1.250 [1.250, 1.250]\n"));
    EXPECT_THAT(readFile(out + "/comparison.md"), HasSubstr("own\\_ms | 40 | 50 ms | 1.250"));
    const std::string sha = sha256OfFile(folder.path() / "new/bin/renderer").substr(0, 12);
    EXPECT_THAT(readFile(folder.path() / "history.csv"),
                AllOf(HasSubstr("Z," + sha + ","), HasSubstr(", no graphics device\",sweep/mine")))
        << "the program, and not what measures it";
    EXPECT_EQ(rowsOf(out + "/new-00", "own_ms").size(), 2U) << "no seed: whether two differ";
}

TEST_F(TwoBuilds, FilesThatACommandNamesFromHereOnAreTheBuildsOwn) {
    for (const char* place : {"", "old/", "new/"}) {
        build(std::string(place) + "renderer.sh", place == std::string("new/") ? 40 : 50);
    }
    const ProcessResult faster = endedWith(0, compared({config("sh {here}/renderer.sh {out}")}));
    EXPECT_THAT(faster.out, HasSubstr("1 faster, "));
}

/// As of two builds of gfxrepro; one build draws the same bit by bit.
TEST_F(TwoBuilds, APictureMayDifferByWhatTwoBuildsMayDiffer) {
    build("old/renderer", 40);
    build("new/renderer", 40, 'b');
    const std::string mine = config("renderer {out}");
    endedWith(0, compared({mine}));
    build("new/renderer", 40, 'a', 'g');
    EXPECT_THAT(endedWith(1, compared({mine})).out,
                HasSubstr("sweep/mine external picture/result: changed: FLIP "));
}

TEST_F(TwoBuilds, ABuildThatFailsIsAnAlarm) {
    build("old/renderer", 40);
    writeProgram(folder, "new/renderer", "#!/bin/sh\nexit 3\n");
    EXPECT_THAT(endedWith(1, compared({config("renderer {out}")})).out,
                HasSubstr("own_ms: lost: error: program 'renderer' ended with exit code 3"));
}

TEST_F(TwoBuilds, RefusesWhatIsNoBuild) {
    build("old/renderer", 40);
    build("renderer.sh", 40);
    const std::string byName = config("renderer {out}");
    EXPECT_EQ(refusal({byName}), "gfxrepro: DIR/new is no folder\n");
    fs::create_directory(folder.path() / "new");
    EXPECT_EQ(refusal({byName}),
              "gfxrepro: DIR/new has no renderer, which DIR/mine.yaml calls; a build's program is "
              "called by its name alone, and lies in its folder or in bin/ there, or by {here}/\n");
    // One of the system's own is not taken for it.
    EXPECT_THAT(refusal({config("env sh {here}/renderer.sh {out}")}),
                EndsWith("DIR/old has no renderer.sh, which the command of DIR/mine.yaml names "
                         "from {here}/ on\n"));
    EXPECT_THAT(refusal({writeMockConfig(folder, "params: {number: 1}\n")}),
                EndsWith(": has no 'program', of which two builds could be compared\n"));
    build("old/renderer.sh", 40);
    EXPECT_THAT(refusal({config("renderer {out}"), config("sh {here}/renderer.sh {out}", "other")}),
                EndsWith("DIR/mine.yaml calls its program by name, and DIR/other.yaml from {here} "
                         "on: compare them one by one\n"));
    EXPECT_EQ(gfxrepro({"compare", "--programs", "a", "b"}).err,
              "gfxrepro: compare: --programs needs OLD_DIR NEW_DIR CONFIG…\n");
    EXPECT_THAT(gfxrepro({"compare", "--programs", "--binaries", "a", "b", byName}).err,
                HasSubstr("--binaries excludes --programs"));
}

TEST_F(TwoBuilds, TwoRunsTakenApartSayHowToTellMore) {
    build("renderer.sh", 40);
    const std::string mine = config("sh {here}/renderer.sh {out}");
    for (const char* run : {"a", "b"}) {
        ASSERT_EQ(gfxrepro({"run", mine, "--out", folder.path() / run}).exitCode, 0);
    }
    EXPECT_THAT(
        endedWith(0, gfxrepro({"compare", folder.path() / "a", folder.path() / "b", "--out", out}))
            .out,
        HasSubstr("of two runs only times that differ by more than × 1.5 are told, as a machine "
                  "drifts between them; by turns 2 % are: gfxrepro compare --programs OLD_DIR "
                  "NEW_DIR CONFIG\n"));
}

}  // namespace
}  // namespace gfxrepro::test
