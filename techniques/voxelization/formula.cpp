#include "techniques/voxelization/formula.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <string_view>

#include "engine/core/text.h"

namespace gfxrepro::voxelization {

namespace {

constexpr std::size_t kMaxLength = 4096;  // characters; keeps shader compilation short
constexpr int kMaxDepth = 100;            // of nesting; the translator and GLSL compilers recurse
constexpr double kMaxIntegerPower = 64;   // larger exponents are left to pow()

struct Function {
    std::string_view name;
    int arguments;
};
// The names are those of GLSL.
constexpr std::array<Function, 9> kFunctions{{{"abs", 1},
                                              {"cos", 1},
                                              {"exp", 1},
                                              {"log", 1},
                                              {"max", 2},
                                              {"min", 2},
                                              {"sin", 1},
                                              {"sqrt", 1},
                                              {"tan", 1}}};

[[noreturn]] void fail(const SourceLocation& where, const std::string& formula, std::size_t index,
                       const std::string& problem, const std::vector<std::string>& variables) {
    std::vector<std::string> names = variables;
    names.emplace_back("pi");
    for (const Function& function : kFunctions) names.emplace_back(function.name);
    throw Error(where, fmt::format("formula '{}', character {}: {}; allowed: numbers, {}, + - * / "
                                   "^ ( )",
                                   formula, index + 1, problem, joined(names)));
}

/// What went wrong in a formula, with the index of the character.
struct Problem {
    std::size_t index;
    std::string text;
};

/// Recursive descent over
///     sum = product (("+" | "-") product)*          product = factor (("*" | "/") factor)*
///     factor = "-" power | power                    power = atom ("^" factor)?
///     atom = number | name | name "(" sum ("," sum)* ")" | "(" sum ")".
/// Throws Problem.
class Translator {
  public:
    Translator(std::string_view text, std::span<const std::string> variables)
        : text_(text), variables_(variables) {}

    std::string translate() {
        std::string glsl = sum();
        skipSpace();
        if (at_ < text_.size()) unexpected();
        return glsl;
    }

  private:
    std::string sum() {
        if (++depth_ > kMaxDepth) {
            throw Problem{at_, fmt::format("nested deeper than {}", kMaxDepth)};
        }
        std::string glsl = product();
        while (accept('+') || accept('-')) {
            const char sign = text_[at_ - 1];
            glsl = fmt::format("({} {} {})", glsl, sign, product());
        }
        --depth_;
        return glsl;
    }

    std::string product() {
        std::string glsl = factor();
        while (accept('*') || accept('/')) {
            const char sign = text_[at_ - 1];
            glsl = fmt::format("({} {} {})", glsl, sign, factor());
        }
        return glsl;
    }

    std::string factor() {
        if (accept('-')) return fmt::format("(-{})", power());
        return power();
    }

    std::string power() {
        std::string base = atom();
        if (!accept('^')) return base;
        const std::size_t begin = at_;
        if (++depth_ > kMaxDepth) {
            throw Problem{at_, fmt::format("nested deeper than {}", kMaxDepth)};
        }
        std::string exponent = factor();
        --depth_;
        // GLSL's pow() is undefined for negative bases; whole powers are products.
        if (const auto whole = wholeNumber(text_.substr(begin, at_ - begin))) {
            return fmt::format("integerPower({}, {})", base, *whole);
        }
        return fmt::format("realPower({}, {})", base, exponent);
    }

    std::string atom() {
        skipSpace();
        if (accept('(')) {
            std::string inner = sum();
            expect(')');
            return inner;
        }
        if (at_ == text_.size()) throw Problem{at_, "the formula ends early"};
        const char first = text_[at_];
        if (std::isdigit(static_cast<unsigned char>(first)) || first == '.') return number();
        if (std::isalpha(static_cast<unsigned char>(first))) return name();
        unexpected();
    }

    std::string number() {
        double value = 0;
        const char* begin = text_.data() + at_;
        const auto [end, status] = std::from_chars(begin, text_.data() + text_.size(), value);
        if (status == std::errc::invalid_argument) unexpected();
        if (status != std::errc{} ||
            std::abs(value) > static_cast<double>(std::numeric_limits<float>::max())) {
            throw Problem{at_, "the number is out of the range of a float"};
        }
        at_ += static_cast<std::size_t>(end - begin);
        return literal(value);
    }

    std::string name() {
        const std::size_t begin = at_;
        while (at_ < text_.size() && std::isalnum(static_cast<unsigned char>(text_[at_]))) ++at_;
        const std::string_view word = text_.substr(begin, at_ - begin);
        if (word == "pi") return literal(std::numbers::pi);
        if (std::ranges::find(variables_, word) != variables_.end()) return std::string(word);
        const auto* const function = std::ranges::find(kFunctions, word, &Function::name);
        if (function == kFunctions.end()) {
            throw Problem{begin, fmt::format("unknown name '{}'", word)};
        }
        std::string call(word);
        for (int i = 0; i < function->arguments; ++i) {
            expect(i == 0 ? '(' : ',');
            call += (i == 0 ? "(" : ", ") + sum();
        }
        expect(')');
        return call + ")";
    }

    static std::string literal(double value) {
        std::string digits = fmt::format("{}", static_cast<float>(value));
        // GLSL reads "2" as an integer.
        if (digits.find_first_of(".e") == std::string::npos) digits += ".0";
        return digits;
    }

    /// The whole text as a small whole number, as in x^4, x^-2 or x^2.0.
    static std::optional<int> wholeNumber(std::string_view text) {
        const auto value = parseDouble(trimmed(text));
        if (!value || *value != std::floor(*value) || std::abs(*value) > kMaxIntegerPower) {
            return std::nullopt;
        }
        return static_cast<int>(*value);
    }

    void skipSpace() {
        while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
    }
    bool accept(char wanted) {
        skipSpace();
        if (at_ == text_.size() || text_[at_] != wanted) return false;
        ++at_;
        return true;
    }
    void expect(char wanted) {
        if (accept(wanted)) return;
        if (at_ == text_.size()) throw Problem{at_, fmt::format("'{}' is missing", wanted)};
        unexpected();
    }
    [[noreturn]] void unexpected() const {
        throw Problem{at_, fmt::format("unexpected '{}'", text_[at_])};
    }

    std::string_view text_;
    std::span<const std::string> variables_;
    std::size_t at_ = 0;
    int depth_ = 0;
};

}  // namespace

Formula::Formula(const std::string& formula, std::vector<std::string> variables,
                 const SourceLocation& where)
    : formula_(formula), variables_(std::move(variables)) {
    if (formula.size() > kMaxLength) {
        throw Error(where, fmt::format("a formula of {} characters; at most {} are allowed",
                                       formula.size(), kMaxLength));
    }
    try {
        glsl_ = Translator(formula, variables_).translate();
    } catch (const Problem& problem) {
        fail(where, formula, problem.index, problem.text, variables_);
    }
}

std::string Formula::glslFunction(const std::string& name) const {
    std::vector<std::string> parameters;
    for (const std::string& variable : variables_) parameters.push_back("float " + variable);
    return fmt::format("float {}({}) {{ precise float value = {}; return value; }}", name,
                       joined(parameters), glsl_);
}

}  // namespace gfxrepro::voxelization
