// The curves of a run's tables as files: scripts for gnuplot, and the SVGs that it makes of them.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "runner/config/experiment.h"
#include "runner/tables/table.h"

namespace gfxrepro::report {

/// One figure of a table. Paths are relative to the run's folder.
struct PlotFile {
    std::string table;    // "zju2005/2.1"
    std::string title;    // its caption: the plot's own, else the experiment's
    std::string script;   // "plots/zju2005-2.1.gp"; "-2" and so on follow the slug of further ones
    std::string svg;      // "plots/zju2005-2.1.svg"; empty when it was not drawn
    std::string problem;  // why not: nothing measured, a column that is not there, no gnuplot
    std::vector<std::string> notes;  // which values are left out; they stand in the SVG, too
};

/// Writes the plots of all experiments, in order; `tables` lies beside `experiments`. The SVGs may
/// stand in one page: ids are unique, nothing is fetched, text takes the colour of the page's. A
/// run without gnuplot gets its scripts only; a plot of a column that a profile or an override took
/// away has its problem alone. What gnuplot takes beyond kGnuplotLimit a plot is taken off
/// `patience`. Throws Error for files.
std::vector<PlotFile> writePlots(const std::filesystem::path& runDir,
                                 const std::vector<tables::Table>& tables,
                                 const std::vector<config::Experiment>& experiments,
                                 std::chrono::milliseconds& patience);

}  // namespace gfxrepro::report
