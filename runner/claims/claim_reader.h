// Reads the values that a claim is about off a table.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runner/claims/judge.h"
#include "runner/tables/expression.h"
#include "runner/tables/table.h"

namespace gfxrepro::claims {

using Rows = std::vector<std::size_t>;

using tables::AbsentColumnError;
using tables::ExpressionError;
using tables::Operand;

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
    /// Why `part` could not read the group, whatever was measured; empty where it could.
    std::string whyUnread(const ClaimPart& part, const Rows& rows) const;

    /// Reads times by the process's CPU time from now on; false, and nothing is changed, where one
    /// of them was not recorded by it.
    bool readByProcess();
    tables::Clock clock() const { return clock_; }

    /// The labels that the rows share: "scene=models/duck".
    std::string groupName(const Rows& rows) const;
    /// The name of the one scene that the rows are of; empty of several, or of a table without the
    /// row axis `scene`.
    std::string sceneOf(const Rows& rows) const;

    /// Those of `rows` whose scene could not be fitted to what is printed, where the claim is of
    /// the document or read off it.
    Rows unfitOf(const Rows& rows) const;

    /// The rows that `at` leaves.
    Rows rows() const;
    /// Whether the table has a row for it.
    bool readsAny() const { return !rows().empty(); }
    /// "no row is of {m: a, n: 2}; there are: {m: a}, {m: b, n: 2}"; empty where there is one.
    std::string whyNoRow() const;
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
    bool readsOnly(std::string_view metric) const;
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
    Rows rowsOrAll() const;
    bool readsSome(const std::function<bool(const tables::Cell&)>& isSuch, const Rows& rows) const;
    std::size_t rowAxis(const std::string& name, const char* key) const;
    std::vector<bool> axesAlongX();
    std::optional<double> expected(std::size_t operand, std::size_t row);
    std::optional<double> growthAsTimesDouble(Operand& operand, std::size_t row, double base);
    /// Empty if the operand can be read; else why not.
    std::string problemOf(const Operand& operand, std::size_t row) const;
    bool isPlanned(const ClaimPart& part, std::size_t row) const;
    struct TimeCell {
        std::size_t row, column;
        const tables::Cell* cell;
    };
    /// The cells of times that are read and ok.
    std::vector<TimeCell> timePlaces() const;
    Sampled abscissa(std::size_t row);

    const ClaimSpec& claim_;
    const tables::Table& table_;
    std::vector<Operand> operands_;
    std::optional<std::size_t> overAxis_;
    std::vector<Operand> overColumn_;  // one, or none
    tables::Clock clock_ = tables::Clock::Wall;
};

}  // namespace gfxrepro::claims
