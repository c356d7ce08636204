// The axes of a plot: their ranges, and round ticks whose texts do not overlap.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace gfxrepro::report {

struct Axis {
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
Axis axisOf(const std::vector<double>& values, bool isLog, bool fromZero);

/// In which direction the axis runs, so what room a text takes along it.
enum class Along { X, Y };
struct Tick {
    double value = 0.0;
    std::string text;  // empty: a small tick
};
/// 1, 2 or 5 times powers of ten; on a logarithmic axis the powers, and between them what there is
/// room for. `length` is in pixels.
std::vector<Tick> ticksOf(const Axis& axis, double length, Along along);
/// At the values themselves, if they are few and short; else as ticksOf(). Of an x axis.
std::vector<Tick> ticksAt(const std::vector<double>& values, const Axis& axis, double length);

/// About how wide a text is, in pixels.
double textWidth(std::string_view text);
inline constexpr double kFontPx = 12.0;

}  // namespace gfxrepro::report
