// The smoke configs draw what they drew before. See README.md for how to bless a change.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/files.h"
#include "engine/gl/device.h"
#include "engine/image/exr_io.h"
#include "engine/metrics/image_error.h"
#include "tests/support/process.h"
#include "tests/support/support.h"

namespace gfxrepro {
namespace {

const fs::path kFolder = fs::path(GFXREPRO_SOURCE) / "tests/golden";

// One Mesa version on another processor rounds differently where LLVM picks other vector
// instructions: a pixel may change by rounding, and a few on edges by more, but none by what would
// be another surface or light.
constexpr float kPixelThreshold = 2.0F / 255.0F;
constexpr double kAllowedFraction = 0.002;
constexpr float kHardMaximum = 0.25F;

// The rasterizers that have goldens. A new technique's author may have one of them alone.
constexpr std::array<std::string_view, 2> kPinned = {"llvmpipe-22.3", "llvmpipe-25.0"};

struct Golden {
    const char* config;             // of configs/smoke
    const char* image;              // the recorded name
    std::vector<std::string> only;  // the case, where there are several
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

std::string fileName(const Golden& golden) {
    return fmt::format("{}-{}.exr", golden.config, golden.image);
}

/// The pinned rasterizers that have the file.
std::vector<std::string_view> rasterizersWith(const std::string& file) {
    std::vector<std::string_view> having;
    for (const std::string_view rasterizer : kPinned) {
        if (fs::exists(kFolder / rasterizer / file)) having.push_back(rasterizer);
    }
    return having;
}

/// The name of the config's test.
std::string testName(std::string config) {
    std::ranges::replace(config, '-', '_');
    return config;
}

/// The command that blesses the config's golden.
std::string blessing(const std::string& config) {
    return fmt::format("GFXREPRO_BLESS=1 ctest --test-dir {} -R 'LooksAsBefore/{}( |$)'",
                       GFXREPRO_BUILD, testName(config));
}

/// Colours alone, as halves: no command, parameters or layers.
void writeColours(const fs::path& path, const image::ImageF& colours) {
    fs::create_directories(path.parent_path());
    image::ExrImage file;
    std::vector<std::string> names = {"R", "G", "B", "A"};
    names.resize(static_cast<std::size_t>(colours.channels()));
    file.add(colours, colours.channels() == 1 ? std::vector<std::string>{"Y"} : names);
    image::writeExr(path, file);
}

/// "" where the images are alike; else by how much they differ. Throws Error for not-a-numbers.
std::string complaintAbout(const image::ImageF& actual, const image::ImageF& expected) {
    if (actual.width() != expected.width() || actual.height() != expected.height() ||
        actual.channels() != expected.channels()) {
        return "other sizes";
    }
    const image::ImageF difference = metrics::absoluteDifference(actual, expected);
    std::size_t changed = 0;
    float largest = 0.0F;
    for (const float value : difference.values()) {
        changed += value > kPixelThreshold;
        largest = std::max(largest, value);
    }
    const auto allowed =
        static_cast<std::size_t>(kAllowedFraction * static_cast<double>(actual.values().size()));
    if (changed <= allowed && largest <= kHardMaximum) return "";
    return fmt::format("{} of {} values changed (allowed {}), the largest by {:.3g} (allowed {})",
                       changed, actual.values().size(), allowed, largest, kHardMaximum);
}

TEST_P(GoldenTest, LooksAsBefore) {
    const Golden golden = GetParam();
    const std::string rasterizer = rasterizerName();
    const fs::path reference = kFolder / rasterizer / fileName(golden);
    const TemporaryFolder folder;
    const fs::path runDir = folder.path() / "run";
    std::vector<std::string> command = {
        GFXREPRO_PROGRAM,
        "run",
        std::string(GFXREPRO_SOURCE) + "/configs/smoke/" + golden.config + ".yaml",
        "--device",
        "software",
        "--out",
        runDir.string()};
    for (const std::string& only : golden.only) command.insert(command.end(), {"--only", only});
    const test::ProcessResult run = test::runProgram(command);
    ASSERT_EQ(run.exitCode, 0) << run.err;
    const fs::path recorded = recordedImage(runDir, golden.image);
    const image::ImageF actual = image::readExr(recorded).colour();
    if (std::getenv("GFXREPRO_BLESS")) writeColours(reference, actual);
    if (!fs::exists(reference)) {
        const bool isPinned = std::ranges::find(kPinned, rasterizer) != kPinned.end();
        const std::vector<std::string_view> having = rasterizersWith(fileName(golden));
        ASSERT_TRUE(!isPinned || !having.empty())
            << reference << " is missing: " << blessing(golden.config);
        if (!isPinned) GTEST_SKIP() << "no golden for this rasterizer: " << reference;
        GTEST_SKIP() << fmt::format("{} has a golden of {}, {} has none yet; to bless it here: {}",
                                    having.front(), golden.config, rasterizer,
                                    blessing(golden.config));
    }

    const image::ImageF expected = image::readExr(reference).colour();
    const std::string complaint = complaintAbout(actual, expected);
    if (complaint.empty()) return;
    const fs::path failures = GFXREPRO_FAILURES;
    const std::string stem = (failures / golden.config).string();
    writeColours(stem + "-actual.exr", actual);
    writeColours(stem + "-reference.exr", expected);
    if (complaint != "other sizes") {
        writeColours(stem + "-difference.exr", metrics::absoluteDifference(actual, expected));
    }
    ADD_FAILURE() << complaint << "; see " << stem
                  << "-*.exr\nIf the change is meant: " << blessing(golden.config);
}

// One of each technique, and of voxelization each kind of source.
const std::vector<Golden> kGoldens = {
    Golden{"clustered_reflections", "result", {"method=clustered"}},
    Golden{"depth_sampling", "image_1", {"redundancy=pixel", "method=non_redundant"}},
    Golden{"point_splatting", "image", {"method=adaptive"}},
    Golden{"reflection_reuse", "result-f0001", {"method=reuse"}},
    Golden{"shadow_mapping", "result", {"method=standard", "filter=pcf", "light_kind=spot"}},
    Golden{"soft_shadows", "shadow", {"method=non_redundant"}},
    Golden{"template", "result", {"brightness=1"}},
    Golden{"terrain_tessellation", "image", {"method=adaptive", "view=valley"}},
    Golden{"voxelization", "draw", {}},
    Golden{"voxelization-implicit", "draw", {}},
    Golden{"voxelization-mixed", "draw", {}}};

INSTANTIATE_TEST_SUITE_P(Smoke, GoldenTest, testing::ValuesIn(kGoldens),
                         [](const auto& info) { return testName(info.param.config); });

TEST(GoldenComparison, FailsForOnePixelFarOffAndForManyALittleOff) {
    const image::ImageF grey(64, 64, 1, 0.5F);
    image::ImageF other = grey;
    EXPECT_EQ(complaintAbout(other, grey), "");
    for (int y = 0; y < 8; ++y) other.at(0, y) = 0.7F;  // 8 of 4096: as many as are allowed
    EXPECT_EQ(complaintAbout(other, grey), "");
    other.at(0, 0) = 0.8F;
    EXPECT_EQ(complaintAbout(other, grey),
              "8 of 4096 values changed (allowed 8), the largest by 0.3 (allowed 0.25)");
    other.at(0, 0) = other.at(0, 8) = 0.7F;
    EXPECT_EQ(complaintAbout(other, grey),
              "9 of 4096 values changed (allowed 8), the largest by 0.2 (allowed 0.25)");
    EXPECT_EQ(complaintAbout(image::ImageF(64, 63, 1), grey), "other sizes");
}

TEST(Goldens, AreSmallAndOfThisList) {
    std::set<std::string> listed;
    for (const Golden& golden : kGoldens) listed.insert(fileName(golden));
    for (const std::string_view rasterizer : kPinned) {
        for (const auto& file : fs::directory_iterator(kFolder / rasterizer)) {
            EXPECT_LE(file.file_size(), 64U << 10) << file.path();
            EXPECT_TRUE(listed.contains(file.path().filename()))
                << file.path() << " is compared by no test";
        }
    }
}

}  // namespace
}  // namespace gfxrepro
