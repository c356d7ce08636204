#include "engine/gl/program.h"

#include <fmt/format.h>

#include <array>
#include <glm/gtc/type_ptr.hpp>

#include "engine/core/error.h"
#include "engine/core/text.h"

namespace gfxrepro::gl {

namespace {

void deleteShader(GLuint id) {
    glDeleteShader(id);
}
using Shader = detail::Name<deleteShader>;

GLenum stageOf(const std::string& file) {
    struct Stage {
        std::string_view ending;
        GLenum type;
    };
    constexpr std::array kStages{
        Stage{".vert.glsl", GL_VERTEX_SHADER},          Stage{".tesc.glsl", GL_TESS_CONTROL_SHADER},
        Stage{".tese.glsl", GL_TESS_EVALUATION_SHADER}, Stage{".geom.glsl", GL_GEOMETRY_SHADER},
        Stage{".frag.glsl", GL_FRAGMENT_SHADER},        Stage{".comp.glsl", GL_COMPUTE_SHADER}};
    for (const Stage& stage : kStages) {
        if (file.ends_with(stage.ending)) return stage.type;
    }
    throw Error(
        fmt::format("{}: a stage's file ends in .vert.glsl, .tesc.glsl, .tese.glsl, "
                    ".geom.glsl, .frag.glsl or .comp.glsl",
                    file));
}

/// NVIDIA's has sections ("Vertex info", "Compute info"), whose places are those of one stage's
/// text, and may end with a whole assembly.
std::string translateLinkLog(std::string_view log, const std::vector<std::string>& files,
                             const std::vector<ShaderSource>& sources) {
    std::string translated;
    const ShaderSource* source = nullptr;
    for (const std::string& line : split(trimmed(log), '\n')) {
        if (line.starts_with("-- internal assembly")) break;
        for (std::size_t i = 0; i < files.size() && line.ends_with(" info"); ++i) {
            // The line's "Vertex" is the file's ".vert.glsl"; of tessellation's two the last.
            const std::size_t dot = files[i].find('.');
            if (line.substr(1, 2) == files[i].substr(dot + 2, 2)) source = &sources[i];
        }
        if (!translated.empty()) translated += '\n';
        translated += source ? translateLog(line, *source) : line;
    }
    return translated;
}

Shader compile(const std::string& file, const ShaderSource& source) {
    Shader shader(glCreateShader(stageOf(file)));
    const char* text = source.text.c_str();
    glShaderSource(shader.get(), 1, &text, nullptr);
    glCompileShader(shader.get());
    GLint isCompiled = GL_FALSE;
    glGetShaderiv(shader.get(), GL_COMPILE_STATUS, &isCompiled);
    if (isCompiled == GL_TRUE) return shader;

    GLint logBytes = 0;
    glGetShaderiv(shader.get(), GL_INFO_LOG_LENGTH, &logBytes);
    std::string log(static_cast<std::size_t>(logBytes), '\0');
    GLsizei writtenBytes = 0;
    glGetShaderInfoLog(shader.get(), logBytes, &writtenBytes, log.data());
    log.resize(static_cast<std::size_t>(writtenBytes));
    throw Error(fmt::format("cannot compile {}:\n{}", file, translateLog(log, source)));
}

}  // namespace

Program::Program(const ShaderLibrary& library, const std::vector<std::string>& files,
                 const Defines& defines, const std::map<std::string, std::string>& snippets)
    : name_(glCreateProgram()), files_(joined(files, " + ")) {
    // For whoever looks at it from outside; 255 characters are what every device takes.
    glObjectLabel(GL_PROGRAM, id(), -1, files_.substr(0, 255).c_str());
    std::vector<ShaderSource> sources;
    for (const std::string& file : files) {
        sources.push_back(library.assemble(file, defines, snippets));
        const Shader shader = compile(file, sources.back());
        glAttachShader(id(), shader.get());  // keeps the shader as long as the program
    }
    glLinkProgram(id());
    GLint isLinked = GL_FALSE;
    glGetProgramiv(id(), GL_LINK_STATUS, &isLinked);
    if (isLinked == GL_TRUE) return;

    GLint logBytes = 0;
    glGetProgramiv(id(), GL_INFO_LOG_LENGTH, &logBytes);
    std::string log(static_cast<std::size_t>(logBytes), '\0');
    GLsizei writtenBytes = 0;
    glGetProgramInfoLog(id(), logBytes, &writtenBytes, log.data());
    log.resize(static_cast<std::size_t>(writtenBytes));
    throw Error(fmt::format("cannot link {}:\n{}", files_, translateLinkLog(log, files, sources)));
}

void Program::use() const {
    glUseProgram(id());
}

GLint Program::findLocation(const char* name) const {
    auto found = locations_.find(std::string_view(name));
    if (found == locations_.end()) {
        found = locations_.emplace(name, glGetUniformLocation(id(), name)).first;
    }
    return found->second;
}

bool Program::isActive(const char* name) const {
    return findLocation(name) >= 0;
}

GLint Program::location(const char* name) const {
    const GLint location = findLocation(name);
    if (location < 0) {
        throw Error(fmt::format("{} uses no uniform '{}' that it is given", files_, name));
    }
    return location;
}

void Program::set(const char* name, int value) const {
    glProgramUniform1i(id(), location(name), value);
}
void Program::set(const char* name, unsigned value) const {
    glProgramUniform1ui(id(), location(name), value);
}
void Program::set(const char* name, float value) const {
    glProgramUniform1f(id(), location(name), value);
}
void Program::set(const char* name, const glm::ivec2& value) const {
    glProgramUniform2iv(id(), location(name), 1, glm::value_ptr(value));
}
void Program::set(const char* name, const glm::ivec3& value) const {
    glProgramUniform3iv(id(), location(name), 1, glm::value_ptr(value));
}
void Program::set(const char* name, const glm::uvec3& value) const {
    glProgramUniform3uiv(id(), location(name), 1, glm::value_ptr(value));
}
void Program::set(const char* name, const glm::vec2& value) const {
    glProgramUniform2fv(id(), location(name), 1, glm::value_ptr(value));
}
void Program::set(const char* name, const glm::vec3& value) const {
    glProgramUniform3fv(id(), location(name), 1, glm::value_ptr(value));
}
void Program::set(const char* name, const glm::vec4& value) const {
    glProgramUniform4fv(id(), location(name), 1, glm::value_ptr(value));
}
void Program::set(const char* name, const glm::mat4& value) const {
    glProgramUniformMatrix4fv(id(), location(name), 1, GL_FALSE, glm::value_ptr(value));
}

}  // namespace gfxrepro::gl
