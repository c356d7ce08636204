#include "runner/report/curves.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <optional>
#include <set>

#include "engine/core/files.h"
#include "engine/core/text.h"
#include "runner/config/experiment.h"
#include "runner/report/markup.h"
#include "runner/report/pages.h"
#include "runner/report/svg.h"
#include "runner/tables/figure.h"
#include "runner/tables/table.h"

namespace gfxrepro::report {

namespace fs = std::filesystem;

// A figure.

namespace {

using Lines = std::vector<std::string>;

/// A colour and a shape a curve. The first colours are after Okabe and Ito, the others were found
/// by a search: all have a contrast of 3 to white and to near-black, and a distance of 18 in CIELAB
/// to each other for readers with any kind of colour blindness (as simulated by Machado et al.
/// 2009).
struct CurveStyle {
    std::string_view colour;
    int corners;  // 0: a circle
    int turn;     // of the first corner, in degrees from the right, clockwise
};
constexpr std::array<CurveStyle, 7> kCurveStyles = {{{"#1f77c9", 0, 0},
                                                     {"#d55e00", 4, 45},
                                                     {"#009e73", 3, -90},
                                                     {"#666688", 4, 0},
                                                     {"#ee0044", 3, 90},
                                                     {"#aa00ee", 5, -90},
                                                     {"#ee44ee", 0, 0}}};

constexpr double kEdge = 14.0;  // right of a plot
constexpr double kGap = 18.0;   // between entries, panels
constexpr double kSample = 30.0;
constexpr double kMeasured = 3.2, kPrinted = 4.5, kSmallPoint = 2.4;  // sizes of markers
constexpr std::string_view kReference = "stroke-dasharray=\"6 4\" stroke-width=\"1.2\"";
constexpr std::string_view kFaint = "stroke-opacity=\".4\"";
constexpr std::string_view kLater = "stroke-width=\"1.8\" stroke-dasharray=\"2 3\"";  // B, C, …
constexpr std::string_view kHollow = "fill=\"none\" stroke-width=\"1.4\"";

const CurveStyle& styleOf(std::size_t curve) {
    return kCurveStyles[curve % kCurveStyles.size()];
}

/// A curve of a name has one colour in every run; those of the first have whole lines.
std::size_t nameCount(const tables::Figure& figure) {
    return std::max<std::size_t>(figure.curveNames.size() / figure.runCount, 1);
}
std::string_view lineOf(const tables::Figure& figure, std::size_t curve) {
    return curve < nameCount(figure) ? "stroke-width=\"1.8\"" : kLater;
}

std::string group(std::string_view colour, const std::string& content) {
    return content.empty()
               ? ""
               : fmt::format("<g fill=\"{0}\" stroke=\"{0}\">\n{1}</g>\n", colour, content);
}

std::string marker(const CurveStyle& style, double x, double y, double size,
                   std::string_view attributes = "", const std::string& title = "") {
    const std::string shownTitle =
        title.empty() ? "" : fmt::format("<title>{}</title>", escapeXml(title));
    if (style.corners == 0) {
        return fmt::format("<circle cx=\"{:.5g}\" cy=\"{:.5g}\" r=\"{}\" {}>{}</circle>\n", x, y,
                           size, attributes, shownTitle);
    }
    std::string path;
    for (int i = 0; i < style.corners; ++i) {
        const double angle = (style.turn + 360.0 * i / style.corners) * std::numbers::pi / 180.0;
        constexpr double kLarger = 1.2;  // than a circle, so that it looks alike
        path +=
            fmt::format("{}{:.5g} {:.5g}", i == 0 ? 'M' : 'L', x + kLarger * size * std::cos(angle),
                        y + kLarger * size * std::sin(angle));
    }
    return fmt::format("<path d=\"{}Z\" {}>{}</path>\n", path, attributes, shownTitle);
}

std::string intervalBar(double x, double low, double high, Along along = Along::Y) {
    constexpr double kHalf = 4.5;
    constexpr std::string_view kStyle = "stroke-width=\"1.2\"";
    const auto line = [&](double x1, double y1, double x2, double y2) {
        return along == Along::Y ? svgLine(x1, y1, x2, y2, kStyle)
                                 : svgLine(y1, x1, y2, x2, kStyle);
    };
    return line(x, low, x, high) + line(x - kHalf, low, x + kHalf, low) +
           line(x - kHalf, high, x + kHalf, high);
}

/// Bounds that can be drawn.
bool hasEnds(tables::Bounds bounds, const metrics::Interval& interval) {
    return bounds != tables::Bounds::None && !std::isnan(interval.low) &&
           !std::isnan(interval.high);
}

/// " (95 % interval 4 – 5)"; empty without any.
std::string boundsText(tables::Bounds bounds, const metrics::Interval& interval) {
    if (!hasEnds(bounds, interval)) return "";
    return fmt::format(" ({} {:.6g} – {:.6g})", tables::boundsName(bounds), interval.low,
                       interval.high);
}

/// "time [ms] 4.2 (95 % interval 4 – 5)".
std::string valueText(const std::string& label, double value, tables::Bounds bounds,
                      const metrics::Interval& interval) {
    return fmt::format("{}{}{:.6g}{}", label, label.empty() ? "" : " ", value,
                       boundsText(bounds, interval));
}

/// All values of a panel that its axes have to hold.
void gatherValues(const tables::FigurePanel& panel, std::vector<double>& x,
                  std::vector<double>& y) {
    for (const tables::FigureCurve& curve : panel.curves) {
        for (const auto* points : {&curve.points, &curve.printed, &curve.reference}) {
            for (const tables::FigurePoint& point : *points) {
                x.push_back(point.x);
                if (point.xBounds != tables::Bounds::None) {
                    x.push_back(point.xInterval.low);
                    x.push_back(point.xInterval.high);
                }
                if (point.y) y.push_back(*point.y);
                if (point.bounds == tables::Bounds::None) continue;
                y.push_back(point.interval.low);
                y.push_back(point.interval.high);
            }
        }
    }
}

/// Draws one figure from the top to the bottom.
class FigureDrawing {
  public:
    FigureDrawing(const tables::Figure& figure, double width) : figure_(figure), width_(width) {}

