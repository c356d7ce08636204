#include "runner/claims/kinds/operands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "engine/core/text.h"
#include "runner/claims/kinds/kind.h"

namespace gfxrepro::claims {

namespace {

using Labels = std::span<const std::string>;

bool isNameStart(char c) {
    return std::isalpha(static_cast<unsigned char>(c)) || c == '_';
}
bool isNamePart(char c) {
    return isNameStart(c) || std::isdigit(static_cast<unsigned char>(c)) || c == '.';
}
bool isNumber(const std::string& text) {
    return parseDouble(text).has_value();
}

}  // namespace

std::string noColumn(const std::string& name, Labels labels) {
    const bool isFrameTime = name == "wall_time_ms" && std::ranges::count(labels, "frame_ms") > 0;
    std::string hint = isFrameTime ? "; its column is 'frame_ms'" : "";
    for (const Kind& kind : kinds()) {
        if (kind.hintOn) hint += kind.hintOn(name);
    }
    if (hint.empty() && !isNumber(name)) hint = suggestion(name, labels);
    return fmt::format("'{}' is no column{} (columns: {})", name, hint, joined(labels));
}

namespace {

/// The column in quotes at the head of `rest`; those without an end are of all of it.
OperandPiece quoted(std::string_view rest, Labels labels) {
    const std::size_t end = rest.find(rest[0], 1);
    if (end == rest.npos) return {rest, {}, fmt::format("quotes without an end: {}", rest)};
    const std::string name(rest.substr(1, end - 1));
    const auto found = std::ranges::find(labels, name);
    if (found == labels.end()) return {rest.substr(0, end + 1), {}, noColumn(name, labels)};
    return {rest.substr(0, end + 1), static_cast<std::size_t>(found - labels.begin())};
}

/// The column whose label, not a number's, stands at the head of `rest`, the longest of several.
std::optional<std::size_t> columnAt(std::string_view rest, Labels labels) {
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < labels.size(); ++i) {
        const std::string& label = labels[i];
        const bool isWhole = !label.empty() && rest.starts_with(label) &&
                             (rest.size() == label.size() || !isNamePart(rest[label.size()]));
        if (!isWhole || isNumber(label)) continue;
        const bool isCalled = trimmed(rest.substr(label.size())).starts_with('(');
        if (isCalled && std::ranges::count(kFunctions, label) > 0) continue;
        if (!best || label.size() > labels[*best].size()) best = i;
    }
    return best;
}

/// The number, name or character at the head of `rest`, a part of the expression.
OperandPiece wordAt(std::string_view rest, std::string_view expression, Labels labels) {
    std::size_t length = 1;
    while (isNamePart(rest[0]) && length < rest.size() && isNamePart(rest[length])) ++length;
    OperandPiece piece{rest.substr(0, length)};
    const std::string word(piece.text);
    const bool isWhole = length == expression.size();
    const bool isCalled = trimmed(rest.substr(length)).starts_with('(');
    if (isNumber(word) && !isWhole && std::ranges::find(labels, word) != labels.end()) {
        piece.problem = fmt::format(
            "'{0}' may be the column or the number (quoted it is the column; written otherwise, "
            "as {0}.0, the number)",
            word);
    }
    const bool meansColumn = isNumber(word) ? isWhole && std::ranges::any_of(labels, isNumber)
                                            : isNameStart(word[0]) && !isCalled;
    if (meansColumn) piece.problem = noColumn(word, labels);
    if (isCalled && isNameStart(word[0]) && std::ranges::count(kFunctions, word) == 0) {
        const std::vector<std::string> known(kFunctions.begin(), kFunctions.end());
        piece.problem = fmt::format("'{}' is no function{}", word, suggestionOrAll(word, known));
        piece.isFunction = true;
    }
    return piece;
}

}  // namespace

std::vector<OperandPiece> operandPieces(std::string_view expression, Labels labels) {
    const auto whole = std::ranges::find(labels, expression);
    if (whole != labels.end()) {
        return {{expression, static_cast<std::size_t>(whole - labels.begin())}};
    }
    std::vector<OperandPiece> pieces;
    for (std::string_view rest = expression; !rest.empty();
         rest.remove_prefix(pieces.back().text.size())) {
        if (const auto column = columnAt(rest, labels)) {
            pieces.push_back({rest.substr(0, labels[*column].size()), column});
        } else if (rest[0] == '\'' || rest[0] == '"') {
            pieces.push_back(quoted(rest, labels));
        } else {
            pieces.push_back(wordAt(rest, expression, labels));
        }
    }
    return pieces;
}

namespace {

std::vector<std::pair<std::string, std::string>> pairsIn(std::string_view text) {
    std::vector<std::pair<std::string, std::string>> pairs;
    for (const std::string& pair : split(text, ',')) {
        const std::size_t equals = pair.find('=');
        if (equals == pair.npos) return {};
        const std::string_view all = pair;
        pairs.emplace_back(trimmed(all.substr(0, equals)), trimmed(all.substr(equals + 1)));
        if (pairs.back().first.empty() || pairs.back().second.empty()) return {};
    }
    return pairs;
}

}  // namespace

std::vector<RowReference> rowReferences(std::string_view expression, Labels labels) {
    std::vector<RowReference> references;
    std::size_t begin = 0;  // of what is still to be read
    const auto next = [&] {
        std::size_t at = begin;
        for (const OperandPiece& piece : operandPieces(expression.substr(begin), labels)) {
            const std::size_t end = at + piece.text.size();
            if (piece.column && end < expression.size() && expression[end] == '[') {
                const std::size_t close = expression.find(']', end);
                begin = close == expression.npos ? expression.size() : close + 1;
                RowReference& one = references.emplace_back();
                one.text = expression.substr(at, begin - at);
                one.column = *piece.column;
                if (close != expression.npos) {
                    one.at = pairsIn(expression.substr(end + 1, close - end - 1));
                }
                return true;
            }
            at = end;
        }
        return false;
    };
    while (begin < expression.size() && next()) {
    }
    return references;
}

std::vector<std::string> sidesOf(std::string_view text, std::string_view separator, Labels labels) {
    std::vector<std::string> sides;
    std::size_t begin = 0, end = 0;  // of the side; `end` is where the next piece stands
    const auto close = [&] { sides.emplace_back(trimmed(text.substr(begin, end - begin))); };
    int depth = 0;
    for (const OperandPiece& piece : operandPieces(text, labels)) {
        depth += piece.text == "(" ? 1 : piece.text == ")" ? -1 : 0;
        const bool isSeparator =
            !piece.column && depth == 0 && end >= begin && text.substr(end).starts_with(separator);
        if (isSeparator) {
            close();
            begin = end + separator.size();
        }
        end += piece.text.size();
    }
    close();
    return sides;
}

}  // namespace gfxrepro::claims
