// The arithmetic of claims: expressions over the columns of a table ("rasterization_ms + draw_ms").
#pragma once

#include <muParser.h>

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runner/core/error.h"
#include "runner/tables/table.h"

namespace gfxrepro::claims {

/// A value, and what it was in each round (none: it is taken as certain).
struct Sampled {
    double point = 0.0;
    std::map<int, double> rounds;
    bool areDraws = false;  // they are of shares that were counted once (share_draws.h)

    double at(int round) const { return rounds.empty() ? point : rounds.at(round); }
};

/// Where a value has rounds of its own, drops the draws of others: the two have nothing to do with
/// each other, and rounds tell more. Whether draws are left.
bool keepRoundsOrDraws(std::span<Sampled* const> values);

/// The rounds that all of them have but those that are certain.
std::vector<int> commonRounds(std::span<const Sampled> values);

/// A name that is no column of the table, or may be one: a profile or an override may have taken it
/// away, or brought a column that looks like a number.
class AbsentColumnError : public Error {
  public:
    AbsentColumnError(const SourceLocation& where, const std::string& owner,
                      const std::string& text)
        : Error(where, owner + ": " + text), text_(text) {}
    /// Without the place and the owner.
    const std::string& text() const { return text_; }

  private:
    std::string text_;
};

class Operand {
  public:
    /// Columns are written by their labels, whatever characters these have, also in quotes. In a
    /// table with columns that are numbers ("8"), a number that is the whole expression means a
    /// column, and one within an expression that is a label, too, could mean either: the column is
    /// written '8', the number 8.0. Throws Error at `where`, its message begun with `owner`, for
    /// bad syntax, and AbsentColumnError for a name that is no column, or may be one.
    Operand(const std::string& text, const tables::Table& table, const SourceLocation& where,
            const std::string& owner);
    Operand(Operand&&) = default;
    Operand& operator=(Operand&&) = delete;

    const std::string& text() const { return text_; }
    /// The table's columns that are read.
    const std::vector<std::size_t>& columns() const { return columns_; }
    /// `values` lies beside columns().
    double evaluate(std::span<const double> values);
    /// On the cells of a row, all of which must have the statistic by that clock; those that have
    /// none by the process's are no times. The rounds are those that all cells have; draws count
    /// only where no cell has rounds of its own.
    Sampled evaluate(const tables::TableRow& row, const std::string& statistic,
                     tables::Clock clock);

  private:
    std::string translated(const tables::Table& table, const SourceLocation& where,
                           const std::string& owner);
    /// The head of `rest`, a number or a name, as it stands in the expression.
    std::string translatedWord(std::string_view rest, std::size_t length,
                               const tables::Table& table, const SourceLocation& where,
                               const std::string& owner) const;
    std::string variableOf(std::size_t column);

    std::string text_;
    std::vector<std::size_t> columns_;
    std::vector<double> slots_;  // the parser points at them
    mu::Parser parser_;
};

}  // namespace gfxrepro::claims
