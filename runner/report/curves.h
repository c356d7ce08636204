// Curves: figures as SVG, and those of the tables of a run.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runner/config/experiment.h"
#include "runner/tables/figure.h"
#include "runner/tables/table.h"

namespace gfxrepro::report {

/// A figure of a table, as a page has it.
struct Curve {
    std::string table;    // "zju2005/2.1"
    std::string title;    // its caption: the plot's own, else the experiment's
    std::string svg;      // for wide pages and for narrow ones (svg.h); empty when there is none
    std::string problem;  // why not: nothing measured, a column that is not there
};

/// The plots of all experiments, in order; `tables` lies beside `experiments`. Below `folder`,
/// where one is given, each is a file too: plots/zju2005-2.1.svg; "-2" and so on follow the slug of
/// further ones. A plot of a column that a profile or an override took away has its problem alone.
/// Throws Error for files.
std::vector<Curve> drawCurves(const std::filesystem::path& folder,
                              const std::vector<tables::Table>& tables,
                              const std::vector<config::Experiment>& experiments);

/// The same of several runs, lettered A, B, …: a plot that several have is one figure of all. Each
/// is given of the first run that has its table; nothing is written.
std::vector<Curve> overlaidCurves(const std::vector<std::vector<tables::Table>>& tables,
                                  const std::vector<std::vector<config::Experiment>>& experiments);

/// The legend above, then the panels, then the notes. Points are titled with their numbers. What an
/// axis does not show is left out; the ends of an interval stay within the axis.
std::string figureSvg(const tables::Figure& figure, const std::string& title, double width);

}  // namespace gfxrepro::report
