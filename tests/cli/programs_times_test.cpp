// By which clock programs are judged, when they are timed, what is made of them once, and the seeds
// of their random numbers.
#include <algorithm>
#include <map>
#include <set>

#include "engine/core/files.h"
#include "engine/image/png_io.h"
#include "runner/records/images.h"
#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

/// `renderer.sh NUMBER OUT`: sleeps 0.24 s ÷ NUMBER, and says what stands in the file `own_ms`.
constexpr const char* kSleeper = R"(#!/bin/sh
here=$(dirname "$0")
case $1 in 1) sleep 0.24 ;; 2) sleep 0.12 ;; 4) sleep 0.06 ;; esac
echo "$1" >>"$here/runs"
cp "$here/picture.png" "$2/result.png"
echo "{\"metric\": \"own_ms\", \"value\": $(cat "$here/own_ms"), \"unit\": \"ms\"}" >&3
)";

constexpr const char* kSleeps =
    "sweep_of: mine\ntitle: Mine\ntechnique: external\n"
    "program:\n"
    "  command: \"{here}/renderer.sh {number} {out}\"\n"
    "  params: {number: {default: 8, min: 0, max: 99}}\n"
    "  metrics: {own_ms: ms}\n";
constexpr const char* kImages = "  images: {result: {file: result.png, truth: {number: 99}}}\n";

struct Timed : FolderTest {
    Timed() {
        writeProgram(folder, "renderer.sh", kSleeper);
        folder.write("own_ms", "50");
        draw(100);
    }
    void draw(std::uint8_t grey) const {
        image::Image8 picture(16, 16, 3, grey);
        picture.values()[0] = 7;
        image::writePng(folder.path() / "picture.png", picture);
    }
    ProcessResult reproduce(const std::string& config, const std::string& name = "run") const {
        return gfxrepro({"reproduce", folder.write("mine.yaml", config), "--out", runDir(name)});
    }
    std::string runDir(const std::string& name = "run") const { return folder.path() / name; }
    std::vector<double> valuesOf(const std::string& metric) const {
        std::vector<double> values;
        for (const records::Record& row : rowsOf(runDir(), metric)) values.push_back(row.value);
        return values;
    }
};

TEST_F(Timed, AProgramThatWaitsIsJudgedByTheClock) {
    endedWith(
        0,
        reproduce(
            std::string(kSleeps) +
            "sweep: {number: [1, 2, 4]}\n"
            "layout: {rows: number, columns: {ms: {metric: wall_time_ms}, own: {metric: own_ms}}}\n"
            "claims:\n"
            "  slope: {says: it falls with the number, trend: ms, over: number, at_least: -1.2, "
            "at_most: -0.6}\n"
            "  slower: {says: two take longer than four, kind: algorithmic, across: number, ratio: "
            "\"'2' / '4'\", at_least: 1.3, of: ms}\n"
            "  absolute: {says: it takes a tenth of a second, kind: absolute, bound: ms, at_least: "
            "100, at: {number: 1}}\n"));
    const std::string claims = readFile(runDir() + "/claims.csv");
    EXPECT_THAT(claims, Not(HasSubstr("CPU time")));
    EXPECT_THAT(claims, Not(HasSubstr("not-applicable")));
    EXPECT_EQ(std::ranges::count(claims, '\n'), 4);
    EXPECT_THAT(readFile(runDir() + "/tables/sweep-mine.csv"), Not(HasSubstr("cpu_ms")));
}

TEST_F(Timed, ItsOwnTimesAreComparedToo) {
    const std::string config = kSleeps + std::string("measure: {processes: 6}\n");
    ASSERT_EQ(reproduce(config, "before").exitCode, 0);
    folder.write("own_ms", "100");
    ASSERT_EQ(reproduce(config, "after").exitCode, 0);
    const std::string history = folder.path() / "history.csv";
    EXPECT_THAT(endedWith(1, gfxrepro({"compare", runDir("before"), runDir("after"), "--out",
                                       folder.path() / "compared", "--history", history}))
                    .out,
                HasSubstr("sweep/mine external own_ms: slower × 2.000"));
    for (const char* metric : {"own_ms", "wall_time_ms"}) {
        EXPECT_THAT(readFile(folder.path() / "compared" / "junit.xml"), HasSubstr(metric));
        EXPECT_THAT(readFile(history), HasSubstr(metric));
    }
}