    std::string draw(const std::string& title) {
        drawLegend();
        if (!figure_.panels.empty()) drawPanels();
        constexpr std::string_view kSmall = "font-size=\"11\"";
        for (const std::string& note : figure_.notes) addLines(wrapped(note, width_), kSmall);
        return svgElement(width_, end_ + 4.0, title, svg_);
    }

  private:
    struct Entry {
        std::string sample;  // around 0, 0
        std::string text;
        std::optional<std::size_t> curve = {};  // whose name it is
    };

    void addLines(const Lines& lines, std::string_view style = "") {
        svg_ += svgLines(0.0, end_ + kFontPx, "start", lines, style);
        end_ += kLinePx * static_cast<double>(lines.size());
    }

    /// A curve alone needs no name: its axis has it.
    std::vector<Entry> entries() const {
        std::vector<Entry> entries;
        const bool areSeveral = figure_.curveNames.size() > 1;
        for (std::size_t i = 0; areSeveral && i < figure_.curveNames.size(); ++i) {
            const CurveStyle& style = styleOf(i % nameCount(figure_));
            entries.push_back(
                {group(style.colour, svgLine(-11.0, 0.0, 11.0, 0.0, lineOf(figure_, i)) +
                                         marker(style, 0.0, 0.0, kMeasured)),
                 figure_.curveNames[i], i});
        }
        bool hasPrinted = false;
        std::set<tables::Bounds> bounds;
        for (const tables::FigurePanel& panel : figure_.panels) {
            for (const tables::FigureCurve& curve : panel.curves) {
                hasPrinted = hasPrinted || !curve.printed.empty();
                for (const auto& point : curve.points) {
                    bounds.insert({point.bounds, point.xBounds});
                }
            }
        }
        bounds.erase(tables::Bounds::None);
        const std::string_view colour = areSeveral ? "currentColor" : styleOf(0).colour;
        const auto add = [&](const std::string& sample, const std::string& text) {
            entries.push_back({group(colour, sample), text});
        };
        if (hasPrinted) {
            add(marker(styleOf(0), 0.0, 0.0, kMeasured), "measured");
            add(marker(styleOf(0), 0.0, 0.0, kPrinted, kHollow), "printed");
        }
        if (!bounds.empty()) {
            Lines names;
            for (const tables::Bounds one : bounds) names.emplace_back(tables::boundsName(one));
            add(intervalBar(0.0, -6.0, 6.0), joined(names, " or "));
        }
        if (figure_.slope) {
            add(svgLine(-11.0, 0.0, 11.0, 0.0, kReference), tables::slopeName(*figure_.slope));
        }
        return entries;
    }

