#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "runner/core/text.h"
#include "runner/records/csv.h"
#include "runner/report/gnuplot.h"
#include "runner/report/gnuplot_axis.h"
#include "runner/tables/reference_line.h"

namespace gfxrepro::report {

namespace {

/// A colour and a shape a curve. The first colours are after Okabe and Ito, the others were found
/// by a search: all have a contrast of 3 to white and to near-black, and a distance of 18 in CIELAB
/// to each other for readers with any kind of colour blindness (as simulated by Machado et al.
/// 2009).
struct CurveStyle {
    std::string_view colour;
    int filled, hollow;  // gnuplot's point types
};
constexpr std::array<CurveStyle, 7> kStyles = {{{"#1f77c9", 7, 6},
                                                {"#d55e00", 5, 4},
                                                {"#009e73", 9, 8},
                                                {"#666688", 13, 12},
                                                {"#ee0044", 11, 10},
                                                {"#aa00ee", 15, 14},
                                                {"#ee44ee", 7, 6}}};

// Everything in pixels; the page gives the width.
constexpr double kWidth = 640;
constexpr double kLegendLine = 18;
constexpr double kNoteLine = 16;
constexpr double kTitle = 28;
constexpr double kTicLabels = 28;
constexpr double kXLabel = 22;
constexpr double kYLabel = 22;
constexpr double kTicWidth = 48;
constexpr double kEdge = 14;
constexpr double kLine = 18;  // what gnuplot counts as a character's height, in offsets

constexpr std::string_view kReference = "dashtype 2 linewidth 1.2";
constexpr std::string_view kInterval = "heads size screen 0.004,90 fixed linewidth 1.2";

std::string number(double value) {
    return std::isfinite(value) ? records::shortestText(value) : "NaN";
}

/// For comments: one line.
std::string oneLine(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return c < 0x20; }, ' ');
    return text;
}

std::size_t letters(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
        return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
    }));
}

using BoundsSet = std::set<tables::Bounds>;

BoundsSet boundsOf(const tables::FigureCurve& curve) {
    BoundsSet bounds;
    for (const tables::FigurePoint& point : curve.points) {
        if (point.bounds != tables::Bounds::None) bounds.insert(point.bounds);
    }
    return bounds;
}

/// "95 % interval", "range", or both; where a curve has no bounds, what it would have.
std::string namesOf(const BoundsSet& bounds) {
    if (bounds.empty()) return std::string(tables::boundsName(tables::Bounds::Interval));
    std::vector<std::string> names;
    for (const tables::Bounds one : bounds) names.emplace_back(tables::boundsName(one));
    return joined(names, " or ");
}

/// Writes the script of one figure.
class ScriptWriter {
  public:
    explicit ScriptWriter(const tables::Figure& figure) : figure_(figure) {
        for (const tables::FigurePanel& panel : figure.panels) {
            for (const tables::FigureCurve& curve : panel.curves) {
                hasPrinted_ = hasPrinted_ || !curve.printed.empty();
                for (const tables::FigurePoint& point : curve.points) {
                    if (point.bounds != tables::Bounds::None) bounds_.insert(point.bounds);
                }
            }
        }
        listEntries();
        const auto count = figure.panels.size();
        panelColumns_ = count > 1 ? 2 : 1;
        panelRows_ = (count + panelColumns_ - 1) / panelColumns_;
        plotHeight_ = count > 1 ? 150 : 270;
        top_ = kEdge + (entries_.empty() ? 0 : 6) + kLegendLine * static_cast<double>(legendLines_);
        bottom_ = kXLabel + kNoteLine * static_cast<double>(figure.notes.size());
        hasOneYLabel_ = std::all_of(figure.panels.begin(), figure.panels.end(),
                                    [&](const tables::FigurePanel& panel) {
                                        return panel.yLabel == figure.panels[0].yLabel;
                                    });
        height_ = top_ + bottom_ + static_cast<double>(panelRows_) * rowHeight();
    }

    std::string write(const std::string& name, const std::string& source) {
        text_ = fmt::format(
            "# {}\n# Made by gfxrepro. To draw it: gnuplot FILE.gp > FILE.svg (gnuplot 5.4 or "
            "later)\n"
            "set terminal svg size {},{} fixed noenhanced font 'sans-serif,12' name {}\n"
            "set encoding utf8\n\n",
            oneLine(source), kWidth, height_, gnuplotQuoted(name));
        for (std::size_t i = 0; i < figure_.panels.size(); ++i) writeData(i);
        text_ += "set multiplot\n";
        writeLegend();
        writeLabels();
        text_ +=
            "set border 3 linewidth 0.8\nset tics out scale 0.6\n"
            "set grid ytics linetype 1 linewidth 0.6 linecolor rgb '#b0808080'\nunset key\n";
        if (figure_.isLogX) text_ += "set logscale x\n";
        if (figure_.isLogY) text_ += "set logscale y\n";
        for (std::size_t i = 0; i < figure_.panels.size(); ++i) writePanel(i);
        return std::move(text_) + "unset multiplot\n";
    }