/// Keys that are not given are what they would be without the others.
TEST_F(Timed, AKeyOfMeasureChangesThatKeyAlone) {
    const std::string shown =
        "params: {number: 8}\n"
        "layout: {rows: number, columns: {ms: {metric: wall_time_ms}, own: {metric: own_ms}}}\n";
    for (const std::string& config : {shown, shown + "measure: {time_budget_s: 50}\n",
                                      std::string("measure: {lane: timing, time_budget_s: 50}\n"),
                                      std::string("measure: {repeats: 1}\n")}) {
        fs::remove_all(runDir());
        ASSERT_EQ(reproduce(kSleeps + config).exitCode, 0) << config;
        EXPECT_EQ(rowsOf(runDir(), "wall_time_ms").size(), 6U) << config;
        EXPECT_THAT(readFile(runDir() + "/tables/sweep-mine.csv"), Not(HasSubstr("not timed")));
    }
    // What shows no time is not timed, but twice tells whether it comes to the same without a seed;
    // and what says how often is measured as often.
    for (const auto& [config, count] :
         {std::pair{std::string("layout: {columns: {n: {metric: peak_memory_bytes}}}\n"), 2U},
          std::pair{shown + "measure: {processes: 2}\n", 2U},
          std::pair{shown + "measure: {time_budget_s: 0}\n", 1U}}) {
        fs::remove_all(runDir());
        ASSERT_EQ(reproduce(kSleeps + config).exitCode, 0) << config;
        EXPECT_EQ(rowsOf(runDir(), "wall_time_ms").size(), count) << config;
    }
}

/// A round that ends is not the end.
TEST_F(Timed, ProgressIsThatOfARound) {
    const ProcessResult open = reproduce(kSleeps + std::string("sweep: {number: [8, 9]}\n"));
    EXPECT_THAT(open.err, HasSubstr("[2/2] ok sweep/mine number=9, round 1 of at most 6\n"));
    EXPECT_THAT(open.err, HasSubstr("[1/2] ok sweep/mine number=9, round 2 of at most 6\n"));
    fs::remove_all(runDir());
    const ProcessResult asked = reproduce(kSleeps + std::string("measure: {processes: 2}\n"));
    EXPECT_THAT(asked.err, HasSubstr("[1/1] ok sweep/mine, round 2 of 2\n"));
}

TEST_F(Timed, AProgramThatIsNotHereIsToldOnceWhereItIsQuiet) {
    const std::string config =
        folder.write("none.yaml",
                     "sweep_of: none\ntitle: T\ntechnique: external\n"
                     "program: {command: \"no-such-program {n}\", params: {n: 1}}\n"
                     "sweep: {n: [1, 2, 3]}\nmeasure: {lane: quality}\n");
    const std::string err = gfxrepro({"run", config, "--quiet", "--out", runDir()}).err;
    const std::string said = "the program 'no-such-program' is not on this machine";
    const std::size_t first = err.find(said);
    EXPECT_NE(first, err.npos);
    EXPECT_EQ(err.find(said, first + 1), err.npos) << err;
}

TEST_F(Timed, WarmUpTruthAndErrorsAreOfTheFirstProcessAlone) {
    ASSERT_EQ(reproduce(std::string(kSleeps) + kImages).exitCode, 0);
    // A warm-up, the case, its truth; then the case alone.
    EXPECT_EQ(readFile(folder.path() / "runs"), "8\n8\n99\n8\n8\n8\n8\n8\n");
    EXPECT_EQ(valuesOf("wall_time_ms").size(), 6U);
    EXPECT_EQ(valuesOf("own_ms").size(), 6U) << "its own times are of every process";
    EXPECT_THAT(valuesOf("mse"), ElementsAre(0.0));
    EXPECT_EQ(records::readImages(runDir()).size(), 2U);
}

