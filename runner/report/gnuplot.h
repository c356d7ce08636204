// Figures as gnuplot scripts, and what gnuplot makes of them.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>

#include "runner/tables/figure.h"

namespace gfxrepro::report {

/// A script with its data that writes an SVG to the standard output. `name` begins the ids of the
/// SVG's elements and `source` says in its head what it was made from.
std::string gnuplotScript(const tables::Figure& figure, const std::string& name,
                          const std::string& source);

/// Text in single quotes, in which gnuplot sees no markup, macro or command.
std::string gnuplotQuoted(const std::string& text);

/// What running a script gave: an SVG, or why there is none.
struct Drawn {
    std::string svg;
    std::string problem;
};
inline constexpr std::chrono::seconds kGnuplotLimit{1};
/// For all plots of a report together, beyond each one's limit.
inline constexpr std::chrono::seconds kGnuplotPatience{60};
/// Runs the program `gnuplot` of PATH, without anyone's settings; kills it at the limit.
Drawn runGnuplot(const std::filesystem::path& script,
                 std::chrono::milliseconds limit = kGnuplotPatience);

/// gnuplot's SVG made fit to stand in a page beside others: text and axes in the colour of the
/// text around, every id begun by `name`, no titles of parts and no XML head.
std::string adaptedSvg(const std::string& svg, const std::string& name);

}  // namespace gfxrepro::report
