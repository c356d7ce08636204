#include "runner/report/svg.h"

#include <fmt/format.h>
#include <algorithm>

#include "engine/core/text.h"
#include "runner/report/markup.h"

namespace gfxrepro::report {

std::string svgElement(double width, double height, const std::string& title,
                       const std::string& content) {
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"{0}\" width=\"{1:.5g}\" "
        "height=\"{2:.5g}\" viewBox=\"0 0 {1:.5g} {2:.5g}\" role=\"img\" overflow=\"visible\" "
        "fill=\"currentColor\" font-size=\"{3}\" font-family=\"system-ui, "
        "sans-serif\">\n<title>{4}</title>\n{5}</svg>\n",
        width < kWidePx ? "narrow" : "wide", width, height, kFontPx, escapeXml(title), content);
}

std::string svgLine(double x1, double y1, double x2, double y2, std::string_view style) {
    return fmt::format("<path d=\"M{:.5g} {:.5g}L{:.5g} {:.5g}\"{}{}/>\n", x1, y1, x2, y2,
                       style.empty() ? "" : " ", style);
}

std::string svgText(double x, double y, std::string_view anchor, std::string_view text,
                    std::string_view style) {
    if (text.empty()) return "";
    return fmt::format("<text x=\"{:.5g}\" y=\"{:.5g}\" text-anchor=\"{}\"{}{}>{}</text>\n", x, y,
                       anchor, style.empty() ? "" : " ", style, escapeXml(text));
}

std::vector<std::string> wrapped(const std::string& text, double width) {
    std::vector<std::string> lines;
    if (text.empty()) return lines;
    for (const std::string& word : split(text, ' ')) {
        if (!lines.empty() && textWidth(lines.back() + " " + word) <= width) {
            lines.back() += " " + word;
        } else {
            lines.push_back(word);
        }
    }
    return lines;
}

std::string svgLines(double x, double y, std::string_view anchor,
                     const std::vector<std::string>& lines, std::string_view style) {
    std::string svg;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        svg += svgText(x, y + kLinePx * static_cast<double>(i), anchor, lines[i], style);
    }
    return svg;
}

std::string axesSvg(const Plane& plane, const std::vector<Tick>& x, const std::vector<Tick>& y) {
    constexpr double kTick = 5.0, kSmall = 3.0;
    const double bottom = plane.top + plane.height, right = plane.left + plane.width;
    std::string rules, lines, texts;
    for (const Tick& tick : y) {
        const double at = plane.yOf(tick.value);
        if (!tick.text.empty()) rules += svgLine(plane.left, at, right, at);
        lines += svgLine(plane.left - (tick.text.empty() ? kSmall : kTick), at, plane.left, at);
        texts += svgText(plane.left - kTick - 3.0, at + 4.0, "end", tick.text);
    }
    for (const Tick& tick : x) {
        const double at = plane.xOf(tick.value);
        lines += svgLine(at, bottom, at, bottom + (tick.text.empty() ? kSmall : kTick));
        texts += svgText(at, bottom + kTick + 13.0, "middle", tick.text);
    }
    lines += svgLine(plane.left, plane.top, plane.left, bottom);
    lines += svgLine(plane.left, bottom, right, bottom);
    return fmt::format(
        "<g stroke=\"currentColor\" stroke-opacity=\".15\">\n{}</g>\n"
        "<g stroke=\"currentColor\" stroke-opacity=\".7\">\n{}</g>\n{}",
        rules, lines, texts);
}

double roomOf(std::span<const Tick> yTicks) {
    double widest = 0.0;
    for (const Tick& tick : yTicks) widest = std::max(widest, textWidth(tick.text));
    return widest + 10.0;
}

std::string pathSvg(const Plane& plane,
                    std::span<const std::pair<double, std::optional<double>>> points,
                    std::string_view style) {
    std::string path;
    bool isOpen = false;
    for (const auto& [x, y] : points) {
        const bool isThere = y && plane.x.shows(x) && plane.y.shows(*y);
        if (isThere) {
            path += fmt::format("{}{:.5g} {:.5g}", isOpen ? 'L' : 'M', plane.xOf(x), plane.yOf(*y));
        }
        isOpen = isThere;
    }
    return path.empty() ? "" : fmt::format("<path d=\"{}\" fill=\"none\" {}/>\n", path, style);
}

}  // namespace gfxrepro::report
