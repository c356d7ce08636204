#include "runner/claims/operand.h"

#include <fmt/format.h>
#include <algorithm>
#include <cctype>

#include "runner/core/text.h"

namespace gfxrepro::claims {

namespace {

bool isNameStart(char c) {
    return std::isalpha(static_cast<unsigned char>(c)) || c == '_';
}
bool isNamePart(char c) {
    return isNameStart(c) || std::isdigit(static_cast<unsigned char>(c)) || c == '.';
}

/// The column whose label stands at the head of `text`, the longest of several.
std::optional<std::size_t> columnAt(std::string_view text, const tables::Table& table) {
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        const std::string& label = table.columns[i].label;
        const bool isWhole = text.starts_with(label) &&
                             (text.size() == label.size() || !isNamePart(text[label.size()]));
        const bool isNumber = parseDouble(label).has_value();
        if (!isWhole || label.empty() || isNumber) continue;
        if (!best || label.size() > table.columns[*best].label.size()) best = i;
    }
    return best;
}

/// The column whose label stands in quotes at the head of `text`.
std::optional<std::size_t> quotedColumnAt(std::string_view text, const tables::Table& table) {
    if (text.empty() || (text[0] != '\'' && text[0] != '"')) return std::nullopt;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        const std::string& label = table.columns[i].label;
        if (text.substr(1).starts_with(label + text[0])) return i;
    }
    return std::nullopt;
}

std::vector<std::string> labelsOf(const tables::Table& table) {
    std::vector<std::string> labels;
    for (const tables::TableColumn& column : table.columns) labels.push_back(column.label);
    return labels;
}

}  // namespace

Operand::Operand(const std::string& text, const tables::Table& table, const SourceLocation& where,
                 const std::string& owner)
    : text_(trimmed(text)) {
    const std::string expression = translated(table, where, owner);
    slots_.resize(columns_.size());
    try {
        for (std::size_t i = 0; i < columns_.size(); ++i) {
            parser_.DefineVar(fmt::format("v{}", i), &slots_[i]);
        }
        parser_.SetExpr(expression);
        parser_.Eval();
    } catch (const mu::Parser::exception_type& error) {
        throw Error(where, owner + ": '" + text_ + "' is no expression: " + error.GetMsg());
    }
}

std::string Operand::variableOf(std::size_t column) {
    const auto found = std::find(columns_.begin(), columns_.end(), column);
    const auto index = found - columns_.begin();
    if (found == columns_.end()) columns_.push_back(column);
    return fmt::format("v{}", index);
}

std::string Operand::translatedWord(std::string_view rest, std::size_t length,
                                    const tables::Table& table, const SourceLocation& where,
                                    const std::string& owner) const {
    const std::string word(rest.substr(0, length));
    const bool isNumber = parseDouble(word).has_value();
    const bool isWhole = word.size() == text_.size();
    const bool isCall = trimmed(rest.substr(length)).starts_with('(');
    const bool isName = isNameStart(word[0]) && !isCall;
    const std::vector<std::string> labels = labelsOf(table);
    if (isNumber && !isWhole && std::ranges::find(labels, word) != labels.end()) {
        throw AbsentColumnError(
            where, owner,
            fmt::format("'{0}' may be the column or the number (quoted it is the column; written "
                        "otherwise, as {0}.0, the number)",
                        word));
    }
    const bool areNumbers = std::ranges::any_of(
        labels, [](const std::string& label) { return parseDouble(label).has_value(); });
    if (isName || (isNumber && isWhole && areNumbers)) {
        throw AbsentColumnError(where, owner,
                                "'" + word + "' is no column" +
                                    (isNumber ? "" : suggestion(word, labels)) +
                                    " (columns: " + joined(labels) + ")");
    }
    return word;
}

std::string Operand::translated(const tables::Table& table, const SourceLocation& where,
                                const std::string& owner) {
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        if (table.columns[i].label == text_) return variableOf(i);
    }
    std::string expression;
    for (std::size_t i = 0; i < text_.size();) {
        const std::string_view rest = std::string_view(text_).substr(i);
        if (const auto column = quotedColumnAt(rest, table)) {
            expression += variableOf(*column);
            i += table.columns[*column].label.size() + 2;
            continue;
        }
        if (const auto column = columnAt(rest, table)) {
            expression += variableOf(*column);
            i += table.columns[*column].label.size();
            continue;
        }
        std::size_t length = 1;
        if (isNamePart(text_[i])) {
            while (i + length < text_.size() && isNamePart(text_[i + length])) ++length;
        }
        expression += translatedWord(rest, length, table, where, owner);
        i += length;
    }
    return expression;
}

double Operand::evaluate(std::span<const double> values) {
    std::copy(values.begin(), values.end(), slots_.begin());
    return parser_.Eval();
}

Sampled Operand::evaluate(const tables::TableRow& row, const std::string& statistic,
                          tables::Clock clock) {
    std::vector<Sampled> cells;
    std::vector<double> values;
    for (const std::size_t column : columns_) {
        const tables::Cell& cell = row.cells[column];
        const tables::Measured& measured =
            *cell.find(statistic, cell.isTime ? clock : tables::Clock::Wall);
        // A single round tells no more than the value.
        const bool hasRounds = measured.rounds.size() > 1;
        cells.push_back({measured.value, hasRounds ? measured.rounds : std::map<int, double>(),
                         measured.areDraws});
        values.push_back(measured.value);
    }
    std::vector<Sampled*> all;
    for (Sampled& cell : cells) all.push_back(&cell);
    Sampled result;
    result.point = evaluate(values);
    result.areDraws = keepRoundsOrDraws(all);
    for (const int round : commonRounds(cells)) {
        for (std::size_t i = 0; i < cells.size(); ++i) values[i] = cells[i].at(round);
        result.rounds[round] = evaluate(values);
    }
    return result;
}

bool keepRoundsOrDraws(std::span<Sampled* const> values) {
    const bool hasRounds = std::ranges::any_of(
        values, [](const Sampled* value) { return !value->rounds.empty() && !value->areDraws; });
    if (!hasRounds) return std::ranges::any_of(values, &Sampled::areDraws);
    for (Sampled* value : values) {
        if (value->areDraws) *value = {value->point, {}, false};
    }
    return false;
}

std::vector<int> commonRounds(std::span<const Sampled> values) {
    std::map<int, std::size_t> counts;
    std::size_t sampledCount = 0;
    for (const Sampled& sampled : values) {
        sampledCount += sampled.rounds.empty() ? 0 : 1;
        for (const auto& [round, value] : sampled.rounds) ++counts[round];
    }
    std::vector<int> rounds;
    for (const auto& [round, count] : counts) {
        if (count == sampledCount) rounds.push_back(round);
    }
    return rounds;
}

}  // namespace gfxrepro::claims
