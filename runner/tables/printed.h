// What a paper printed: its values beside what was measured, and the parameters at which both were
// measured.
#pragma once

#include <set>
#include <span>
#include <string>
#include <vector>

#include "runner/config/experiment.h"
#include "runner/tables/labels.h"
#include "runner/tables/table.h"

namespace gfxrepro::tables {

/// Gives the cells of the table what `printed` has for their row and column. Printed rows that it
/// does not have become its `printedRows`; its notes name printed columns that it does not have.
void layPrintedBeside(const config::Experiment& experiment, Table& table);
/// Of a table without a measurement: the first column for the rows.
void layPrintedAlone(const config::Printed& printed, Table& table);

/// Throws Error, at its line, for a printed row that none of `tables` measures, and for a printed
/// value that is not written as its cell's format writes numbers. `experiment` is the file as it
/// stands; the tables are of that and of its profiles, and may have been built from no records.
void requirePrintedValues(const config::Experiment& experiment, std::span<const Table> tables);

/// At what the paper measured behind each cell.
///
/// What is printed stands for the cases of the profile `paper`, with `printed.at` laid over them. A
/// cell is at the printed parameters where the cases behind it are these cases: the same parameters
/// of the technique (defaults resolved), size of the output, frames and scene. Not compared: how
/// often and where a case runs, and the parameter `pictures`, by which techniques save pictures
/// beside their numbers. What an assumption names and `printed.at` does not say is open in the
/// document: a cell without a departure is at the printed parameters as far as they are given. A
/// departure is said to be from a printed value where `printed.at` has it, else from the config's:
/// what a config takes need not be printed. A stand-in in place of a real
/// model is no other scene: it goes by its name, and Table marks its source, as that of a generated
/// one.
class PrintedParameters {
  public:
    /// `experiment.paperCases` are its cases; without any, nothing is known.
    explicit PrintedParameters(const config::Experiment& experiment);

    bool isKnown() const { return !cases_.cases.empty(); }
    /// Nobody says of a parameter that it is printed, or left open.
    bool isUnsaid() const { return isKnown() && open_.empty() && given_.empty(); }
    /// Sets what the cell says of its parameters. `layout` and `cases` are this run's. Does nothing
    /// for a cell without a measurement, or where nothing is known.
    void compare(const config::Layout& layout, const Key& row, const Key& column,
                 const LayoutCases& cases, Cell& cell) const;

  private:
    // Under the profile `paper`.
    config::Layout layout_;
    config::Printed printed_;
    std::set<std::string> open_;
    std::set<std::string> given_;  // in `printed.at`
    LayoutCases cases_;
};

/// Cells with a printed value in tables (those of figures and sections are not counted). A cell is
/// one, however many statistics are printed in it.
struct PrintedCells {
    int printed = 0;
    int measured = 0;   // those beside a measurement
    int atPrinted = 0;  // those of them that were measured at the printed parameters
    int asGiven = 0;    // likewise, as far as these are given
    int unknown = 0;    // those of tables that do not know the printed parameters

    void add(const config::Experiment& experiment, const Table& table);
};
PrintedCells countPrintedCells(std::span<const config::Experiment> experiments,
                               std::span<const Table> tables);
/// "Of 897 printed cells of tables 691 were measured again: 120 at the printed parameters; 300 at
/// the parameters that the document gives, which leaves some open; 271 at other parameters, which
/// each table names."; empty when nothing is printed.
std::string printedCellsLine(const PrintedCells& count);

/// "output 128×128 (printed 512×512), light grid 4 (16), frames 3 (paper profile 50)".
std::string departuresText(const std::vector<Departure>& departures, const Words& words = {});

/// "output, view spread, view distance, frame size": Cell::openParameters.
std::string openText(const std::vector<std::string>& parameters, const Words& words = {});

/// At which parameters the table was measured, and which of them differ from the printed ones:
/// "Measured at output 128×128 (printed 512×512), light grid 4 (16)." Of the cells beside a printed
/// value or, where there are none, of all that were measured. Then with which table its times were
/// measured, where it was another. Empty for what is not published and has its own times.
std::string parametersLine(const Table& table);
/// The same of one row, without the full stop; empty where nothing of it is measured.
std::string parametersLine(const Table& table, const TableRow& row);

}  // namespace gfxrepro::tables
