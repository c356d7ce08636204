// Programs that give several frames in one run, and which seeds they get.

#include <algorithm>
#include <map>

#include "engine/core/files.h"
#include "engine/image/png_io.h"
#include "runner/records/images.h"
#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

struct Frames : testing::Test {
    ProcessResult run(const std::string& config) const {
        return gfxrepro({"run", config, "--out", dir});
    }

    TemporaryFolder folder;
    std::string dir = (folder.path() / "run").string();
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
    fs::permissions(folder.write("all.sh", kAllFrames), fs::perms::owner_all);
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
    fs::permissions(
        folder.write("passes.sh",
                     "#!/bin/sh\nfor pass in left right; do echo '{\"metric\": \"number\", "
                     "\"value\": 1, \"unit\": \"1\", \"pass\": \"'$pass'\"}' >&3; done\n"),
        fs::perms::owner_all);
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
    fs::permissions(
        folder.write(
            "seeded.sh",
            "#!/bin/sh\necho '{\"metric\": \"number\", \"value\": '$1', \"unit\": \"1\"}' >&3\n"),
        fs::perms::owner_all);
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