    void drawLegend() {
        double x = 0.0;
        std::size_t most = 0;  // lines of an entry of this row
        const auto endRow = [&] {
            end_ += kLinePx * static_cast<double>(most) + (most > 0 ? 3.0 : 0.0);
            x = 0.0;
            most = 0;
        };
        for (const Entry& entry : entries()) {
            const Lines lines = wrapped(entry.text, width_ - kSample);
            double room = kSample;
            for (const auto& line : lines) room = std::max(room, kSample + textWidth(line));
            if (x + room > width_) endRow();
            const std::string drawn =
                fmt::format("<g transform=\"translate({:.5g} {:.5g})\">\n{}</g>\n",
                            x + 0.5 * kSample - 3.0, end_ + kFontPx - 4.0, entry.sample) +
                svgLines(x + kSample, end_ + kFontPx, "start", lines);
            svg_ += entry.curve ? fmt::format("<g data-name=\"{}\">\n{}</g>\n", *entry.curve, drawn)
                                : drawn;
            most = std::max(most, lines.size());
            x += room + kGap;
        }
        endRow();
        if (end_ > 0.0) end_ += 6.0;
    }

    void drawPanels() {
        struct Panel {
            Plane plane;
            std::vector<double> x;
            std::vector<Tick> yTicks;
            Lines head;
        };
        const std::size_t count = figure_.panels.size();
        const std::size_t columns = count > 1 && width_ >= kWidePx ? 2 : 1;
        const double slot =
            (width_ - kGap * static_cast<double>(columns - 1)) / static_cast<double>(columns);
        const std::string& label = figure_.panels[0].yLabel;
        const bool hasOneLabel = std::ranges::all_of(
            figure_.panels, [&](const auto& panel) { return panel.yLabel == label; });
        if (hasOneLabel) addLines(wrapped(label, width_));
        if (count > 1) end_ += 4.0;
        std::vector<Panel> panels(count);
        double left = 0.0, head = 0.0;
        for (std::size_t i = 0; i < count; ++i) {
            const tables::FigurePanel& shown = figure_.panels[i];
            Panel& panel = panels[i];
            std::vector<double> y;
            gatherValues(shown, panel.x, y);
            panel.plane.x = axisOf(panel.x, figure_.isLogX, false);
            panel.plane.y = axisOf(y, figure_.isLogY, true);
            panel.plane.height = count > 1 || isOverNames() ? 150.0
                                 : width_ < kWidePx         ? 220.0
                                                            : 270.0;
            panel.yTicks = ticksOf(panel.plane.y, panel.plane.height, Along::Y);
            panel.head = wrapped(shown.title, slot);
            if (!hasOneLabel)
                std::ranges::copy(wrapped(shown.yLabel, slot), std::back_inserter(panel.head));
            left = std::max(left, roomOf(panel.yTicks));
            head = std::max(head, kLinePx * static_cast<double>(panel.head.size()));
        }
        const Lines xLabel = wrapped(figure_.xLabel, slot - left);
        double next = end_;  // row
        for (std::size_t i = 0; i < count; ++i) {
            if (i % columns == 0) end_ = next;
            const Panel& panel = panels[i];
            const double start = static_cast<double>(i % columns) * (slot + kGap);
            Plane plane = panel.plane;
            plane.left = start + left;
            plane.width = slot - left - kEdge;
            plane.top = end_ + head + 8.0;
            svg_ += svgLines(
                start, end_ + head - 4.0 - kLinePx * (static_cast<double>(panel.head.size()) - 1.0),
                "start", panel.head);
            svg_ += axesSvg(plane,
                            isOverNames() ? ticksNamed(figure_.xNames, plane.x, plane.width)
                                          : ticksAt(panel.x, plane.x, plane.width),
                            panel.yTicks);
            drawMarks(figure_.panels[i].marks, plane);
            for (std::size_t n = 0; n < figure_.panels[i].curves.size(); ++n) {
                svg_ += fmt::format("<g data-curve=\"{}\">\n{}</g>\n", n,
                                    curveSvg(figure_.panels[i], n, plane));
            }
            next = plane.top + plane.height + 30.0;
            if (i + columns < count) continue;
            svg_ += svgLines(plane.left + 0.5 * plane.width, next + 4.0, "middle", xLabel);
        }
        end_ = next - 6.0 + kLinePx * static_cast<double>(xLabel.size());
    }

