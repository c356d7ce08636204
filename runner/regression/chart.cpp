#include "runner/regression/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "runner/metrics/statistics.h"
#include "runner/report/markup.h"

namespace gfxrepro::regression {

namespace {

// In units of the SVG, which are pixels where the page has room for it.
constexpr double kWidth = 600, kHeight = 190, kLeft = 70, kRight = 16, kTop = 20, kBottom = 26;
constexpr std::size_t kMostDays = 6;

/// From nights and values to places.
struct Scale {
    double low = 0.0, high = 1.0;
    std::size_t count = 1;

    double x(double night) const {
        const double span = std::max<double>(1.0, static_cast<double>(count) - 1.0);
        return kLeft + (kWidth - kLeft - kRight) * (count == 1 ? 0.5 : night / span);
    }
    double y(double value) const {
        return kTop + (kHeight - kTop - kBottom) * (high - value) / (high - low);
    }
};

Scale scaleOf(const ChartSeries& series) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const std::optional<double>& value : series.values) {
        if (!value || !std::isfinite(*value)) continue;
        low = std::min(low, *value);
        high = std::max(high, *value);
    }
    if (low > high) low = high = 0.0;
    const double pad = high > low ? 0.06 * (high - low) : std::max(0.05 * std::abs(high), 1e-9);
    return {low - pad, high + pad, series.values.size()};
}

std::string line(double x1, double y1, double x2, double y2, const char* style) {
    return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", x1,
                       y1, x2, y2, style);
}

std::string text(double x, double y, const char* anchor, const std::string& words,
                 const char* colour = "var(--soft)") {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" fill=\"{}\">{}</text>\n",
                       x, y, anchor, colour, report::escapeXml(words));
}

std::string axesSvg(const std::vector<ChartNight>& nights, const Scale& scale,
                    const std::string& unit) {
    std::string svg;
    for (const double tick : roundTicks(scale.low, scale.high)) {
        const double y = scale.y(tick);
        svg += line(kLeft, y, kWidth - kRight, y, "stroke=\"var(--rule)\"");
        svg += text(kLeft - 6, y + 4, "end", fmt::format("{:.6g}", tick));
    }
    svg += text(kLeft - 6, kTop - 8, "end", unit);
    const std::size_t step = std::max<std::size_t>(1, (nights.size() + kMostDays - 1) / kMostDays);
    for (std::size_t i = 0; i < nights.size(); i += step) {
        svg += text(scale.x(static_cast<double>(i)), kHeight - 8, "middle", nights[i].day);
    }
    return svg;
}

/// The line through nights that follow one another.
std::string lineSvg(const ChartSeries& series, const Scale& scale) {
    std::string path;
    bool isOpen = false;
    for (std::size_t i = 0; i < series.values.size(); ++i) {
        const std::optional<double>& value = series.values[i];
        const bool isThere = value && std::isfinite(*value);
        if (isThere) {
            path += fmt::format("{}{:.1f} {:.1f}", isOpen ? 'L' : 'M',
                                scale.x(static_cast<double>(i)), scale.y(*value));
        }
        isOpen = isThere;
    }
    return fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"var(--soft)\" opacity=\".5\"/>\n",
                       path);
}

std::string pointsSvg(const std::vector<ChartNight>& nights, const ChartSeries& series,
                      const Scale& scale) {
    std::string svg;
    for (std::size_t i = 0; i < series.values.size(); ++i) {
        const std::optional<double>& value = series.values[i];
        if (!value || !std::isfinite(*value)) continue;
        svg += fmt::format(
            "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.4\" fill=\"currentColor\"><title>{}: {:.6g} "
            "{}</title></circle>\n",
            scale.x(static_cast<double>(i)), scale.y(*value), report::escapeXml(nights[i].label),
            *value, report::escapeXml(series.unit));
    }
    return svg;
}

/// The median of the values between two marks.
std::string levelsSvg(const ChartSeries& series, const Scale& scale) {
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
        const double y = scale.y(metrics::summarize(values, metrics::Statistic::Median));
        svg += line(scale.x(static_cast<double>(first)), y, scale.x(static_cast<double>(last) - 1),
                    y, "stroke=\"var(--link)\" stroke-width=\"2\"");
    }
    return svg;
}

std::string marksSvg(const ChartSeries& series, const Scale& scale) {
    std::string svg;
    for (const ChartSeries::Mark& mark : series.marks) {
        const double x = scale.x(static_cast<double>(mark.night) - 0.5);
        const char* colour = mark.isWorse ? "var(--fails)" : "var(--holds)";
        svg += line(x, kTop - 4, x, kHeight - kBottom,
                    mark.isWorse ? "stroke=\"var(--fails)\" stroke-dasharray=\"5 3\""
                                 : "stroke=\"var(--holds)\" stroke-dasharray=\"5 3\"");
        svg += text(x, kTop - 8, "middle", mark.text, colour);
    }
    return svg;
}

}  // namespace

std::vector<double> roundTicks(double low, double high) {
    if (!(high > low)) return {low};
    constexpr double kWanted = 4.0;
    const double rough = (high - low) / kWanted;
    const double power = std::pow(10.0, std::floor(std::log10(rough)));
    double step = 10.0 * power;
    for (const double factor : {5.0, 2.0, 1.0}) {
        if (factor * power >= rough) step = factor * power;
    }
    std::vector<double> ticks;
    for (double at = std::ceil(low / step); at * step <= high; ++at) ticks.push_back(at * step);
    return ticks;
}

std::string chartSvg(const std::vector<ChartNight>& nights, const ChartSeries& series) {
    const Scale scale = scaleOf(series);
    return fmt::format(
               "<svg viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" role=\"img\" "
               "font-size=\"11\" font-family=\"system-ui, sans-serif\">\n",
               kWidth, kHeight) +
           axesSvg(nights, scale, series.unit) + lineSvg(series, scale) +
           (series.hasLevels ? levelsSvg(series, scale) : "") + pointsSvg(nights, series, scale) +
           marksSvg(series, scale) + "</svg>\n";
}

}  // namespace gfxrepro::regression