TEST_F(Timed, APictureThatIsAnotherInEachProcessIsRecordedInEach) {
    writeProgram(folder, "renderer.sh",
                 "#!/bin/sh\nhere=$(dirname \"$0\")\n"
                 "[ $1 = 99 ] || echo x >>\"$here/runs\"\n"
                 "cp \"$here/grey$(wc -l <\"$here/runs\").png\" \"$2/result.png\"\n"
                 "echo '{\"metric\": \"own_ms\", \"value\": 1, \"unit\": \"ms\"}' >&3\n");
    for (int i = 1; i <= 7; ++i) {
        image::Image8 picture(16, 16, 3, static_cast<std::uint8_t>(20 * i));
        picture.values()[0] = 7;
        image::writePng(folder.path() / ("grey" + std::to_string(i) + ".png"), picture);
    }
    ASSERT_EQ(reproduce(std::string(kSleeps) + kImages).exitCode, 0);
    const std::vector<double> errors = valuesOf("mse");
    EXPECT_EQ(std::set<double>(errors.begin(), errors.end()).size(), 6U);
}

TEST_F(Timed, WhereItDrawsRandomNumbersEachProcessHasASeedOfItsOwn) {
    writeProgram(folder, "renderer.sh",
                 "#!/bin/sh\ncp \"$(dirname \"$0\")/picture.png\" \"$2/result.png\"\necho "
                 "'{\"metric\": \"own_ms\", \"value\": '$1', \"unit\": \"ms\"}' >&3\n"
                 "[ \"$3\" != 2 ] || echo $1 >>\"$(dirname \"$0\")/truths\"\n");
    const std::string head =
        "sweep_of: mine\ntitle: Mine\ntechnique: external\n"
        "program:\n"
        "  command: \"{here}/renderer.sh {seed} {out}\"\n"
        "  metrics: {own_ms: ms}\n";
    const auto seedsOf = [&](const std::string& config) {
        fs::remove_all(runDir());
        EXPECT_EQ(reproduce(config).exitCode, 0) << config;
        std::vector<double> seeds = valuesOf("own_ms");
        std::ranges::sort(seeds);
        return seeds;
    };
    const std::string truth = "  images: {result: {file: result.png, truth: {seed: 99}}}\n";
    EXPECT_THAT(seedsOf(head + truth), ElementsAre(1, 1001, 2001, 3001, 4001, 5001));
    EXPECT_EQ(valuesOf("mse").size(), 6U);
    std::string other = head;
    other.replace(other.find(" {out}"), 6, " {out} {n}");
    // A truth of another word may have the same random numbers.
    EXPECT_THAT(
        seedsOf(other +
                "  params: {n: [a, b]}\n  images: {result: {file: result.png, truth: {n: b}}}\n"),
        Each(1));
    const std::string csv = readFile(runDir() + "/tables/sweep-mine.csv");
    const std::string markdown = readFile(runDir() + "/tables/sweep-mine.md");
    EXPECT_THAT(csv, HasSubstr(",one seed,"));
    EXPECT_THAT(markdown, HasSubstr("Note: One seed, and another would give other numbers: "));
    EXPECT_THAT(readFile(runDir() + "/tables/sweep-mine.tex"), HasSubstr("/bounds}{one seed}"));
    EXPECT_THAT(seedsOf(head + "measure: {processes: 2}\n"), ElementsAre(1, 1001));
    other += "  params: {n: 1}\n  images: {result: {file: result.png, truth: {n: 2}}}\n";
    EXPECT_THAT(seedsOf(other), ElementsAre(1, 1001, 2001, 3001, 4001, 5001));
    EXPECT_EQ(readFile(folder.path() / "truths"), "1\n") << "made once";
    EXPECT_THAT(seedsOf(other + "sweep: {seed: [3, 4]}\n"), Each(AnyOf(3, 4)));
}

