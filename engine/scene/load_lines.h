// Lines and words of OBJ and MTL files.
#pragma once

#include <fmt/format.h>

#include <optional>
#include <string>
#include <string_view>

#include "engine/core/error.h"
#include "engine/scene/load_text.h"

namespace gfxrepro::scene {

/// Goes through a text line by line and through a line word by word. A backslash at the end of a
/// line continues it; '#' begins a comment.
class LineReader {
  public:
    LineReader(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {}

    /// False at the end of the text.
    bool nextLine() {
        line_ = nextLine_;
        if (text_.empty()) return false;
        rest_ = takeLine();
        if (endsWithBackslash(rest_)) joinContinuations();
        if (const std::size_t comment = rest_.find('#'); comment != rest_.npos) {
            rest_ = rest_.substr(0, comment);
        }
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

    /// What is left of the line, without blanks around it.
    std::string_view rest() {
        skipBlanks();
        while (!rest_.empty() && isBlank(rest_.back())) rest_.remove_suffix(1);
        return rest_;
    }

    /// The next word as a finite number; empty at the end of the line.
    std::optional<float> optionalNumber() {
        const std::string_view text = word();
        if (text.empty()) return std::nullopt;
        const auto value = parsedNumber<float>(text);
        if (!value || !std::isfinite(*value)) {
            fail(fmt::format("{} is not a finite number", inQuotes(text)));
        }
        return value;
    }

    float number() {
        const auto value = optionalNumber();
        if (!value) fail("the line lacks a number");
        return *value;
    }

    [[noreturn]] void fail(const std::string& message) const {
        throw Error({file_, line_, 0}, message);
    }

  private:
    static constexpr std::size_t kMostLineBytes = std::size_t{64} << 20;

    static bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
    static bool endsWithBackslash(std::string_view line) {
        while (!line.empty() && line.back() == '\r') line.remove_suffix(1);
        return !line.empty() && line.back() == '\\';
    }

    void skipBlanks() {
        while (!rest_.empty() && isBlank(rest_.front())) rest_.remove_prefix(1);
    }

    std::string_view takeLine() {
        ++nextLine_;
        const std::size_t end = text_.find('\n');
        const std::string_view line = text_.substr(0, end);
        if (line.size() > kMostLineBytes) {
            line_ = nextLine_ - 1;
            fail(fmt::format("a line of {} bytes; at most {} are read", line.size(),
                             kMostLineBytes));
        }
        text_.remove_prefix(end == text_.npos ? text_.size() : end + 1);
        return line;
    }

    void joinContinuations() {
        joined_.clear();
        while (endsWithBackslash(rest_)) {
            joined_ += rest_.substr(0, rest_.rfind('\\'));
            joined_ += ' ';
            rest_ = text_.empty() ? std::string_view{} : takeLine();
        }
        joined_ += rest_;
        rest_ = joined_;
    }

    std::string_view text_;
    std::string file_;
    std::string_view rest_;
    std::string joined_;
    int line_ = 1;
    int nextLine_ = 1;
};

}  // namespace gfxrepro::scene
