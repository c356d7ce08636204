// What `check` refuses of a config of one's own program, and what it says.
#include <fmt/format.h>

#include "engine/core/files.h"
#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

/// A program that draws random numbers, of which nothing runs; `images` is that of its picture.
struct OwnProgram : FolderTest {
    struct Parts {
        std::string metrics = "{rays: ray}";
        std::string truth = "{n: 4096, seed: 99}";
        std::string command = "true {n} {pattern} {seed} {out}/p.pfm";
    };
    ProcessResult check(const std::string& lines, const Parts& parts) const {
        const std::string head = fmt::format(
            "sweep_of: mine\ntitle: Mine\nprogram:\n  command: {}\n"
            "  params: {{n: 16, pattern: [even, odd]}}\n  metrics: {}\n"
            "  images: {{p: {{file: p.pfm, truth: {}}}}}\nsweep: {{pattern: all, n: [4, 16]}}\n",
            parts.command, parts.metrics, parts.truth);
        ProcessResult result = gfxrepro({"check", folder.write("mine.yaml", head + lines)});
        for (std::string* text : {&result.out, &result.err}) {
            const std::string prefix = folder.path().string();
            for (std::size_t at; (at = text->find(prefix)) != std::string::npos;) {
                text->replace(at, prefix.size(), "DIR");
            }
        }
        return result;
    }
    std::string refusal(const std::string& lines, const Parts& parts) const {
        const ProcessResult result = check(lines, parts);
        EXPECT_EQ(result.exitCode, 2) << lines << result.out;
        return result.err;
    }
    std::string refusal(const std::string& lines) const { return refusal(lines, {}); }
};

TEST_F(OwnProgram, ATestOfMeansIsOfATruthOfSeveralFrames) {
    const std::string column = "layout: {rows: [pattern, n], columns: {b: {metric: bias_seen";
    const std::string none =
        "allowed: none, as no image has a truth of several 'frames': {frame: 1000, frames: 6}\n";
    EXPECT_EQ(refusal(column + ", pass: p}}}\n"),
              "gfxrepro: DIR/mine.yaml:9:43: metric 'bias_seen' is not taken of 'p'; " + none);
    EXPECT_THAT(refusal(column + "}}}\n"), HasSubstr("allowed: none, as no image has"));
    EXPECT_THAT(refusal("claims: {b: {says: so, bound: bias_seen, at_most: 0.1}}\n"),
                HasSubstr("claim 'b': 'bias_seen' is no column; it is of an image whose truth has "
                          "several 'frames' (columns: "));
    Parts several;
    several.command = "true {n} {pattern} {frame} {out}/p.pfm";
    several.truth = "{n: 4096, frame: 1000, frames: 6}";
    EXPECT_EQ(check("claims: {b: {says: so, bound: bias_seen, at_most: 0.1}}\n"
                    "output: {frames: 4}\n",
                    several)
                  .err,
              "");
}

TEST_F(OwnProgram, WhatIsOfNoPassSaysWhatToWrite) {
    const std::string columns = "layout: {rows: [pattern, n], columns: {a: {metric: ";
    EXPECT_EQ(
        refusal(columns + "rays, pass: nonexistent}}}\n"),
        "gfxrepro: DIR/mine.yaml:9:43: technique 'external' has no pass 'nonexistent'; it has p\n");
    EXPECT_THAT(refusal(columns + "gpu_time_ms}}}\n"),
                HasSubstr("names none; allowed: none, as there are no passes; the time of a whole "
                          "frame is wall_time_ms\n"));
    EXPECT_EQ(refusal(columns + "frame_ms}}}\n"),
              "gfxrepro: DIR/mine.yaml:9:43: technique 'external' has no metric 'frame_ms'; the "
              "time of a frame is the metric wall_time_ms\n");
    EXPECT_THAT(refusal("claims: {c: {says: so, trend: wall_time_ms, over: n, at_most: 2}}\n"),
                HasSubstr("'wall_time_ms' is no column; its column is 'frame_ms' (columns: "));
}

TEST_F(OwnProgram, AMetricHasANameOfItsOwn) {
    const auto named = [&](const std::string& metric) {
        Parts parts;
        parts.metrics = metric;
        return refusal("", parts);
    };
    EXPECT_EQ(named("{n: \"1\"}"),
              "gfxrepro: DIR/mine.yaml:6:13: program: metric 'n' has the name of an axis that is "
              "swept; allowed: another\n");
    EXPECT_THAT(named("{seed: \"1\"}"), HasSubstr("the name of an axis that any program may have"));
    EXPECT_THAT(named("{frame_ms: ms}"),
                HasSubstr("the name of the column of wall_time_ms, a frame's time"));
}

