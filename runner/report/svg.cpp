#include "runner/report/svg.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

#include "engine/core/text.h"
#include "runner/report/markup.h"

namespace gfxrepro::report {

namespace {

constexpr double kRoom = 0.05;  // on each side, of the axis

using Ticks = std::vector<Tick>;

double scaled(double mantissa, int exponent) {
    // Division is exact where a product with 0.1 is not.
    const double power = std::pow(10.0, std::abs(exponent));
    return exponent < 0 ? mantissa / power : mantissa * power;
}

std::string withMinus(std::string text) {
    return text.starts_with('-') ? "−" + text.substr(1) : text;
}

/// "2·10⁶", "10⁻⁷".
std::string powerText(double value) {
    if (value == 0.0) return "0";
    static constexpr const char* kDigits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    const int exponent = static_cast<int>(std::floor(std::log10(std::abs(value)) + 1e-9));
    std::string power = exponent < 0 ? "10⁻" : "10";
    for (const char digit : std::to_string(std::abs(exponent))) power += kDigits[digit - '0'];
    const double mantissa = scaled(value, -exponent);
    return std::abs(mantissa - 1.0) < 1e-9 ? power
                                           : withMinus(fmt::format("{:.10g}·{}", mantissa, power));
}

/// As it is from a thousandth up to `plain`.
std::string tickText(double value, double plain) {
    const double size = std::abs(value);
    const bool isPlain = size == 0.0 || (size >= 1e-3 && size < plain);
    return isPlain ? withMinus(fmt::format("{:.6g}", value)) : powerText(value);
}

/// Whether no text comes near the next, and no tick with one nearer than `least`.
bool haveRoom(const Ticks& ticks, const PlotAxis& axis, double length, Along along, double gap,
              double least = 0.0) {
    double before = -1e9, end = -1e9;
    for (const Tick& tick : ticks) {
        if (tick.text.empty()) continue;
        const double half = 0.5 * (along == Along::X ? textWidth(tick.text) : kFontPx);
        const double place = length * axis.at(tick.value);
        if (place - half < end || place - before < least) return false;
        before = place;
        end = place + half + gap;
    }
    return true;
}

/// At multiples of a factor times a power of ten.
Ticks multiples(const PlotAxis& axis, int factor, int exponent) {
    const double largest = std::max(std::abs(axis.low), std::abs(axis.high));
    const bool isPlain = largest >= 1e-3 && largest < 1e6;
    const double step = scaled(factor, exponent);
    Ticks ticks;
    for (double n = std::ceil(axis.low / step - 1e-9); n <= axis.high / step + 1e-9; ++n) {
        const double value = scaled(n * factor, exponent);
        const std::string plain = fmt::format("{:.{}f}", value, std::max(0, -exponent));
        ticks.push_back({value, value == 0.0 ? "0"
                                : isPlain    ? withMinus(plain)
                                             : powerText(value)});
    }
    return ticks;
}

/// The finest that have room; two of them may lie nearer together than more would.
Ticks linearTicks(const PlotAxis& axis, double length, Along along) {
    constexpr double kGap = 10.0, kLeastX = 64.0, kLeastY = 30.0;
    Ticks best;
    for (int exponent = static_cast<int>(std::floor(std::log10(axis.high - axis.low))) + 1;;
         --exponent) {
        for (const int factor : {5, 2, 1}) {
            Ticks ticks = multiples(axis, factor, exponent);
            const double least = best.size() < 2 ? 0.0 : along == Along::X ? kLeastX : kLeastY;
            if (!haveRoom(ticks, axis, length, along, kGap, least)) {
                return best.empty() ? Ticks{ticks[0]} : best;
            }
            best = std::move(ticks);
        }
    }
}

/// At powers of ten, with a text at each `every`-th of them and at these multiples.
Ticks powerTicks(const PlotAxis& axis, const std::set<int>& labelled, int every) {
    const bool hasSmall = std::log10(axis.high / axis.low) < 4.5;
    const int first = static_cast<int>(std::ceil(std::log10(axis.low) - 1e-9));
    const int last = static_cast<int>(std::floor(std::log10(axis.high)));
    Ticks ticks;
    for (int exponent = first - 1; exponent <= last; ++exponent) {
        for (int mantissa = 1; mantissa <= 9; ++mantissa) {
            const double value = scaled(mantissa, exponent);
            if (value < axis.low || value > axis.high) continue;
            const bool hasText = labelled.contains(mantissa) && (exponent - first) % every == 0;
            if (hasText || hasSmall) ticks.push_back({value, hasText ? tickText(value, 1e4) : ""});
        }
    }
    return ticks;
}

}  // namespace

bool PlotAxis::shows(double value) const {
    // Ratios and differences of these are numbers, too.
    const double size = std::abs(value);
    return (size == 0.0 || size > 1e-120) && size < 1e120 && (!isLog || value > 0.0);
}

double PlotAxis::at(double value) const {
    return isLog ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
}

PlotAxis axisOf(const std::vector<double>& values, bool isLog, bool fromZero) {
    PlotAxis axis{isLog ? 1.0 : 0.0, isLog ? 10.0 : 1.0, isLog};
    std::vector<double> shown;
    std::ranges::copy_if(values, std::back_inserter(shown),
                         [&](double v) { return axis.shows(v); });
    if (shown.empty()) return axis;
    const auto [low, high] = std::ranges::minmax(shown);
    if (isLog) {
        const double room = std::max(std::pow(high / low, kRoom), 1.1);
        return {low / room, high * room, true};
    }
    const double largest = std::max(std::abs(low), std::abs(high));
    double room = kRoom * (high - low);
    if (high - low <= 1e-9 * largest) room = largest == 0.0 ? 1.0 : kRoom * largest;
    return {fromZero && low >= 0.0 && low < 0.6 * high ? 0.0 : low - room, high + room, false};
}

std::vector<Tick> ticksOf(const PlotAxis& axis, double length, Along along) {
    if (!axis.isLog) return linearTicks(axis, length, along);
    const double gap = along == Along::X ? 28.0 : 9.0;
    const int least = axis.high < 10.0 * axis.low ? 2 : 1;  // texts
    using Candidate = std::pair<std::set<int>, int>;
    std::vector<Candidate> candidates = {{{1, 2, 3, 4, 5, 6, 8}, 1}, {{1, 2, 5}, 1}};
    for (const int every : {1, 2, 5, 10, 50, 100, 1000}) candidates.push_back({{1}, every});
    for (const auto& [labelled, every] : candidates) {
        Ticks ticks = powerTicks(axis, labelled, every);
        const auto hasText = [](const Tick& tick) { return !tick.text.empty(); };
        if (std::ranges::count_if(ticks, hasText) >= least &&
            haveRoom(ticks, axis, length, along, gap)) {
            return ticks;
        }
    }
    return linearTicks(axis, length, along);
}

std::vector<Tick> ticksAt(const std::vector<double>& values, const PlotAxis& axis, double length) {
    constexpr std::size_t kMost = 10;
    constexpr double kLetters = 6.0;
    std::set<double> distinct;
    for (const double value : values) {
        if (axis.shows(value)) distinct.insert(value);
    }
    Ticks ticks;
    for (const double value : distinct) ticks.push_back({value, tickText(value, 1e6)});
    const bool areShort = std::ranges::all_of(
        ticks, [](const Tick& tick) { return textWidth(tick.text) <= kLetters * textWidth("0"); });
    return !ticks.empty() && ticks.size() <= kMost && areShort &&
                   haveRoom(ticks, axis, length, Along::X, 10.0)
               ? ticks
               : ticksOf(axis, length, Along::X);
}

std::vector<Tick> ticksNamed(const std::vector<std::string>& names, const PlotAxis& axis,
                             double length) {
    double widest = 0.0;
    for (const std::string& name : names) widest = std::max(widest, textWidth(name + " "));
    const double distance = length * (axis.at(1.0) - axis.at(0.0));
    const auto step = static_cast<std::size_t>(std::max(1.0, std::ceil(widest / distance)));
    Ticks ticks;
    for (std::size_t i = step / 2; i < names.size(); i += step) {
        const auto place = static_cast<double>(i);
        const bool isCut = length * axis.at(place) + 0.5 * textWidth(names[i]) > length + 8.0;
        if (!isCut) ticks.push_back({place, names[i]});
    }
    return ticks;
}

double textWidth(std::string_view text) {
    constexpr double kLetter = 0.56 * kFontPx;
    return kLetter * static_cast<double>(columnsOf(text));
}

std::string svgElement(double width, double height, const std::string& title,
                       const std::string& content) {
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"{0}\" width=\"{1:.5g}\" "
        "height=\"{2:.5g}\" viewBox=\"0 0 {1:.5g} {2:.5g}\" role=\"group\" overflow=\"visible\" "
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
