#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "runner/batch/manifest.h"
#include "runner/batch/protocol.h"
#include "runner/cli/commands.h"
#include "runner/cli/experiments.h"
#include "runner/core/files.h"
#include "runner/gl/device.h"

namespace gfxrepro::cli {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

constexpr double kBytesPerGib = 1024.0 * 1024.0 * 1024.0;

Json devicesJson() {
    Json devices = Json::array();
    for (const gl::DeviceReport& report : gl::listDevices()) {
        Json device = batch::toJson(report.info);
        device["problem"] = report.problem;
        const gl::DeviceLimits& limits = report.limits;
        device["limits"] = {{"max_texture_size_px", limits.maxTextureSizePx},
                            {"max_3d_texture_size_px", limits.max3dTextureSizePx},
                            {"max_array_layers", limits.maxArrayLayers},
                            {"max_storage_block_bytes", limits.maxStorageBlockBytes},
                            {"max_tessellation_level", limits.maxTessellationLevel},
                            {"max_compute_invocations", limits.maxComputeInvocations},
                            {"max_image_units", limits.maxImageUnits}};
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

std::string embreeIsa() {
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) return "AVX-512";
    if (__builtin_cpu_supports("avx2")) return "AVX2";
    if (__builtin_cpu_supports("avx")) return "AVX";
    return "SSE";
}

/// "real", "stand-in", "generated" or "missing".
std::string sceneState(const scene::Catalog& catalog, const std::string& name) {
    const scene::SceneEntry& entry = catalog.entries().at(name);
    for (const scene::SceneSource& source : entry.sources) {
        const bool isThere =
            source.file.empty() || fs::exists(catalog.assetsFolder() / source.file);
        if (!isThere) continue;
        if (source.kind == scene::Origin::Kind::Real) return "real";
        return source.kind == scene::Origin::Kind::StandIn ? "stand-in" : "generated";
    }
    return "missing";
}

Json gather(const scene::Catalog& catalog) {
    Json scenes = Json::object();
    for (const auto& [name, entry] : catalog.entries()) scenes[name] = sceneState(catalog, name);
    return {{"commit", batch::programCommit()},
            {"build", batch::programBuild()},
            {"devices", devicesJson()},
            {"embree", {{"version", embreeVersion()}, {"cpu_isa", embreeIsa()}}},
            {"assets",
             {{"folder", catalog.assetsFolder().string()},
              {"exists", fs::is_directory(catalog.assetsFolder())}}},
            {"scenes", scenes},
            {"free_disk_bytes", fs::space(fs::current_path()).available}};
}

void printDevice(const Json& device) {
    const std::string problem = device["problem"];
    if (!problem.empty()) {
        fmt::print("device {}   does not serve: {}\n", device["index"].get<int>(), problem);
        return;
    }
    const Json& limits = device["limits"];
    fmt::print("device {}   {} ({}, {})\n", device["index"].get<int>(),
               device["renderer"].get<std::string>(), device["platform"].get<std::string>(),
               device["is_software"].get<bool>() ? "software" : "gpu");
    fmt::print("           OpenGL {}, timer resolution {:.0f} ns\n",
               device["version"].get<std::string>(), device["timer_resolution_ns"].get<double>());
    fmt::print("           textures {}², 3D {}³, {} layers, storage blocks {} MiB,\n",
               limits["max_texture_size_px"].get<int>(),
               limits["max_3d_texture_size_px"].get<int>(), limits["max_array_layers"].get<int>(),
               limits["max_storage_block_bytes"].get<long long>() >> 20);
    fmt::print("           tessellation {}, compute {} invocations, {} image units\n",
               limits["max_tessellation_level"].get<int>(),
               limits["max_compute_invocations"].get<int>(), limits["max_image_units"].get<int>());
}

std::vector<std::string> namesInState(const Json& scenes, const std::string& state) {
    std::vector<std::string> names;
    for (const auto& [name, value] : scenes.items()) {
        if (value == state) names.push_back(name);
    }
    return names;
}

/// What to do, in plain words; empty when there is nothing.
std::vector<std::string> advice(const Json& found, bool anyServes) {
    std::vector<std::string> lines;
    if (!anyServes) {
        lines.push_back(
            "no device can make an OpenGL 4.5 context; install libgl1-mesa-dri and "
            "libegl-mesa0 for the software one, or a GPU driver with EGL");
    }
    if (!found["assets"]["exists"].get<bool>()) {
        lines.push_back(
            "the assets folder is not there: stand-ins are used for scanned models; "
            "scripts/fetch-assets fills it, --assets DIR names another");
    } else if (!namesInState(found["scenes"], "stand-in").empty() ||
               !namesInState(found["scenes"], "missing").empty()) {
        lines.push_back("some scenes are not the real ones; scripts/fetch-assets gets them");
    }
    if (found["free_disk_bytes"].get<double>() < kBytesPerGib) {
        lines.push_back("less than 1 GiB is free here; a full run writes images");
    }
    return lines;
}

void print(const Json& found) {
    fmt::print("program    {}, {}\n", found["commit"].get<std::string>(),
               found["build"].get<std::string>());
    for (const Json& device : found["devices"]) printDevice(device);
    fmt::print("embree     {} ({})\n", found["embree"]["version"].get<std::string>(),
               found["embree"]["cpu_isa"].get<std::string>());
    fmt::print("assets     {}{}\n", found["assets"]["folder"].get<std::string>(),
               found["assets"]["exists"].get<bool>() ? "" : " (not there)");
    for (const char* state : {"real", "stand-in", "generated", "missing"}) {
        const std::vector<std::string> names = namesInState(found["scenes"], state);
        if (!names.empty()) fmt::print("  {:<11}{}\n", state, fmt::join(names, ", "));
    }
    fmt::print("disk       {:.1f} GiB free here\n",
               found["free_disk_bytes"].get<double>() / kBytesPerGib);
}

}  // namespace

int doctor(const Context&, const std::string& assets, bool asJson) {
    const Json found = gather(openCatalog(assets));
    bool anyServes = false;
    for (const Json& device : found["devices"]) {
        anyServes = anyServes || device["problem"].get<std::string>().empty();
    }
    if (asJson) {
        fmt::print("{}\n", found.dump(2));
    } else {
        print(found);
        const std::vector<std::string> lines = advice(found, anyServes);
        for (const std::string& line : lines) fmt::print("to do      {}\n", line);
        if (lines.empty()) fmt::print("all well\n");
    }
    return anyServes ? kExitOk : kExitNoDevice;
}

}  // namespace gfxrepro::cli
