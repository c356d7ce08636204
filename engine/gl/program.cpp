#include "engine/gl/program.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <optional>
#include <regex>
#include <set>

#include "engine/core/error.h"
#include "engine/core/files.h"
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

// Puts a stage's source together from files, and translates line numbers back.

namespace {

/// A value as GLSL spells it; negative numbers in parentheses, so that `x-NAME` stays a difference.
struct SpellValue {
    std::string operator()(int value) const {
        return value < 0 ? fmt::format("({})", value) : fmt::format("{}", value);
    }
    std::string operator()(unsigned value) const { return fmt::format("{}u", value); }
    std::string operator()(float value) const {
        GFXREPRO_ASSERT(std::isfinite(value));
        std::string digits = fmt::format("{:#}", value);
        const std::size_t behindPoint = digits.find('.') + 1;  // from fmt 10 on maybe nothing
        if (behindPoint == digits.size() || digits[behindPoint] == 'e') {
            digits.insert(behindPoint, 1, '0');
        }
        return value < 0 ? '(' + digits + ')' : digits;
    }
    std::string operator()(const std::string& value) const { return value; }
};

/// What follows `directive` on a line that begins with it ("#include"), trimmed.
std::optional<std::string_view> argumentOf(std::string_view line, std::string_view directive) {
    line = trimmed(line);
    if (!line.starts_with(directive)) return std::nullopt;
    line.remove_prefix(directive.size());
    if (!line.empty() && line.front() != ' ' && line.front() != '\t' && line.front() != '"') {
        return std::nullopt;  // a longer word
    }
    return trimmed(line);
}

class Assembler {
  public:
    Assembler(const std::filesystem::path& folder, const Defines& defines,
              const std::map<std::string, std::string>& snippets)
        : folder_(folder), defines_(defines), snippets_(snippets) {}

    ShaderSource run(const std::string& file) {
        addFile(file);
        return std::move(source_);
    }

  private:
    /// The file that is being read, and the line reached in it.
    struct Place {
        std::string file;
        int line = 0;
    };

    void addFile(const std::string& file) {
        const bool isStage = stack_.empty();
        const std::string text = read(file);
        seen_.insert(file);
        stack_.push_back({file, 0});
        for (const std::string& line : linesOf(text)) {
            ++stack_.back().line;
            if (argumentOf(line, "#version") || (isStage && stack_.back().line == 1)) {
                addVersion(line, isStage);
            } else if (const auto include = argumentOf(line, "#include")) {
                addInclude(*include);
            } else if (const auto snippet = argumentOf(line, "#pragma snippet")) {
                addSnippet(std::string(*snippet));
            } else {
                addLine(line, file, stack_.back().line);
            }
        }
        stack_.pop_back();
    }

    void addVersion(const std::string& line, bool isStage) {
        const bool isFirst = isStage && stack_.back().line == 1;
        if (!isFirst) fail("'#version' is allowed in the first line of a stage's file only");
        if (!argumentOf(line, "#version")) {
            fail(fmt::format("the first line must be '#version 450 core', found '{}'", line));
        }
        addLine(line, stack_.back().file, 1);
        for (const auto& [name, value] : defines_) {
            addLine(fmt::format("#define {} {}", name, std::visit(SpellValue{}, value)),
                    fmt::format("define {}", name), 0);
        }
    }

    void addInclude(std::string_view argument) {
        const bool isQuoted = argument.size() > 2 && argument.front() == '"' &&
                              argument.find('"', 1) == argument.size() - 1;
        if (!isQuoted) {
            fail(fmt::format("'#include' needs a path in double quotes, found '{}'", argument));
        }
        const std::string file(argument.substr(1, argument.size() - 2));
        const bool isOpen =
            std::ranges::any_of(stack_, [&](const Place& place) { return place.file == file; });
        if (isOpen) fail(fmt::format("include cycle: \"{}\" is being read", file));
        if (!seen_.contains(file)) addFile(file);
    }

    void addSnippet(const std::string& name) {
        const auto snippet = snippets_.find(name);
        if (snippet == snippets_.end()) {
            std::vector<std::string> names;
            for (const auto& [given, text] : snippets_) names.push_back(given);
            fail(fmt::format("no snippet '{}' was given; given: {}", name,
                             names.empty() ? "none" : joined(names)));
        }
        int number = 0;
        for (const std::string& line : linesOf(snippet->second)) {
            addLine(line, fmt::format("snippet {}", name), ++number);
        }
    }

    void addLine(const std::string& line, const std::string& file, int number) {
        source_.text += line + '\n';
        source_.lines.push_back({file, number});
    }

    std::string read(const std::string& file) const {
        const std::filesystem::path path = folder_ / file;
        if (!std::filesystem::is_regular_file(path)) {
            const std::string message =
                fmt::format("there is no shader file \"{}\" in {}", file, folder_.string());
            if (stack_.empty()) throw Error(message);
            fail(message);
        }
        return readFile(path);
    }

    static std::vector<std::string> linesOf(std::string_view text) {
        if (text.ends_with('\n')) text.remove_suffix(1);
        std::vector<std::string> lines = split(text, '\n');
        for (std::string& line : lines) {
            if (line.ends_with('\r')) line.pop_back();
        }
        return lines;
    }

    /// Throws at the line being read, with the files that led to it.
    [[noreturn]] void fail(const std::string& message) const {
        std::string chain;
        for (std::size_t i = stack_.size() - 1; i-- > 0;) {
            chain += fmt::format("\n  included from {}:{}", stack_[i].file, stack_[i].line);
        }
        throw Error(SourceLocation{stack_.back().file, stack_.back().line}, message + chain);
    }

    const std::filesystem::path& folder_;
    const Defines& defines_;
    const std::map<std::string, std::string>& snippets_;
    ShaderSource source_;
    std::set<std::string> seen_;
    std::vector<Place> stack_;
};

}  // namespace

ShaderSource ShaderLibrary::assemble(std::string_view file, const Defines& defines,
                                     const std::map<std::string, std::string>& snippets) const {
    return Assembler(folder_, defines, snippets).run(std::string(file));
}

std::string translateLog(std::string_view log, const ShaderSource& source) {
    // Mesa "0:12(3): ", NVIDIA "0(12) : ". The place is translated through the assembled text's own
    // line numbers and not with #line, whose string number Mesa drops on semantic errors.
    static const std::regex kPlace(R"(^(?:\d+:(\d+)\(\d+\): |\d+\((\d+)\) : ))");
    std::string translated;
    for (const std::string& line : split(trimmed(log), '\n')) {
        std::smatch match;
        std::size_t number = 0;
        if (std::regex_search(line, match, kPlace)) {
            const std::string digits = match[1].matched ? match[1].str() : match[2].str();
            std::from_chars(digits.data(), digits.data() + digits.size(), number);
        }
        if (!translated.empty()) translated += '\n';
        if (number >= 1 && number <= source.lines.size()) {
            const ShaderSource::Line& place = source.lines[number - 1];
            translated +=
                toString(SourceLocation{place.file, place.line}) + ": " + match.suffix().str();
        } else {
            translated += line;
        }
    }
    return translated;
}

}  // namespace gfxrepro::gl
