// A calibration's outcome: which row of a table comes nearest to the printed cells that its columns
// are held against (`fit:`).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runner/config/printed_section.h"
#include "runner/tables/table.h"

namespace gfxrepro::tables {

/// A row of the grid, by how far its cells are from the printed ones.
struct FitRow {
    std::size_t row = 0;            // of the table
    std::vector<double> residuals;  // measured − printed, beside the targets; in the cells' unit
    double rms = 0.0;               // root mean square, of shares in log-odds, else in logarithms
};

struct Fit {
    std::vector<config::FitTarget> targets;
    std::vector<FitRow> rows;  // of those whose cells are all measured; best first
    /// "view_distance 0.55 of 0.55 to 1": axes of which the best row has the least or the greatest
    /// number that was measured, so that a better one may lie beyond.
    std::vector<std::string> edges;
    std::size_t unmeasured = 0;  // rows without one of the cells
};

/// Of the table of `experiment`; without targets where it has no `fit`.
Fit fitOf(const config::Experiment& experiment, const Table& table);

/// What a page says of it: the best row, printed beside measured, whether it lies at the edge of
/// the grid, and the second best.
std::vector<std::string> fitNotes(const Fit& fit, const Table& table);

/// The log-odds ln(p / (100 − p)) of a share in %: one of 98 % and one of 99 are as far apart as
/// one of 2 and one of 1, as they are by what is missing. All and nothing count as a hundredth of a
/// percent from it, which is as fine as shares are printed.
double logOdds(double pct);
/// A fit whose root mean square is greater has failed: what is missing, or what is wrong, is off by
/// more than a quarter. It holds for log-odds and for logarithms.
inline constexpr double kFitBound = 0.25;

/// The best row, a line a target: row axes, column, table, printed, measured, residual (in the
/// column's unit), rms with its unit, edges.
/// Empty without a best row.
std::string fitCsv(const Fit& fit, const Table& table);

/// What kept calibrations (`folder`/<scene>.csv, as `fitCsv` writes them) say on the page of each
/// table whose printed cells they read: what was fitted, printed beside measured, and the grid's
/// edges. Empty where there is no folder. Throws Error for a file of another kind.
TableNotes keptCalibrations(const std::filesystem::path& folder);
/// Puts notes below the tables that they are about.
void addNotes(const TableNotes& about, std::vector<Table>& tables);

/// tables/<slug>.fit.csv of each experiment with a fit; `tables` lies beside `experiments`.
void writeFits(const std::filesystem::path& runDir,
               const std::vector<config::Experiment>& experiments,
               const std::vector<Table>& tables);

}  // namespace gfxrepro::tables
