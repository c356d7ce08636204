// To be preloaded into the program (LD_PRELOAD): writes the stages of every GL program that is
// linked into the folder KEPT_PROGRAMS, "<program>.vert" and so on. <program> is a hash of what it
// is made of: one that is linked again is the same file.
#include <dlfcn.h>

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <unistd.h>

namespace {

struct Stage {
    GLenum type = GL_NONE;
    std::string source;
};
// By GL's names. Shaders that are deleted live on in programs, whose names may come again.
std::map<GLuint, Stage> shaders;
std::map<GLuint, std::vector<Stage>> programs;

template <class Function>
Function next(const char* name) {
    return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

const char* endingOf(GLenum type) {
    switch (type) {
        case GL_VERTEX_SHADER:
            return "vert";
        case GL_TESS_CONTROL_SHADER:
            return "tesc";
        case GL_TESS_EVALUATION_SHADER:
            return "tese";
        case GL_GEOMETRY_SHADER:
            return "geom";
        case GL_FRAGMENT_SHADER:
            return "frag";
        default:
            return "comp";
    }
}

/// Whole under its name at once: workers write beside each other.
void keep(const std::filesystem::path& file, const std::string& text) {
    const std::string unfinished = file.string() + '-' + std::to_string(::getpid());
    std::ofstream(unfinished) << text;
    std::filesystem::rename(unfinished, file);
}

}  // namespace

extern "C" {

GLAPI GLuint APIENTRY glCreateShader(GLenum type) {
    const GLuint id = next<decltype(&glCreateShader)>("glCreateShader")(type);
    shaders[id] = {type, ""};
    return id;
}

GLAPI void APIENTRY glShaderSource(GLuint id, GLsizei count, const GLchar* const* texts,
                                   const GLint* lengths) {
    shaders[id].source.clear();
    for (GLsizei i = 0; i < count; ++i) {
        const bool isMeasured = lengths && lengths[i] >= 0;
        shaders[id].source +=
            isMeasured ? std::string(texts[i], static_cast<std::size_t>(lengths[i])) : texts[i];
    }
    next<decltype(&glShaderSource)>("glShaderSource")(id, count, texts, lengths);
}

GLAPI GLuint APIENTRY glCreateProgram() {
    const GLuint id = next<decltype(&glCreateProgram)>("glCreateProgram")();
    programs[id].clear();
    return id;
}

GLAPI void APIENTRY glAttachShader(GLuint program, GLuint shader) {
    programs[program].push_back(shaders[shader]);
    next<decltype(&glAttachShader)>("glAttachShader")(program, shader);
}

GLAPI void APIENTRY glLinkProgram(GLuint program) {
    next<decltype(&glLinkProgram)>("glLinkProgram")(program);
    std::string all;
    for (const Stage& stage : programs[program]) all += endingOf(stage.type) + stage.source;
    const std::size_t hash = std::hash<std::string>()(all);
    const char* folder = std::getenv("KEPT_PROGRAMS");
    if (!folder) return;
    for (const Stage& stage : programs[program]) {
        keep(std::filesystem::path(folder) / (std::to_string(hash) + '.' + endingOf(stage.type)),
             stage.source);
    }
}

}  // extern "C"
