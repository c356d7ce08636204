// Reads the values that a claim is about off a table.
#pragma once

#include <muParser.h>

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/core/error.h"
#include "runner/claims/judge.h"
#include "runner/tables/table.h"

namespace gfxrepro::claims {

using Rows = std::vector<std::size_t>;

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

/// What no table makes readable: bad syntax, or a claim that reads no column.
class ExpressionError : public Error {
  public:
    using Error::Error;
};

/// The arithmetic of claims: an expression over the columns of a table ("rasterization_ms +
/// draw_ms").
class Operand {
  public:
    /// Columns are written as operandPieces() reads them. Throws ExpressionError at `where`, its
    /// message begun with `owner`, for bad syntax, and AbsentColumnError for a name that is no
    /// column, or may be one.
    Operand(const std::string& text, const tables::Table& table, const SourceLocation& where,
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
    Sampled evaluate(const tables::TableRow& row, tables::Clock clock);

  private:
    bool isColumn_ = false;
    std::vector<std::size_t> columns_;
    std::vector<double> slots_;  // the parser points at them
    mu::Parser parser_;
};

/// The table as the claim reads it: with `across`, rows for columns. Throws Error at the claim's
/// place for an axis that it does not have.
tables::Table tableFor(const ClaimSpec& claim, const tables::Table& table);

bool isCalibrated(const tables::Cell& cell);

/// A claim made ready to be read off a table.
class ClaimReader {
  public:
    /// `table` is that of tableFor(). Throws Error with the claim's place for operands and axes
    /// that it does not have, and ExpressionError for operands that are none, or read no column.
    /// The claim and the table must outlive the reader.
    ClaimReader(const ClaimSpec& claim, const tables::Table& table);

    /// The rows that `at` leaves, parted into the groups that the claim is judged in.
    std::vector<Rows> groups();
    /// What `part` reads of a group, or why it cannot be read. Rows that the sweep does not have,
    /// or whose printed number is lost, are passed over.
    struct Reading {
        Group group;
        Rows rows;  // those that were read
        std::string problem;
    };
    Reading read(const ClaimPart& part, const Rows& rows);

    /// Reads times by the process's CPU time from now on; false, and nothing is changed, where one
    /// of them was not recorded by it.
    bool readByProcess();
    tables::Clock clock() const { return clock_; }

    /// The labels that the rows share: "scene=models/duck".
    std::string groupName(const Rows& rows) const;

    /// Whether the table has a row for it.
    bool readsAny() const { return !rows().empty(); }
    /// Whether it reads a time that was measured.
    bool hasTimes() const { return !timePlaces().empty(); }
    /// The table's columns, before rows took their place, in which the times stand that it reads.
    std::vector<std::string> timeColumns() const;
    /// Whether all times that it reads were measured at what the paper measured at.
    bool isAtPrintedParameters() const;
    /// Whether some cell that it may read is a time or a rate of time; of all rows, where `at`
    /// leaves none in this profile.
    bool readsTime() const;
    /// What decides a claim about time: as it says; times as such, where it holds one against a
    /// number; else nothing is known.
    std::optional<ClaimSpec::TimeKind> timeKind();
    /// Whether some cell that it may read is such.
    bool readsSome(const std::function<bool(const tables::Cell&)>& isSuch) const {
        return readsSome(isSuch, rows());
    }
    /// Whether its operands are columns alone, no arithmetic, and show that metric as recorded.
    bool readsOnly(const std::string& metric) const;
    /// The rows of which the sweep has what some part of it reads.
    Rows plannedRows() const;
    /// How many rows it reads.
    std::size_t rowCount() const { return rows().size(); }
    /// A label along `over` that is no number, where a trend or a crossing needs numbers.
    std::optional<std::string> wordAlongOver() const;
    /// Whether what it reads is a column, and `over` or `of` is the same.
    bool isOverItself() const;
    /// Whether all cells that it may read are marked as calibrated.
    bool readsCalibrated() const;
    /// Whether what it asks could come out otherwise on a machine on which every time is twice as
    /// long: a time held against a number, or compared with what is no time.
    bool asksForATimeAsSuch();

  private:
    [[noreturn]] void fail(const std::string& message) const {
        throw Error(claim_.location, "claim '" + claim_.id + "': " + message);
    }
    Rows rows() const;
    Rows rowsOrAll() const;
    bool readsSome(const std::function<bool(const tables::Cell&)>& isSuch, const Rows& rows) const;
    std::size_t rowAxis(const std::string& name, const char* key) const;
    std::vector<bool> axesAlongX();
    std::optional<double> expected(std::size_t operand, std::size_t row);
    std::optional<double> growthAsTimesDouble(Operand& operand, std::size_t row, double base);
    /// Empty if the operand can be read; else why not.
    std::string problemOf(const Operand& operand, std::size_t row) const;
    bool isPlanned(const ClaimPart& part, std::size_t row) const;
    struct Place {
        std::size_t row, column;
        const tables::Cell* cell;
    };
    /// The cells of times that are read and ok.
    std::vector<Place> timePlaces() const;
    Sampled abscissa(std::size_t row);

    const ClaimSpec& claim_;
    const tables::Table& table_;
    std::vector<Operand> operands_;
    std::optional<std::size_t> overAxis_;
    std::vector<Operand> overColumn_;  // one, or none
    tables::Clock clock_ = tables::Clock::Wall;
};

}  // namespace gfxrepro::claims
