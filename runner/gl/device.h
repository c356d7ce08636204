// Headless OpenGL 4.5 core through EGL: NVIDIA's device platform or Mesa's surfaceless one.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace gfxrepro::gl {

/// What a device says of itself; goes into the manifest.
struct DeviceInfo {
    int index = 0;                   // as `doctor` lists it and --device takes it
    std::string platform;            // "device" | "surfaceless"
    std::string vendor;              // GL_VENDOR
    std::string renderer;            // GL_RENDERER
    std::string version;             // GL_VERSION
    std::string mesaVersion;         // "22.3.6"; empty elsewhere
    bool isSoftware = false;         // llvmpipe, softpipe, swrast
    double timerResolutionNs = 0.0;  // smallest step seen between two GL_TIMESTAMP readings
};

/// What a device can do, read once.
struct DeviceLimits {
    int maxTextureSizePx = 0;
    int max3dTextureSizePx = 0;
    int maxArrayLayers = 0;
    long long maxStorageBlockBytes = 0;
    int maxTessellationLevel = 0;
    int maxComputeInvocations = 0;
    int maxImageUnits = 0;
};

enum class DebugOutput {
    Off,    // timing runs
    Log,    // errors and warnings to standard error
    Fatal,  // an error of high severity throws Error from the call that raised it (tests)
};

/// "auto": the first hardware device, else the software one; "software"; or an index from
/// listDevices().
struct DeviceChoice {
    std::string name = "auto";
    DebugOutput debug = DebugOutput::Log;
};

/// An EGL display with a current OpenGL 4.5 core context, without a surface. One a process is the
/// rule.
class Device {
  public:
    /// Throws NoDeviceError with one message per way that was tried.
    static Device open(const DeviceChoice& choice);
    Device(Device&&) noexcept;
    Device& operator=(Device&&) noexcept;
    ~Device();

    const DeviceInfo& info() const;
    const DeviceLimits& limits() const;
    bool hasExtension(const std::string& name) const;

    /// Waits for everything; throws DeviceLostError after a reset and Error for a pending GL error,
    /// naming `what` was being done.
    void finish(const char* what);

  private:
    struct Impl;
    explicit Device(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

/// What is there, without keeping a context; entries that cannot make a context carry the reason.
struct DeviceReport {
    DeviceInfo info;
    DeviceLimits limits;
    std::string problem;  // empty: serves
};
std::vector<DeviceReport> listDevices();

}  // namespace gfxrepro::gl
