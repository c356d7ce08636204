// Shader programs from files: #include, injected defines, driver errors translated back to file and
// line.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "engine/gl/gl.h"
#include "engine/gl/objects.h"

namespace gfxrepro::gl {

/// A `#define NAME value` put behind #version. Ordered by name, so that equal sets give equal
/// source.
using Defines = std::map<std::string, std::variant<int, unsigned, float, std::string>>;

/// One stage's source, put together: `#include "shared/x.glsl"` is resolved against the shader
/// folders, each file at most once; `lines` maps a line of `text` back to file and line.
struct ShaderSource {
    std::string text;
    struct Line {
        std::string file;
        int line = 0;
    };
    std::vector<Line> lines;
};

/// Finds shader files: <folder>/<technique>/<pass>.<stage>.glsl.
class ShaderLibrary {
  public:
    explicit ShaderLibrary(std::filesystem::path folder) : folder_(std::move(folder)) {}
    const std::filesystem::path& folder() const { return folder_; }

    /// `file` is relative to the folder ("marching/trace.frag.glsl"). `snippets` replace
    /// lines `#pragma snippet NAME` (generated code, such as an implicit surface's formula). The
    /// file's first line is `#version …`; the defines follow it.
    /// Throws Error at file:line with the chain of including files for a missing file, an include
    /// cycle, a snippet that was not given, a malformed `#include` and a misplaced `#version`.
    ShaderSource assemble(std::string_view file, const Defines& defines,
                          const std::map<std::string, std::string>& snippets = {}) const;

  private:
    std::filesystem::path folder_;
};

/// A linked program. The stage of a file is its middle extension: .vert .tesc .tese .geom .frag
/// .comp.
class Program {
  public:
    Program() = default;
    /// Throws Error with the driver's log, its line numbers translated to file:line.
    Program(const ShaderLibrary& library, const std::vector<std::string>& files,
            const Defines& defines = {}, const std::map<std::string, std::string>& snippets = {});

    GLuint id() const { return name_.get(); }
    void use() const;

    // Setters by name. Throw Error that names the files for a name that is no active uniform;
    // setIfActive() where a define can leave it unused.
    void set(const char* name, int value) const;
    void set(const char* name, unsigned value) const;
    void set(const char* name, float value) const;
    void set(const char* name, const glm::ivec2& value) const;
    void set(const char* name, const glm::ivec3& value) const;
    void set(const char* name, const glm::uvec3& value) const;
    void set(const char* name, const glm::vec2& value) const;
    void set(const char* name, const glm::vec3& value) const;
    void set(const char* name, const glm::vec4& value) const;
    void set(const char* name, const glm::mat4& value) const;
    bool isActive(const char* name) const;
    /// For what a shader may do without.
    template <class T>
    void setIfActive(const char* name, const T& value) const {
        if (isActive(name)) set(name, value);
    }

  private:
    /// Asked for once a name; −1 for one that is not active.
    GLint findLocation(const char* name) const;
    GLint location(const char* name) const;
    detail::Name<detail::deleteProgram> name_;
    std::string files_;  // "a.vert.glsl + a.frag.glsl"
    mutable std::map<std::string, GLint, std::less<>> locations_;
};

/// Translates the line numbers of a driver's log (Mesa "0:12(3):", NVIDIA "0(12) :") into
/// file:line.
std::string translateLog(std::string_view log, const ShaderSource& source);

}  // namespace gfxrepro::gl
