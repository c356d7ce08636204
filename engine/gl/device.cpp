#include "engine/gl/device.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <optional>
#include <set>
#include <utility>

#include "engine/core/error.h"
#include "engine/core/processors.h"
#include "engine/core/text.h"
#include "engine/gl/egl_context.h"
#include "engine/gl/gl.h"
#include "engine/gl/nvml.h"
#include "engine/gl/profiler.h"
#include "engine/gl/unused_gpus.h"

namespace gfxrepro::gl {
namespace {

/// The GPU that an entry means; empty for none.
std::string gpuOf(std::string entry, const std::vector<std::string>& gpus) {
    if (const auto index = parseInteger(entry)) {
        const bool isThere = *index >= 0 && *index < static_cast<long long>(gpus.size());
        return isThere ? gpus[static_cast<std::size_t>(*index)] : "";
    }
    entry = lowerCase(entry);
    if (!entry.starts_with("gpu-") || entry.size() == 4) return "";
    const auto found = std::ranges::find_if(
        gpus, [&](const std::string& uuid) { return uuid.starts_with(entry.substr(4)); });
    return found == gpus.end() ? "" : *found;
}

/// Why a device of that UUID is not to be used: it is not among the GPUs that a cluster gave to
/// this task by CUDA_VISIBLE_DEVICES, as EGL lists all. That has, as CUDA reads it, numbers in the
/// order of nvidiaGpus() or beginnings of UUIDs, up to the first that is neither. Empty where it
/// may be used; nothing is said of devices that are no GPUs of NVIDIA's.
std::string whyNotGranted(const std::string& uuid) {
    const char* visible = std::getenv("CUDA_VISIBLE_DEVICES");
    if (!visible) return "";
    const std::vector<std::string> gpus = nvidiaGpus();
    if (std::ranges::find(gpus, uuid) == gpus.end()) return "";
    for (const std::string& entry : split(visible, ',')) {
        const std::string gpu = gpuOf(std::string(trimmed(entry)), gpus);
        if (gpu == uuid) return "";
        if (gpu.empty()) break;
    }
    return fmt::format("is not among those that CUDA_VISIBLE_DEVICES gives: '{}'", visible);
}

}  // namespace

struct Device::Impl {
    std::optional<egl::Context> context;  // none: of "none"
    DeviceInfo info;
    DeviceLimits limits;
    std::set<std::string, std::less<>> extensions;
    std::string fatalMessage;  // the first of high severity since the last check
};

namespace {

std::string getString(GLenum name) {
    const GLubyte* text = glGetString(name);
    return text == nullptr ? "" : reinterpret_cast<const char*>(text);
}

/// "4.5 (Core Profile) Mesa 22.3.6" → "22.3.6".
std::string mesaVersionIn(const std::string& version) {
    constexpr std::string_view kMark = "Mesa ";
    const std::size_t at = version.find(kMark);
    if (at == std::string::npos) return "";
    const std::size_t begin = at + kMark.size();
    return version.substr(begin, version.find(' ', begin) - begin);
}

/// From stamps that the device takes in a row. Steps between answers of
/// glGetInteger64v(GL_TIMESTAMP) would be how long the question takes: a microsecond and more on a
/// GPU. A clock that surely goes slower or faster than the processor's is none, either.
DeviceTimer measureTimer() {
    DeviceTimer timer;
    glGetQueryiv(GL_TIMESTAMP, GL_QUERY_COUNTER_BITS, &timer.bits);
    if (timer.bits <= 0) return {0};
    using Clock = std::chrono::steady_clock;
    constexpr std::chrono::milliseconds kCoarsest(50);  // a clock that steps more rarely is none
    constexpr std::chrono::milliseconds kWatched(5);
    std::array<GLuint, 256> stamps = {};
    glCreateQueries(GL_TIMESTAMP, static_cast<GLsizei>(stamps.size()), stamps.data());
    const Clock::time_point begin = Clock::now();
    std::optional<GLuint64> first;  // of the first row its last stamp, which came before this:
    GLuint64 newest = 0;            // and that of the newest row, which came after this
    Clock::time_point firstRead, newestAsked, newestRead;
    const auto isDecided = [&] {  // how fast it goes is known to a fifth
        return timer.stepNs > 0.0 && newestRead - begin < 1.2 * (newestAsked - firstRead);
    };
    do {
        newestAsked = Clock::now();
        for (const GLuint stamp : stamps) glQueryCounter(stamp, GL_TIMESTAMP);
        std::optional<GLuint64> last;
        for (const GLuint stamp : stamps) {
            GLuint64 now = 0;
            glGetQueryObjectui64v(stamp, GL_QUERY_RESULT, &now);
            const auto step = static_cast<double>(nsBetween(last.value_or(now), now, timer.bits));
            const bool isForwards = step > 0.0 && step < std::ldexp(0.5, timer.bits);
            if (isForwards && (timer.stepNs == 0.0 || step < timer.stepNs)) timer.stepNs = step;
            timer.repeats |= last == now;
            last = now;
        }
        newest = last.value_or(0);
        if (!first) {
            first = newest;
            firstRead = Clock::now();
        }
        newestRead = Clock::now();
    } while (newestAsked - firstRead < kWatched ||
             (!isDecided() && newestRead - begin < kCoarsest));
    glDeleteQueries(static_cast<GLsizei>(stamps.size()), stamps.data());
    const std::chrono::duration<double, std::nano> least = newestAsked - firstRead;
    const std::chrono::duration<double, std::nano> most = newestRead - begin;
    const bool mayWrap = most.count() > std::ldexp(0.5, timer.bits);
    const auto told = static_cast<double>(nsBetween(*first, newest, timer.bits));
    const double rounding = 2.0 * timer.stepNs;
    const bool goesAlike =
        told > 0.99 * least.count() - rounding && told < 1.01 * most.count() + rounding;
    return timer.stepNs > 0.0 && (goesAlike || mayWrap) ? timer : DeviceTimer{0};
}

std::set<std::string, std::less<>> readExtensions() {
    std::set<std::string, std::less<>> extensions;
    const auto count = static_cast<GLuint>(getInteger(GL_NUM_EXTENSIONS));
    for (GLuint i = 0; i < count; ++i) {
        extensions.insert(reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, i)));
    }
    return extensions;
}

