#include "runner/tables/reference_line.h"

#include <fmt/format.h>
#include <cmath>

#include "runner/records/csv.h"

namespace gfxrepro::tables {

namespace {

std::vector<FigurePoint> referenceOf(const std::vector<FigurePoint>& points, double slope) {
    std::vector<FigurePoint> drawn;
    double logX = 0.0, logY = 0.0;
    for (const FigurePoint& point : points) {
        if (!point.y) continue;
        drawn.push_back(point);
        logX += std::log(point.x);
        logY += std::log(*point.y);
    }
    if (drawn.size() < 2) return {};
    logX /= static_cast<double>(drawn.size());
    logY /= static_cast<double>(drawn.size());
    std::vector<FigurePoint> ends(2);
    for (std::size_t i = 0; i < ends.size(); ++i) {
        ends[i].x = (i == 0 ? drawn.front() : drawn.back()).x;
        ends[i].y = std::exp(logY + slope * (std::log(ends[i].x) - logX));
    }
    return ends;
}

}  // namespace

void addReference(Figure& figure, double slope) {
    for (FigurePanel& panel : figure.panels) {
        for (FigureCurve& curve : panel.curves) {
            curve.reference = referenceOf(curve.points, slope);
            if (!curve.reference.empty()) figure.slope = slope;
        }
    }
}

std::string slopeName(double slope) {
    return fmt::format("slope {}{}", slope < 0.0 ? "−" : "",
                       records::shortestText(std::abs(slope)));
}

}  // namespace gfxrepro::tables
