// What a plan of 100,000 cases takes. The program itself, as its techniques have many parameters.

#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

constexpr long long kMostBytes = 2'000'000'000;

constexpr const char* kTwoAxes =
    "  opacity: {range: [0.1, 0.5995, 0.0005]}\n"
    "  output.height: {range: [1, 100, 1]}\n";
constexpr const char* kSixAxes =
    "  output.height: {range: [1, 88, 1]}\n"
    "  fill: [surface, solid]\n"
    "  voxel_bits: [1, 8, 16, 32]\n"
    "  opacity: {range: [0.1, 0.25, 0.01]}\n"
    "  padding: {range: [0, 8, 1]}\n"
    "  read_back: [true]\n";

std::string largeConfig(const TemporaryFolder& folder, const std::string& axes) {
    return folder.write("large.yaml",
                        "sweep_of: large\ntitle: A hundred thousand cases\n"
                        "technique: voxelization\nscene: shapes/torus\n"
                        "params: {resolution: 32, draw: opaque}\n"
                        "measure: {lane: quality, repeats: 1}\n"
                        "sweep:\n" +
                            axes + "output: {width: 64}\n");
}

TEST(LargePlan, IsListedAsItComes) {
    const TemporaryFolder folder;
    const std::string file = folder.path() / "out";
    const auto list = [&](const std::string& axes, const std::string& form) {
        const ProcessResult plan =
            endedWith(0, shell("exec " GFXREPRO_PROGRAM " plan " + largeConfig(folder, axes) +
                               form + " >" + file));
        EXPECT_LT(plan.peakBytes, kMostBytes) << form << "\n" << axes;
        EXPECT_GT(fs::file_size(file), 10'000'000U);
    };
    list(kTwoAxes, " --json");
    list(kSixAxes, "");
}

}  // namespace
}  // namespace gfxrepro::test
