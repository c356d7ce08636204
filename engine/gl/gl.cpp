#include "engine/gl/gl.h"

#include <fmt/format.h>

#include <new>

#include "engine/core/error.h"

namespace gfxrepro::gl {

std::string errorName(GLenum error) {
    switch (error) {
        case GL_NO_ERROR:
            return "GL_NO_ERROR";
        case GL_INVALID_ENUM:
            return "GL_INVALID_ENUM";
        case GL_INVALID_VALUE:
            return "GL_INVALID_VALUE";
        case GL_INVALID_OPERATION:
            return "GL_INVALID_OPERATION";
        case GL_INVALID_FRAMEBUFFER_OPERATION:
            return "GL_INVALID_FRAMEBUFFER_OPERATION";
        case GL_OUT_OF_MEMORY:
            return "GL_OUT_OF_MEMORY";
        case GL_CONTEXT_LOST:
            return "GL_CONTEXT_LOST";
        default:
            return fmt::format("{:#x}", error);
    }
}

void checkError(const char* call) {
    const GLenum error = glGetError();
    if (error == GL_NO_ERROR) return;
    if (error == GL_OUT_OF_MEMORY) throw std::bad_alloc();
    if (error == GL_CONTEXT_LOST)
        throw DeviceLostError(fmt::format("{}: {}", call, errorName(error)));
    throw Error(fmt::format("{}: {}", call, errorName(error)));
}

int getInteger(GLenum name) {
    GLint value = 0;
    glGetIntegerv(name, &value);
    return value;
}

long long getInteger64(GLenum name) {
    GLint64 value = 0;
    glGetInteger64v(name, &value);
    return value;
}

}  // namespace gfxrepro::gl