/// "4b1c0f3e-…" of 16 bytes; empty where the driver does not tell.
std::string readUuid() {
    constexpr GLenum kDeviceUuid = 0x9597;  // GL_EXT_memory_object, not among the core's names
    using GetBytes = void(APIENTRY*)(GLenum, GLuint, GLubyte*);
    const auto getBytes = reinterpret_cast<GetBytes>(eglGetProcAddress("glGetUnsignedBytei_vEXT"));
    if (!getBytes || !readExtensions().contains("GL_EXT_memory_object")) return "";
    std::array<GLubyte, 16> bytes = {};
    getBytes(kDeviceUuid, 0, bytes.data());
    if (glGetError() != GL_NO_ERROR) return "";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        if (i == 4 || i == 6 || i == 8 || i == 10) text += '-';
        text += fmt::format("{:02x}", bytes[i]);
    }
    return text;
}

DeviceInfo readInfo(const egl::Candidate& candidate) {
    DeviceInfo info;
    info.index = candidate.index;
    info.platform = candidate.platform;
    info.vendor = getString(GL_VENDOR);
    info.renderer = getString(GL_RENDERER);
    info.version = getString(GL_VERSION);
    info.uuid = readUuid();
    info.mesaVersion = mesaVersionIn(info.version);
    info.isSoftware = isSoftwareContext();
    info.countsWork = readExtensions().contains("GL_ARB_pipeline_statistics_query");
    info.timer = measureTimer();
    return info;
}

DeviceLimits readLimits() {
    DeviceLimits limits;
    limits.maxTextureSizePx = getInteger(GL_MAX_TEXTURE_SIZE);
    limits.max3dTextureSizePx = getInteger(GL_MAX_3D_TEXTURE_SIZE);
    limits.maxArrayLayers = getInteger(GL_MAX_ARRAY_TEXTURE_LAYERS);
    limits.maxStorageBlockBytes = getInteger64(GL_MAX_SHADER_STORAGE_BLOCK_SIZE);
    limits.maxTessellationLevel = getInteger(GL_MAX_TESS_GEN_LEVEL);
    limits.maxComputeInvocations = getInteger(GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS);
    limits.maxImageUnits = getInteger(GL_MAX_IMAGE_UNITS);
    limits.maxStorageBlocks = {
        .vertex = getInteger(GL_MAX_VERTEX_SHADER_STORAGE_BLOCKS),
        .tessellationControl = getInteger(GL_MAX_TESS_CONTROL_SHADER_STORAGE_BLOCKS),
        .tessellationEvaluation = getInteger(GL_MAX_TESS_EVALUATION_SHADER_STORAGE_BLOCKS),
        .fragment = getInteger(GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS),
        .compute = getInteger(GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS)};
    return limits;
}

void APIENTRY logMessage(GLenum, GLenum type, GLuint, GLenum severity, GLsizei,
                         const GLchar* message, const void*) {
    const bool isWarning =
        severity == GL_DEBUG_SEVERITY_MEDIUM && type != GL_DEBUG_TYPE_PERFORMANCE;
    if (severity == GL_DEBUG_SEVERITY_HIGH || type == GL_DEBUG_TYPE_ERROR || isWarning) {
        std::fprintf(stderr, "OpenGL: %s\n", message);
    }
}

