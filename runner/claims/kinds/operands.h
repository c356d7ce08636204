// How the expressions of claims are read: "'a / b' + max(c, a_0.5) * 2" over the columns of a
// table.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gfxrepro::claims {

/// What an expression may call, beside + - * / ^ and comparisons, which are 1 or 0.
inline constexpr std::array<std::string_view, 12> kFunctions = {
    "abs", "avg", "exp", "ln", "log10", "log2", "max", "min", "rint", "sign", "sqrt", "sum"};

/// A column, or what stands between columns: a number, the name of a function, or one character.
struct OperandPiece {
    std::string_view text;  // of the expression, quotes included; the pieces are all of it
    std::optional<std::size_t> column = std::nullopt;  // among the labels
    /// Why it cannot be read: "'y' is no column (columns: a, b)"; or empty.
    std::string problem = {};
    bool isFunction = false;  // the problem is of one, which no table makes right
};

/// A column is written by its label, whatever characters this has, also in quotes; of several that
/// begin at a place the longest is meant. Every other name is one of kFunctions, called as
/// `max(a, b)`, or a problem.
/// Where labels are numbers ("8"), a number that is the whole expression means a column, and one
/// within an expression that is a label, too, could mean either, a problem: the column is written
/// '8', the number 8.0. The pieces point into `expression`.
std::vector<OperandPiece> operandPieces(std::string_view expression,
                                        std::span<const std::string> labels);

/// A column's cell in another row: "time[method=slices, size=64]".
struct RowReference {
    std::string_view text;  // of the expression, to the bracket that closes, or to its end
    std::size_t column;     // among the labels
    /// Row axes with values; none where it cannot be read.
    std::vector<std::pair<std::string, std::string>> at;
};
/// "'tme' is no column; did you mean 'time'? (columns: time, size)".
std::string noColumn(const std::string& name, std::span<const std::string> labels);

/// Those of an expression, in its order. They point into it.
std::vector<RowReference> rowReferences(std::string_view expression,
                                        std::span<const std::string> labels);

/// The parts of the text between the separators that are outside of parentheses and of columns,
/// trimmed.
std::vector<std::string> sidesOf(std::string_view text, std::string_view separator,
                                 std::span<const std::string> labels);

}  // namespace gfxrepro::claims