TEST_F(OwnProgram, ATruthIsNoCase) {
    const auto of = [&](const std::string& truth, const std::string& lines = "") {
        Parts parts;
        parts.truth = truth;
        return check(lines, parts).err;
    };
    EXPECT_EQ(of("{n: 16, seed: 1}"),
              "gfxrepro: DIR/mine.yaml:7:36: program: image 'p': truth: {n: 16, seed: 1} is what "
              "makes the case sweep/mine pattern=even n=16 itself, whose error would be 0 whatever "
              "the program does; allowed: a parameter, 'seed' or 'frame' that no case has\n");
    EXPECT_THAT(of("{n: 16, seed: 5001}"), HasSubstr("makes the case")) << "of the sixth process";
    EXPECT_EQ(of("{n: 16, seed: 6001}"), "");
    const std::string goesOn = "measure: {processes: 6, time_budget_s: 60}\n";
    EXPECT_THAT(of("{n: 16, seed: 19001}", goesOn), HasSubstr("makes the case")) << "the last";
    EXPECT_EQ(of("{n: 16, seed: 20001}", goesOn), "");
    EXPECT_EQ(of("{n: 16, seed: 2}"), "");
    EXPECT_EQ(of("{n: 64, seed: 1}"), "");
    EXPECT_EQ(of("{pattern: even}"), "");
    EXPECT_THAT(gfxrepro({"check", folder.path() / "mine.yaml", "--sweep", "pattern=even"}).err,
                HasSubstr("makes the case"))
        << "each of them";
}

/// One of the methods that are compared, or the most samples.
TEST_F(OwnProgram, ACaseThatIsTheTruthOfOthersIsSaid) {
    const auto of = [&](const std::string& truth) {
        Parts parts;
        parts.truth = truth;
        const ProcessResult result = check("", parts);
        EXPECT_EQ(result.exitCode, 0) << result.err;
        return result.out;
    };
    EXPECT_THAT(
        of("{pattern: even, n: 16}"),
        HasSubstr("mine.yaml: sweep/mine pattern=even n=16 is the truth of 'p' ({pattern: even, n: "
                  "16}) by itself: its errors are 0 whatever the program does.\n"));
    EXPECT_THAT(of("{n: 16}"), HasSubstr("2 cases, sweep/mine pattern=even n=16 the first, are "
                                         "each the truth of 'p' ({n: 16}) by itself: "));
    EXPECT_THAT(of("{n: 64}"), Not(HasSubstr("by itself")));
}

TEST_F(OwnProgram, TheLaneOfTheCommandLineIsThatOfTheTable) {
    for (const char* lines :
         {"layout: {rows: [pattern, n], columns: {t: {metric: wall_time_ms}}}\n",
          "claims: {c: {says: so, order: [even, odd], of: frame_ms}}\n"}) {
        const std::string quality = fmt::format("measure: {{lane: quality}}\n{}", lines);
        EXPECT_THAT(refusal(quality), HasSubstr("'lane: quality' takes no times"));
        const auto file = folder.path() / "mine.yaml";
        for (const char* set : {"measure.lane=timing", "measure={lane: timing}"}) {
            const ProcessResult result = gfxrepro({"check", file, "--set", set});
            EXPECT_EQ(result.exitCode, 0) << result.err;
        }
    }
}

TEST_F(OwnProgram, AnArgumentThatIsNotThereIsSaid) {
    folder.write("beside.py", "");
    const auto said = [&](const std::string& argument) {
        Parts parts;
        parts.command = "true " + argument + " {n} {pattern} {seed}";
        return check("", parts).out;
    };
    EXPECT_THAT(said("{here}/absent.py"),
                HasSubstr("the command's '{here}/absent.py' is not there: DIR/absent.py\n"));
    EXPECT_THAT(said("beside.py"),
                HasSubstr("the command's 'beside.py' is a file beside the config, and the program "
                          "runs in {out}; there it is {here}/beside.py\n"));
    EXPECT_THAT(said("{here}/beside.py"), Not(HasSubstr("the command's")));
}

/// What rows a table that nobody laid out has is known with an override, too.
TEST_F(OwnProgram, AnOverrideLeavesTheRowsThatClaimsCompare) {
    const auto file = folder.write(
        "mine.yaml",
        "sweep_of: mine\ntitle: Mine\nprogram:\n  command: true {n} {pattern} {seed} {out}/p.pfm\n"
        "  params: {n: 16, pattern: [even, odd]}\n"
        "  images: {p: {file: p.pfm, truth: {n: 4096, seed: 99}}}\nsweep: {pattern: all}\n"
        "claims: {c: {says: so, order: [odd, even], of: rmse}}\n");
    for (const char* given : {"measure.processes=10", "measure.lane=quality"}) {
        const ProcessResult result = gfxrepro({"check", file, "--set", given});
        EXPECT_EQ(result.exitCode, 0) << result.err;
        EXPECT_THAT(result.out, Not(HasSubstr("unmeasured")));
    }
}

/// What a table that nobody laid out divides, a claim reads as a time, too.
TEST_F(OwnProgram, AQuotientOfTimesIsATime) {
    const auto file =
        folder.write("mine.yaml",
                     "sweep_of: mine\ntitle: Mine\ntechnique: voxelization\n"
                     "scene: models/duck\nsweep: {rule: [rasterized, thin]}\n"
                     "scene_seeds: 3\nmeasure: {lane: quality}\n"
                     "claims: {c: {says: so, bound: \"frame ÷ rasterized\", at_most: 1.2}}\n");
    EXPECT_THAT(gfxrepro({"check", file}).err,
                HasSubstr("mine.yaml:8:10: 'scene_seeds' takes no times, and claim 'c' reads "
                          "'frame ÷ rasterized'; allowed: scene_seeds: 1\n"));
}

}  // namespace
}  // namespace gfxrepro::test
