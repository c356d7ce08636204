// Looks at draws, dispatches and commands on buffers and textures for what OpenGL 4.5 leaves
// undefined, though a driver may do it as it was meant:
//   order     what a shader wrote is used, or what one read is written by another, without a
//             barrier of glMemoryBarrier between (7.12.2). glFinish is none. A program that writes
//             again what it wrote last is taken for one pass in parts, whose places are apart.
//   feedback  what is drawn into is read, but right behind glTextureBarrier (9.3.1)
//   wait      within a frame (a debug group of that name) something is read back, for which the CPU
//             waits. glFinish is left out: a software device takes its stamps with it.
//   unbound   a block, a sampler or an image that a program uses has nothing bound to it
// Whatever is found is kept, and is a line "hazard: PROGRAM: …" of the file that HAZARDS names; a
// line "checked: PROGRAM" is of each that draws or is dispatched.
#pragma once

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <string>
#include <vector>

namespace gfxrepro::hazards {

/// What was found since the last call.
std::vector<std::string> take();

// Before the calls of GL that they are called by.

/// `arguments` is GL_DISPATCH_INDIRECT_BUFFER_BINDING or none.
void dispatch(GLenum arguments = GL_NONE);
/// `arguments` is GL_DRAW_INDIRECT_BUFFER_BINDING or none.
void draw(bool isIndexed, GLenum arguments = GL_NONE);
/// Of glNamedBufferSubData and its like.
void useBuffer(const char* command, GLuint buffer, GLbitfield bit = GL_BUFFER_UPDATE_BARRIER_BIT);
void useTexture(const char* command, GLuint texture,
                GLbitfield bit = GL_TEXTURE_UPDATE_BARRIER_BIT);
/// Whole: what follows sees the clear, which is behind all that was.
void clearBuffer(GLuint buffer);
void clearTexture(GLuint texture);
/// glClearNamedFramebuffer.
void clearPicture(GLuint framebuffer, GLenum buffer, GLint index);
void memoryBarrier(GLbitfield bits);
void beginGroup(const char* name);
void endGroup();
void readBack(const char* command);
void textureBarrier();
void bindFramebuffer(GLuint framebuffer);
void viewTexture(GLuint view, GLuint texture, GLuint firstLevel);
void forgetBuffer(GLuint buffer);
void forgetTexture(GLuint texture);
void forgetProgram(GLuint program);

}  // namespace gfxrepro::hazards
