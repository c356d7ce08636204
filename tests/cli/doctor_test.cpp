// The advice of `gfxrepro doctor`, each from made-up facts, by its exact words.

#include <cstdlib>
#include <filesystem>

#include "engine/gl/unused_gpus.h"
#include "runner/cli/advice.h"
#include "runner/cli/cpp_library.h"
#include "tests/support/support.h"

namespace gfxrepro::cli {
namespace {

DeviceFacts gpu() {
    DeviceFacts device{.renderer = "a GPU"};
    device.timer.stepNs = 40.0;
    device.maxTextureSizePx = 16384;
    device.max3dTextureSizePx = 2048;
    device.maxStorageBlockBytes = 128LL << 20;
    device.maxStorageBlocks = {16, 16, 16, 16, 16};
    return device;
}

/// "severity id: problem → advice" of each finding, a line each.
std::string linesOf(const MachineFacts& facts) {
    std::string lines;
    for (const Finding& finding : findingsOf(facts)) {
        lines += std::string(severityName(finding.severity)) + " " + finding.id + ": " +
                 finding.problem + " → " + finding.advice + "\n";
    }
    return lines;
}

/// Begins with a good machine.
struct Doctor : testing::Test {
    Doctor() {
        facts.devices = {gpu()};
        facts.assetsFolder = "/models";
        facts.coreCount = 4;
    }
    MachineFacts facts;
};

TEST_F(Doctor, SaysNothingOfAGoodMachine) {
    EXPECT_EQ(linesOf(facts), "");
}

TEST_F(Doctor, AGpuThatDoesNotServeIsOne) {
    facts.devices = {gpu(), gpu()};
    facts.devices[0].problem = "device 0 (device): cannot initialize its display";
    facts.devices[0].isGpu = true;
    facts.devices[1].isSoftware = true;
    EXPECT_EQ(linesOf(facts),
              "results device_does_not_serve: A device does not serve: device 0 (device): cannot "
              "initialize its display. → OpenGL 4.5 is needed: update this device's driver, or "
              "take another device with --device.\n");
}

TEST_F(Doctor, FewStorageBlocks) {
    facts.devices[0].maxStorageBlocks = {0, 16, 16, 16, 8};
    EXPECT_EQ(linesOf(facts),
              "results few_storage_blocks: Device 0 gives its shaders fewer storage blocks than "
              "some programs use (vertex 0 of 4, compute 8 of 12): their cases will fail. → "
              "Measure those on another device.\n");
}

TEST_F(Doctor, NoEgl) {
    facts.devices.clear();
    EXPECT_EQ(linesOf(facts),
              "fatal no_egl: No EGL device was found: there is no driver to draw with. → Install "
              "libegl1, libegl-mesa0 and libgl1-mesa-dri for the software device, or a GPU's "
              "driver with EGL.\n");
}

TEST_F(Doctor, DriverNotLoaded) {
    facts.devices[0].isSoftware = true;
    facts.driverProblems = {"/a.json names the driver libEGL_a.so.0: no such file"};
    EXPECT_THAT(
        linesOf(facts),
        StartsWith("results driver_not_loaded: A driver cannot be loaded: /a.json names the driver "
                   "libEGL_a.so.0: no such file. → Install what it lacks, or the driver anew; "
                   "where there is no such device, its file may go.\nresults software_only: "));
    facts.devices.clear();
    EXPECT_EQ(linesOf(facts).substr(0, 24), "fatal driver_not_loaded:");
}

/// Of the drivers that `folder` names, and no others.
std::vector<std::string> problemsOf(const TemporaryFolder& folder) {
    ::setenv("__EGL_VENDOR_LIBRARY_DIRS", folder.path().c_str(), 1);
    std::vector<std::string> problems = gl::vendorLibraryProblems();
    ::unsetenv("__EGL_VENDOR_LIBRARY_DIRS");
    return problems;
}

TEST(VendorLibraries, SayWhyADriverCannotBeLoaded) {
    const TemporaryFolder folder;
    const std::string driver = R"({"file_format_version":"1.0.0","ICD":{"library_path":"LIB"}})";
    const auto naming = [&](const std::string& library) {
        return std::string(driver).replace(driver.find("LIB"), 3, library);
    };
    folder.write("10_good.json", naming("libm.so.6"));
    EXPECT_THAT(problemsOf(folder), IsEmpty());
    folder.write("20_gone.json", naming("libEGL_gone.so.0"));
    folder.write("30_torn.json", driver.substr(0, 20));
    const std::string libraries = folder.write("no.so", "no library").string();
    folder.write("40_no.json", naming(libraries));
    folder.write("50_other.json", R"({"ICD": {"library_path": 3}})");
    const std::vector<std::string> problems = problemsOf(folder);
    ASSERT_EQ(problems.size(), 4U);
    EXPECT_EQ(problems[0], (folder.path() / "20_gone.json").string() +
                               " names the driver libEGL_gone.so.0: libEGL_gone.so.0: cannot open "
                               "shared object file: No such file or directory");
    EXPECT_EQ(problems[1], (folder.path() / "30_torn.json").string() + ": is no JSON object");
    EXPECT_THAT(problems[2], HasSubstr("no.so: file too short"));
    EXPECT_EQ(problems[3], (folder.path() / "50_other.json").string() +
                               ": '/ICD/library_path' is number; expected text");
}

TEST(CppLibrary, ReleaseComesFromTheName) {
    const TemporaryFolder folder;
    const auto file = folder.write("libstdc++.so.6.0.30", "");
    EXPECT_EQ(releaseOfCppLibrary(file), 30);
    fs::create_symlink(file, folder.path() / "libstdc++.so.6");
    EXPECT_EQ(releaseOfCppLibrary(folder.path() / "libstdc++.so.6"), 30);
    const auto plain = folder.write("plain/libstdc++.so.6", "copy");
    EXPECT_EQ(releaseOfCppLibrary(plain), 0);
    folder.write("plain/libstdc++.so.6.0.29", "another");
    EXPECT_EQ(releaseOfCppLibrary(plain), 0);
    folder.write("plain/libstdc++.so.6.0.31", "copy");
    EXPECT_EQ(releaseOfCppLibrary(plain), 31);
    EXPECT_EQ(releaseOfCppLibrary(folder.path() / "none"), 0);
}

TEST_F(Doctor, OldGl) {
    facts.devices[0].problem = "OpenGL 3.3 only";
    EXPECT_EQ(linesOf(facts),
              "fatal device_does_not_serve: A device does not serve: OpenGL 3.3 only. → OpenGL 4.5 "
              "is needed: update this device's driver, or take another device with --device.\n"
              "fatal no_device: No device makes an OpenGL 4.5 context: nothing can be measured. → "
              "Install libegl-mesa0 and libgl1-mesa-dri of Mesa 20.3 or newer for the software "
              "device.\n");
    // Beside one that serves it is no more than a remark.
    facts.devices.push_back(gpu());
    EXPECT_EQ(linesOf(facts).substr(0, 29), "results device_does_not_serve");
}

TEST_F(Doctor, SoftwareOnly) {
    facts.devices[0].isSoftware = true;
    EXPECT_EQ(linesOf(facts),
              "results software_only: There is no GPU, only the software device: claims that need "
              "a GPU stay without a verdict. → On a machine with a GPU, install its driver with "
              "EGL, and let this user open /dev/dri or /dev/nvidia*.\n");
    facts.devices.push_back(gpu());
    EXPECT_EQ(linesOf(facts), "");
}

TEST_F(Doctor, AGpuThatDoesNotServe) {
    facts.devices[0].isSoftware = true;
    facts.unusedGpus = {"/dev/nvidia0: Permission denied"};
    EXPECT_EQ(
        linesOf(facts),
        "results gpu_does_not_serve: There is a GPU that cannot be used: /dev/nvidia0: Permission "
        "denied. → Install its driver with EGL (in a container, let in its graphics part), and let "
        "this user open its file. --device software measures without it.\n");
}

TEST_F(Doctor, CoarseTimer) {
    facts.devices[0].timer.stepNs = 20000.0;
    EXPECT_EQ(linesOf(facts),
              "times coarse_timer: Device 0: its clock moves in steps of 20000 ns, so short passes "
              "cannot be told apart. → Compare times of this device with more frames (--set "
              "measure.repeats=50), or take another device.\n");
}

TEST_F(Doctor, NoTimer) {
    facts.devices[0].timer = {0};
    EXPECT_EQ(linesOf(facts),
              "times no_timer: Device 0: it has no clock for GPU times, or one that does not go as "
              "the processor's, so passes have none. → Compare times of the whole frame "
              "(wall_time_ms), update its driver, or take another device.\n");
}

TEST_F(Doctor, SmallLimits) {
    facts.devices[0].max3dTextureSizePx = 256;
    facts.devices[0].maxStorageBlockBytes = 1 << 20;
    EXPECT_EQ(
        linesOf(facts),
        "results small_limits: Device 0 has smaller limits than OpenGL 4.5 promises (3D textures "
        "of 256, storage blocks of 1048576): the largest cases will be marked unsupported. → "
        "Measure those on another device; --set and --sweep make them smaller.\n");
}

TEST_F(Doctor, Assets) {
    facts.hasAssets = false;
    facts.standInCount = 3;
    EXPECT_EQ(linesOf(facts),
              "results no_assets: The folder of real models, /models, is not there: stand-ins are "
              "measured, and marked. → Run scripts/fetch-assets, or name a folder with --assets or "
              "GFXREPRO_ASSETS.\n");
    facts.hasAssets = true;
    EXPECT_EQ(linesOf(facts),
              "results stand_ins: The real models of 3 scenes are not in /models: stand-ins are "
              "measured, and marked. → Run scripts/fetch-assets; `gfxrepro describe SCENE` says "
              "where those come from that it cannot get.\n");
    facts.standInCount = 0;
    facts.missingSceneCount = 2;
    EXPECT_THAT(
        linesOf(facts),
        HasSubstr("results missing_scenes: 2 scenes have not even a stand-in: their cases will not "
                  "run. → `gfxrepro describe SCENE` says which file each needs.\n"));
}

TEST_F(Doctor, Disk) {
    facts.freeDiskBytes = 0.25 * 1024 * 1024 * 1024;
    facts.isRunsWritable = false;
    facts.runsFolder = "/usr/runs";
    EXPECT_EQ(
        linesOf(facts),
        "results runs_not_writable: /usr/runs cannot be written: no run can be kept there. → Go to "
        "a folder of your own, or name one with --out.\n"
        "results little_disk: Only 0.25 GiB of disk are free here; a run of a whole paper writes "
        "up to 1 GiB of images. → Free some, or name a folder on another disk with --out.\n");
}

TEST_F(Doctor, Processor) {
    facts.cpuIsa = "SSE";
    EXPECT_EQ(linesOf(facts),
              "times no_avx: The processor has no AVX: ray tracing on it takes several times "
              "longer. → In a virtual machine, ask for the host's processor type; otherwise allow "
              "more time with --set measure.time_limit_s=600.\n");
}

TEST_F(Doctor, Noise) {
    facts.load = 3.0;
    facts.cpuGovernor = "powersave";
    facts.stolenFraction = 0.034;
    EXPECT_EQ(linesOf(facts),
              "times other_load: Other programs are running: a load of 3.0 on 4 cores. Times will "
              "scatter. → Stop them, or wait, before a table of times is measured.\n"
              "times cpu_governor: The processor changes its clock as it goes (governor "
              "'powersave'): times will scatter. → As root: echo performance | tee "
              "/sys/devices/system/cpu/cpu*/cpufreq/scaling_governor\n"
              "times noisy_host: This virtual machine was kept waiting 3.4 % of the time: its host "
              "is busy with others. → Measure times on a machine of one's own; elsewhere raise "
              "measure.processes and look at the intervals.\n");
    facts.cpuGovernor = "performance";
    facts.load = 0.5;
    facts.stolenFraction = 0.0;
    EXPECT_EQ(linesOf(facts), "");
}

TEST_F(Doctor, WorstFirst) {
    facts.load = 9.0;
    facts.freeDiskBytes = 0.0;
    facts.devices.clear();
    const std::vector<Finding> findings = findingsOf(facts);
    ASSERT_EQ(findings.size(), 3U);
    EXPECT_EQ(findings[0].id, "no_egl");
    EXPECT_EQ(findings[1].id, "little_disk");
    EXPECT_EQ(findings[2].id, "other_load");
}

}  // namespace
}  // namespace gfxrepro::cli
