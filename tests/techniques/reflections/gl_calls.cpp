#include "tests/techniques/reflections/gl_calls.h"

#include <dlfcn.h>

#include "engine/gl/gl.h"

namespace gfxrepro::reflections {

std::vector<GlCall>& glCalls() {
    static std::vector<GlCall> calls;
    return calls;
}

namespace {

/// Notes the call and hands it on to the library that has it.
template <class... Arguments>
void passOn(GlCall call, const char* name, Arguments... arguments) {
    glCalls().push_back(call);
    reinterpret_cast<void (*)(Arguments...)>(dlsym(RTLD_NEXT, name))(arguments...);
}

}  // namespace
}  // namespace gfxrepro::reflections

using gfxrepro::reflections::GlCall;
using gfxrepro::reflections::passOn;

extern "C" {
void glDrawElementsInstancedBaseInstance(GLenum mode, GLsizei count, GLenum type,
                                         const void* indices, GLsizei instanceCount,
                                         GLuint baseInstance) {
    passOn(GlCall::DrawObject, __func__, mode, count, type, indices, instanceCount, baseInstance);
}
void glDrawElements(GLenum mode, GLsizei count, GLenum type, const void* indices) {
    passOn(GlCall::DrawList, __func__, mode, count, type, indices);
}
void glDrawElementsIndirect(GLenum mode, GLenum type, const void* indirect) {
    passOn(GlCall::DrawList, __func__, mode, type, indirect);
}
void glProgramUniformMatrix4fv(GLuint program, GLint location, GLsizei count, GLboolean transpose,
                               const GLfloat* value) {
    passOn(GlCall::SetView, __func__, program, location, count, transpose, value);
}
void glMemoryBarrier(GLbitfield barriers) {
    passOn(GlCall::Barrier, __func__, barriers);
}
void glTextureParameteri(GLuint texture, GLenum name, GLint value) {
    passOn(GlCall::Parameter, __func__, texture, name, value);
}
void glFlush() {
    passOn(GlCall::Flush, __func__);
}
void glFinish() {
    passOn(GlCall::Wait, __func__);
}
void glGetQueryObjectui64v(GLuint id, GLenum name, GLuint64* value) {
    passOn(GlCall::Wait, __func__, id, name, value);
}
void glNamedBufferSubData(GLuint buffer, GLintptr offset, GLsizeiptr size, const void* data) {
    passOn(GlCall::Write, __func__, buffer, offset, size, data);
}
void glGetNamedBufferSubData(GLuint buffer, GLintptr offset, GLsizeiptr size, void* data) {
    passOn(GlCall::Wait, __func__, buffer, offset, size, data);
}
void glGetTextureImage(GLuint texture, GLint level, GLenum format, GLenum type, GLsizei size,
                       void* pixels) {
    passOn(GlCall::Wait, __func__, texture, level, format, type, size, pixels);
}
}
