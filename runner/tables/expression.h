// Expressions over the cells of a row: what claims compute, and columns that are computed of
// others.
#pragma once

#include <muParser.h>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "engine/core/error.h"
#include "runner/config/experiment.h"
#include "runner/tables/summary.h"
#include "runner/tables/table.h"

namespace gfxrepro::tables {

/// A value, and what it was in each round (none: it is taken as certain).
struct Sampled {
    double point = 0.0;
    std::map<int, double> rounds;
    bool areDraws = false;  // they are of shares that were counted once (shareDraws)
    bool isRandom = false;  // another seed would give another value: it has no rounds of one seed
    std::size_t seedCount = 0;       // as Cell::seedCount
    bool scatters = false;           // as Cell::scatters; it is random, too
    bool isOnce = false;             // a time, of one process: others of which differ
    std::string onceAlong = {};      // as Cell::onceAlong; it is random, too, and has no rounds
    std::string overProcesses = {};  // of "mean", "max", …: Summary::isOverProcesses
    bool isRunOnce = false;          // as Cell::isRunOnce
    double halfStep = 0.0;           // as Summary::halfStep

    double at(int round) const { return rounds.empty() ? point : rounds.at(round); }
};

/// Where a value has rounds of its own, drops the draws of others: the two have nothing to do with
/// each other, and rounds tell more. Whether draws are left.
bool keepRoundsOrDraws(std::span<Sampled* const> values);

/// The rounds that all of them have but those that are certain.
std::vector<int> commonRounds(std::span<const Sampled> values);

/// What is no expression over the table's columns.
class OperandError : public Error {
  public:
    OperandError(const SourceLocation& where, const std::string& owner, const std::string& text)
        : Error(where, owner + ": " + text), text_(text) {}
    /// Without the place and the owner.
    const std::string& text() const { return text_; }

  private:
    std::string text_;
};

/// A name that is no column of the table, or may be one: a profile or an override may have taken it
/// away, or brought a column that looks like a number; and of a table without columns what may be
/// one of any name.
class AbsentColumnError : public OperandError {
  public:
    using OperandError::OperandError;
};

/// What no table makes readable: bad syntax, or a claim that reads no column.
class ExpressionError : public OperandError {
  public:
    using OperandError::OperandError;
};

/// The arithmetic of claims and of columns: an expression over the columns of a table
/// ("rasterization_ms + draw_ms").
class Operand {
  public:
    /// Columns are written as operandPieces() reads them. Throws ExpressionError at `where`, its
    /// message begun with `owner`, for bad syntax, and AbsentColumnError for a name that is no
    /// column, or may be one.
    Operand(const std::string& text, const Table& table, const SourceLocation& where,
            const std::string& owner);
    Operand(Operand&&) = default;
    Operand& operator=(Operand&&) = delete;

    /// Whether it is a column as it stands, without arithmetic.
    bool isColumn() const { return isColumn_; }
    /// The table's columns that are read.
    const std::vector<std::size_t>& columns() const { return columns_; }
    /// `values` lies beside columns().
    double evaluate(std::span<const double> values);
    /// On the cells of a row, all of which must be measured by that clock; those that have
    /// none by the process's are no times. The rounds are those that all cells have; draws count
    /// only where no cell has rounds of its own.
    /// Of each cell the statistic of that name, or its first.
    Sampled evaluate(const TableRow& row, Clock clock, const std::string& statistic = "");
    /// As evaluate(), but 0 where that is no more than what the values' rounding comes to.
    double withoutRounding(std::span<const double> values);

  private:
    /// How far from its own the result may lie as rounded cells do.
    double halfStep(std::span<const Sampled> cells);

    bool isColumn_ = false;
    std::vector<std::size_t> columns_;
    std::vector<double> slots_;  // the parser points at them
    mu::Parser parser_;
};

/// Fills the columns of `layout` that have an expression (Selection::of), once all others have
/// their cells. In each process the value is that of the cells that it reads there, and its bounds
/// are of these values: what slows a whole process falls out of a ratio. A cell is as good as the
/// worst that it reads. Throws ExpressionError at the column's place for bad syntax.
void fillComputed(const config::Layout& layout, Table& table);

/// A case on the curve: the other metric, and the cell's own.
struct CurvePoint {
    Sampled x, y;
};

/// The curve's value where x is `at`, in the order of the points: interpolated between the two
/// beside it, on logarithmic scales where all are positive, and so in each round. Not-a-number
/// where the curve does not come by in each round, or does so at several places, as which is meant
/// nobody can tell.
Summary readCurve(std::span<const CurvePoint> curve, double at);

/// Why it has none there; `metric` is that of x.
std::string whyNoValue(std::span<const CurvePoint> curve, const std::string& metric, double at);

}  // namespace gfxrepro::tables
