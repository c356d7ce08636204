#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>
#include <sstream>

#include "engine/core/files.h"
#include "engine/core/processors.h"
#include "engine/core/text.h"
#include "engine/gl/device.h"
#include "engine/gl/unused_gpus.h"
#include "engine/raycast/embree.h"
#include "runner/cli/advice.h"
#include "runner/cli/commands.h"
#include "runner/cli/console.h"
#include "runner/cli/driver_limit.h"
#include "runner/cli/experiments.h"
#include "runner/run/manifest.h"
#include "runner/run/protocol.h"

namespace gfxrepro::cli {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

Json devicesJson(const std::vector<gl::DeviceReport>& reports) {
    Json devices = Json::array();
    for (const gl::DeviceReport& report : reports) {
        Json device = run::toJson(report.info);
        device["problem"] = report.problem;
        const gl::DeviceLimits& limits = report.limits;
        device["limits"] = {
            {"max_texture_size_px", limits.maxTextureSizePx},
            {"max_3d_texture_size_px", limits.max3dTextureSizePx},
            {"max_array_layers", limits.maxArrayLayers},
            {"max_storage_block_bytes", limits.maxStorageBlockBytes},
            {"max_tessellation_level", limits.maxTessellationLevel},
            {"max_compute_invocations", limits.maxComputeInvocations},
            {"max_image_units", limits.maxImageUnits},
            {"max_storage_blocks",
             {{"vertex", limits.maxStorageBlocks.vertex},
              {"tessellation_control", limits.maxStorageBlocks.tessellationControl},
              {"tessellation_evaluation", limits.maxStorageBlocks.tessellationEvaluation},
              {"fragment", limits.maxStorageBlocks.fragment},
              {"compute", limits.maxStorageBlocks.compute}}}};
        devices.push_back(std::move(device));
    }
    return devices;
}

std::string embreeVersion() {
    const RTCDevice device = rtcNewDevice(nullptr);
    const auto version = rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_VERSION);
    rtcReleaseDevice(device);
    return fmt::format("{}.{}.{}", version / 10000, version / 100 % 100, version % 100);
}

/// The instructions that Embree takes on this processor.
std::string embreeIsa() {
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) return "AVX-512";
    if (__builtin_cpu_supports("avx2")) return "AVX2";
    if (__builtin_cpu_supports("avx")) return "AVX";
    return "SSE";
#else
    return "NEON";
#endif
}

std::vector<DeviceFacts> deviceFacts(const std::vector<gl::DeviceReport>& reports) {
    std::vector<DeviceFacts> devices;
    for (const gl::DeviceReport& report : reports) {
        devices.push_back({report.info.index, report.info.renderer, report.problem,
                           report.info.isSoftware, report.isGpu, report.info.timer,
                           report.limits.maxTextureSizePx, report.limits.max3dTextureSizePx,
                           report.limits.maxStorageBlockBytes, report.limits.maxStorageBlocks});
    }
    return devices;
}

/// The first line of a file of the kernel; empty when there is none.
std::string firstLineOf(const char* path) {
    std::ifstream file(path);
    std::string line;
    std::getline(file, line);
    return line;
}

/// Of all ticks since boot, those that the host of a virtual machine gave to others.
double stolenFraction() {
    std::istringstream line(firstLineOf("/proc/stat"));  // cpu user nice … steal guest guest_nice
    std::string name;
    line >> name;
    std::array<double, 8> ticks = {};
    for (double& tick : ticks) line >> tick;
    const double sum = std::accumulate(ticks.begin(), ticks.end(), 0.0);
    return sum > 0.0 ? ticks.back() / sum : 0.0;
}

MachineFacts gatherFacts(const std::vector<gl::DeviceReport>& reports,
                         const scene::Catalog& catalog) {
    MachineFacts facts;
    facts.devices = deviceFacts(reports);
    const bool hasGpu = std::ranges::any_of(facts.devices, [](const DeviceFacts& device) {
        return device.problem.empty() && !device.isSoftware;
    });
    if (!hasGpu) {
        facts.driverProblems = gl::vendorLibraryProblems();
        facts.unusedGpus = gl::unusedGpus();
    }
    facts.cpuIsa = embreeIsa();
    facts.assetsFolder = catalog.assetsFolder().string();
    facts.fetchScript =
        (dataFolder("configs").parent_path() / "scripts/fetch-assets").lexically_normal().string();
    facts.hasAssets = fs::is_directory(catalog.assetsFolder());
    for (const auto& [name, entry] : catalog.entries()) {
        const std::string state = sceneState(catalog, name);
        facts.standInCount += state == "stand-in";
        facts.missingSceneCount += state == "missing";
    }
    facts.freeDiskBytes = static_cast<double>(fs::space(fs::current_path()).available);
    facts.runsFolder = fs::absolute("runs").string();
    const fs::path writable = fs::is_directory("runs") ? "runs" : ".";
    facts.isRunsWritable = ::access(writable.c_str(), W_OK | X_OK) == 0;
    facts.cpuGovernor = firstLineOf("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor");
    facts.load = parseDouble(split(firstLineOf("/proc/loadavg"), ' ').front()).value_or(0.0);
    facts.coreCount = usableProcessors();
    facts.stolenFraction = stolenFraction();
    return facts;
}

