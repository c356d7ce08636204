// What a plan of 100,000 cases takes. The program itself, as its techniques have many parameters.
#include <gtest/gtest.h>
#include <signal.h>

#include <thread>

#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

namespace fs = std::filesystem;

constexpr long long kMostBytes = 500'000'000;

std::string largeConfig(const TemporaryFolder& folder) {
    return folder.write("large.yaml",
                        "sweep_of: large\ntitle: A hundred thousand cases\n"
                        "technique: voxelization\nscene: shapes/torus\n"
                        "params: {resolution: 32, draw: opaque}\n"
                        "measure: {lane: quality, warmup: 0, repeats: 1}\n"
                        "sweep:\n  azimuth_deg: {range: [0, 249.75, 0.25]}\n"
                        "  elevation_deg: {range: [-50, 49, 1]}\n"
                        "output: {width: 64, height: 64}\n");
}

TEST(LargePlan, IsListedAsItComes) {
    const TemporaryFolder folder;
    const std::string config = largeConfig(folder), file = folder.path() / "out";
    for (const char* form : {"", " --json"}) {
        const ProcessResult plan = runProgram(
            {"/bin/sh", "-c", "exec " GFXREPRO_PROGRAM " plan " + config + form + " >" + file});
        EXPECT_EQ(plan.exitCode, 0) << plan.err;
        EXPECT_LT(plan.peakBytes, kMostBytes) << form;
        EXPECT_GT(fs::file_size(file), 10'000'000U);
    }
}

TEST(LargePlan, IsFrozenAsItComes) {
    const TemporaryFolder folder;
    const fs::path dir = folder.path() / "run";
    BackgroundProgram run(
        {GFXREPRO_PROGRAM, "run", largeConfig(folder), "--device", "software", "--out", dir});
    for (int i = 0; i < 3000 && !fs::exists(dir / "plan.json"); ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    run.signal(SIGTERM);
    const ProcessResult result = run.wait();
    EXPECT_LT(result.peakBytes, kMostBytes);
    EXPECT_GT(fs::file_size(dir / "plan.json"), 80'000'000U) << result.err;
}

}  // namespace
}  // namespace gfxrepro::test
