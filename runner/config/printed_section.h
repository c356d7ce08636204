// `fit:` — columns of a table that are held against printed cells of other tables: a calibration;
// and what the other tables say of such cells (`printed.calibrated`).
#pragma once

#include <string>
#include <vector>

#include "runner/config/experiment.h"

namespace gfxrepro::config {

/// The text of `printed.values`, which is there.
const Node& printedValuesOf(const Node& document);

/// A column and the number that it is held against.
struct FitTarget {
    std::string column;
    std::string table;  // "xie2017/2": where the number is printed
    double printed = 0.0;
};

/// The `fit:` of an experiment; empty where it has none.
std::vector<FitTarget> fitTargets(const Experiment& experiment);

/// Whether the table says of the cell that an input of ours was fitted so that it comes out
/// (`printed.calibrated`). `row` has the labels beside the row axes.
bool isCalibrated(const Experiment& table, const std::vector<std::string>& row,
                  const std::string& column);

/// The file of the table that the entry of `fit` at a column names; `where` that column stands.
/// Throws Error for an entry with other keys, or without one of its own.
const Node& tableOfFit(const Node& entry, const SourceLocation& where, const std::string& column);

/// Such an entry with the printed number that it names, of `table`. So no other number of the
/// table reaches the experiment. Throws Error for a cell that is not there, is of another measure
/// than the column, or of another method than the fit's cases: what compares methods is not seen;
/// and for one that its table does not mark as calibrated.
Node withPrintedCell(const Node& entry, const std::string& column, const Experiment& fit,
                     const Experiment& table);

}  // namespace gfxrepro::config