Json findingsJson(const std::vector<Finding>& findings) {
    Json list = Json::array();
    for (const Finding& finding : findings) {
        list.push_back({{"id", finding.id},
                        {"severity", severityName(finding.severity)},
                        {"problem", finding.problem},
                        {"advice", finding.advice}});
    }
    return list;
}

Json gather(const std::vector<gl::DeviceReport>& reports, const scene::Catalog& catalog,
            const MachineFacts& facts) {
    Json scenes = Json::object();
    for (const auto& [name, entry] : catalog.entries()) scenes[name] = sceneState(catalog, name);
    return {{"commit", run::programCommit()},
            {"build", run::programBuild()},
            {"devices", devicesJson(reports)},
            {"embree", {{"version", embreeVersion()}, {"cpu_isa", facts.cpuIsa}}},
            {"assets", {{"folder", facts.assetsFolder}, {"exists", facts.hasAssets}}},
            {"scenes", scenes},
            {"free_disk_bytes", facts.freeDiskBytes},
            {"runs", {{"folder", facts.runsFolder}, {"writable", facts.isRunsWritable}}},
            {"cpu",
             {{"cores", facts.coreCount},
              {"governor", facts.cpuGovernor},
              {"load", facts.load},
              {"stolen_fraction", facts.stolenFraction}}}};
}

void printDevice(const Json& device) {
    const std::string problem = device["problem"];
    if (!problem.empty()) {
        say("device {}   does not serve: {}\n", device["index"].get<int>(), problem);
        return;
    }
    const Json& limits = device["limits"];
    say("device {}   {} ({}, {})\n", device["index"].get<int>(),
        device["renderer"].get<std::string>(), device["platform"].get<std::string>(),
        device["is_software"].get<bool>() ? "software" : "gpu");
    if (const std::string uuid = device["uuid"]; !uuid.empty()) say("           UUID {}\n", uuid);
    const int bits = device["timer_bits"];
    const std::string timer = bits == 0
                                  ? "no clock for GPU times"
                                  : fmt::format("GPU times of {} bits in steps of {:.0f} ns", bits,
                                                device["timer_resolution_ns"].get<double>());
    say("           OpenGL {}, {}\n", device["version"].get<std::string>(), timer);
    say("           textures {}², 3D {}³, {} layers, storage blocks {} MiB,\n",
        limits["max_texture_size_px"].get<int>(), limits["max_3d_texture_size_px"].get<int>(),
        limits["max_array_layers"].get<int>(),
        limits["max_storage_block_bytes"].get<long long>() >> 20);
    say("           tessellation {}, compute {} invocations, {} image units\n",
        limits["max_tessellation_level"].get<int>(), limits["max_compute_invocations"].get<int>(),
        limits["max_image_units"].get<int>());
}

std::vector<std::string> namesInState(const Json& scenes, const std::string& state) {
    std::vector<std::string> names;
    for (const auto& [name, value] : scenes.items()) {
        if (value == state) names.push_back(name);
    }
    return names;
}

void printFacts(const Json& found) {
    say("program    {}, {}\n", found["commit"].get<std::string>(),
        found["build"].get<std::string>());
    for (const Json& device : found["devices"]) printDevice(device);
    say("embree     {} ({})\n", found["embree"]["version"].get<std::string>(),
        found["embree"]["cpu_isa"].get<std::string>());
    say("assets     {}{}\n", found["assets"]["folder"].get<std::string>(),
        found["assets"]["exists"].get<bool>() ? "" : " (not there)");
    for (const char* state : {"real", "stand-in", "generated", "missing"}) {
        const std::vector<std::string> names = namesInState(found["scenes"], state);
        if (!names.empty()) say("  {:<11}{}\n", state, joined(names));
    }
    say("disk       {:.1f} GiB free here\n", found["free_disk_bytes"].get<double>() / kBytesPerGib);
}

}  // namespace

int doctor(const Context& context, const std::string& assets, bool asJson) {
    const scene::Catalog catalog = openCatalog(context, assets);
    const std::vector<gl::DeviceReport> reports = [] {
        const DriverLimit limit;
        return gl::listDevices();
    }();
    const MachineFacts facts = gatherFacts(reports, catalog);
    const std::vector<Finding> findings = findingsOf(facts);
    Json found = gather(reports, catalog, facts);
    if (asJson) {
        found["findings"] = findingsJson(findings);
        fmt::print("{}\n", found.dump(2, ' ', false, Json::error_handler_t::replace));
    } else {
        printFacts(found);
        for (const Finding& finding : findings) {
            say("\n{:<10} {}\n{:<10} {}\n", severityName(finding.severity), finding.problem,
                "  to do", finding.advice);
        }
        if (findings.empty()) say("all well\n");
    }
    const bool anyServes = std::any_of(reports.begin(), reports.end(),
                                       [](const auto& report) { return report.problem.empty(); });
    return anyServes ? kExitOk : kExitNoDevice;
}

}  // namespace gfxrepro::cli
