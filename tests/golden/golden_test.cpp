// The smoke configs draw what they drew before. See README.md for how to bless a change.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "runner/core/files.h"
#include "runner/gl/device.h"
#include "runner/image/exr_io.h"
#include "runner/metrics/image_error.h"
#include "tests/support/process.h"
#include "tests/support/support.h"

namespace gfxrepro {
namespace {

namespace fs = std::filesystem;

// One Mesa version on another processor rounds differently where LLVM picks other vector
// instructions: a pixel may change by rounding, a few on edges may flip.
constexpr float kPixelThreshold = 2.0F / 255.0F;
constexpr double kAllowedFraction = 0.002;
constexpr float kHardMaximum = 1.0F;

struct Golden {
    const char* config;  // of configs/smoke
    const char* image;   // the recorded name
};

void PrintTo(const Golden& golden, std::ostream* stream) {
    *stream << golden.config;
}

class GoldenTest : public testing::TestWithParam<Golden> {};

/// "llvmpipe-22.3": images of another version are not to be compared.
std::string rasterizerName() {
    const gl::Device device = gl::Device::open({"software", gl::DebugOutput::Off});
    const std::string& version = device.info().mesaVersion;
    return "llvmpipe-" + version.substr(0, version.rfind('.'));
}

/// The one image of that name in a run directory.
fs::path recordedImage(const fs::path& runDir, const std::string& name) {
    for (const auto& entry : fs::recursive_directory_iterator(runDir / "images")) {
        if (entry.path().filename().string().ends_with('-' + name + ".exr")) return entry.path();
    }
    throw Error("no image '" + name + "' was recorded");
}

TEST_P(GoldenTest, LooksAsBefore) {
    const Golden golden = GetParam();
    const fs::path reference = fs::path(GFXREPRO_SOURCE) / "tests/golden" / rasterizerName() /
                               (std::string(golden.config) + '-' + golden.image + ".exr");
    const test::TemporaryFolder folder;
    const fs::path runDir = folder.path() / "run";
    const std::string config =
        std::string(GFXREPRO_SOURCE) + "/configs/smoke/" + golden.config + ".yaml";
    const test::ProcessResult run = test::runProgram(
        {GFXREPRO_PROGRAM, "run", config, "--device", "software", "--out", runDir.string()});
    ASSERT_EQ(run.exitCode, 0) << run.err;
    const fs::path recorded = recordedImage(runDir, golden.image);
    if (std::getenv("GFXREPRO_BLESS")) {
        fs::create_directories(reference.parent_path());
        fs::copy_file(recorded, reference, fs::copy_options::overwrite_existing);
    }
    if (!fs::exists(reference)) GTEST_SKIP() << "no golden for this rasterizer: " << reference;

    const image::ImageF actual = image::readExr(recorded).colour();
    const image::ImageF expected = image::readExr(reference).colour();
    ASSERT_EQ(actual.width(), expected.width());
    ASSERT_EQ(actual.height(), expected.height());
    const image::ImageF difference = metrics::absoluteDifference(actual, expected);
    std::size_t changed = 0;
    float largest = 0.0F;
    for (const float value : difference.values()) {
        ASSERT_TRUE(std::isfinite(value));
        changed += value > kPixelThreshold;
        largest = std::max(largest, value);
    }
    const auto allowed =
        static_cast<std::size_t>(kAllowedFraction * static_cast<double>(actual.values().size()));
    if (changed <= allowed && largest <= kHardMaximum) return;

    const fs::path failures = GFXREPRO_FAILURES;
    fs::create_directories(failures);
    const std::string stem = (failures / golden.config).string();
    fs::copy_file(recorded, stem + "-actual.exr", fs::copy_options::overwrite_existing);
    fs::copy_file(reference, stem + "-reference.exr", fs::copy_options::overwrite_existing);
    image::ExrImage differenceFile;
    differenceFile.add(difference, {"R", "G", "B"});
    image::writeExr(stem + "-difference.exr", differenceFile);
    ADD_FAILURE() << changed << " of " << actual.values().size() << " values changed (allowed "
                  << allowed << "), largest " << largest << "; see " << stem
                  << "-*.exr\nIf the change is meant: GFXREPRO_BLESS=1 ctest -L golden";
}

INSTANTIATE_TEST_SUITE_P(Smoke, GoldenTest,
                         testing::Values(Golden{"voxelization", "draw"},
                                         Golden{"voxelization-implicit", "draw"},
                                         Golden{"voxelization-mixed", "draw"}),
                         [](const auto& info) {
                             std::string name = info.param.config;
                             std::ranges::replace(name, '-', '_');
                             return name;
                         });

}  // namespace
}  // namespace gfxrepro
