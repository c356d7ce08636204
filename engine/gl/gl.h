// The prototypes of OpenGL 4.5 core (linked against GLVND's libOpenGL) and its errors. The one
// place that includes a GL header.
#pragma once

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <string>

namespace gfxrepro::gl {

/// "GL_INVALID_ENUM"; also of what a framebuffer lacks; "0x1234" for what is no error of OpenGL
/// 4.5.
std::string errorName(GLenum error);

/// glGetError: std::bad_alloc for GL_OUT_OF_MEMORY, Error("CALL: GL_INVALID_ENUM") for the others.
/// `call` is the GL function or the work that raised it.
void checkError(const char* call);

/// glGetIntegerv and glGetInteger64v of a single value.
int getInteger(GLenum name);
long long getInteger64(GLenum name);

}  // namespace gfxrepro::gl
