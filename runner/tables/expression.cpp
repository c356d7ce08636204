#include "runner/tables/expression.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "engine/core/text.h"
#include "engine/metrics/alike.h"
#include "runner/claims/kinds/operands.h"
#include "runner/tables/case_records.h"
#include "runner/tables/cell_format.h"
#include "runner/tables/labels.h"

namespace gfxrepro::tables {

using claims::OperandPiece;
using claims::operandPieces;

bool keepRoundsOrDraws(std::span<Sampled* const> values) {
    const bool hasRounds = std::ranges::any_of(
        values, [](const Sampled* value) { return !value->rounds.empty() && !value->areDraws; });
    if (!hasRounds) return std::ranges::any_of(values, &Sampled::areDraws);
    for (Sampled* value : values) {
        if (value->areDraws) {
            value->rounds.clear();
            value->areDraws = false;
        }
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

Operand::Operand(const std::string& text, const Table& table, const SourceLocation& where,
                 const std::string& owner) {
    const std::string whole(trimmed(text));
    std::vector<std::string> labels;
    for (const TableColumn& column : table.columns) labels.push_back(column.label);
    const std::vector<OperandPiece> pieces = operandPieces(whole, labels);
    isColumn_ = pieces.size() == 1 && pieces[0].column.has_value();
    std::string expression;  // with a variable for each column
    for (const OperandPiece& piece : pieces) {
        const bool isBad = piece.isFunction && !labels.empty();
        if (isBad) throw ExpressionError(where, owner, piece.problem);
        if (!piece.problem.empty()) throw AbsentColumnError(where, owner, piece.problem);
        if (!piece.column) {
            if (piece.text == "(") expression.erase(trimmed(expression).size());  // of a call
            expression += piece.text;
            continue;
        }
        const auto found = std::ranges::find(columns_, *piece.column);
        expression += fmt::format("v{}", found - columns_.begin());
        if (found == columns_.end()) columns_.push_back(*piece.column);
    }
    slots_.resize(columns_.size());
    try {
        for (std::size_t i = 0; i < columns_.size(); ++i) {
            parser_.DefineVar(fmt::format("v{}", i), &slots_[i]);
        }
        parser_.SetExpr(expression);
        parser_.Eval();
    } catch (const mu::Parser::exception_type& error) {
        std::string message = error.GetMsg();
        for (std::size_t i = 0; i < columns_.size(); ++i) {
            const std::string variable = fmt::format("\"v{}\"", i);
            const std::size_t at = message.find(variable);
            if (at == message.npos) continue;
            message.replace(at, variable.size(), '"' + labels[columns_[i]] + '"');
        }
        message = fmt::format("'{}' is no expression: {}", whole, message);
        if (labels.empty()) throw AbsentColumnError(where, owner, message);
        throw ExpressionError(where, owner, message);
    }
}

double Operand::evaluate(std::span<const double> values) {
    std::copy(values.begin(), values.end(), slots_.begin());
    return parser_.Eval();
}

double Operand::withoutRounding(std::span<const double> values) {
    const double result = evaluate(values);
    if (isColumn_ || result == 0.0 || !std::isfinite(result)) return result;
    std::vector<double> others(values.begin(), values.end());
    double rounding = 0.0;
    for (std::size_t i = 0; i < others.size(); ++i) {
        others[i] = metrics::roundedOtherwise(values[i]);
        rounding += std::abs(evaluate(others) - result);
        others[i] = values[i];
    }
    return std::isfinite(rounding) && std::abs(result) <= rounding ? 0.0 : result;
}

double Operand::halfStep(std::span<const Sampled> cells) {
    std::vector<double> values;
    for (const Sampled& cell : cells) values.push_back(cell.point);
    const double result = evaluate(values);
    double reach = 0.0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (cells[i].halfStep == 0.0) continue;
        double farthest = 0.0;
        for (const double side : {-1.0, 1.0}) {
            values[i] = cells[i].point + side * cells[i].halfStep;
            farthest = std::max(farthest, std::abs(evaluate(values) - result));
        }
        values[i] = cells[i].point;
        reach += farthest;
    }
    return reach;
}

Sampled Operand::evaluate(const TableRow& row, Clock clock, const std::string& statistic) {
    Sampled result;
    std::vector<Sampled> cells;
    std::vector<double> values;
    for (const std::size_t column : columns_) {
        const Cell& cell = row.cells[column];
        const Clock own = cell.isTime ? clock : Clock::Wall;
        const Measured* named = cell.find(statistic, own);
        const Measured& measured = named ? *named : *cell.find("", own);
        // A single round tells no more than the value.
        const bool isOnceAlong = !cell.onceAlong.empty();
        const bool hasRounds = measured.rounds.size() > 1 && !isOnceAlong;
        cells.push_back({measured.value, hasRounds ? measured.rounds : std::map<int, double>(),
                         measured.areDraws, cell.seedCount > 0 || cell.scatters || isOnceAlong,
                         cell.seedCount, cell.scatters, cell.isTime && !hasRounds, cell.onceAlong,
                         measured.isOverProcesses ? measured.statistic : "", cell.isRunOnce,
                         measured.halfStep});
        values.push_back(measured.value);
        result.seedCount = fewerSeeds(result.seedCount, cell.seedCount);
    }
    std::vector<Sampled*> all;
    for (Sampled& cell : cells) all.push_back(&cell);
    result.point = withoutRounding(values);
    result.areDraws = keepRoundsOrDraws(all);
    result.isRandom = std::ranges::any_of(cells, &Sampled::isRandom);
    result.scatters = std::ranges::any_of(cells, &Sampled::scatters);
    result.isRunOnce = std::ranges::any_of(cells, &Sampled::isRunOnce);
    result.isOnce = std::ranges::any_of(cells, &Sampled::isOnce);
    result.halfStep = halfStep(cells);
    for (const Sampled& cell : cells) {
        if (result.overProcesses.empty()) result.overProcesses = cell.overProcesses;
        if (result.onceAlong.empty()) result.onceAlong = cell.onceAlong;
    }
    // One sample of a part is one of the whole, however often the rest was measured.
    const auto isOne = [](const Sampled& cell) {
        return (cell.isRandom || cell.isOnce) && cell.rounds.empty();
    };
    if (!result.overProcesses.empty() || std::ranges::any_of(cells, isOne)) return result;
    for (const int round : commonRounds(cells)) {
        for (std::size_t i = 0; i < cells.size(); ++i) values[i] = cells[i].at(round);
        result.rounds[round] = withoutRounding(values);
    }
    return result;
}

// Columns of other columns.

namespace {

/// A cell of another row: "time[method=slices]".
struct Elsewhere {
    std::size_t column;
    std::vector<std::pair<std::size_t, std::string>> at;  // row axis, label
    std::string name;                                     // "method=slices"
};

std::vector<Elsewhere> elsewhereIn(const std::string& expression, const Table& table,
                                   std::vector<std::string>& labels) {
    std::vector<Elsewhere> all;
    for (const claims::RowReference& reference : claims::rowReferences(expression, labels)) {
        Elsewhere& one = all.emplace_back();
        one.column = reference.column;
        for (const auto& [axis, value] : reference.at) {
            const auto found = std::ranges::find(table.rowAxes, axis);
            GFXREPRO_ASSERT(found != table.rowAxes.end());  // the layout's reader has looked
            one.at.emplace_back(found - table.rowAxes.begin(), canonicalCell(value));
            one.name += (one.name.empty() ? "" : ", ") + axis + "=" + one.at.back().second;
        }
        labels.emplace_back(reference.text);
    }
    return all;
}

/// What stands there for the row: the cell of the row that has these labels and is alike otherwise.
Cell cellElsewhere(const Elsewhere& place, const TableRow& row, const Table& table) {
    std::vector<std::string> labels = row.labels;
    for (const auto& [axis, label] : place.at) labels[axis] = label;
    const auto found = std::ranges::find(table.rows, labels, &TableRow::labels);
    if (found != table.rows.end()) return found->cells[place.column];
    // A baseline without the others' parameters is one for all of their values.
    for (const auto& [axis, label] : place.at) {
        for (std::size_t other = 0; other < labels.size(); ++other) {
            if (other != axis) labels[other] = kLeftOut;
        }
    }
    const auto plain = std::ranges::find(table.rows, labels, &TableRow::labels);
    if (plain != table.rows.end()) return plain->cells[place.column];
    Cell missing;
    missing.isNowhere = true;
    missing.message = "this run has no row " + place.name;
    return missing;
}

/// What the expression does as all times double, as a power of two.
int powerOf(Operand& operand, const TableRow& row) {
    std::vector<double> before, after;
    double base = 1.0;
    for (const std::size_t column : operand.columns()) {
        base *= 1.7;  // no two alike: their difference is no 0
        before.push_back(base);
        after.push_back(std::ldexp(base, row.cells[column].timePower));
    }
    const double exponent = std::log2(operand.evaluate(after) / operand.evaluate(before));
    return std::isfinite(exponent) ? static_cast<int>(std::lround(exponent)) : 0;
}

/// Whether cells are added, taken away and chosen from alone: what comes out is of their unit.
bool isSumOf(const std::string& expression, std::span<const std::string> labels) {
    static const std::set<std::string, std::less<>> kKeepUnit = {"",  "+",   "-",   "(",  ")",
                                                                 ",", "min", "max", "abs"};
    return std::ranges::all_of(operandPieces(expression, labels), [](const OperandPiece& piece) {
        return piece.column.has_value() || kKeepUnit.contains(trimmed(piece.text));
    });
}

/// Why the cells do not give these values: one of them has not the statistic, or they divide by 0.
std::string problemOf(const std::vector<const Cell*>& read, const CellFormat& format,
                      const std::vector<Measured>& values) {
    const auto isFinite = [](const Measured& measured) { return std::isfinite(measured.value); };
    for (const CellFormat::Placeholder& placeholder : format.placeholders()) {
        for (const Cell* one : read) {
            if (one->find(placeholder.name)) continue;
            return fmt::format("a cell that it reads shows '{}' and no '{}'",
                               one->values[0].statistic, placeholder.name);
        }
    }
    const bool areFinite = std::ranges::all_of(
        read, [&](const Cell* one) { return std::ranges::all_of(one->values, isFinite); });
    return areFinite && !std::ranges::all_of(values, isFinite) ? "no number comes out" : "";
}

std::vector<Measured> computedValues(Operand& operand, const TableRow& row,
                                     const CellFormat& format, Clock clock) {
    std::vector<Measured> values;
    for (const CellFormat::Placeholder& placeholder : format.placeholders()) {
        const Sampled sampled = operand.evaluate(row, clock, placeholder.name);
        Measured& measured = values.emplace_back();
        static_cast<Summary&>(measured) =
            summaryOf(sampled.point, sampled.rounds, sampled.areDraws);
        measured.isOverProcesses = !sampled.overProcesses.empty();
        measured.halfStep = sampled.halfStep;
        measured.statistic = placeholder.name;
    }
    return values;
}

/// What a cell has of the cells that it reads, but for its values.
void gatherFrom(const Cell& from, Cell& cell) {
    if (from.status > cell.status) {
        cell.status = from.status;
        cell.message = from.message;
    }
    cell.isCalibrated |= from.isCalibrated;
    cell.isOwnTruth |= from.isOwnTruth;
    cell.isNowhere |= from.isNowhere;
    cell.scatters |= from.scatters;
    cell.isRunOnce |= from.isRunOnce;
    if (cell.onceAlong.empty()) cell.onceAlong = from.onceAlong;
    cell.isAtPrintedParameters &= from.isAtPrintedParameters;
    const auto add = [](const auto& items, auto& all) {
        for (const auto& item : items) {
            if (std::ranges::find(all, item) == all.end()) all.push_back(item);
        }
    };
    add(from.caseIds, cell.caseIds);
    add(from.openParameters, cell.openParameters);
    add(from.departures, cell.departures);
    add(from.pooled, cell.pooled);
}

/// `row` has the cells that the operand reads. `isSum`: of their unit.
void fillComputedCell(Operand& operand, const TableRow& row, const CellFormat& format, bool isSum,
                      Cell& cell) {
    std::vector<const Cell*> read;
    for (const std::size_t column : operand.columns()) read.push_back(&row.cells[column]);
    cell.isTime = std::ranges::any_of(read, &Cell::isTime);
    cell.timePower = powerOf(operand, row);
    cell.isPlanned = std::ranges::all_of(read, &Cell::isPlanned);
    cell.isUnrecorded = std::ranges::any_of(read, &Cell::isUnrecorded);
    if (!cell.isPlanned) return;
    cell.status = records::Status::Ok;
    cell.isAtPrintedParameters = true;
    for (const Cell* one : read) gatherFrom(*one, cell);
    const bool isMeasured =
        std::ranges::none_of(read, [](const Cell* one) { return one->values.empty(); });
    if (!isMeasured) {
        cell.isAtPrintedParameters = false;
        writeStatus(records::statusName(cell.status), cell);
        return;
    }
    cell.seedCount = operand.evaluate(row, Clock::Wall).seedCount;
    cell.values = computedValues(operand, row, format, Clock::Wall);
    if (const std::string problem = problemOf(read, format, cell.values); !problem.empty()) {
        cell.status = records::Status::Missing;
        cell.message = problem;
        cell.values.clear();
        writeStatus(records::statusName(cell.status), cell);
        return;
    }
    const bool hasProcessTimes = std::ranges::all_of(
        read, [](const Cell* one) { return !one->isTime || !one->byProcess.empty(); });
    if (cell.isTime && hasProcessTimes) {
        cell.byProcess = computedValues(operand, row, format, Clock::Process);
    }
    std::set<std::string> units;
    for (const Cell* one : read) units.insert(one->unit);
    if (isSum && units.size() == 1) cell.unit = *units.begin();
    writeValues(format, cell);
    writeStatus(records::statusName(cell.status), cell);
}

}  // namespace

void fillComputed(const config::Layout& layout, Table& table) {
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        const config::Selection* selection = layout.computed(table.columns[i].label);
        if (!selection) continue;
        const CellFormat format(selection->format.value_or(*layout.cell.format),
                                selection->location);
        Table reading;  // the columns before it, and what it reads of other rows
        reading.columns.assign(table.columns.begin(),
                               table.columns.begin() + static_cast<std::ptrdiff_t>(i));
        std::vector<std::string> labels;
        for (const TableColumn& column : reading.columns) labels.push_back(column.label);
        const std::vector<Elsewhere> elsewhere = elsewhereIn(*selection->of, table, labels);
        for (std::size_t k = i; k < labels.size(); ++k) reading.columns.push_back({labels[k], ""});
        Operand operand(*selection->of, reading, selection->location,
                        "column '" + table.columns[i].label + "'");
        const bool isSum = isSumOf(*selection->of, labels);
        std::set<std::string> units;
        for (TableRow& row : table.rows) {
            TableRow cells{row.labels,
                           row.source,
                           {row.cells.begin(), row.cells.begin() + static_cast<std::ptrdiff_t>(i)}};
            for (const Elsewhere& place : elsewhere) {
                cells.cells.push_back(cellElsewhere(place, row, table));
            }
            fillComputedCell(operand, cells, format, isSum, row.cells[i]);
            if (!row.cells[i].values.empty()) units.insert(row.cells[i].unit);
        }
        if (units.size() == 1) table.columns[i].unit = *units.begin();
    }
}

namespace {

/// Whether one of the values is no logarithm's.
bool isLinear(std::span<const std::pair<double, double>> points, double at) {
    return at <= 0.0 || std::ranges::any_of(points, [](const auto& point) {
               return point.first <= 0.0 || point.second <= 0.0;
           });
}

/// Of one round.
double readAt(std::span<const std::pair<double, double>> points, double at) {
    const bool isPlain = isLinear(points, at);
    const auto scaled = [&](double value) { return isPlain ? value : std::log(value); };
    std::set<double> values;
    for (std::size_t i = 1; i < points.size(); ++i) {
        const auto [x0, y0] = points[i - 1];
        const auto [x1, y1] = points[i];
        if (at < std::min(x0, x1) || at > std::max(x0, x1)) continue;
        if (x0 == x1) {
            values.insert({y0, y1});
            continue;
        }
        if (at == x0 || at == x1) {
            values.insert(at == x0 ? y0 : y1);
            continue;
        }
        const double share = (scaled(at) - scaled(x0)) / (scaled(x1) - scaled(x0));
        const double value = std::lerp(scaled(y0), scaled(y1), share);
        values.insert(isPlain ? value : std::exp(value));
    }
    return values.size() == 1 ? *values.begin() : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

Summary readCurve(std::span<const CurvePoint> curve, double at) {
    std::vector<Sampled> all;
    std::vector<std::pair<double, double>> points;
    for (const CurvePoint& point : curve) {
        all.insert(all.end(), {point.x, point.y});
        points.emplace_back(point.x.point, point.y.point);
    }
    const double value = readAt(points, at);
    std::map<int, double> rounds;
    const bool isOver = std::ranges::any_of(
        all, [](const Sampled& sampled) { return !sampled.overProcesses.empty(); });
    for (const int round : isOver ? std::vector<int>() : commonRounds(all)) {
        points.clear();
        for (const CurvePoint& point : curve) {
            points.emplace_back(point.x.at(round), point.y.at(round));
        }
        rounds[round] = readAt(points, at);
    }
    const bool isThere =
        std::ranges::all_of(rounds, [](const auto& round) { return std::isfinite(round.second); });
    if (!isThere || !std::isfinite(value))
        return summaryOf(std::numeric_limits<double>::quiet_NaN(), {}, false);
    Summary summary = summaryOf(value, std::move(rounds), false);
    summary.isOverProcesses = isOver;
    return summary;
}

std::string whyNoValue(std::span<const CurvePoint> curve, const std::string& metric, double at) {
    const auto [low, high] =
        std::ranges::minmax(curve, {}, [](const CurvePoint& point) { return point.x.point; });
    if (low.x.point <= at && at <= high.x.point) {
        return fmt::format("'{}' passes {:.4g} more than once, or not in every process", metric,
                           at);
    }
    return fmt::format("'{}' goes from {:.4g} to {:.4g} and does not reach {:.4g}", metric,
                       low.x.point, high.x.point, at);
}

}  // namespace gfxrepro::tables
