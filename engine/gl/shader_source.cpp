// Puts a stage's source together from files, and translates line numbers back.

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <regex>
#include <set>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/text.h"
#include "engine/gl/program.h"

namespace gfxrepro::gl {

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
