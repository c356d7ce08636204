// --device: what a run measures on, is said to be measured on, and what it refuses.

#include <algorithm>

#include "engine/core/files.h"
#include "engine/gl/device.h"
#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

bool hasRealGpu() {
    return std::ranges::any_of(gl::listDevices(), [](const gl::DeviceReport& report) {
        return report.problem.empty() && !report.info.isSoftware;
    });
}

struct DeviceChoice : FolderTest {
    /// One case of the mock on `device`, with the software device as a GPU that serves or not.
    ProcessResult onPretended(const std::string& device, const std::string& how = "serves",
                              const std::vector<std::string>& more = {}) {
        std::vector<std::string> environment = {"LD_PRELOAD=" GFXREPRO_PRETENDED_GPU,
                                                "PRETENDED_GPU=" + how};
        environment.insert(environment.end(), more.begin(), more.end());
        return runProgram({GFXREPRO_MOCK_PROGRAM, "run", config, "--device", device, "--quiet",
                           "--out", folder.path() / ("run-" + std::to_string(++count))},
                          environment);
    }
    nlohmann::json lastManifest() const {
        return nlohmann::json::parse(
            readFile(folder.path() / ("run-" + std::to_string(count)) / "manifest.json"));
    }

    std::string config = writeMockConfig(folder, "");
    int count = 0;
};

constexpr const char* kUuid = "00112233-4455-6677-8899-aabbccddeeff";

TEST_F(DeviceChoice, TheFirstLineOfARunNamesTheDevice) {
    const ProcessResult run =
        endedWith(0, mockGfxrepro({"run", config, "--device", "software", "--quiet", "--out",
                                   folder.path() / "run"}));
    EXPECT_THAT(run.err, MatchesRegex("device [0-9]+: .* \\(software\\), OpenGL 4.*\n"));
    const ProcessResult again = mockGfxrepro({"run", "--resume", folder.path() / "run"});
    EXPECT_EQ(again.err.substr(0, run.err.size()), run.err);
}

TEST_F(DeviceChoice, AGpuIsTakenByItsKindIndexAndUuid) {
    if (hasRealGpu()) GTEST_SKIP() << "a GPU is here: which the pretended one would stand behind";
    const std::string upper = "GPU-00112233-4455-6677-8899-AABBCCDDEEFF";
    for (const std::string& name :
         {std::string("auto"), std::string("gpu"), std::string("0"), std::string(kUuid), upper}) {
        const ProcessResult run = onPretended(name);
        EXPECT_EQ(run.exitCode, 0) << name << run.err;
        EXPECT_THAT(run.err, StartsWith("device 0: Pretended GPU (gpu), OpenGL 4")) << name;
        EXPECT_THAT(run.err, HasSubstr(std::string(", UUID ") + kUuid + "\n")) << name;
        EXPECT_EQ(lastManifest()["device_class"], "gpu") << name;
        EXPECT_EQ(lastManifest()["gl"]["uuid"], kUuid) << name;
    }
    const ProcessResult software = endedWith(0, onPretended("software"));
    EXPECT_EQ(lastManifest()["device_class"], "software");
}

TEST_F(DeviceChoice, AnotherUuidIsRefused) {
    if (hasRealGpu()) GTEST_SKIP() << "a GPU is here: its own UUID would be named";
    EXPECT_THAT(endedWith(3, onPretended("00112233-4455-6677-8899-aabbccddee00")).err,
                StartsWith("gfxrepro: no usable OpenGL 4.5 device for "
                           "'00112233-4455-6677-8899-aabbccddee00':\n|   device 0 (device): "
                           "Pretended GPU has the UUID 00112233-4455-6677-8899-aabbccddeeff\n"));
}

TEST_F(DeviceChoice, NothingStandsInForAGpuThatDoesNotServe) {
    if (hasRealGpu()) GTEST_SKIP() << "a GPU is here: it would be taken";
    const std::string last =
        "| This machine has a GPU that does not serve; --device software measures without it\n";
    for (const std::string name : {"auto", "gpu"}) {
        const ProcessResult run = onPretended(name, "refuses");
        EXPECT_EQ(run.exitCode, 3) << name;
        EXPECT_THAT(run.err, StartsWith("gfxrepro: no usable OpenGL 4.5 device for '" + name +
                                        "':\n|   device 0 (device): eglInitialize failed: "))
            << name;
        EXPECT_THAT(run.err, HasSubstr(" is no GPU\n")) << name;
        EXPECT_EQ(run.err.ends_with(last), name == "auto") << run.err;
    }
    EXPECT_THAT(endedWith(0, onPretended("software", "refuses")).err,
                HasSubstr(" (software), OpenGL 4"));
}

TEST_F(DeviceChoice, WithoutAGpuOnlyWhoAsksForOneIsRefused) {
    if (hasRealGpu()) GTEST_SKIP() << "a GPU is here";
    const ProcessResult run = endedWith(3, mockGfxrepro({"run", config, "--device", "gpu"}));
    EXPECT_THAT(run.err,
                StartsWith("gfxrepro: no usable OpenGL 4.5 device for 'gpu':\n|   device 0 "));
    EXPECT_THAT(run.err, HasSubstr(" is no GPU\n"));
}