/// A built-in technique that declares that it draws them.
TEST_F(Timed, RandomNumbersOfATechniqueHaveAnIntervalOverSeeds) {
    const std::string head =
        "layout:\n  columns: {face: {metric: face}, worth: {metric: worth}}\n"
        "claims: {more: {says: a face is worth more, order: face < worth}}\n";
    const auto facesOf = [&](const std::string& technique, const std::string& more) {
        fs::remove_all(runDir());
        const std::string config = "sweep_of: mine\ntitle: Mine\ntechnique: " + technique + '\n';
        EXPECT_EQ(reproduce(config + head + more).exitCode, 0) << more;
        const std::vector<double> faces = valuesOf("face");
        return std::set<double>(faces.begin(), faces.end()).size();
    };
    EXPECT_EQ(facesOf("dice", "measure: {processes: 6}\n"), 6U);
    EXPECT_EQ(valuesOf("worth").size(), 6U);
    EXPECT_THAT(readFile(runDir() + "/claims.csv"), HasSubstr(",holds,"));
    EXPECT_EQ(facesOf("dice", "measure: {processes: 1}\n"), 1U);
    EXPECT_THAT(readFile(runDir() + "/claims.csv"), HasSubstr(",ambiguous,holds,"));
    EXPECT_THAT(readFile(runDir() + "/tables/sweep-mine.csv"), HasSubstr(",one seed,"));
    EXPECT_EQ(facesOf("loaded_dice", "measure: {lane: timing, processes: 6}\n"), 1U);
    EXPECT_EQ(valuesOf("face").size(), 6U);
    EXPECT_EQ(valuesOf("worth").size(), 1U) << "made once";
    facesOf("loaded_dice", "params: {wobbles: true}\nmeasure: {lane: timing, processes: 3}\n");
    EXPECT_EQ(valuesOf("worth").size(), 3U) << "another picture, other errors";
}

// Programs that give several frames in one run, and which seeds they get.

struct Frames : RunTest {
    ProcessResult run(const std::string& config) const {
        return gfxrepro({"run", config, "--out", dir});
    }
};

/// Draws all frames in one run, each of its own grey; the third argument says what it does wrong.
constexpr const char* kAllFrames = R"(#!/bin/sh
here=$(dirname "$0")
echo "$1 $2" >>"$here/runs"
frame=0
while [ $frame -lt $1 ]; do
    cp "$here/grey$((frame + $2)).png" "frame_$frame.png"
    value=$((10 * frame + $2))
    [ "$3" = beyond ] && frame_said=$((frame + 1)) || frame_said=$frame
    [ "$3 $frame" = "missing 2" ] || echo "{\"metric\":\"number\",\"pass\":\"draw\",\"frame\":$frame_said,\"value\":$value,\"unit\":\"1\"}" >&3
    [ "$3 $frame" = "unsaid 1" ] && echo '{"metric":"number","pass":"draw","value":1,"unit":"1"}' >&3
    frame=$((frame + 1))
done
[ "$3" = half ] && rm frame_1.png
exit 0
)";

TEST_F(Frames, GivesAllFramesInOneRun) {
    writeProgram(folder, "all.sh", kAllFrames);
    for (int i = 0; i < 8; ++i) {
        const auto grey = static_cast<std::uint8_t>(20 * i);
        image::writePng(folder.path() / ("grey" + std::to_string(i) + ".png"),
                        image::Image8(16, 16, 3, grey));
    }
    const std::string config = folder.write(
        "mine.yaml",
        "sweep_of: mine\ntitle: Mine\ntechnique: external\n"
        "program:\n"
        "  command: [\"{here}/all.sh\", \"{frames}\", \"{from}\", \"{behaviour}\"]\n"
        "  frames: all\n"
        "  params: {from: 0, behaviour: well}\n"
        "  metrics: {number: \"1\"}\n"
        "  passes: {draw: drawing}\n"
        "  images: {result: {file: \"frame_{frame}.png\", truth: {from: 4, behaviour: well}}}\n"
        "sweep: {behaviour: [well, beyond, missing, unsaid, half]}\n"
        "output: {frames: 3}\nmeasure: {lane: timing, repeats: 2, processes: 1}\n");
    const ProcessResult result = run(config);
    EXPECT_EQ(result.exitCode, 4) << result.err;
    std::vector<std::string> lines = statusLines(dir);
    std::ranges::sort(lines);
    EXPECT_THAT(
        lines,
        ElementsAre("beyond: error (line 3 of its metrics: \"frame\" is 3; allowed: 0 … 2)",
                    "half: error (image 'result': there is no file frame_1.png)",
                    "missing: error (metric 'number': the program gave no value of it for frame 2)",
                    "unsaid: error (line 3 of its metrics: no \"frame\"; allowed: 0 … 2)",
                    "well: ok"));
    std::map<int, double> numbers, squaredErrors;
    for (const records::Record& row : rowsOf(dir, "number")) numbers[row.frame] = row.value;
    for (const records::Record& row : rowsOf(dir, "mse")) squaredErrors[row.frame] = row.value;
    EXPECT_EQ(numbers, (std::map<int, double>{{0, 0.0}, {1, 10.0}, {2, 20.0}}));
    // Each against the truth of its own frame, four greys off.
    ASSERT_EQ(squaredErrors.size(), 3U);
    for (const auto& [frame, mse] : squaredErrors) {
        EXPECT_NEAR(mse, (80.0 / 255.0) * (80.0 / 255.0), 1e-6) << frame;
    }
    // A warm-up, two repeats and a truth; of times each frame has its share, two repeats a frame.
    EXPECT_THAT(readFile(folder.path() / "runs"), HasSubstr("3 0\n3 0\n3 0\n3 4\n"));
    std::map<int, std::vector<double>> times;
    for (const records::Record& row : rowsOf(dir, "wall_time_ms")) {
        times[row.frame].push_back(row.value);
    }
    ASSERT_EQ(times.size(), 3U);
    EXPECT_EQ(times[0].size(), 2U);
    EXPECT_EQ(times[1], times[0]);
    EXPECT_EQ(times[2], times[0]);
    const std::string well = rowsOf(dir, "mse").front().caseId;
    const auto images = records::readImages(dir);
    EXPECT_EQ(std::ranges::count(images, well, &records::ImageEntry::caseId), 6);
}

