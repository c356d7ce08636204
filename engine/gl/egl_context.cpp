#include "engine/gl/egl_context.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/error.h"
#include "engine/core/text.h"

namespace gfxrepro::gl::egl {
namespace {

std::string lastError() {
    const EGLint error = eglGetError();
    switch (error) {
        case EGL_SUCCESS:
            return "EGL_SUCCESS";
        case EGL_NOT_INITIALIZED:
            return "EGL_NOT_INITIALIZED";
        case EGL_BAD_ACCESS:
            return "EGL_BAD_ACCESS";
        case EGL_BAD_ALLOC:
            return "EGL_BAD_ALLOC";
        case EGL_BAD_ATTRIBUTE:
            return "EGL_BAD_ATTRIBUTE";
        case EGL_BAD_CONFIG:
            return "EGL_BAD_CONFIG";
        case EGL_BAD_CONTEXT:
            return "EGL_BAD_CONTEXT";
        case EGL_BAD_DISPLAY:
            return "EGL_BAD_DISPLAY";
        case EGL_BAD_MATCH:
            return "EGL_BAD_MATCH";
        case EGL_BAD_PARAMETER:
            return "EGL_BAD_PARAMETER";
        case EGL_BAD_DEVICE_EXT:
            return "EGL_BAD_DEVICE_EXT";
        default:
            return fmt::format("{:#x}", error);
    }
}

bool hasExtension(const char* extensions, std::string_view name) {
    if (extensions == nullptr) return false;
    const std::vector<std::string> all = split(extensions, ' ');
    return std::ranges::find(all, name) != all.end();
}

template <class Function>
Function procedure(const char* name) {
    return reinterpret_cast<Function>(eglGetProcAddress(name));
}

[[noreturn]] void fail(const Candidate& candidate, const std::string& reason) {
    throw NoDeviceError(candidate.name() + ": " + reason);
}

const char* deviceString(EGLDeviceEXT device, EGLint name) {
    const auto query = procedure<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
    return query ? query(device, name) : nullptr;
}

EGLDisplay openDisplay(const Candidate& candidate) {
    const bool isDevice = candidate.platform == "device";
    const EGLenum platform = isDevice ? EGL_PLATFORM_DEVICE_EXT : EGL_PLATFORM_SURFACELESS_MESA;
    void* native = isDevice ? candidate.device : nullptr;
    const auto getPlatformDisplay =
        procedure<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
    EGLDisplay display = getPlatformDisplay(platform, native, nullptr);
    if (display == EGL_NO_DISPLAY) {
        fail(candidate, "eglGetPlatformDisplayEXT gave no display: " + lastError());
    }
    EGLint major = 0;
    EGLint minor = 0;
    if (!eglInitialize(display, &major, &minor)) {
        fail(candidate, "eglInitialize failed: " + lastError());
    }
    if (major == 1 && minor < 5) {
        fail(candidate, fmt::format("EGL 1.5 is needed, the display has {}.{}", major, minor));
    }
    const char* extensions = eglQueryString(display, EGL_EXTENSIONS);
    for (const char* needed : {"EGL_KHR_surfaceless_context", "EGL_KHR_no_config_context"}) {
        if (!hasExtension(extensions, needed)) {
            fail(candidate, fmt::format("the display has no {}", needed));
        }
    }
    return display;
}

/// Without robust buffer access: its bounds checks would be part of every time measured.
EGLContext createContext(EGLDisplay display, bool hasDebug, bool hasResetNotification) {
    std::vector<EGLint> attributes{
        EGL_CONTEXT_MAJOR_VERSION,       4,
        EGL_CONTEXT_MINOR_VERSION,       5,
        EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
        EGL_CONTEXT_OPENGL_DEBUG,        hasDebug ? EGL_TRUE : EGL_FALSE};
    if (hasResetNotification) {
        attributes.insert(attributes.end(), {EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY,
                                             EGL_LOSE_CONTEXT_ON_RESET});
    }
    attributes.push_back(EGL_NONE);
    return eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
}

}  // namespace

Candidates findCandidates() {
    Candidates found;
    const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    // GLVND's libEGL without any vendor library answers as well, with next to nothing.
    if (!hasExtension(extensions, "EGL_EXT_platform_base")) {
        found.problems.emplace_back(
            "EGL: libEGL found no driver (the client extension EGL_EXT_platform_base is missing); "
            "install a GPU driver's EGL, or Mesa's (libegl-mesa0), which needs no GPU");
        return found;
    }
    // EGL_EXT_device_base is the older name of enumeration and query together: NVIDIA's.
    if ((!hasExtension(extensions, "EGL_EXT_device_enumeration") &&
         !hasExtension(extensions, "EGL_EXT_device_base")) ||
        !hasExtension(extensions, "EGL_EXT_platform_device")) {
        found.problems.push_back(fmt::format(
            "EGL devices: EGL_EXT_device_enumeration or EGL_EXT_platform_device is missing; there "
            "are {}",
            extensions));
    } else {
        const auto queryDevices = procedure<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
        EGLint count = 0;
        std::vector<EGLDeviceEXT> devices;
        if (queryDevices(0, nullptr, &count)) {
            devices.resize(static_cast<std::size_t>(count));
            if (!queryDevices(count, devices.data(), &count)) devices.clear();
        }
        if (devices.empty()) {
            found.problems.push_back("EGL devices: eglQueryDevicesEXT found none: " + lastError());
        }
        for (EGLDeviceEXT device : devices) {
            const bool isSoftware =
                hasExtension(deviceString(device, EGL_EXTENSIONS), "EGL_MESA_device_software");
            found.all.push_back(
                {static_cast<int>(found.all.size()), "device", device, !isSoftware});
        }
    }
    if (hasExtension(extensions, "EGL_MESA_platform_surfaceless")) {
        found.all.push_back({static_cast<int>(found.all.size()), "surfaceless", EGL_NO_DEVICE_EXT});
    } else {
        found.problems.emplace_back("EGL surfaceless: EGL_MESA_platform_surfaceless is missing");
    }
    return found;
}

Context::Context(const Candidate& candidate, bool hasDebug) : display_(openDisplay(candidate)) {
    if (!eglBindAPI(EGL_OPENGL_API)) fail(candidate, "EGL has no OpenGL: " + lastError());
    context_ = createContext(display_, hasDebug, true);
    // Not every driver tells of resets; such a one is used without.
    if (context_ == EGL_NO_CONTEXT) context_ = createContext(display_, hasDebug, false);
    if (context_ == EGL_NO_CONTEXT) {
        fail(candidate, "no OpenGL 4.5 core context (eglCreateContext: " + lastError() + ")");
    }
}

Context::~Context() {
    if (context_ == EGL_NO_CONTEXT) return;
    if (eglGetCurrentContext() == context_) {
        eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }
    eglDestroyContext(display_, context_);
}

void Context::makeCurrent() const {
    if (!eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_)) {
        throw NoDeviceError("eglMakeCurrent without a surface failed: " + lastError());
    }
}

CurrentContextGuard::~CurrentContextGuard() {
    if (context_ == EGL_NO_CONTEXT) return;
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_);
}

}  // namespace gfxrepro::gl::egl