  private:
    double rowHeight() const { return titleHeight() + plotHeight_ + kTicLabels; }
    double titleHeight() const {
        return std::all_of(figure_.panels.begin(), figure_.panels.end(),
                           [](const tables::FigurePanel& panel) { return panel.title.empty(); })
                   ? 0.0
                   : kTitle;
    }

    static const CurveStyle& styleOf(std::size_t curve) { return kStyles[curve % kStyles.size()]; }

    static std::string block(std::size_t panel, std::size_t curve, const char* what = "") {
        return fmt::format("$panel{}_curve{}{}", panel + 1, curve + 1, what);
    }

    /// A line alone needs no name: its axis has it.
    void listEntries() {
        if (figure_.curveNames.size() > 1) {
            for (std::size_t i = 0; i < figure_.curveNames.size(); ++i) {
                const CurveStyle& style = styleOf(i);
                entries_.push_back(fmt::format(
                    "keyentry with linespoints linecolor rgb '{}' linewidth 1.8 pointtype {} "
                    "pointsize 0.6 title {}",
                    style.colour, style.filled, gnuplotQuoted(figure_.curveNames[i])));
                longest_ = std::max(longest_, letters(figure_.curveNames[i]));
            }
        }
        const std::string colour =
            figure_.curveNames.size() > 1 ? "black" : fmt::format("rgb '{}'", styleOf(0).colour);
        if (hasPrinted_) {
            entries_.push_back(fmt::format(
                "keyentry with points linecolor {} pointtype 7 pointsize 0.6 title 'measured'",
                colour));
            entries_.push_back(
                fmt::format("keyentry with points linecolor {} linewidth 1.4 pointtype 6 pointsize "
                            "1.0 title 'printed'",
                            colour));
        }
        if (!bounds_.empty()) {
            entries_.push_back(fmt::format("keyentry with vectors {} linecolor {} title '{}'",
                                           kInterval, colour, namesOf(bounds_)));
        }
        if (figure_.slope) {
            entries_.push_back(fmt::format("keyentry with lines {} linecolor black title {}",
                                           kReference,
                                           gnuplotQuoted(tables::slopeName(*figure_.slope))));
        }
        longest_ = std::max<std::size_t>(longest_, 13);
        constexpr double kLetter = 6.6, kSample = 52;
        const double entry = kSample + kLetter * static_cast<double>(longest_);
        legendColumns_ = std::clamp<std::size_t>(static_cast<std::size_t>((kWidth - 20) / entry), 1,
                                                 std::max<std::size_t>(entries_.size(), 1));
        legendLines_ = (entries_.size() + legendColumns_ - 1) / legendColumns_;
    }

    void writeData(std::size_t panelIndex) {
        const tables::FigurePanel& panel = figure_.panels[panelIndex];
        for (std::size_t i = 0; i < panel.curves.size(); ++i) {
            const tables::FigureCurve& curve = panel.curves[i];
            if (!curve.points.empty()) {
                text_ += fmt::format("# {}{}{}: x, measured, ends of its {}\n{} << EOD\n",
                                     oneLine(panel.title), panel.title.empty() ? "" : ", ",
                                     oneLine(curve.name), namesOf(boundsOf(curve)),
                                     block(panelIndex, i));
                for (const tables::FigurePoint& point : curve.points) writePoint(point);
                text_ += "EOD\n";
            }
            if (!curve.printed.empty()) {
                text_ += fmt::format("# likewise as printed: x, y\n{} << EOD\n",
                                     block(panelIndex, i, "_printed"));
                writePairs(curve.printed);
            }
            if (!curve.reference.empty()) {
                text_ +=
                    fmt::format("# a line of {}: x, y\n{} << EOD\n",
                                tables::slopeName(*figure_.slope), block(panelIndex, i, "_slope"));
                writePairs(curve.reference);
            }
        }
        text_ += "\n";
    }

    void writePairs(const std::vector<tables::FigurePoint>& points) {
        for (const tables::FigurePoint& point : points) {
            text_ += fmt::format("{} {}\n", number(point.x), number(*point.y));
        }
        text_ += "EOD\n";
    }

