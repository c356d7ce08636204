// Text files of lines and words.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "engine/core/error.h"
#include "engine/scene/load_text.h"

namespace gfxrepro::scene {

/// Refuses what is no text in bytes: of two bytes a letter, or compressed.
inline void requireUtf8Text(std::string_view text, const std::string& file) {
    constexpr std::pair<std::string_view, const char*> kOthers[] = {
        {"\xFF\xFE", "in UTF-16"},
        {"\xFE\xFF", "in UTF-16"},
        {"\x1F\x8B\x08", "compressed by gzip"},
        {"\xFD"
         "7zXZ",
         "compressed by xz"},
        {"\x28\xB5\x2F\xFD", "compressed by zstd"},
        {"PK\x03\x04", "an archive (zip)"}};
    for (const auto& [magic, kind] : kOthers) {
        if (text.starts_with(magic)) {
            throw Error(fmt::format("{}: is {}; allowed: as it is, text in UTF-8", file, kind));
        }
    }
}

/// Goes through a text line by line and through a line word by word. A backslash at the end of a
/// line continues it, but no comment; '#' begins one at the start of a line and behind a blank. A
/// byte order mark is skipped. In a text without line feeds carriage returns end the lines.
class LineReader {
  public:
    LineReader(std::string_view text, std::string file)
        : text_(withoutByteOrderMark(text)),
          file_(std::move(file)),
          lineEndMark_(lineEndOf(text)) {}

    /// False at the end of the text.
    bool nextLine() {
        line_ = nextLine_;
        takesLine_ = false;
        if (text_.empty()) return false;
        rest_ = takeLine();
        if (isContinued(rest_)) joinContinuations();
        lineEnd_ = rest_.data() + rest_.size();
        rest_ = withoutComment(rest_);
        return true;
    }

    /// Empty at the end of the line.
    std::string_view word() {
        skipBlanks();
        std::size_t end = 0;
        while (end < rest_.size() && !isBlank(rest_[end])) ++end;
        const std::string_view result = rest_.substr(0, end);
        rest_.remove_prefix(end);
        return result;
    }

    /// What is left of the line, without blanks around it: a name, which may hold blanks and '#'.
    std::string_view name() {
        skipBlanks();
        std::string_view name(rest_.data(), static_cast<std::size_t>(lineEnd_ - rest_.data()));
        while (!name.empty() && isBlank(name.back())) name.remove_suffix(1);
        return name;
    }

    /// Says that the line ends in a backslash, as a folder's path does, and so takes another one.
    void noteTakenLine(LeftOut& leftOut) const {
        if (takesLine_) leftOut.add("a line that the one before takes, as that ends in '\\'");
    }

    /// What stands before a comment.
    static std::string_view withoutComment(std::string_view line) {
        for (std::size_t at = line.find('#'); at != line.npos; at = line.find('#', at + 1)) {
            if (at > 0 && !isBlank(line[at - 1])) continue;
            line = line.substr(0, at);
            while (!line.empty() && isBlank(line.back())) line.remove_suffix(1);
            break;
        }
        return line;
    }

    /// The next word as a finite number; empty at the end of the line.
    template <class T = float>
    std::optional<T> optionalNumber() {
        const std::string_view text = word();
        if (text.empty()) return std::nullopt;
        const T value = parsed<T>(text);
        if (!std::isfinite(value)) failNumber(text);
        return value;
    }

    template <class T = float>
    T number() {
        const auto value = optionalNumber<T>();
        if (!value) fail("the line lacks a number");
        return *value;
    }

    glm::vec3 position(Anchor& anchor) {
        glm::dvec3 position(0.0);
        for (int axis = 0; axis < 3; ++axis) {
            position[axis] = number<double>();
            requireNear(position[axis], [this](const std::string& problem) { fail(problem); });
        }
        return anchor.relative(position);
    }

    /// Goes on to the next line that has a word.
    void nextFilledLine() {
        while (nextLine()) {
            skipBlanks();
            if (!rest_.empty()) return;
        }
        fail("the file ends early");
    }

    /// It may be infinite or not a number, as "nan" is none.
    float anyNumber() {
        const std::string_view text = word();
        if (text.empty()) fail("the line lacks a number");
        return parsed<float>(text);
    }

    /// Behind the line.
    std::size_t unreadBytes() const { return text_.size(); }

    [[noreturn]] void fail(const std::string& message) const {
        throw Error({file_, line_, 0}, message);
    }

  private:
    static constexpr std::size_t kMostLineBytes = std::size_t{64} << 20;

    static bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
    static bool isContinued(std::string_view line) {
        line = withoutComment(line);
        while (!line.empty() && isBlank(line.back())) line.remove_suffix(1);
        return !line.empty() && line.back() == '\\';
    }

    [[noreturn]] void failNumber(std::string_view text) const {
        fail(fmt::format("{} is not a finite number", inQuotes(text)));
    }

    template <class T>
    T parsed(std::string_view text) const {
        const auto value = parsedNumber<T>(text);
        if (!value) failNumber(text);
        return *value;
    }

    void skipBlanks() {
        while (!rest_.empty() && isBlank(rest_.front())) rest_.remove_prefix(1);
    }

    std::string_view takeLine() {
        ++nextLine_;
        const std::size_t end = text_.find(lineEndMark_);
        const std::string_view line = text_.substr(0, end);
        if (line.size() > kMostLineBytes) {
            line_ = nextLine_ - 1;
            fail(fmt::format("a line of {} bytes; at most {} are read", line.size(),
                             kMostLineBytes));
        }
        text_.remove_prefix(end == text_.npos ? text_.size() : end + 1);
        return line;
    }

    /// Whether it is a line of its own: with a key of OBJ and MTL files; behind a word that ends in
    /// the backslash also with another one. Names and numbers go on otherwise.
    static bool beginsWithKey(std::string_view line, bool isOfWord) {
        constexpr std::string_view kKeys[] = {
            "v",  "vt", "vn", "f", "l",  "g",     "o",      "s",      "Ka",     "Kd",    "Ks",
            "Ke", "Ns", "Ni", "d", "Tr", "illum", "map_Kd", "newmtl", "usemtl", "mtllib"};
        while (!line.empty() && isBlank(line.front())) line.remove_prefix(1);
        const std::string_view word = line.substr(0, line.find_first_of(" \t\r"));
        if (isOfWord) return !word.empty() && std::isalpha(static_cast<unsigned char>(word[0]));
        return word.size() < line.size() && std::ranges::find(kKeys, word) != std::end(kKeys);
    }

    void joinContinuations() {
        joined_.clear();
        while (isContinued(rest_)) {
            joined_ += rest_.substr(0, rest_.rfind('\\'));
            const bool isOfWord = !joined_.empty() && !isBlank(joined_.back());
            joined_ += ' ';
            rest_ = text_.empty() ? std::string_view{} : takeLine();
            takesLine_ |= beginsWithKey(rest_, isOfWord);
        }
        joined_ += rest_;
        rest_ = joined_;
    }

    std::string_view text_;
    std::string file_;
    char lineEndMark_;
    std::string_view rest_;
    const char* lineEnd_ = nullptr;  // behind its comment
    std::string joined_;
    bool takesLine_ = false;
    int line_ = 1;
    int nextLine_ = 1;
};

}  // namespace gfxrepro::scene
