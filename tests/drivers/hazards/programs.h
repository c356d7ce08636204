// What the programs that are linked use, as GL and their sources tell.
#pragma once

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <string>
#include <vector>

namespace gfxrepro::hazards {

/// A block, a sampler or an image.
struct Variable {
    std::string name;
    bool isWritten = false;    // may be: its declaration does not say `readonly`
    GLuint index = 0;          // of a block
    GLint location = 0;        // of a sampler or an image
    GLenum binding = GL_NONE;  // of a sampler: GL_TEXTURE_BINDING_2D, …
};

/// What is active in a linked program.
struct Program {
    std::string name;  // its label
    std::vector<Variable> storageBlocks, uniformBlocks, samplers, images;
};

/// Samplers are those of 2D, 3D, cube and 2D array textures.
Program describe(GLuint program);

GLint resourceNumber(GLuint program, GLenum interface, GLuint index, GLenum property);

}  // namespace gfxrepro::hazards
