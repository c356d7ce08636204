#include "runner/cli/advice.h"

#include <fmt/format.h>

#include <algorithm>

namespace gfxrepro::cli {

namespace {

using Severity = Finding::Severity;
using Findings = std::vector<Finding>;

constexpr double kMinFreeDiskBytes = kBytesPerGib;  // a full run of a paper writes images
// A pass of the shipped tables takes 10 µs or more: a coarser step shows in its last digit.
constexpr double kMaxTimerStepNs = 1000.0;
// What OpenGL 4.5 promises (core profile, tables of implementation dependent values).
constexpr int kMinTextureSizePx = 16384;
constexpr int kMin3dTextureSizePx = 2048;
constexpr long long kMinStorageBlockBytes = 128LL << 20;
// What the programs use at most, of one stage (tests/drivers counts them).
constexpr gl::DeviceLimits::StorageBlocks kUsedStorageBlocks{.vertex = 4,
                                                             .tessellationControl = 4,
                                                             .tessellationEvaluation = 1,
                                                             .fragment = 8,
                                                             .compute = 12};
// Another task on every fifth core already shows in the intervals.
constexpr double kMaxLoadPerCore = 0.2;
constexpr double kMaxStolenFraction = 0.01;

void addDriverFindings(const MachineFacts& facts, Findings& findings) {
    for (const std::string& problem : facts.driverProblems) {
        findings.push_back({"driver_not_loaded",
                            facts.devices.empty() ? Severity::Fatal : Severity::Result,
                            fmt::format("A driver cannot be loaded: {}.", problem),
                            "Install what it lacks, or the driver anew; where there is no such "
                            "device, its file may go."});
    }
}

void addDeviceFindings(const MachineFacts& facts, Findings& findings) {
    if (facts.devices.empty()) {
        findings.push_back({"no_egl", Severity::Fatal,
                            "No EGL device was found: there is no driver to draw with.",
                            "Install libegl1, libegl-mesa0 and libgl1-mesa-dri for the software "
                            "device, or a GPU's driver with EGL."});
        return;
    }
    const bool anyServes = std::any_of(facts.devices.begin(), facts.devices.end(),
                                       [](const DeviceFacts& d) { return d.problem.empty(); });
    for (const DeviceFacts& device : facts.devices) {
        if (device.problem.empty()) continue;
        findings.push_back({"device_does_not_serve", anyServes ? Severity::Result : Severity::Fatal,
                            fmt::format("A device does not serve: {}.", device.problem),
                            "OpenGL 4.5 is needed: update this device's driver, or take another "
                            "device with --device."});
    }
    if (!anyServes) {
        findings.push_back({"no_device", Severity::Fatal,
                            "No device makes an OpenGL 4.5 context: nothing can be measured.",
                            "Install libegl-mesa0 and libgl1-mesa-dri of Mesa 20.3 or newer for "
                            "the software device."});
        return;
    }
    const bool anyGpu = std::any_of(
        facts.devices.begin(), facts.devices.end(),
        [](const DeviceFacts& d) { return d.problem.empty() ? !d.isSoftware : d.isGpu; });
    for (const std::string& gpu : facts.unusedGpus) {
        findings.push_back(
            {"gpu_does_not_serve", Severity::Result,
             fmt::format("There is a GPU that cannot be used: {}.", gpu),
             "Install its driver with EGL (in a container, let in its graphics part), and let this "
             "user open its file. --device software measures without it."});
    }
    if (!anyGpu && facts.unusedGpus.empty()) {
        findings.push_back({"software_only", Severity::Result,
                            "There is no GPU, only the software device: claims that need a GPU "
                            "stay without a verdict.",
                            "On a machine with a GPU, install its driver with EGL, and let this "
                            "user open /dev/dri or /dev/nvidia*."});
    }
}

void addLimitFindings(const DeviceFacts& device, Findings& findings) {
    if (!device.problem.empty()) return;
    if (device.timer.bits == 0) {
        findings.push_back(
            {"no_timer", Severity::Timing,
             fmt::format("Device {}: it has no clock for GPU times, or one that does "
                         "not go as the processor's, so passes have none.",
                         device.index),
             "Compare times of the whole frame (wall_time_ms), update its driver, "
             "or take another device."});
    } else if (device.timer.stepNs > kMaxTimerStepNs) {
        findings.push_back(
            {"coarse_timer", Severity::Timing,
             fmt::format("Device {}: its clock moves in steps of {:.0f} ns, so short passes cannot "
                         "be told apart.",
                         device.index, device.timer.stepNs),
             "Compare times of this device with more frames (--set measure.repeats=50), or "
             "take another device."});
    }
    std::string small;
    const auto require = [&](auto value, auto least, const char* what) {
        if (value < least) small += fmt::format("{}{} {}", small.empty() ? "" : ", ", what, value);
    };
    require(device.maxTextureSizePx, kMinTextureSizePx, "textures of");
    require(device.max3dTextureSizePx, kMin3dTextureSizePx, "3D textures of");
    require(device.maxStorageBlockBytes, kMinStorageBlockBytes, "storage blocks of");
    if (!small.empty()) {
        findings.push_back(
            {"small_limits", Severity::Result,
             fmt::format("Device {} has smaller limits than OpenGL 4.5 promises ({}): "
                         "the largest cases will be marked unsupported.",
                         device.index, small),
             "Measure those on another device; --set and --sweep make them "
             "smaller."});
    }
    std::string few;
    const auto use = [&](int most, int used, const char* stage) {
        if (most >= used) return;
        few += fmt::format("{}{} {} of {}", few.empty() ? "" : ", ", stage, most, used);
    };
    const gl::DeviceLimits::StorageBlocks& blocks = device.maxStorageBlocks;
    use(blocks.vertex, kUsedStorageBlocks.vertex, "vertex");
    use(blocks.tessellationControl, kUsedStorageBlocks.tessellationControl, "tessellation control");
    use(blocks.tessellationEvaluation, kUsedStorageBlocks.tessellationEvaluation,
        "tessellation evaluation");
    use(blocks.fragment, kUsedStorageBlocks.fragment, "fragment");
    use(blocks.compute, kUsedStorageBlocks.compute, "compute");
    if (!few.empty()) {
        findings.push_back({"few_storage_blocks", Severity::Result,
                            fmt::format("Device {} gives its shaders fewer storage blocks than "
                                        "some programs use ({}): their cases will fail.",
                                        device.index, few),
                            "Measure those on another device."});
    }
}

void addSceneFindings(const MachineFacts& facts, Findings& findings) {
    if (!facts.hasAssets) {
        findings.push_back({"no_assets", Severity::Result,
                            fmt::format("The folder of real models, {}, is not there: stand-ins "
                                        "are measured, and marked.",
                                        facts.assetsFolder),
                            fmt::format("Run {}, or name a folder with --assets or "
                                        "GFXREPRO_ASSETS.",
                                        facts.fetchScript)});
    } else if (facts.standInCount + facts.missingSceneCount > 0) {
        findings.push_back(
            {"stand_ins", Severity::Result,
             fmt::format("The real models of {} scenes are not in {}: stand-ins "
                         "are measured, and marked.",
                         facts.standInCount + facts.missingSceneCount, facts.assetsFolder),
             fmt::format("Run {}; `gfxrepro describe SCENE` says where those come from "
                         "that it cannot get.",
                         facts.fetchScript)});
    }
    if (facts.missingSceneCount > 0) {
        findings.push_back({"missing_scenes", Severity::Result,
                            fmt::format("{} scenes have not even a stand-in: their cases will not "
                                        "run.",
                                        facts.missingSceneCount),
                            "`gfxrepro describe SCENE` says which file each needs."});
    }
}

void addDiskFindings(const MachineFacts& facts, Findings& findings) {
    if (!facts.isRunsWritable) {
        findings.push_back(
            {"runs_not_writable", Severity::Result,
             fmt::format("{} cannot be written: no run can be kept there.", facts.runsFolder),
             "Go to a folder of your own, or name one with --out."});
    }
    if (facts.freeDiskBytes < kMinFreeDiskBytes) {
        findings.push_back({"little_disk", Severity::Result,
                            fmt::format("Only {:.2f} GiB of disk are free here; a run of a whole "
                                        "paper writes up to 1 GiB of images.",
                                        facts.freeDiskBytes / kBytesPerGib),
                            "Free some, or name a folder on another disk with --out."});
    }
}

void addProcessorFindings(const MachineFacts& facts, Findings& findings) {
    if (facts.cpuIsa == "SSE") {
        findings.push_back({"no_avx", Severity::Timing,
                            "The processor has no AVX: ray tracing on it takes several times "
                            "longer.",
                            "In a virtual machine, ask for the host's processor type; otherwise "
                            "allow more time with --set measure.time_limit_s=600."});
    }
}

void addNoiseFindings(const MachineFacts& facts, Findings& findings) {
    const double loadPerCore = facts.load / std::max(1, facts.coreCount);
    if (loadPerCore > kMaxLoadPerCore) {
        findings.push_back({"other_load", Severity::Timing,
                            fmt::format("Other programs are running: a load of {:.1f} on {} "
                                        "cores. Times will scatter.",
                                        facts.load, facts.coreCount),
                            "Stop them, or wait, before a table of times is measured."});
    }
    if (!facts.cpuGovernor.empty() && facts.cpuGovernor != "performance") {
        findings.push_back({"cpu_governor", Severity::Timing,
                            fmt::format("The processor changes its clock as it goes (governor "
                                        "'{}'): times will scatter.",
                                        facts.cpuGovernor),
                            "As root: echo performance | tee "
                            "/sys/devices/system/cpu/cpu*/cpufreq/scaling_governor"});
    }
    if (facts.stolenFraction > kMaxStolenFraction) {
        findings.push_back({"noisy_host", Severity::Timing,
                            fmt::format("This virtual machine was kept waiting {:.1f} % of the "
                                        "time: its host is busy with others.",
                                        facts.stolenFraction * 100.0),
                            "Measure times on a machine of one's own; elsewhere raise "
                            "measure.processes and look at the intervals."});
    }
}

}  // namespace

std::vector<Finding> findingsOf(const MachineFacts& facts) {
    Findings findings;
    addDriverFindings(facts, findings);
    addDeviceFindings(facts, findings);
    for (const DeviceFacts& device : facts.devices) addLimitFindings(device, findings);
    addDiskFindings(facts, findings);
    addSceneFindings(facts, findings);
    addProcessorFindings(facts, findings);
    addNoiseFindings(facts, findings);
    std::stable_sort(findings.begin(), findings.end(),
                     [](const Finding& a, const Finding& b) { return a.severity < b.severity; });
    return findings;
}

const char* severityName(Finding::Severity severity) {
    switch (severity) {
        case Severity::Fatal:
            return "fatal";
        case Severity::Result:
            return "results";
        case Severity::Timing:
            return "times";
    }
    return "";
}

}  // namespace gfxrepro::cli