/// Only remembers: an exception must not pass through the driver's frames.
void APIENTRY rememberMessage(GLenum, GLenum, GLuint, GLenum severity, GLsizei,
                              const GLchar* message, const void* fatalMessage) {
    auto& first = *static_cast<std::string*>(const_cast<void*>(fatalMessage));
    if (severity == GL_DEBUG_SEVERITY_HIGH && first.empty()) first = message;
}

void setDebugOutput(DebugOutput debug, std::string& fatalMessage) {
    if (debug == DebugOutput::Off) return;
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    // A compiler's message comes with Program's Error, there with the file and line.
    glDebugMessageControl(GL_DEBUG_SOURCE_SHADER_COMPILER, GL_DONT_CARE, GL_DONT_CARE, 0, nullptr,
                          GL_FALSE);
    glDebugMessageCallback(debug == DebugOutput::Fatal ? rememberMessage : logMessage,
                           &fatalMessage);
}

/// Empty while the device is well. Drivers without reset notification report none.
std::string resetReason() {
    switch (glGetGraphicsResetStatus()) {
        case GL_NO_ERROR:
            return "";
        case GL_GUILTY_CONTEXT_RESET:
            return "by this context's work";
        case GL_INNOCENT_CONTEXT_RESET:
            return "by another context's work";
        default:
            return "for an unknown reason";
    }
}

/// What DeviceChoice::name asks for.
struct Wanted {
    enum class Kind { Auto, Gpu, Software, Index, Uuid };
    Kind kind = Kind::Auto;
    long long index = 0;
    std::string uuid{};  // as DeviceInfo has it

    static Wanted parse(const std::string& name);
    /// Empty: `device` serves. Whose index it is was looked at before.
    std::string whyNot(const DeviceInfo& device) const;
};

/// As DeviceInfo has it; nothing for what is no UUID.
std::optional<std::string> parseUuid(std::string text) {
    text = lowerCase(text);
    if (text.starts_with("gpu-")) text.erase(0, 4);
    constexpr std::string_view kForm = "xxxxxxxx-xxxx-xxxx-xxxx-xxxxxxxxxxxx";
    const bool isUuid = std::ranges::equal(text, kForm, [](unsigned char c, char form) {
        return form == '-' ? c == '-' : std::isxdigit(c) != 0;
    });
    return isUuid ? std::optional(text) : std::nullopt;
}

Wanted Wanted::parse(const std::string& name) {
    if (name == "auto") return {Kind::Auto};
    if (name == "gpu") return {Kind::Gpu};
    if (name == "software") return {Kind::Software};
    if (const auto index = parseInteger(name)) return {Kind::Index, *index};
    if (const auto uuid = parseUuid(name)) return {Kind::Uuid, 0, *uuid};
    throw UsageError(fmt::format(
        "unknown device '{}'; allowed: auto, gpu, software, or an index or a UUID as 'gfxrepro "
        "doctor' lists them",
        name));
}

std::string Wanted::whyNot(const DeviceInfo& device) const {
    switch (kind) {
        case Kind::Auto:
        case Kind::Gpu:
            return device.isSoftware ? device.renderer + " is no GPU" : "";
        case Kind::Software:
            return device.isSoftware ? "" : device.renderer + " is no software renderer";
        case Kind::Uuid:
            if (device.uuid == uuid) return "";
            return device.renderer +
                   (device.uuid.empty() ? " tells no UUID" : " has the UUID " + device.uuid);
        case Kind::Index:
            break;
    }
    return "";
}

void append(std::vector<std::string>& to, const std::vector<std::string>& more) {
    to.insert(to.end(), more.begin(), more.end());
}

}  // namespace

void requireDeviceName(const std::string& name) {
    if (name != "none") Wanted::parse(name);
}

