// Pictures that programs leave: which part of a picture they are, and in which format.
#include "engine/core/files.h"
#include "engine/image/exr_io.h"
#include "engine/image/image_file.h"
#include "engine/image/png_io.h"
#include "runner/records/images.h"
#include "tests/cli/cli_support.h"
#include "tests/support/grid.h"

namespace gfxrepro::test {
namespace {

using image::ImageF;

struct PicturesOfPrograms : RunTest {
    /// Runs a config whose program leaves the file `made`, of which `truth` is the truth.
    ProcessResult run(const std::string& made, const std::string& truth) const {
        const std::string ending = fs::path(made).extension();
        const std::string config = folder.write(
            "mine.yaml",
            "sweep_of: mine\ntitle: Mine\noutput: {width: 16, height: 12}\n"
            "program:\n  command: cp {here}/" +
                made + " {out}/result" + ending + "\n  env: {SIZE: \"{width} {height}\"}\n" +
                "  images: {result: {file: result" + ending + ", truth: \"{here}/" + truth +
                "\"}}\n");
        fs::remove_all(dir);
        return gfxrepro({"run", config, "--out", dir, "--quiet"});
    }
};

TEST_F(PicturesOfPrograms, APartOfThePictureIsHeldAgainstThatPartOfItsTruth) {
    const auto write = [&](const char* name, const image::Rectangle& data, int width) {
        ImageF colour(data.width, data.height, 3);
        for (const auto [y, x] : test::grid(data.height, data.width)) {
            colour.at(x, y, 0) = 0.01F * static_cast<float>(data.left + x);
            colour.at(x, y, 1) = 0.01F * static_cast<float>(data.top + y);
        }
        image::ExrImage exr;
        exr.add(colour, {"R", "G", "B"}, image::ExrPixelType::Float);
        exr.left = data.left;
        exr.top = data.top;
        exr.displayWindow = {0, 0, width, 12};
        image::writeExr(folder.path() / name, exr);
    };
    write("whole.exr", {0, 0, 16, 12}, 16);
    write("part.exr", {5, 3, 4, 6}, 16);
    write("other.exr", {12, 3, 4, 6}, 16);
    write("wide.exr", {5, 3, 4, 6}, 17);
    ASSERT_EQ(run("part.exr", "whole.exr").exitCode, 0);
    EXPECT_EQ(rowsOf(dir, "mse").at(0).value, 0.0);
    const auto images = records::readImages(dir);
    ASSERT_EQ(images.size(), 2U);
    const ImageF truth = image::readPicture(dir + "/" + images[1].exr).linear;
    EXPECT_EQ(truth.width(), 4);
    EXPECT_NEAR(truth.at(0, 0, 0), 0.05F, 1e-4);
    EXPECT_EQ(run("part.exr", "other.exr").exitCode, 4);
    EXPECT_THAT(readFile(dir + "/records.csv"),
                HasSubstr("image 'result' and its truth: the images show no place that both have: "
                          "4x6 pixels from (5, 3) of 16x12 and 4x6 pixels from (12, 3) of 16x12"));
    EXPECT_EQ(run("wide.exr", "whole.exr").exitCode, 4);
    EXPECT_THAT(readFile(dir + "/records.csv"),
                HasSubstr("image 'result': has 17 × 12 pixels; 16 × 12 were asked for"));
}

TEST_F(PicturesOfPrograms, OtherFormatsAreReadAsTheirKind) {
    const ImageF light(16, 12, 3, 0.25F);
    image::ExrImage exr;
    exr.add(light, {"R", "G", "B"}, image::ExrPixelType::Float);
    image::writeExr(folder.path() / "truth.exr", exr);
    image::writePng(folder.path() / "truth.png", image::Image8(16, 12, 3, 51));
    const auto values = light.values();
    folder.write("p.pfm",
                 "PF\n16 12\n-1\n" + std::string(reinterpret_cast<const char*>(values.data()),
                                                 values.size_bytes()));
    std::string hdr = "#?RADIANCE\n\n-Y 12 +X 16\n";
    for (int i = 0; i < 16 * 12; ++i) hdr += "\x80\x80\x80\x7f";
    folder.write("p.hdr", hdr);
    folder.write("p.ppm", "P6\n16 12\n255\n" + std::string(16 * 12 * 3, '\x33'));
    folder.write("p.tga", std::string("\0\0\2\0\0\0\0\0\0\0\0\0\x10\0\x0c\0\x18\0", 18) +
                              std::string(16 * 12 * 3, '\x33'));
    for (const auto& [made, truth] : {std::pair("p.pfm", "truth.exr"),
                                      {"p.hdr", "truth.exr"},
                                      {"p.hdr", "p.pfm"},
                                      {"p.ppm", "truth.png"},
                                      {"p.tga", "truth.png"},
                                      {"truth.png", "p.ppm"}}) {
        ASSERT_EQ(run(made, truth).exitCode, 0) << made << readFile(dir + "/records.csv");
        EXPECT_EQ(rowsOf(dir, "mse").at(0).value, 0.0) << made;
    }
    const auto images = records::readImages(dir);
    EXPECT_NEAR(image::readPicture(dir + "/" + images[0].exr).linear.at(3, 3, 1), 0.0331F, 1e-4);
    EXPECT_EQ(run("p.pfm", "truth.png").exitCode, 4);
    EXPECT_THAT(readFile(dir + "/records.csv"),
                HasSubstr("image 'result': one of it and its truth is linear, as EXR files are, "
                          "the other sRGB, as PNG files are"));
    EXPECT_THAT(
        endedWith(2, run("p.gif", "truth.png")).err,
        HasSubstr("file is result.gif; allowed: a name that ends in one of .exr, .png, .pfm, "));
}

/// A path tracer as far as a config can tell: noise that falls with the root of the samples, less
/// of it by one of two patterns.
constexpr const char* kTracer = R"(#!/bin/sh
# tracer.sh SAMPLES PATTERN SEED WIDTH FILE
{ printf 'P5\n%d %d\n255\n' "$4" "$4"
  LC_ALL=C awk -v samples="$1" -v pattern="$2" -v seed="$3" -v width="$4" 'BEGIN {
    srand(seed)
    scale = (pattern == "SOBOL" ? 400 : 200) / sqrt(samples)
    for (i = 0; i < width * width; ++i) printf "%c", int(128.5 + scale * (rand() - 0.5))
  }'; } >"$5"
echo '{"metric": "render_ms", "value": '"$1.$3"', "unit": "ms"}' >>"$GFXREPRO_METRICS_FILE"
)";

/// The whole file of a comparison: what nobody says comes without being asked for.
TEST_F(PicturesOfPrograms, GammaOfAPngIsReadAndSaid) {
    std::string png = image::encodePng(image::Image8(16, 12, 3, 51));
    // Behind the header: a gamma of 1, so that the values are light.
    png.insert(33, std::string("\0\0\0\x04gAMA\0\x01\x86\xA0\x31\xE8\x96\x5F", 16));
    folder.write("light.png", png);
    std::string truth = "P6 16 12 65535\n";
    for (int i = 0; i < 16 * 12 * 3; ++i) truth += "\x7C\n";  // 31754: 0.2 in sRGB
    folder.write("truth.ppm", truth);
    ASSERT_EQ(run("light.png", "truth.ppm").exitCode, 0);
    EXPECT_LT(rowsOf(dir, "mse").at(0).value, 1e-9);
    EXPECT_THAT(
        readFile(dir + "/journal.jsonl"),
        HasSubstr("warning: image 'result': its values are converted from a gamma of 1 to sRGB"));
    EXPECT_EQ(gfxrepro({"image", "info", (folder.path() / "light.png").string()}).out,
              "png 16x12, 3 channels, sRGB\nits values are converted from a gamma of 1 to sRGB\n");
}

TEST_F(PicturesOfPrograms, LayersThatAreLeftOutAreSaidInTheRunAndTheReport) {
    const ImageF light(16, 12, 3, 0.25F);
    image::ExrImage exr;
    exr.add(light, {"R", "G", "B"}, image::ExrPixelType::Float);
    image::writeExr(folder.path() / "truth.exr", exr);
    exr.add(light, {"diffuse.R", "diffuse.G", "diffuse.B"});
    image::writeExr(folder.path() / "layers.exr", exr);
    const ProcessResult said = run("layers.exr", "truth.exr");
    ASSERT_EQ(said.exitCode, 0) << said.err;
    EXPECT_EQ(rowsOf(dir, "mse").at(0).value, 0.0);
    const std::string note = "left out: the channels diffuse.B, diffuse.G, diffuse.R";
    const std::string line = "warning: image 'result': " + note + "\n";
    const std::size_t at = said.err.find(line);
    ASSERT_NE(at, std::string::npos) << said.err;
    EXPECT_EQ(said.err.find(note, at + line.size()), std::string::npos) << said.err;
    ASSERT_EQ(gfxrepro({"report", dir}).exitCode, 0);
    EXPECT_THAT(readFile(dir + "/report.html"),
                AllOf(HasSubstr("<th scope=\"row\">Warnings</th><td>image "), HasSubstr(note)));
}

TEST_F(PicturesOfPrograms, TwoPatternsAreComparedByAFewLines) {
    const auto script = writeProgram(folder, "tracer.sh", kTracer);
    const std::string config = folder.write(
        "mine.yaml",
        "sweep_of: patterns\ntitle: Two sampling patterns\n"
        "program:\n"
        "  command: \"{here}/tracer.sh {samples} {pattern} {seed} {width} {out}/picture.pgm\"\n"
        "  params: {samples: 16, pattern: [SOBOL, PROGRESSIVE_MULTI_JITTER]}\n"
        "  metrics: {render_ms: ms}\n"
        "  images: {picture: {file: picture.pgm, truth: {samples: 100000, seed: 99}}}\n"
        "output: {width: 16, height: 16}\n"
        "sweep: {pattern: all, samples: {log2: [16, 64]}}\n"
        "claims:\n"
        "  slope: {says: the error falls, trend: rmse, over: samples, at_most: -0.4}\n"
        "  better: {says: jittered samples have the lower error, order: [PROGRESSIVE_MULTI_JITTER, "
        "SOBOL], of: rmse, at: {samples: 64}}\n"
        "  faster: {says: more samples take longer, order: [samples=16, samples=64], of: "
        "render_ms}\n");
    const ProcessResult bad =
        endedWith(2, gfxrepro({"check", folder.write("bad.yaml", [&] {
                                   std::string text = readFile(config);
                                   return text.replace(text.find("of: rmse,"), 8, "of: rmsee");
                               }())}));
    EXPECT_THAT(bad.err, HasSubstr(":12:3: claim 'better': 'rmsee' is no column; did you mean "
                                   "'rmse'? (columns: render_ms, "));
    EXPECT_THAT(bad.err, Not(HasSubstr("render_ms_picture")));
    endedWith(0, gfxrepro({"check", config}));
    endedWith(0, gfxrepro({"reproduce", config, "--out", dir}));
    EXPECT_THAT(readFile(dir + "/tables/sweep-patterns.csv"),
                StartsWith("pattern,samples,render_ms_measured"));
    const std::string claims = readFile(dir + "/claims.csv");
    for (const char* id : {"slope", "better", "faster"}) {
        EXPECT_THAT(claims, ContainsRegex(std::string("\n") + id + ",[^\n]*,holds,"));
    }
    const std::string page = readFile(dir + "/report.html");
    EXPECT_THAT(
        page,
        HasSubstr("PROGRESSIVE_MULTI_JITTER is nearer to its truth than SOBOL in all 3 rows"));
    EXPECT_THAT(page, HasSubstr("mse over render"));
}

// The configs of configs/external and GUIDE.md's example, on real programs.

bool isHere(const std::string& program) {
    return shell("command -v " + program).exitCode == 0;
}

/// Every claim of the shipped config holds.
void expectClaimsHold(const std::string& config, const std::string& dir) {
    EXPECT_THAT(
        endedWith(0, gfxrepro({"reproduce", std::string(GFXREPRO_CONFIGS) + "/external/" + config,
                               "--out", dir}))
            .out,
        Not(HasSubstr("fails")));
}

using ShippedPrograms = test::RunTest;

TEST_F(ShippedPrograms, UnitVectorsAreOffByThePrintedAngles) {
    expectClaimsHold("unit_vectors-errors.yaml", folder.path() / "run");
    EXPECT_THAT(readFile(folder.path() / "run/tables/cigolle2014-errors.csv"),
                Not(HasSubstr("missing")));
}

TEST_F(ShippedPrograms, TwoBitsMoreHalveTheErrorOfUnitVectors) {
    expectClaimsHold("unit_vectors-bits.yaml", folder.path() / "run");
}

TEST_F(ShippedPrograms, ErrorOfPovRayFallsAsTheRootOfItsSamples) {
    if (!isHere("povray")) GTEST_SKIP() << "povray is not here";
    expectClaimsHold("povray-samples.yaml", folder.path() / "run");
}

TEST_F(ShippedPrograms, PovRaysExpectationIsTheSameWithoutEdgesAlone) {
    if (!isHere("povray")) GTEST_SKIP() << "povray is not here";
    expectClaimsHold("povray-expectation.yaml", folder.path() / "run");
}

TEST_F(ShippedPrograms, TheGuidesExampleWorksAsTyped) {
    if (!isHere("povray")) GTEST_SKIP() << "povray is not here";
    const fs::path configs = GFXREPRO_CONFIGS;
    const std::string guide = readFile(configs.parent_path() / "GUIDE.md");
    const std::size_t section = guide.find("## A renderer's pictures");
    const std::size_t begin = guide.find("```yaml mine.yaml\n", section) + 18;
    ASSERT_LT(section, begin);
    const std::string config =
        folder.write("mine.yaml", guide.substr(begin, guide.find("```", begin) - begin));
    folder.write("configs/external/hall.pov", readFile(configs / "external" / "hall.pov"));
    endedWith(0, gfxrepro({"reproduce", config, "--out", dir}));
    EXPECT_EQ(rowsOf(dir, "wall_time_ms").size(), 18U);
    for (const char* metric : {"rmse", "ssim", "flip", "rel_mse", "psnr_db", "process_time_ms"}) {
        EXPECT_FALSE(rowsOf(dir, metric).empty()) << metric;
    }
    EXPECT_THAT(readFile(dir + "/tables/sweep-mine.csv"), HasSubstr("rmse"));
    EXPECT_THAT(readFile(dir + "/claims.csv"), HasSubstr("exponent ≤ -0.4"));
}

TEST_F(ShippedPrograms, VolumeOfABallOfOpenScad) {
    if (!isHere("openscad")) GTEST_SKIP() << "openscad is not here";
    expectClaimsHold("openscad-ball.yaml", folder.path() / "run");
}

}  // namespace
}  // namespace gfxrepro::test
