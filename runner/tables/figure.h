// What a plot shows, as numbers: the panels, curves and points that a table and a plot's
// specification come to. Knows nothing of how it is drawn.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "runner/config/experiment.h"
#include "runner/tables/table.h"

namespace gfxrepro::tables {

/// A measured value with its bounds. Without `y` there is a gap in the curve.
struct FigurePoint {
    double x = 0.0;
    std::optional<double> y;
    metrics::Interval interval;
    Bounds bounds = Bounds::None;
    metrics::Interval xInterval = {};  // of an x that was measured, too
    Bounds xBounds = Bounds::None;
    /// Why there is a gap; of a point what it is, where it is not its curve's name and its numbers.
    std::string remark;
};

struct FigureCurve {
    std::string name;                         // in the legend
    std::vector<FigurePoint> points;          // by x
    std::vector<FigurePoint> printed;         // by x; each has its y
    std::vector<FigurePoint> reference = {};  // of a line beside it (addReference), or none
};

/// An upright line: from there on all is otherwise.
struct FigureMark {
    double x = 0.0;
    std::string text;
    bool isWorse = false;
};

/// `curves` lies beside those of the other panels: the same place is the same curve.
struct FigurePanel {
    std::string title;
    std::string yLabel;
    std::vector<FigureCurve> curves;
    std::vector<FigureMark> marks = {};
    bool hasPoints() const;
};

struct Figure {
    std::string xLabel;
    std::vector<std::string> xNames;  // of the x 0, 1, 2, …, in the place of these; or none
    bool isLogX = false;
    bool isLogY = false;
    std::optional<double> slope;  // of the references: exponent of x
    std::vector<std::string> curveNames;
    std::size_t runCount = 1;  // whose curves lie one behind the other: as many names of each
    std::vector<FigurePanel> panels;  // those that have a point
    std::vector<std::string> notes;   // what was left out and why, a sentence each
};

/// Values that are not ok, and on logarithmic axes those that are not positive, are left out and
/// counted in the notes. Printed values stand over the printed x where there is one, and beside the
/// curves of this run also those that were not measured. Throws Error at the plot's place for
/// columns that the table does not have.
Figure makeFigure(const config::PlotSpec& plot, const Table& table);

/// The column that the plot names and the table does not have, as one whose profile or override
/// took it away: "'y' is no column (columns: x)"; empty where it has all. The table may have been
/// built from no records.
std::string whatIsAbsent(const config::PlotSpec& plot, const Table& table);

/// Gives each curve of two points or more its `reference`: through the mean of its points on
/// logarithmic axes, from the first to the last of them. `slope`: exponent of x. The figure has its
/// `slope` where a curve got one. Values must be positive, as makeFigure's on such axes are.
void addReference(Figure& figure, double slope);

/// The same plot of several runs, laid over one another: of each run a curve of every name, which
/// its letter precedes. What is printed stands once. Throws nothing: one figure stays as it is.
Figure overlaid(const std::vector<Figure>& figures, const std::vector<std::string>& letters);

/// "slope −0.5".
std::string slopeName(double slope);

}  // namespace gfxrepro::tables
