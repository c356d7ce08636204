#include "runner/regression/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "engine/metrics/statistics.h"
#include "runner/report/markup.h"
#include "runner/report/svg.h"

namespace gfxrepro::regression {

namespace {

constexpr double kTop = 22.0, kHeight = 146.0, kBottom = 24.0, kRight = 8.0;

using report::Plane;

Plane planeOf(const ChartSeries& series, double width) {
    std::vector<double> values;
    for (const std::optional<double>& value : series.values) {
        if (value) values.push_back(*value);
    }
    Plane plane;
    plane.x = {-0.5, std::max(0.5, static_cast<double>(series.values.size()) - 0.5)};
    plane.y = report::axisOf(values, false, false);
    plane.left = report::roomOf(report::ticksOf(plane.y, kHeight, report::Along::Y));
    plane.top = kTop;
    plane.width = width - plane.left - kRight;
    plane.height = kHeight;
    return plane;
}

std::string nightsSvg(const std::vector<ChartNight>& nights, const Plane& plane) {
    std::vector<report::Tick> days;
    const auto most = static_cast<std::size_t>(plane.width / report::textWidth("2026-11-21 "));
    const std::size_t step = (nights.size() + most - 1) / most;
    for (std::size_t i = step / 2; i < nights.size(); i += step) {
        const double place = static_cast<double>(i);
        const double end = plane.xOf(place) + 0.5 * report::textWidth(nights[i].day);
        if (end < plane.left + plane.width + kRight) days.push_back({place, nights[i].day});
    }
    return report::axesSvg(plane, days, report::ticksOf(plane.y, plane.height, report::Along::Y));
}

std::string nightPointsSvg(const std::vector<ChartNight>& nights, const ChartSeries& series,
                           const Plane& plane) {
    std::string svg;
    for (std::size_t i = 0; i < series.values.size(); ++i) {
        const std::optional<double>& value = series.values[i];
        if (!value || !plane.y.shows(*value)) continue;
        svg += fmt::format(
            "<circle cx=\"{:.5g}\" cy=\"{:.5g}\" r=\"2.4\"><title>{}: {:.6g} {}</title></circle>\n",
            plane.xOf(static_cast<double>(i)), plane.yOf(*value),
            report::escapeXml(nights[i].label), *value, report::escapeXml(series.unit));
    }
    return svg;
}

/// The median of the values between two marks.
std::string levelsSvg(const ChartSeries& series, const Plane& plane) {
    std::string svg;
    for (std::size_t level = 0; level <= series.marks.size(); ++level) {
        const std::size_t first = level == 0 ? 0 : series.marks[level - 1].night;
        const std::size_t last =
            level == series.marks.size() ? series.values.size() : series.marks[level].night;
        std::vector<double> values;
        for (std::size_t i = first; i < last; ++i) {
            if (series.values[i]) values.push_back(*series.values[i]);
        }
        if (values.empty()) continue;
        const double y = plane.yOf(metrics::summarize(values, metrics::Statistic::Median));
        svg += report::svgLine(plane.xOf(static_cast<double>(first)), y,
                               plane.xOf(static_cast<double>(last) - 1.0), y,
                               "stroke=\"var(--link)\" stroke-width=\"2\"");
    }
    return svg;
}

std::string marksSvg(const ChartSeries& series, const Plane& plane) {
    std::string svg;
    for (const ChartSeries::Mark& mark : series.marks) {
        const double x = plane.xOf(static_cast<double>(mark.night) - 0.5);
        const std::string colour = mark.isWorse ? "var(--fails)" : "var(--holds)";
        svg += report::svgLine(x, plane.top - 4.0, x, plane.top + plane.height,
                               "stroke=\"" + colour + "\" stroke-dasharray=\"5 3\"");
        svg += report::svgText(x, plane.top - 8.0, "middle", mark.text, "fill=\"" + colour + "\"");
    }
    return svg;
}

std::string chartOf(const std::vector<ChartNight>& nights, const ChartSeries& series,
                    const std::string& title, double width) {
    const Plane plane = planeOf(series, width);
    std::vector<std::pair<double, std::optional<double>>> places;
    for (const std::optional<double>& value : series.values) {
        places.emplace_back(static_cast<double>(places.size()), value);
    }
    const std::string content =
        nightsSvg(nights, plane) + report::svgText(0.0, plane.top - 8.0, "start", series.unit) +
        report::pathSvg(plane, places, "stroke=\"currentColor\" opacity=\".3\"") +
        (series.hasLevels ? levelsSvg(series, plane) : "") + nightPointsSvg(nights, series, plane) +
        marksSvg(series, plane);
    return report::svgElement(width, kTop + kHeight + kBottom, title, content);
}

}  // namespace

std::string chartSvg(const std::vector<ChartNight>& nights, const ChartSeries& series,
                     const std::string& title) {
    return chartOf(nights, series, title, report::kWidePx) +
           chartOf(nights, series, title, report::kNarrowPx);
}

}  // namespace gfxrepro::regression