    /// A series of nights, say: low, as many of them stand on a page, and of small points.
    bool isOverNames() const { return !figure_.xNames.empty(); }

    void drawMarks(const std::vector<tables::FigureMark>& marks, const Plane& plane) {
        for (const tables::FigureMark& mark : marks) {
            const double x = plane.xOf(mark.x);
            const std::string colour = mark.isWorse ? "var(--fails)" : "var(--holds)";
            svg_ += svgLine(x, plane.top - 8.0, x, plane.top + plane.height,
                            "stroke=\"" + colour + "\" stroke-dasharray=\"5 3\"");
            svg_ += svgText(x, plane.top - 12.0, "middle", mark.text, "fill=\"" + colour + "\"");
        }
    }

    /// What a point says of itself: "grass, peeling: size 4, time [ms] 4.2 (range 4 – 5)".
    std::string pointText(const tables::FigurePanel& panel, const tables::FigureCurve& curve,
                          const tables::FigurePoint& point, std::string_view what) const {
        if (!point.remark.empty()) {
            return point.remark + boundsText(point.bounds, point.interval);
        }
        Lines names;
        if (!panel.title.empty()) names.push_back(panel.title);
        if (figure_.curveNames.size() > 1) names.push_back(curve.name);
        if (!what.empty()) names.emplace_back(what);
        return fmt::format("{}{}{}, {}", joined(names), names.empty() ? "" : ": ",
                           valueText(figure_.xLabel, point.x, point.xBounds, point.xInterval),
                           valueText(panel.yLabel, *point.y, point.bounds, point.interval));
    }

    std::string curveSvg(const tables::FigurePanel& panel, std::size_t which,
                         const Plane& plane) const {
        const tables::FigureCurve& curve = panel.curves[which];
        const CurveStyle& style = styleOf(which % nameCount(figure_));
        const auto path = [&](const std::vector<tables::FigurePoint>& points,
                              std::string_view attributes) {
            std::vector<std::pair<double, std::optional<double>>> places;
            for (const tables::FigurePoint& point : points) places.emplace_back(point.x, point.y);
            return pathSvg(plane, places, attributes);
        };
        const std::string_view colour =
            figure_.curveNames.size() > 1 ? style.colour : "currentColor";
        const std::string reference = group(colour, path(curve.reference, kReference));
        std::string bars, markers;
        const auto addPoint = [&](const tables::FigurePoint& point, double size,
                                  std::string_view attributes, std::string_view what) {
            if (!point.y || !plane.x.shows(point.x) || !plane.y.shows(*point.y)) return;
            const double x = plane.xOf(point.x), y = plane.yOf(*point.y);
            const auto within = [](double end, const PlotAxis& axis) {
                return std::clamp(end, axis.low, axis.high);
            };
            if (hasEnds(point.bounds, point.interval)) {
                bars += intervalBar(x, plane.yOf(within(point.interval.low, plane.y)),
                                    plane.yOf(within(point.interval.high, plane.y)));
            }
            if (hasEnds(point.xBounds, point.xInterval)) {
                bars += intervalBar(y, plane.xOf(within(point.xInterval.low, plane.x)),
                                    plane.xOf(within(point.xInterval.high, plane.x)), Along::X);
            }
            markers += marker(style, x, y, size, attributes, pointText(panel, curve, point, what));
        };
        for (const auto& point : curve.points)
            addPoint(point, isOverNames() ? kSmallPoint : kMeasured, "stroke=\"none\"", "");
        for (const auto& point : curve.printed) addPoint(point, kPrinted, kHollow, "printed");
        const std::string_view line = isOverNames() ? kFaint : lineOf(figure_, which);
        const std::string drawn = group(style.colour, path(curve.points, line) + bars + markers);
        return isOverNames() ? drawn + reference : reference + drawn;
    }