    void writePoint(const tables::FigurePoint& point) {
        constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
        text_ +=
            fmt::format("{} {} {} {}{}\n", number(point.x), number(point.y.value_or(kNone)),
                        number(point.bounds != tables::Bounds::None ? point.interval.low : kNone),
                        number(point.bounds != tables::Bounds::None ? point.interval.high : kNone),
                        point.remark.empty() ? "" : "  # " + oneLine(point.remark));
    }

    /// A plot of its own across the top, so that no panel gives room for it.
    void writeLegend() {
        if (entries_.empty()) return;
        text_ += fmt::format(
            "unset border; unset tics; set xrange [0:1]; set yrange [0:1]\n"
            "set key at screen 0.5,{:.5f} top center horizontal maxcols {} Left reverse samplen 2\n"
            "plot NaN notitle, \\\n     {}\n",
            1.0 - 4.0 / height_, legendColumns_, joined(entries_, ", \\\n     "));
    }

    /// What stands outside of the panels. It is written with the first, and not again.
    void writeLabels() {
        const double panels = static_cast<double>(panelRows_) * rowHeight();
        if (hasOneYLabel_) {
            text_ +=
                fmt::format("set label 1 {} at screen {:.5f},{:.5f} center rotate by 90\n",
                            gnuplotQuoted(figure_.panels[0].yLabel), 0.5 * kYLabel / kWidth,
                            1.0 - (top_ + 0.5 * (panels - kTicLabels + titleHeight())) / height_);
        }
        for (std::size_t i = 0; i < figure_.notes.size(); ++i) {
            const double y = kNoteLine * (static_cast<double>(figure_.notes.size() - i) - 0.5);
            text_ += fmt::format("set label {} {} at screen {:.5f},{:.5f} left font ',11'\n", i + 2,
                                 gnuplotQuoted(figure_.notes[i]), kEdge / kWidth, y / height_);
        }
    }

    /// All values of a panel that its axes have to hold.
    void gather(const tables::FigurePanel& panel, std::vector<double>& x,
                std::vector<double>& y) const {
        for (const tables::FigureCurve& curve : panel.curves) {
            for (const auto* points : {&curve.points, &curve.printed, &curve.reference}) {
                for (const tables::FigurePoint& point : *points) {
                    x.push_back(point.x);
                    if (point.y) y.push_back(*point.y);
                    if (point.bounds == tables::Bounds::None) continue;
                    y.push_back(point.interval.high);
                    if (!figure_.isLogY || point.interval.low > 0) y.push_back(point.interval.low);
                }
            }
        }
    }

    void writeTics(char axis, const AxisRange& range, const Tics& tics) {
        const char* offset = axis == 'x' ? " offset 0,0.3" : "";
        if (tics.empty()) {
            const double step = linearStep(range, axis == 'y' && plotHeight_ < 200 ? 5 : 6);
            text_ += fmt::format("set {}tics nomirror {}{}; set format {} '%.10g'\n", axis,
                                 number(step), offset, axis);
            return;
        }
        std::vector<std::string> places;
        for (const auto& [value, label] : tics) {
            // The 1 makes a tic without a text a small one.
            places.push_back(
                fmt::format("'{}' {}{}", label, number(value), label.empty() ? " 1" : ""));
        }
        text_ += fmt::format("set {}tics nomirror ({}){}\n", axis, joined(places), offset);
    }

    /// Returns where the y axis begins.
    double writeAxes(const tables::FigurePanel& panel) {
        std::vector<double> x, y;
        gather(panel, x, y);
        const AxisRange xRange = rangeOf(x, figure_.isLogX, false);
        const AxisRange yRange = rangeOf(y, figure_.isLogY, true);
        text_ += fmt::format("set xrange [{}:{}]; set yrange [{}:{}]\n", number(xRange.low),
                             number(xRange.high), number(yRange.low), number(yRange.high));
        Tics tics = ticsAt(x, xRange, figure_.isLogX);
        if (tics.empty() && figure_.isLogX) tics = logarithmicTics(xRange);
        writeTics('x', xRange, tics);
        writeTics('y', yRange, figure_.isLogY ? logarithmicTics(yRange) : Tics{});
        return yRange.low;
    }