Device::Device(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Device::Device(Device&&) noexcept = default;
Device& Device::operator=(Device&&) noexcept = default;
Device::~Device() = default;

namespace {

/// By default llvmpipe has a thread a core, whoever draws beside it: two processes on two cores
/// take a fifth longer so than each on its own thread. What the environment says wins.
void shareCores(int processes) {
    if (processes <= 1) return;
    const int threads = usableProcessors() / processes;
    ::setenv("LP_NUM_THREADS", std::to_string(threads > 1 ? threads : 0).c_str(), 0);
}

}  // namespace

Device Device::openCandidate(const egl::Candidate& candidate, DebugOutput debug) {
    auto impl = std::make_unique<Impl>(
        Impl{egl::Context(candidate, debug != DebugOutput::Off), {}, {}, {}, {}});
    impl->context->makeCurrent();
    impl->info = readInfo(candidate);
    impl->limits = readLimits();
    impl->extensions = readExtensions();
    setDebugOutput(debug, impl->fatalMessage);
    return Device(std::move(impl));
}

Device Device::open(const DeviceChoice& choice) {
    shareCores(choice.processes);
    if (choice.name == "none") {
        auto impl = std::make_unique<Impl>();
        impl->info.platform = "none";
        impl->info.renderer = "no graphics device";
        impl->info.isSoftware = true;
        return Device(std::move(impl));
    }
    const Wanted wanted = Wanted::parse(choice.name);
    auto [candidates, problems] = egl::findCandidates();
    if (wanted.kind == Wanted::Kind::Index &&
        (wanted.index < 0 || wanted.index >= static_cast<long long>(candidates.size()))) {
        problems.push_back(fmt::format("device {}: there are {} ways to a device, counted from 0",
                                       wanted.index, candidates.size()));
    }

    const bool isAnyGpu = wanted.kind == Wanted::Kind::Auto || wanted.kind == Wanted::Kind::Gpu;
    std::optional<Device> software;  // what auto falls back on where there is no GPU
    bool isGpuThere = false;
    for (const egl::Candidate& candidate : candidates) {
        if (wanted.kind == Wanted::Kind::Index && wanted.index != candidate.index) continue;
        // Where Mesa lists its devices, the surfaceless platform only offers the same again.
        if (software && candidate.platform == "surfaceless") continue;
        try {
            Device device = openCandidate(candidate, choice.debug);
            std::string why = wanted.whyNot(device.info());
            if (why.empty() && isAnyGpu) {
                why = whyNotGranted(device.info().uuid);
                if (!why.empty()) why = device.info().renderer + " " + why;
                isGpuThere |= !why.empty();
            }
            if (why.empty()) return device;
            problems.push_back(fmt::format("{}: {}", candidate.name(), why));
            if (wanted.kind == Wanted::Kind::Auto && device.info().isSoftware && !software) {
                software = std::move(device);
            }
        } catch (const NoDeviceError& error) {
            problems.push_back(error.what());
            isGpuThere |= candidate.isGpu;
        }
    }
    if (isAnyGpu) {
        const std::vector<std::string> unused = unusedGpus();
        isGpuThere |= !unused.empty();
        if (isGpuThere) append(problems, vendorLibraryProblems());
        append(problems, unused);
    }
    if (software && !isGpuThere) {
        software->impl_->context->makeCurrent();
        return std::move(*software);
    }
    std::string text = fmt::format("no usable OpenGL 4.5 device for '{}':\n  {}", choice.name,
                                   joined(problems, "\n  "));
    if (software) {
        text +=
            "\nThis machine has a GPU that does not serve; --device software measures without it";
    }
    throw NoDeviceError(text);
}

bool Device::isNone() const {
    return !impl_->context;
}

const DeviceInfo& Device::info() const {
    return impl_->info;
}

const DeviceLimits& Device::limits() const {
    return impl_->limits;
}

bool Device::hasExtension(const std::string& name) const {
    return impl_->extensions.contains(name);
}

void Device::checkDebug(const char* what) {
    if (impl_->fatalMessage.empty()) return;
    throw Error(fmt::format("{}: {}", what, std::exchange(impl_->fatalMessage, "")));
}

void Device::finish(const char* what) {
    if (isNone()) return;
    glFinish();
    if (const std::string reason = resetReason(); !reason.empty()) {
        throw DeviceLostError(fmt::format("{}: the device was reset {}", what, reason));
    }
    // Both at once: the message says more than the error, and neither may be left for the next one.
    const GLenum error = glGetError();
    checkDebug(what);
    if (error == GL_OUT_OF_MEMORY) throw std::bad_alloc();
    if (error != GL_NO_ERROR) throw Error(fmt::format("{}: {}", what, errorName(error)));
}

bool isSoftwareContext() {
    // Of a virtual machine's device the host's is in brackets: "virgl (LLVMPIPE …)".
    const std::string renderer = getString(GL_RENDERER);
    return std::ranges::any_of(
        std::array{"llvmpipe", "lavapipe", "softpipe", "swrast", "SWR", "Software Rasterizer",
                   "SwiftShader", "Basic Render Driver"},
        [&](const char* name) { return ::strcasestr(renderer.c_str(), name) != nullptr; });
}

std::vector<DeviceReport> listDevices() {
    const egl::CurrentContextGuard guard;
    const auto [candidates, problems] = egl::findCandidates();
    std::vector<DeviceReport> reports;
    for (const egl::Candidate& candidate : candidates) {
        DeviceReport report;
        report.info.index = candidate.index;
        report.info.platform = candidate.platform;
        report.isGpu = candidate.isGpu;
        try {
            const egl::Context context(candidate, false);
            context.makeCurrent();
            report.info = readInfo(candidate);
            report.limits = readLimits();
        } catch (const NoDeviceError& error) {
            report.problem = error.what();
        }
        reports.push_back(std::move(report));
    }
    return reports;
}

}  // namespace gfxrepro::gl