    const tables::Figure& figure_;
    double width_;
    double end_ = 0.0;  // of what was drawn
    std::string svg_;
};

}  // namespace

std::string figureSvg(const tables::Figure& figure, const std::string& title, double width) {
    return FigureDrawing(figure, width).draw(title);
}

// The curves of the tables of a run.

namespace {

std::vector<config::PlotSpec> plotsOf(const config::Experiment& experiment,
                                      const tables::Table& table) {
    return experiment.hasDefaultLayout() ? tables::defaultPlots(table) : experiment.plots;
}

/// As one run has it, and what it lacks.
struct Drawn {
    Curve curve;
    tables::Figure figure = {};  // without panels where it has a problem
};

Drawn drawn(const tables::Table& table, const config::PlotSpec& plot) {
    Drawn one{{table.id, plot.title.empty() ? table.title : plot.title, "", ""}};
    const std::string absent = tables::whatIsAbsent(plot, table);
    if (absent.empty()) one.figure = tables::makeFigure(plot, table);
    if (one.figure.panels.empty()) {
        one.curve.problem =
            absent.empty() ? "no value was measured" : "not among what was measured: " + absent;
    } else if (plot.slope) {
        tables::addReference(one.figure, *plot.slope);
    }
    return one;
}

/// `file` is where it goes as one; empty: nowhere.
Curve drawCurve(const tables::Table& table, const config::PlotSpec& plot, const fs::path& file) {
    auto [curve, figure] = drawn(table, plot);
    if (figure.panels.empty()) {
        if (!file.empty()) fs::remove(file);  // of a run before this one
        return curve;
    }
    curve.svg = figureSvg(figure, curve.title, kWidePx);
    if (!file.empty()) writeFileAtomic(file, curve.svg);
    curve.svg += figureSvg(figure, curve.title, kNarrowPx);
    return curve;
}

}  // namespace

std::vector<Curve> overlaidCurves(const std::vector<std::vector<tables::Table>>& tables,
                                  const std::vector<std::vector<config::Experiment>>& experiments) {
    struct Laid {
        Curve curve;
        std::vector<tables::Figure> figures;
        std::vector<std::string> letters;
    };
    std::map<std::pair<std::string, std::size_t>, Laid> all;  // by table, and which of its plots
    std::vector<std::pair<std::string, std::size_t>> order;
    for (std::size_t run = 0; run < tables.size(); ++run) {
        for (std::size_t i = 0; i < tables[run].size(); ++i) {
            const auto plots = plotsOf(experiments[run][i], tables[run][i]);
            for (std::size_t n = 0; n < plots.size(); ++n) {
                Drawn one = drawn(tables[run][i], plots[n]);
                const std::pair key{tables[run][i].id, n};
                const auto [place, isNew] = all.try_emplace(key, Laid{one.curve, {}, {}});
                if (isNew) order.push_back(key);
                if (one.figure.panels.empty()) continue;
                place->second.curve.problem.clear();
                place->second.figures.push_back(std::move(one.figure));
                place->second.letters.push_back(Model::letter(run));
            }
        }
    }
    std::vector<Curve> curves;
    for (const auto& key : order) {
        Laid& laid = all.at(key);
        Curve& curve = curves.emplace_back(std::move(laid.curve));
        if (laid.figures.empty()) continue;
        const tables::Figure figure = tables::overlaid(laid.figures, laid.letters);
        if (laid.figures.size() == 1) curve.title = laid.letters[0] + ": " + curve.title;
        for (const double width : {kWidePx, kNarrowPx}) {
            curve.svg += figureSvg(figure, curve.title, width);
        }
    }
    return curves;
}

std::vector<Curve> drawCurves(const fs::path& folder, const std::vector<tables::Table>& tables,
                              const std::vector<config::Experiment>& experiments) {
    GFXREPRO_ASSERT_EQ(experiments.size(), tables.size());
    std::vector<Curve> curves;
    for (std::size_t i = 0; i < experiments.size(); ++i) {
        const std::vector<config::PlotSpec> plots = plotsOf(experiments[i], tables[i]);
        for (std::size_t n = 0; n < plots.size(); ++n) {
            const std::string suffix = n == 0 ? "" : fmt::format("-{}", n + 1);
            const fs::path file = "plots/" + tables[i].slug + suffix + ".svg";
            curves.push_back(
                drawCurve(tables[i], plots[n], folder.empty() ? fs::path() : folder / file));
        }
    }
    return curves;
}

}  // namespace gfxrepro::report
