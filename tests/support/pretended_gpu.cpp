// To be preloaded into the program (LD_PRELOAD): Mesa's software device among EGL's devices says
// that it is a GPU, so that what is done on hardware alone runs without any. With
// PRETENDED_GPU=refuses its display cannot be initialized, as where a driver fails. The
// surfaceless platform stays what it is.
#include <dlfcn.h>

#define GL_GLEXT_PROTOTYPES
#define EGL_EGLEXT_PROTOTYPES
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/glcorearb.h>

#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

namespace {

constexpr const char* kSoftware = "EGL_MESA_device_software";
constexpr const char* kRenderer = "Pretended GPU";
EGLDisplay pretended = EGL_NO_DISPLAY;

template <class Function>
Function next(const char* name) {
    return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

template <class Function>
Function extension(const char* name) {
    const auto get = next<decltype(&eglGetProcAddress)>("eglGetProcAddress");
    return reinterpret_cast<Function>(get(name));
}

bool isSoftware(EGLDeviceEXT device) {
    const auto query = extension<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
    return std::strstr(query(device, EGL_EXTENSIONS), kSoftware) != nullptr;
}

/// As the device has it, without the extension that tells of software.
const char* EGLAPIENTRY queryDeviceString(EGLDeviceEXT device, EGLint name) {
    const auto query = extension<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
    const char* told = query(device, name);
    if (!told) return nullptr;
    static std::string text;
    text = told;
    const std::size_t at = text.find(kSoftware);
    if (at != std::string::npos) text.erase(at, std::strlen(kSoftware));
    return text.c_str();
}

EGLDisplay EGLAPIENTRY getPlatformDisplay(EGLenum platform, void* native, const EGLint* given) {
    const auto get = extension<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
    EGLDisplay display = get(platform, native, given);
    if (platform == EGL_PLATFORM_DEVICE_EXT && isSoftware(native)) pretended = display;
    return display;
}

bool isPretended(EGLDisplay display) {
    return display != EGL_NO_DISPLAY && display == pretended;
}

/// 00112233-4455-6677-8899-aabbccddeeff
void APIENTRY getUuid(GLenum name, GLuint index, GLubyte* bytes) {
    extension<void(APIENTRY*)(GLenum, GLuint, GLubyte*)>("glGetUnsignedBytei_vEXT")(name, index,
                                                                                    bytes);
    if (!isPretended(eglGetCurrentDisplay())) return;
    for (int i = 0; i < 16; ++i) bytes[i] = static_cast<GLubyte>(0x11 * i);
}

}  // namespace

extern "C" {

__attribute__((visibility("default"))) EGLBoolean EGLAPIENTRY eglInitialize(EGLDisplay display,
                                                                            EGLint* major,
                                                                            EGLint* minor) {
    const char* how = std::getenv("PRETENDED_GPU");
    if (isPretended(display) && how && std::string_view(how) == "refuses") return EGL_FALSE;
    return next<decltype(&eglInitialize)>("eglInitialize")(display, major, minor);
}

__attribute__((visibility("default"))) __eglMustCastToProperFunctionPointerType EGLAPIENTRY
eglGetProcAddress(const char* name) {
    using Any = __eglMustCastToProperFunctionPointerType;
    const std::string_view wanted = name;
    if (wanted == "eglQueryDeviceStringEXT") return reinterpret_cast<Any>(queryDeviceString);
    if (wanted == "eglGetPlatformDisplayEXT") return reinterpret_cast<Any>(getPlatformDisplay);
    if (wanted == "glGetUnsignedBytei_vEXT") return reinterpret_cast<Any>(getUuid);
    return extension<Any>(name);
}

__attribute__((visibility("default"))) const GLubyte* APIENTRY glGetString(GLenum name) {
    if (name == GL_RENDERER && isPretended(eglGetCurrentDisplay())) {
        return reinterpret_cast<const GLubyte*>(kRenderer);
    }
    return next<decltype(&glGetString)>("glGetString")(name);
}

}  // extern "C"
