// To be preloaded into the program (LD_PRELOAD): the device's time stamps are those of a driver
// whose clock is BROKEN_CLOCK: "none" (0 bits), "zero", "slow", "fast", "short" (16 bits: a round
// of 66 us), or, once something is drawn, "back", "still", "stuck" (still, of steps in which two
// stamps may be equal before), "late" (slow), "ahead" and "wraps" (32 bits, whose round ends
// between any two stamps that are read as a pair).
#include <dlfcn.h>

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <cstdlib>
#include <string_view>

namespace {

bool hasDrawn = false;

bool is(std::string_view mode) {
    const char* asked = std::getenv("BROKEN_CLOCK");
    return asked && mode == asked;
}

template <class Function>
Function real(const char* name) {
    return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {

__attribute__((visibility("default"))) void APIENTRY glUseProgram(GLuint program) {
    hasDrawn = true;
    real<decltype(&glUseProgram)>("glUseProgram")(program);
}

__attribute__((visibility("default"))) void APIENTRY glGetQueryiv(GLenum target, GLenum name,
                                                                  GLint* value) {
    real<decltype(&glGetQueryiv)>("glGetQueryiv")(target, name, value);
    if (target != GL_TIMESTAMP || name != GL_QUERY_COUNTER_BITS) return;
    if (is("none")) *value = 0;
    if (is("wraps")) *value = 32;
    if (is("short")) *value = 16;
}

__attribute__((visibility("default"))) void APIENTRY glGetQueryObjectui64v(GLuint query,
                                                                           GLenum name,
                                                                           GLuint64* value) {
    real<decltype(&glGetQueryObjectui64v)>("glGetQueryObjectui64v")(query, name, value);
    constexpr GLuint64 kLeastTime = 1'000'000'000;  // less are counts of work
    if (name != GL_QUERY_RESULT || *value < kLeastTime) return;
    static const GLuint64 first = *value;
    if (is("zero") || is("none")) *value = 0;
    if (is("slow")) *value = first + (*value - first) * 3 / 5;
    if (is("fast")) *value = first + (*value - first) * 3 / 2;
    if (is("late") && hasDrawn) *value = first + (*value - first) / 1000;
    constexpr GLuint64 kStepNs = 4096;
    if (is("stuck")) *value = (hasDrawn ? first : *value) / kStepNs * kStepNs;
    if (is("short")) *value &= 0xFFFF;
    if (is("wraps")) {
        static GLuint64 end = 0;
        static bool isSecond = false;
        if (hasDrawn && !isSecond) end = *value + 1000;
        isSecond = hasDrawn && !isSecond;
        *value = (*value - end) & 0xFFFFFFFF;
    }
    if (is("back") && hasDrawn) *value = GLuint64{1'000'000'000'000'000} - *value;
    if (is("still") && hasDrawn) *value = first;
    if (is("ahead") && hasDrawn) *value *= 1000;
}

}  // extern "C"
