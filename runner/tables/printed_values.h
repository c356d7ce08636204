// Whether what a paper printed has its place in the table.
#pragma once

#include <span>

#include "runner/config/experiment.h"
#include "runner/tables/table.h"

namespace gfxrepro::tables {

/// Throws Error, at its line, for a printed row that none of `tables` measures, and for a printed
/// value that is not written as its cell's format writes numbers. `experiment` is the file as it
/// stands; the tables are of that and of its profiles, and may have been built from no records.
void requirePrintedValues(const config::Experiment& experiment, std::span<const Table> tables);

}  // namespace gfxrepro::tables
