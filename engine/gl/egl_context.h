// EGL: the displays that there are, and a surfaceless OpenGL 4.5 core context on one of them.
// Private to this folder.
#pragma once

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <string>
#include <utility>
#include <vector>

namespace gfxrepro::gl::egl {

/// A way to a display, not yet opened.
struct Candidate {
    int index = 0;         // devices in the driver's order, then the surfaceless platform
    std::string platform;  // "device" | "surfaceless"
    EGLDeviceEXT device = EGL_NO_DEVICE_EXT;
    bool isGpu = false;  // a device that the driver does not call software

    std::string name() const { return "device " + std::to_string(index) + " (" + platform + ")"; }
};

/// What was found, and why there is not more.
struct Candidates {
    std::vector<Candidate> all;
    std::vector<std::string> problems;
};
Candidates findCandidates();

/// A context without a surface. The display stays initialized as long as the process: EGL gives
/// everyone who asks for the same device the same display, and terminating it would take the
/// context away from another owner.
class Context {
  public:
    /// Throws NoDeviceError with the step that failed and EGL's reason. Not yet current.
    Context(const Candidate& candidate, bool hasDebug);
    Context(Context&& other) noexcept
        : display_(other.display_), context_(std::exchange(other.context_, EGL_NO_CONTEXT)) {}
    Context& operator=(Context&&) = delete;
    ~Context();

    void makeCurrent() const;

  private:
    EGLDisplay display_ = EGL_NO_DISPLAY;
    EGLContext context_ = EGL_NO_CONTEXT;
};

/// Makes the context that was current at construction current again at destruction.
class CurrentContextGuard {
  public:
    CurrentContextGuard() : display_(eglGetCurrentDisplay()), context_(eglGetCurrentContext()) {}
    ~CurrentContextGuard();
    CurrentContextGuard(const CurrentContextGuard&) = delete;
    CurrentContextGuard& operator=(const CurrentContextGuard&) = delete;

  private:
    EGLDisplay display_;
    EGLContext context_;
};

}  // namespace gfxrepro::gl::egl
