// Headless OpenGL 4.5 core through EGL: NVIDIA's device platform or Mesa's surfaceless one.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace gfxrepro::gl {

namespace egl {
struct Candidate;
}

/// Its clock, which GL_TIMESTAMP asks.
struct DeviceTimer {
    /// GL_QUERY_COUNTER_BITS: stamps are told modulo 2^bits ns. 0: the device has no clock for
    /// them, or one that does not go as the processor's.
    int bits = 64;
    double stepNs = 0.0;   // the smallest between stamps in a row
    bool repeats = false;  // stamps in a row are equal, too: so may those of a short pass be
};

/// What a device says of itself; goes into the manifest.
struct DeviceInfo {
    int index = 0;            // as `doctor` lists it and --device takes it
    std::string platform;     // "device" | "surfaceless"
    std::string vendor;       // GL_VENDOR
    std::string renderer;     // GL_RENDERER
    std::string uuid;         // "6d657361-…", of GL_EXT_memory_object; empty: not told
    std::string version;      // GL_VERSION
    std::string mesaVersion;  // "22.3.6"; empty elsewhere
    bool isSoftware = false;  // the processor's cores draw: llvmpipe and its like
    /// GL_ARB_pipeline_statistics_query: whether repeats did the same is told by counts, else by
    /// their pictures alone.
    bool countsWork = false;
    DeviceTimer timer;
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
    /// Of one stage; OpenGL 4.5 promises 8 to fragment and compute shaders, none to the others.
    struct StorageBlocks {
        int vertex = 0, tessellationControl = 0, tessellationEvaluation = 0, fragment = 0,
            compute = 0;
    } maxStorageBlocks;
};

enum class DebugOutput {
    Off,    // timing runs
    Log,    // errors and warnings to standard error
    Fatal,  // the first message of high severity is kept, and thrown as Error by the next
            // checkDebug() or finish() (tests). Not from the call that raised it: an exception must
            // not pass through the driver's frames.
};

/// "auto": the first GPU, where the machine shows none the software device; "gpu"; "software"; an
/// index from listDevices(); a UUID as `nvidia-smi -L` prints it, with "GPU-" or without; or
/// "none", for what needs no device.
struct DeviceChoice {
    std::string name = "auto";
    DebugOutput debug = DebugOutput::Log;
    int processes = 1;  // that draw at once, this one among them: they share the cores (llvmpipe)
};

/// Throws UsageError unless `name`, of a command line, is auto, gpu, software, none, an index or a
/// UUID.
void requireDeviceName(const std::string& name);

/// An EGL display with a current OpenGL 4.5 core context, without a surface. One a process is the
/// rule.
class Device {
  public:
    /// The context is current afterwards. Throws NoDeviceError with one message per way that was
    /// tried, and for "auto" also where a GPU is there that does not serve: the software device is
    /// no answer then. UsageError for a name that is none of these kinds.
    static Device open(const DeviceChoice& choice);
    Device(Device&&) noexcept;
    Device& operator=(Device&&) noexcept;
    ~Device();

    /// Nothing may be drawn on "none": it has no context, and no driver is loaded.
    bool isNone() const;
    const DeviceInfo& info() const;
    const DeviceLimits& limits() const;
    bool hasExtension(const std::string& name) const;

    /// Waits for everything (glFinish); throws DeviceLostError after a reset, std::bad_alloc after
    /// GL_OUT_OF_MEMORY and Error for any other pending GL error, naming `what` was being done.
    void finish(const char* what);
    /// With DebugOutput::Fatal, throws Error for a message of high severity since the last check.
    void checkDebug(const char* what);

  private:
    struct Impl;
    explicit Device(std::unique_ptr<Impl> impl);
    static Device openCandidate(const egl::Candidate& candidate, DebugOutput debug);
    std::unique_ptr<Impl> impl_;
};

/// Whether the context that is current is of a software device, as DeviceInfo::isSoftware says.
bool isSoftwareContext();

/// What is there, without keeping a context (one that was current stays so); entries that cannot
/// make a context carry the reason.
struct DeviceReport {
    DeviceInfo info;
    DeviceLimits limits;
    std::string problem;  // empty: serves
    bool isGpu = false;   // as far as EGL tells, whether it serves or not
};
std::vector<DeviceReport> listDevices();

}  // namespace gfxrepro::gl
