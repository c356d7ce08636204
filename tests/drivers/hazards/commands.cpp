// The commands of OpenGL that the project calls, as far as hazards are in them: to be preloaded
// into the program (LD_PRELOAD), or linked into a test.
#include <dlfcn.h>

#include "tests/drivers/hazards/hazards.h"

using namespace gfxrepro;

/// The command of that name behind these.
#define NEXT(name) reinterpret_cast<decltype(&name)>(::dlsym(RTLD_NEXT, #name))

extern "C" {

GLAPI void APIENTRY glDispatchCompute(GLuint num_groups_x, GLuint num_groups_y,
                                      GLuint num_groups_z) {
    hazards::dispatch();
    NEXT(glDispatchCompute)(num_groups_x, num_groups_y, num_groups_z);
}

GLAPI void APIENTRY glDispatchComputeIndirect(GLintptr indirect) {
    hazards::dispatch(GL_DISPATCH_INDIRECT_BUFFER_BINDING);
    NEXT(glDispatchComputeIndirect)(indirect);
}

GLAPI void APIENTRY glDrawArrays(GLenum mode, GLint first, GLsizei count) {
    hazards::draw(false);
    NEXT(glDrawArrays)(mode, first, count);
}

GLAPI void APIENTRY glDrawArraysInstanced(GLenum mode, GLint first, GLsizei count,
                                          GLsizei instancecount) {
    hazards::draw(false);
    NEXT(glDrawArraysInstanced)(mode, first, count, instancecount);
}

GLAPI void APIENTRY glMultiDrawArrays(GLenum mode, const GLint* first, const GLsizei* count,
                                      GLsizei drawcount) {
    hazards::draw(false);
    NEXT(glMultiDrawArrays)(mode, first, count, drawcount);
}

GLAPI void APIENTRY glDrawElements(GLenum mode, GLsizei count, GLenum type, const void* indices) {
    hazards::draw(true);
    NEXT(glDrawElements)(mode, count, type, indices);
}

GLAPI void APIENTRY glDrawElementsInstancedBaseInstance(GLenum mode, GLsizei count, GLenum type,
                                                        const void* indices, GLsizei instancecount,
                                                        GLuint baseinstance) {
    hazards::draw(true);
    NEXT(glDrawElementsInstancedBaseInstance)
    (mode, count, type, indices, instancecount, baseinstance);
}

GLAPI void APIENTRY glMultiDrawArraysIndirect(GLenum mode, const void* indirect, GLsizei drawcount,
                                              GLsizei stride) {
    hazards::draw(false, GL_DRAW_INDIRECT_BUFFER_BINDING);
    NEXT(glMultiDrawArraysIndirect)(mode, indirect, drawcount, stride);
}

GLAPI void APIENTRY glDrawElementsIndirect(GLenum mode, GLenum type, const void* indirect) {
    hazards::draw(true, GL_DRAW_INDIRECT_BUFFER_BINDING);
    NEXT(glDrawElementsIndirect)(mode, type, indirect);
}

GLAPI void APIENTRY glMultiDrawElementsIndirect(GLenum mode, GLenum type, const void* indirect,
                                                GLsizei drawcount, GLsizei stride) {
    hazards::draw(true, GL_DRAW_INDIRECT_BUFFER_BINDING);
    NEXT(glMultiDrawElementsIndirect)(mode, type, indirect, drawcount, stride);
}

GLAPI void APIENTRY glGetQueryObjectui64v(GLuint id, GLenum pname, GLuint64* params) {
    hazards::readBack("glGetQueryObjectui64v");
    NEXT(glGetQueryObjectui64v)(id, pname, params);
}

GLAPI void APIENTRY glPushDebugGroup(GLenum source, GLuint id, GLsizei length,
                                     const GLchar* message) {
    hazards::beginGroup(message);
    NEXT(glPushDebugGroup)(source, id, length, message);
}

GLAPI void APIENTRY glPopDebugGroup() {
    hazards::endGroup();
    NEXT(glPopDebugGroup)();
}

GLAPI void APIENTRY glMemoryBarrier(GLbitfield barriers) {
    hazards::memoryBarrier(barriers);
    NEXT(glMemoryBarrier)(barriers);
}

GLAPI void APIENTRY glTextureBarrier() {
    hazards::textureBarrier();
    NEXT(glTextureBarrier)();
}

GLAPI void APIENTRY glBindFramebuffer(GLenum target, GLuint framebuffer) {
    hazards::bindFramebuffer(framebuffer);
    NEXT(glBindFramebuffer)(target, framebuffer);
}

GLAPI void APIENTRY glTextureView(GLuint texture, GLenum target, GLuint origtexture,
                                  GLenum internalformat, GLuint minlevel, GLuint numlevels,
                                  GLuint minlayer, GLuint numlayers) {
    hazards::viewTexture(texture, origtexture, minlevel);
    NEXT(glTextureView)
    (texture, target, origtexture, internalformat, minlevel, numlevels, minlayer, numlayers);
}

GLAPI void APIENTRY glClearNamedBufferData(GLuint buffer, GLenum internalformat, GLenum format,
                                           GLenum type, const void* data) {
    hazards::clearBuffer(buffer);
    NEXT(glClearNamedBufferData)(buffer, internalformat, format, type, data);
}

GLAPI void APIENTRY glNamedBufferSubData(GLuint buffer, GLintptr offset, GLsizeiptr size,
                                         const void* data) {
    hazards::useBuffer("glNamedBufferSubData", buffer);
    NEXT(glNamedBufferSubData)(buffer, offset, size, data);
}

GLAPI void APIENTRY glGetNamedBufferSubData(GLuint buffer, GLintptr offset, GLsizeiptr size,
                                            void* data) {
    hazards::readBack("glGetNamedBufferSubData");
    hazards::useBuffer("glGetNamedBufferSubData", buffer);
    NEXT(glGetNamedBufferSubData)(buffer, offset, size, data);
}

GLAPI void APIENTRY glCopyNamedBufferSubData(GLuint readBuffer, GLuint writeBuffer,
                                             GLintptr readOffset, GLintptr writeOffset,
                                             GLsizeiptr size) {
    hazards::useBuffer("glCopyNamedBufferSubData", readBuffer);
    hazards::useBuffer("glCopyNamedBufferSubData", writeBuffer);
    NEXT(glCopyNamedBufferSubData)(readBuffer, writeBuffer, readOffset, writeOffset, size);
}

GLAPI void APIENTRY glBeginTransformFeedback(GLenum primitiveMode) {
    GLint buffer = 0;
    glGetIntegeri_v(GL_TRANSFORM_FEEDBACK_BUFFER_BINDING, 0, &buffer);
    hazards::useBuffer("glBeginTransformFeedback", static_cast<GLuint>(buffer),
                       GL_TRANSFORM_FEEDBACK_BARRIER_BIT);
    NEXT(glBeginTransformFeedback)(primitiveMode);
}

GLAPI void APIENTRY glClearTexImage(GLuint texture, GLint level, GLenum format, GLenum type,
                                    const void* data) {
    hazards::clearTexture(texture);
    NEXT(glClearTexImage)(texture, level, format, type, data);
}

GLAPI void APIENTRY glTextureSubImage2D(GLuint texture, GLint level, GLint xoffset, GLint yoffset,
                                        GLsizei width, GLsizei height, GLenum format, GLenum type,
                                        const void* pixels) {
    hazards::useTexture("glTextureSubImage2D", texture);
    NEXT(glTextureSubImage2D)
    (texture, level, xoffset, yoffset, width, height, format, type, pixels);
}

GLAPI void APIENTRY glTextureSubImage3D(GLuint texture, GLint level, GLint xoffset, GLint yoffset,
                                        GLint zoffset, GLsizei width, GLsizei height, GLsizei depth,
                                        GLenum format, GLenum type, const void* pixels) {
    hazards::useTexture("glTextureSubImage3D", texture);
    NEXT(glTextureSubImage3D)
    (texture, level, xoffset, yoffset, zoffset, width, height, depth, format, type, pixels);
}

GLAPI void APIENTRY glGetTextureImage(GLuint texture, GLint level, GLenum format, GLenum type,
                                      GLsizei bufSize, void* pixels) {
    hazards::readBack("glGetTextureImage");
    hazards::useTexture("glGetTextureImage", texture);
    NEXT(glGetTextureImage)(texture, level, format, type, bufSize, pixels);
}

GLAPI void APIENTRY glGenerateTextureMipmap(GLuint texture) {
    hazards::useTexture("glGenerateTextureMipmap", texture, GL_TEXTURE_FETCH_BARRIER_BIT);
    NEXT(glGenerateTextureMipmap)(texture);
}

GLAPI void APIENTRY glClearNamedFramebufferfv(GLuint framebuffer, GLenum buffer, GLint drawbuffer,
                                              const GLfloat* value) {
    hazards::clearPicture(framebuffer, buffer, drawbuffer);
    NEXT(glClearNamedFramebufferfv)(framebuffer, buffer, drawbuffer, value);
}

GLAPI void APIENTRY glClearNamedFramebufferuiv(GLuint framebuffer, GLenum buffer, GLint drawbuffer,
                                               const GLuint* value) {
    hazards::clearPicture(framebuffer, buffer, drawbuffer);
    NEXT(glClearNamedFramebufferuiv)(framebuffer, buffer, drawbuffer, value);
}

GLAPI void APIENTRY glDeleteBuffers(GLsizei n, const GLuint* buffers) {
    for (GLsizei i = 0; i < n; ++i) hazards::forgetBuffer(buffers[i]);
    NEXT(glDeleteBuffers)(n, buffers);
}

GLAPI void APIENTRY glDeleteTextures(GLsizei n, const GLuint* textures) {
    for (GLsizei i = 0; i < n; ++i) hazards::forgetTexture(textures[i]);
    NEXT(glDeleteTextures)(n, textures);
}

GLAPI void APIENTRY glDeleteProgram(GLuint program) {
    hazards::forgetProgram(program);
    NEXT(glDeleteProgram)(program);
}

}  // extern "C"
