// A series of nights as a curve: an SVG that stands in a page and needs no script.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace gfxrepro::regression {

/// A night on the common axis of a machine.
struct ChartNight {
    std::string day;    // "2026-11-21": below the axis
    std::string label;  // what is said of its point: "2026-11-21T03:14:00Z, abc123"
};

/// Values on that axis, and where their level changes.
struct ChartSeries {
    std::string unit;
    std::vector<std::optional<double>> values;  // beside the nights; none: no point
    struct Mark {
        std::size_t night = 0;  // the first of the new level
        std::string text;       // "× 1.31"
        bool isWorse = false;
    };
    std::vector<Mark> marks = {};
    bool hasLevels = true;  // draws the median between marks
};

/// Points with a title each (label and value), a line through neighbours, marks as upright lines:
/// for wide pages, then for narrow ones.
std::string chartSvg(const std::vector<ChartNight>& nights, const ChartSeries& series,
                     const std::string& title);

}  // namespace gfxrepro::regression