/// A column that names no pass of what there is of passes alone.
TEST_F(Frames, WhatIsOfPassesAloneIsToldWithThem) {
    writeProgram(folder, "passes.sh",
                 "#!/bin/sh\nfor pass in left right; do echo '{\"metric\": \"number\", "
                 "\"value\": 1, \"unit\": \"1\", \"pass\": \"'$pass'\"}' >&3; done\n");
    const auto reproduced = [&](const std::string& column) {
        fs::remove_all(dir);
        const std::string config = folder.write(
            "mine.yaml",
            "sweep_of: mine\ntitle: Mine\nprogram:\n  command: \"{here}/passes.sh {n}\"\n"
            "  params: {n: 1}\n  metrics: {number: \"1\"}\n  passes: {left: l, right: r}\n"
            "sweep: {n: [1, 2]}\nlayout: {rows: n, columns: {v: " +
                column + "}}\n");
        return gfxrepro({"reproduce", config, "--out", dir});
    };
    const ProcessResult result = reproduced("{metric: number}");
    EXPECT_EQ(result.exitCode, 2);
    EXPECT_THAT(result.err, HasSubstr("error: sweep/mine: column 'v': no 'number' was recorded; it "
                                      "is there for pass: left, right\n"));
    EXPECT_EQ(gfxrepro({"table", dir}).exitCode, 2);
    EXPECT_EQ(rowsOf(dir, "number").size(), 8U) << "nothing that was measured is lost";
    EXPECT_EQ(reproduced("{metric: number, pass: left}").exitCode, 0);
}

TEST_F(Frames, SeedsAreOfTheCaseAndOfItsProcess) {
    writeProgram(
        folder, "seeded.sh",
        "#!/bin/sh\necho '{\"metric\": \"number\", \"value\": '$1', \"unit\": \"1\"}' >&3\n");
    const auto numbersWith = [&](const std::string& more) {
        const std::string config = folder.write(
            "seeds.yaml",
            "sweep_of: seeds\ntitle: T\ntechnique: external\n"
            "program: {command: [\"{here}/seeded.sh\", \"{seed}\"], metrics: {number: \"1\"}" +
                more);
        fs::remove_all(dir);
        EXPECT_EQ(run(config).exitCode, 0);
        std::vector<double> numbers;
        for (const records::Record& row : rowsOf(dir, "number")) numbers.push_back(row.value);
        std::ranges::sort(numbers);
        return numbers;
    };
    EXPECT_THAT(numbersWith("}\nmeasure: {lane: quality, processes: 1}\n"), ElementsAre(1));
    EXPECT_THAT(numbersWith("}\nsweep: {seed: [3, 8]}\nmeasure: {lane: quality, processes: 2}\n"),
                ElementsAre(3, 3, 8, 8));
    EXPECT_THAT(numbersWith("}\nparams: {seed: 5}\n"
                            "measure: {lane: quality, processes: 3}\n"),
                ElementsAre(5, 1005, 2005));
}

}  // namespace
}  // namespace gfxrepro::test
