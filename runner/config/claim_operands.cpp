// What the expressions of claims may name: the columns of their table.
#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "runner/config/sections.h"
#include "runner/core/text.h"

namespace gfxrepro::config {

namespace {

bool isColumn(const TableNames& names, const std::string& name) {
    return std::find(names.columns.begin(), names.columns.end(), name) != names.columns.end();
}

/// In a table whose columns are numbers, one alone is a column, and one in an expression that
/// is a column's name could be either.
void requireClearNumber(const std::string& word, const std::string& operand, const Node& node,
                        const TableNames& names, const std::string& what) {
    if (!parseDouble(word)) return;
    const bool areNumbers = std::ranges::any_of(
        names.columns, [](const std::string& name) { return parseDouble(name).has_value(); });
    if (word == operand && areNumbers) {
        throw Error(node.location(), what + ": unknown column '" + word +
                                         "'; allowed: " + joined(names.columns) +
                                         ", or a number within an expression");
    }
    if (word != operand && isColumn(names, word)) {
        throw Error(node.location(),
                    fmt::format("{}: '{}' may be the column or the number; allowed: '{}' in "
                                "quotes for the column, {}.0 for the number",
                                what, word, word, word));
    }
}

/// The end of what is quoted at `begin`: a column.
std::size_t endOfQuoted(const std::string& operand, std::size_t begin, const Node& node,
                        const TableNames& names, const std::string& what) {
    const std::size_t end = operand.find(operand[begin], begin + 1);
    const std::string name = operand.substr(begin + 1, end - begin - 1);
    if (end == std::string::npos || !isColumn(names, name)) {
        throw Error(node.location(),
                    what + ": unknown column '" + name + "'; allowed: " + joined(names.columns));
    }
    return end + 1;
}

}  // namespace

void requireOperand(const std::string& operand, const Node& node, const TableNames& names,
                    const std::string& what) {
    if (!names.hasAllColumns || isColumn(names, operand)) return;
    const auto isStart = [](char c) {
        return std::isalpha(static_cast<unsigned char>(c)) || c == '_';
    };
    const auto isPart = [&](char c) { return isStart(c) || (c >= '0' && c <= '9'); };
    for (std::size_t i = 0; i < operand.size();) {
        if (operand[i] == '\'' || operand[i] == '"') {
            i = endOfQuoted(operand, i, node, names, what);
            continue;
        }
        if (!isPart(operand[i])) {
            ++i;
            continue;
        }
        std::size_t end = i;
        const bool isNumber = !isStart(operand[i]);
        while (end < operand.size() &&
               (isPart(operand[end]) || (isNumber && operand[end] == '.'))) {
            ++end;
        }
        const std::string name = operand.substr(i, end - i);
        const std::size_t next = operand.find_first_not_of(' ', end);
        const bool isCall = next != std::string::npos && operand[next] == '(';
        requireClearNumber(name, operand, node, names, what);
        if (isStart(name[0]) && !isCall && !isColumn(names, name)) {
            const std::string near = suggestion(name, names.columns);
            throw Error(node.location(),
                        what + ": unknown column '" + name + "'" +
                            (near.empty() ? "; allowed: " + joined(names.columns) : near));
        }
        i = end;
    }
}

}  // namespace gfxrepro::config