    void writePlace(std::size_t index) {
        const std::size_t row = index / panelColumns_;
        // Room for labels of the y axis is kept once if it says the same everywhere.
        const double labels = kYLabel * (hasOneYLabel_ ? 1.0 : static_cast<double>(panelColumns_));
        const double tics = kTicWidth + kEdge;
        const double width = (kWidth - labels) / static_cast<double>(panelColumns_) - tics;
        const double column = static_cast<double>(index % panelColumns_);
        const double left = kYLabel + kTicWidth + column * (width + tics + labels - kYLabel);
        const double end = top_ + rowHeight() * static_cast<double>(row + 1) - kTicLabels;
        text_ += fmt::format(
            "set lmargin at screen {:.5f}; set rmargin at screen {:.5f}\n"
            "set tmargin at screen {:.5f}; set bmargin at screen {:.5f}\n",
            left / kWidth, (left + width) / kWidth, 1.0 - (end - plotHeight_) / height_,
            1.0 - end / height_);
    }

    void writePanel(std::size_t index) {
        const tables::FigurePanel& panel = figure_.panels[index];
        text_ += fmt::format("\n# {}\n", panel.title.empty() ? "the axes" : oneLine(panel.title));
        writePlace(index);
        const double yLow = writeAxes(panel);
        const bool isLowest = index + panelColumns_ >= figure_.panels.size();
        text_ += fmt::format(
            "set title {} offset 0,-0.5\nset xlabel {} offset 0,{:.2f}\nset ylabel {}\n",
            gnuplotQuoted(panel.title), gnuplotQuoted(isLowest ? figure_.xLabel : ""), 12.0 / kLine,
            gnuplotQuoted(hasOneYLabel_ ? "" : panel.yLabel));
        std::vector<std::string> parts;
        for (std::size_t i = 0; i < panel.curves.size(); ++i) addParts(index, i, yLow, parts);
        text_ += "plot " + joined(parts, ", \\\n     ") + "\n";
        if (index == 0) text_ += "unset label\n";
    }

    void addParts(std::size_t panel, std::size_t index, double yLow,
                  std::vector<std::string>& parts) const {
        const tables::FigureCurve& curve = figure_.panels[panel].curves[index];
        const CurveStyle& style = styleOf(index);
        const std::string data = block(panel, index);
        if (!curve.reference.empty()) {  // below the curve
            const std::string colour =
                figure_.curveNames.size() > 1 ? fmt::format("rgb '{}'", style.colour) : "black";
            parts.push_back(
                fmt::format("{} using 1:2 with lines {} linecolor {} title {}",
                            block(panel, index, "_slope"), kReference, colour,
                            gnuplotQuoted(curve.name + ", " + tables::slopeName(*figure_.slope))));
        }
        if (!curve.points.empty()) {
            parts.push_back(fmt::format(
                "{} using 1:2 with linespoints linecolor rgb '{}' linewidth 1.8 pointtype {} "
                "pointsize 0.6 title {}",
                data, style.colour, style.filled, gnuplotQuoted(curve.name)));
        }
        if (const BoundsSet bounds = boundsOf(curve); !bounds.empty()) {
            // Arrows with flat heads, for below error bars gnuplot clears the ground in white. On a
            // logarithmic axis an interval may reach down to where nothing is.
            const std::string low =
                figure_.isLogY ? fmt::format("($3 > {0} ? $3 : {0})", number(yLow)) : "$3";
            parts.push_back(fmt::format(
                "{} using 1:({}):(0):($4 - {}) with vectors {} linecolor rgb '{}' title {}", data,
                low, low, kInterval, style.colour,
                gnuplotQuoted(curve.name + ", " + namesOf(bounds))));
        }
        if (!curve.printed.empty()) {
            parts.push_back(fmt::format(
                "{} using 1:2 with points linecolor rgb '{}' linewidth 1.4 pointtype {} "
                "pointsize 1.0 title {}",
                block(panel, index, "_printed"), style.colour, style.hollow,
                gnuplotQuoted(curve.name + ", printed")));
        }
    }

    const tables::Figure& figure_;
    std::vector<std::string> entries_;  // of the legend
    std::size_t longest_ = 0;           // name, in letters
    std::size_t legendColumns_ = 1;
    std::size_t legendLines_ = 0;
    std::size_t panelColumns_ = 1;
    std::size_t panelRows_ = 1;
    double plotHeight_ = 0;
    double top_ = 0;
    double bottom_ = 0;
    double height_ = 0;
    bool hasOneYLabel_ = true;  // for all panels
    bool hasPrinted_ = false;
    BoundsSet bounds_;
    std::string text_;
};

}  // namespace

std::string gnuplotScript(const tables::Figure& figure, const std::string& name,
                          const std::string& source) {
    return ScriptWriter(figure).write(name, source);
}

}  // namespace gfxrepro::report
