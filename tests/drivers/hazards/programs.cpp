#include "tests/drivers/hazards/programs.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <utility>

namespace gfxrepro::hazards {

namespace {

/// The words of declarations of blocks and uniforms in the program's stages: of those with
/// `readonly`, and of the others.
std::array<std::set<std::string>, 2> declarationsOf(GLuint program) {
    std::array<std::set<std::string>, 2> words;
    std::array<GLuint, 8> shaders{};
    GLsizei count = 0;
    glGetAttachedShaders(program, 8, &count, shaders.data());
    for (GLsizei i = 0; i < count; ++i) {
        GLint sizeBytes = 0;
        glGetShaderiv(shaders[static_cast<std::size_t>(i)], GL_SHADER_SOURCE_LENGTH, &sizeBytes);
        std::string text(static_cast<std::size_t>(sizeBytes), '\0');
        glGetShaderSource(shaders[static_cast<std::size_t>(i)], sizeBytes, nullptr, text.data());
        for (std::size_t at = 0; (at = text.find("//", at)) != std::string::npos;) {
            text.erase(at, std::min(text.find('\n', at), text.size()) - at);
        }
        std::set<std::string> piece;
        std::string word;
        for (const char c : text + ';') {
            if (std::isalnum(static_cast<unsigned char>(c)) || c == '_') {
                word += c;
                continue;
            }
            if (!word.empty()) piece.insert(std::exchange(word, ""));
            if (c != ';' && c != '{' && c != '}') continue;
            if (piece.contains("buffer") || piece.contains("uniform")) {
                words[piece.contains("readonly") ? 0 : 1].insert(piece.begin(), piece.end());
            }
            piece.clear();
        }
    }
    return words;
}

std::string resourceName(GLuint program, GLenum interface, GLuint index) {
    std::array<char, 256> name{};
    glGetProgramResourceName(program, interface, index, 256, nullptr, name.data());
    return name.data();
}

GLenum bindingOf(GLint samplerType) {
    switch (samplerType) {
        case GL_SAMPLER_2D:
        case GL_SAMPLER_2D_SHADOW:
        case GL_INT_SAMPLER_2D:
        case GL_UNSIGNED_INT_SAMPLER_2D:
            return GL_TEXTURE_BINDING_2D;
        case GL_SAMPLER_2D_ARRAY:
        case GL_SAMPLER_2D_ARRAY_SHADOW:
        case GL_INT_SAMPLER_2D_ARRAY:
        case GL_UNSIGNED_INT_SAMPLER_2D_ARRAY:
            return GL_TEXTURE_BINDING_2D_ARRAY;
        case GL_SAMPLER_3D:
        case GL_INT_SAMPLER_3D:
        case GL_UNSIGNED_INT_SAMPLER_3D:
            return GL_TEXTURE_BINDING_3D;
        case GL_SAMPLER_CUBE:
        case GL_SAMPLER_CUBE_SHADOW:
            return GL_TEXTURE_BINDING_CUBE_MAP;
        default:
            return GL_NONE;
    }
}

}  // namespace

GLint resourceNumber(GLuint program, GLenum interface, GLuint index, GLenum property) {
    GLint value = 0;
    glGetProgramResourceiv(program, interface, index, 1, &property, 1, nullptr, &value);
    return value;
}

Program describe(GLuint id) {
    Program program;
    std::array<char, 256> label{};
    glGetObjectLabel(GL_PROGRAM, id, 256, nullptr, label.data());
    program.name = label[0] ? label.data() : "program " + std::to_string(id);
    const auto [readOnly, others] = declarationsOf(id);
    const auto isWritten = [&readOnly = readOnly, &others = others](const std::string& name) {
        const std::string plain = name.substr(0, name.find('['));
        return others.contains(plain) || !readOnly.contains(plain);
    };
    const auto countOf = [&](GLenum interface) {
        GLint count = 0;
        glGetProgramInterfaceiv(id, interface, GL_ACTIVE_RESOURCES, &count);
        return static_cast<GLuint>(count);
    };
    for (GLuint i = 0; i < countOf(GL_SHADER_STORAGE_BLOCK); ++i) {
        const std::string name = resourceName(id, GL_SHADER_STORAGE_BLOCK, i);
        program.storageBlocks.push_back({name, isWritten(name), i});
    }
    for (GLuint i = 0; i < countOf(GL_UNIFORM_BLOCK); ++i) {
        program.uniformBlocks.push_back({resourceName(id, GL_UNIFORM_BLOCK, i), false, i});
    }
    for (GLuint i = 0; i < countOf(GL_UNIFORM); ++i) {
        const std::string name = resourceName(id, GL_UNIFORM, i);
        const GLint type = resourceNumber(id, GL_UNIFORM, i, GL_TYPE);
        const bool isImage =
            type >= GL_IMAGE_1D && type <= GL_UNSIGNED_INT_IMAGE_2D_MULTISAMPLE_ARRAY;
        const GLenum binding = bindingOf(type);
        if (!isImage && binding == GL_NONE) continue;
        const GLint location = resourceNumber(id, GL_UNIFORM, i, GL_LOCATION);
        for (GLint k = 0; k < resourceNumber(id, GL_UNIFORM, i, GL_ARRAY_SIZE); ++k) {
            const Variable variable{name, isImage && isWritten(name), 0, location + k, binding};
            (isImage ? program.images : program.samplers).push_back(variable);
        }
    }
    return program;
}

}  // namespace gfxrepro::hazards
