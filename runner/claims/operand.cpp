#include "runner/claims/operand.h"

#include <fmt/format.h>
#include <algorithm>

#include "engine/core/text.h"
#include "runner/config/claim_operands.h"

namespace gfxrepro::claims {

namespace {

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

std::string Operand::translated(const tables::Table& table, const SourceLocation& where,
                                const std::string& owner) {
    std::string expression;
    const std::vector<std::string> labels = labelsOf(table);
    const std::vector<config::OperandPiece> pieces = config::operandPieces(text_, labels);
    isColumn_ = pieces.size() == 1 && pieces[0].column.has_value();
    for (const config::OperandPiece& piece : pieces) {
        if (!piece.problem.empty()) throw AbsentColumnError(where, owner, piece.problem);
        expression += piece.column ? variableOf(*piece.column) : std::string(piece.text);
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
