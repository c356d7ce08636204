// The configs of configs/external and GUIDE.md's example, on real programs.

#include "engine/core/files.h"
#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

bool isHere(const std::string& program) {
    return runProgram({"/bin/sh", "-c", "command -v " + program}).exitCode == 0;
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