TEST_F(DeviceChoice, AWordThatIsNoDeviceIsAMistakeOfTheCommandLine) {
    EXPECT_THAT(endedWith(2, mockGfxrepro({"run", config, "--device", "nonsense"})).err,
                HasSubstr("unknown device 'nonsense'; allowed: auto, gpu, software, or "));
}

TEST_F(DeviceChoice, OnAGpuAFrameIsRepeatedByTime) {
    if (hasRealGpu()) GTEST_SKIP() << "a GPU is here: which the pretended one would stand behind";
    config = writeMockConfig(folder,
                             "params: {pause_ms: 20}\n"
                             "measure: {lane: timing, processes: 1, repeats: 2}\n");
    const ProcessResult run = endedWith(0, onPretended("gpu"));
    const auto rows = [&](const char* metric) {
        return rowsOf(folder.path() / ("run-" + std::to_string(count)), metric).size();
    };
    EXPECT_GT(rows("wall_time_ms"), 2U);  // a fifth of a second of 20 ms each
    EXPECT_LE(rows("wall_time_ms"), 10U);
    EXPECT_EQ(rows("frame_rate"), rows("wall_time_ms"));
    EXPECT_EQ(rows("number"), 1U);
    ASSERT_EQ(onPretended("software").exitCode, 0);
    EXPECT_EQ(rows("wall_time_ms"), 2U);
}

/// With it the pretended GPU is the second of two.
constexpr const char* kNvml = "LD_LIBRARY_PATH=" GFXREPRO_PRETENDED_NVML;

TEST_F(DeviceChoice, OfSeveralGpusThatOfTheClusterIsTaken) {
    if (hasRealGpu()) GTEST_SKIP() << "a GPU is here: which the pretended one would stand behind";
    for (const std::string visible : {"1", "0,1", "GPU-0011", "GPU-00112233-4455"}) {
        const ProcessResult run =
            onPretended("gpu", "serves", {kNvml, "CUDA_VISIBLE_DEVICES=" + visible});
        EXPECT_EQ(run.exitCode, 0) << visible << run.err;
    }
    for (const std::string visible : {"0", "", "-1", "GPU-ffffffff", "x,1"}) {
        for (const std::string device : {"gpu", "auto"}) {
            const ProcessResult run =
                onPretended(device, "serves", {kNvml, "CUDA_VISIBLE_DEVICES=" + visible});
            EXPECT_EQ(run.exitCode, 3) << device << visible;
            EXPECT_THAT(run.err, HasSubstr("device 0 (device): Pretended GPU is not among those "
                                           "that CUDA_VISIBLE_DEVICES gives: '" +
                                           visible + "'\n"));
        }
    }
    // Who names a device knows better, and where NVIDIA's library is not, it says nothing.
    EXPECT_EQ(onPretended("0", "serves", {kNvml, "CUDA_VISIBLE_DEVICES=0"}).exitCode, 0);
    EXPECT_EQ(onPretended("gpu", "serves", {"CUDA_VISIBLE_DEVICES=0"}).exitCode, 0);
}

TEST_F(DeviceChoice, WhatTheGpuDidIsKeptWithItsTimes) {
    if (hasRealGpu()) GTEST_SKIP() << "a GPU is here: which the pretended one would stand behind";
    config = writeMockConfig(folder,
                             "params: {pause_ms: 20}\n"
                             "measure: {lane: timing, processes: 1, repeats: 2}\n");
    ASSERT_EQ(onPretended("gpu", "serves", {kNvml}).exitCode, 0);
    const auto gpuOf = [&] { return lastManifest()["machine_states"].begin()->at("gpu"); };
    EXPECT_EQ(gpuOf()["lowest_clock_hz"], 1.98e9);
    EXPECT_EQ(gpuOf()["highest_clock_hz"], 1.98e9);
    EXPECT_EQ(gpuOf()["max_clock_hz"], 2.1e9);
    EXPECT_EQ(gpuOf()["highest_power_w"], 210.0);
    EXPECT_EQ(gpuOf()["hottest_c"], 64.0);
    EXPECT_EQ(gpuOf()["other_processes"], 0);

    const ProcessResult run =
        endedWith(0, onPretended("gpu", "serves",
                                 {kNvml, "PRETENDED_CLOCKS_MHZ=1980 1410",
                                  "PRETENDED_THROTTLE=0x24", "PRETENDED_USERS=1"}));
    EXPECT_EQ(gpuOf()["lowest_clock_hz"], 1.41e9);
    EXPECT_EQ(gpuOf()["throttled_by"], nlohmann::json({"heat", "its power limit"}));
    EXPECT_THAT(run.err,
                HasSubstr("the GPU's clock moved between 1.41 and 1.98 GHz; the GPU's clock was "
                          "held down by heat and its power limit; 1 other process used the GPU"));
    // Each case that is not of one clock is marked where its times stand.
    const fs::path kept = folder.path() / ("run-" + std::to_string(count));
    ASSERT_EQ(mockGfxrepro({"table", kept}).exitCode, 0);
    EXPECT_THAT(readFile(kept / "tables/sweep-mock.md"),
                HasSubstr("§ timed while the GPU's clock moved between 1.41 and 1.98 GHz.\n"));
}

TEST_F(DeviceChoice, PlansForAGpuNeedNone) {
    endedWith(0, mockGfxrepro({"plan", config, "--device", "gpu"}));
}

}  // namespace
}  // namespace gfxrepro::test
