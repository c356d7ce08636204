// What the SVGs of curves are made of: axes with round ticks whose texts do not overlap, and marks.
// They take the colour of the text around them, have no ids and fetch nothing, so that any number
// may stand in a page.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gfxrepro::report {

struct PlotAxis {
    double low = 0.0;
    double high = 1.0;
    bool isLog = false;

    /// Whether it has a place for the value: finite, on a logarithmic axis positive.
    bool shows(double value) const;
    /// From 0 at `low` to 1 at `high`.
    double at(double value) const;
};

/// Holds all values that it shows with a little room on both sides. `fromZero`: a linear axis
/// begins at 0 unless all values are far from it.
PlotAxis axisOf(const std::vector<double>& values, bool isLog, bool fromZero);

/// In which direction the axis runs, so what room a text takes along it.
enum class Along { X, Y };
struct Tick {
    double value = 0.0;
    std::string text;  // empty: a small tick
};
/// 1, 2 or 5 times powers of ten; on a logarithmic axis the powers, and between them what there is
/// room for. `length` is in pixels.
std::vector<Tick> ticksOf(const PlotAxis& axis, double length, Along along);
/// At the values themselves, if they are few and short; else as ticksOf(). Of an x axis.
std::vector<Tick> ticksAt(const std::vector<double>& values, const PlotAxis& axis, double length);

/// At 0, 1, 2, … their names, at as many of them as have room. Of an x axis.
std::vector<Tick> ticksNamed(const std::vector<std::string>& names, const PlotAxis& axis,
                             double length);

/// About how wide a text is, in pixels.
double textWidth(std::string_view text);
inline constexpr double kFontPx = 12.0;

/// Each curve is drawn for a page with room, where two stand side by side, and for a narrow one;
/// report.css shows one of them.
inline constexpr double kWidePx = 608.0;
inline constexpr double kNarrowPx = 360.0;
inline constexpr double kLinePx = 16.0;  // from one line of text to the next

/// The whole, named by its title.
std::string svgElement(double width, double height, const std::string& title,
                       const std::string& content);
/// `style`: further attributes.
std::string svgLine(double x1, double y1, double x2, double y2, std::string_view style = "");
/// `anchor`: "start", "middle" or "end", which lies at x.
std::string svgText(double x, double y, std::string_view anchor, std::string_view text,
                    std::string_view style = "");
/// Lines that are about as wide or narrower; a word that is wider has one of its own.
std::vector<std::string> wrapped(const std::string& text, double width);
/// Text on several lines, of which the first has its base at y.
std::string svgLines(double x, double y, std::string_view anchor,
                     const std::vector<std::string>& lines, std::string_view style = "");

/// A rectangle with its axes.
struct Plane {
    PlotAxis x, y;
    double left = 0.0, top = 0.0, width = 0.0, height = 0.0;

    double xOf(double value) const { return left + width * x.at(value); }
    double yOf(double value) const { return top + height * (1.0 - y.at(value)); }
};
/// Both axes, their ticks, and rules at those of y.
std::string axesSvg(const Plane& plane, const std::vector<Tick>& x, const std::vector<Tick>& y);
/// What is left of a plane for the texts of these ticks.
double roomOf(std::span<const Tick> yTicks);
/// Through neighbours; without a y, or where an axis does not show it, there is a gap.
std::string pathSvg(const Plane& plane,
                    std::span<const std::pair<double, std::optional<double>>> points,
                    std::string_view style);

}  // namespace gfxrepro::report
