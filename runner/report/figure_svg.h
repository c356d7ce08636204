// A figure as an SVG.
#pragma once

#include <string>

#include "runner/tables/figure.h"

namespace gfxrepro::report {

/// The legend above, then the panels, then the notes. Points are titled with their numbers. What an
/// axis does not show is left out; the ends of an interval stay within the axis.
std::string figureSvg(const tables::Figure& figure, const std::string& title, double width);

}  // namespace gfxrepro::report
