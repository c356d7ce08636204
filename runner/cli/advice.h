// What is wrong on a machine, in plain words, and what to do about it. No fact is looked up here:
// `gfxrepro doctor` gathers them.
#pragma once

#include <string>
#include <vector>

#include "engine/gl/device.h"

namespace gfxrepro::cli {

inline constexpr double kBytesPerGib = 1024.0 * 1024.0 * 1024.0;

struct DeviceFacts {
    int index = 0;
    std::string renderer;
    std::string problem;  // why it does not serve; empty: it does
    bool isSoftware = false;
    bool isGpu = false;  // as far as EGL tells, of one that does not serve
    gl::DeviceTimer timer;
    int maxTextureSizePx = 0;
    int max3dTextureSizePx = 0;
    long long maxStorageBlockBytes = 0;
    gl::DeviceLimits::StorageBlocks maxStorageBlocks;
};

/// What `doctor` looked at. The defaults are a machine without a fault.
struct MachineFacts {
    std::vector<DeviceFacts> devices;
    std::vector<std::string> driverProblems;  // of drivers that cannot be loaded; without a GPU
    std::vector<std::string> unusedGpus;      // that no driver serves, each with its reason
    std::string cpuIsa = "AVX2";              // "SSE", "AVX", "AVX2", "AVX-512", on ARM "NEON"
    std::string assetsFolder;
    std::string fetchScript = "scripts/fetch-assets";
    bool hasAssets = true;
    int standInCount = 0;       // scenes whose real model is not there
    int missingSceneCount = 0;  // scenes without any source at hand
    double freeDiskBytes = 1e12;
    std::string runsFolder = "runs";
    bool isRunsWritable = true;
    std::string cpuGovernor;  // empty: not known
    double load = 0.0;        // runnable tasks, averaged over a minute
    int coreCount = 1;
    double stolenFraction = 0.0;  // of the time since boot that the machine's host kept for others
};

struct Finding {
    enum class Severity {
        Fatal,   // nothing can be measured
        Result,  // some results will be missing, or not the paper's
        Timing,  // times will be less certain
    };
    std::string id;  // "no_device": the same on every machine
    Severity severity = Severity::Result;
    std::string problem;
    std::string advice;
};

/// The worst first.
std::vector<Finding> findingsOf(const MachineFacts& facts);

/// "fatal", "results", "times": what suffers.
const char* severityName(Finding::Severity severity);

}  // namespace gfxrepro::cli
