// A line of an expected slope in a figure of logarithmic axes.
#pragma once

#include <string>

#include "runner/tables/figure.h"

namespace gfxrepro::tables {

/// Gives each curve of two points or more its `reference`: through the mean of its points on
/// logarithmic axes, from the first to the last of them. `slope`: exponent of x. The figure has its
/// `slope` where a curve got one. Values must be positive, as makeFigure's on such axes are.
void addReference(Figure& figure, double slope);

/// "slope −0.5".
std::string slopeName(double slope);

}  // namespace gfxrepro::tables
