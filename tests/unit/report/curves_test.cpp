#include "runner/report/curves.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "engine/core/files.h"
#include "runner/report/svg.h"
#include "runner/tables/table.h"
#include "tests/support/support.h"
#include "tests/unit/report/well_formed.h"
#include "tests/unit/tables/fixture.h"

namespace gfxrepro::report {
namespace {

using testing::DoubleEq;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

tables::FigurePoint point(double x, double y, double halfWidth = 0.0) {
    tables::FigurePoint point{.x = x, .y = y, .interval = {y - halfWidth, y + halfWidth}};
    if (halfWidth > 0.0) point.bounds = tables::Bounds::Interval;
    return point;
}

tables::Figure figureOf(std::vector<tables::FigurePoint> points) {
    return tables::Figure{.xLabel = "size",
                          .curveNames = {"one"},
                          .panels = {{"", "time (ms)", {{"one", std::move(points), {}}}}}};
}

tables::Figure twoCurves() {
    tables::Figure figure = figureOf({point(1, 10, 0.5), point(2, kNan), point(4, 30.25)});
    figure.panels[0].curves[0].points[1].y.reset();
    figure.panels[0].curves.push_back({"two", {point(1, 0.1)}, {point(1, 0.2)}});
    figure.curveNames = {"one", "two"};
    figure.notes = {"left out: 1 of 4 values (1 crash)"};
    return figure;
}

/// The SVG, which is well-formed, has no ids and asks for nothing.
std::string svgOf(const tables::Figure& figure, double width = kWidePx) {
    std::string svg = figureSvg(figure, "A title", width);
    std::set<std::string> ids;
    EXPECT_EQ(test::xmlProblem(svg, ids), "") << svg;
    EXPECT_TRUE(ids.empty());
    for (const char* wrong : {"nan", "inf", "href", "url(", "<script", "<style"}) {
        EXPECT_THAT(svg, Not(HasSubstr(wrong)));
    }
    return svg;
}

std::vector<std::string> findAll(const std::string& text, const std::string& pattern) {
    const std::regex expression(pattern);
    std::vector<std::string> found;
    for (std::sregex_iterator at(text.begin(), text.end(), expression), end; at != end; ++at) {
        found.push_back((*at)[1]);
    }
    return found;
}

/// "x y" of the round markers of measured points.
std::vector<std::string> pointsOf(const std::string& svg) {
    std::vector<std::string> places;
    const std::string marker = "<circle cx=\"([\\d.]+\" cy=\"[\\d.]+)\" r=\"3.2\" stroke";
    for (std::string place : findAll(svg, marker)) {
        place.replace(place.find('"'), 6, " ");
        places.push_back(place);
    }
    return places;
}

// The y axis reaches from 0 to 20 + 5 %. Its widest text has two letters, 13.44 wide; with 10
// beside it the plot begins at 23.44, and ends 14 before 608. Its label is a line of 16, and 8 are
// below.
constexpr double kLeft = 23.44, kPlotWidth = 570.56, kTop = 24.0, kPlotHeight = 270.0;

TEST(FigureSvg, PointsLieWhereTheDataSay) {
    const std::string svg = svgOf(figureOf({point(0, 0), point(10, 20)}));
    const double left = kLeft + kPlotWidth * 0.5 / 11.0;  // x from −0.5 to 10.5
    const double right = kLeft + kPlotWidth * 10.5 / 11.0;
    const double high = kTop + kPlotHeight * (1.0 - 20.0 / 21.0);
    const std::vector<std::string> expected = {fmt::format("{:.5g} 294", left),
                                               fmt::format("{:.5g} {:.5g}", right, high)};
    EXPECT_EQ(pointsOf(svg), expected);
    EXPECT_EQ(expected[1], "568.07 36.857");
    EXPECT_THAT(svg, HasSubstr("d=\"M49.375 294L568.07 36.857\" fill=\"none\""));  // the line
    EXPECT_THAT(svg, HasSubstr("d=\"M23.44 36.857L594 36.857\""));                 // the rule at 20
    EXPECT_THAT(svg, HasSubstr("text-anchor=\"end\">20</text>"));
    EXPECT_THAT(svg, HasSubstr("<title>size 10, time (ms) 20</title>"));
}

TEST(FigureSvg, LogarithmicAxesHaveTheirMiddleAtTheGeometricMean) {
    tables::Figure figure = figureOf({point(1, 1), point(10, 100), point(100, 1e4)});
    figure.isLogX = figure.isLogY = true;
    // "1000" is 26.88 wide: the plot is 557.12 wide from 36.88 on.
    EXPECT_EQ(pointsOf(svgOf(figure))[1], "315.44 159");
}

TEST(FigureSvg, IntervalsReachFromEndToEnd) {
    tables::Figure figure = figureOf({point(0, 20), point(5, 10, 5), point(10, 20)});
    const std::string svg = svgOf(figure);
    // 5 and 15 of 20.75, 270 high, at the middle of the plot; and the lines across both ends. It
    // begins at 49: the legend is 19 high, with 6 below.
    EXPECT_THAT(svg, HasSubstr("d=\"M308.72 253.94L308.72 123.82\""));
    EXPECT_THAT(svg, HasSubstr("d=\"M304.22 253.94L313.22 253.94\""));
    EXPECT_THAT(svg, HasSubstr("d=\"M304.22 123.82L313.22 123.82\""));
    EXPECT_THAT(svg, HasSubstr("<title>size 5, time (ms) 10 (95 % interval 5 – 15)</title>"));
    EXPECT_THAT(svg, HasSubstr(">95 % interval</text>"));  // the legend
    EXPECT_THAT(svgOf(figureOf({point(0, 20)})), Not(HasSubstr("interval")));
}

/// What both axes show was measured: an error over a time.
TEST(FigureSvg, IntervalsOfBothAxes) {
    tables::Figure figure = figureOf({point(0, 20), point(5, 20), point(10, 20)});
    figure.panels[0].curves[0].points[1].xBounds = tables::Bounds::Interval;
    figure.panels[0].curves[0].points[1].xInterval = {2.5, 7.5};
    const std::string svg = svgOf(figure);
    const auto level = findAll(svg, "d=\"M([\\d.]+) ([\\d.]+)L[\\d.]+ \\2\" stroke-width=\"1.2\"");
    EXPECT_EQ(level.size(), 1U);
    EXPECT_THAT(svg, HasSubstr("<title>size 5 (95 % interval 2.5 – 7.5), time (ms) 20</title>"));
}

/// A name and what it names are told by one number: a script takes them away together.
TEST(FigureSvg, NamesSayWhichCurveTheyAre) {
    const std::string svg = svgOf(twoCurves());
    EXPECT_EQ(findAll(svg, "(<g data-name=\"[01]\">)").size(), 2U);
    const std::size_t second = svg.find("<g data-curve=\"1\">");
    ASSERT_NE(second, svg.npos);
    EXPECT_GT(svg.find("<title>two, printed"), second);
    EXPECT_LT(svg.find("<title>one: "), second);
}

/// On a logarithmic axis an interval may reach down to where nothing is.
TEST(FigureSvg, IntervalsStayWithinTheAxis) {
    tables::Figure figure = figureOf({point(1, 10, 10), point(2, 20)});
    figure.isLogY = true;
    std::string svg = svgOf(figure);
    const auto bars = findAll(svg, "d=\"(M[\\d.]+ [\\d.]+L[\\d.]+ [\\d.]+)\" stroke-width=\"1.2\"");
    ASSERT_EQ(bars.size(), 3U);
    // The plot ends 270 below 49.
    EXPECT_THAT(bars[0], ContainsRegex("M[0-9.]+ 319L"));
    figure.panels[0].curves[0].points[0].interval = {kNan, kNan};
    svg = svgOf(figure);
    EXPECT_THAT(svg, Not(HasSubstr("(95 %")));
}

TEST(FigureSvg, LeavesGaps) {
    const auto segments = [](const std::string& svg) {
        const auto lines = findAll(svg, "d=\"([^\"]*)\" fill=\"none\" stroke-width=\"1.8\"");
        return lines.empty() ? -1 : std::count(lines[0].begin(), lines[0].end(), 'L');
    };
    tables::Figure figure = figureOf({point(1, 10), point(2, 20), point(4, 30)});
    EXPECT_EQ(segments(svgOf(figure)), 2);
    figure.panels[0].curves[0].points[1].y.reset();
    EXPECT_EQ(segments(svgOf(figure)), 0);  // none leads from 1 to 4
    EXPECT_EQ(pointsOf(svgOf(figure)).size(), 2U);
}

TEST(FigureSvg, NamesWhatIsThere) {
    const std::string svg = svgOf(twoCurves());
    for (const char* text :
         {">one</text>", ">two</text>", ">measured</text>", ">printed</text>",
          ">95 % interval</text>", ">size</text>", ">time (ms)</text>",
          ">left out: 1 of 4 values (1 crash)</text>",
          "<title>two, printed: size 1, time (ms) 0.2</title>", "<title>A title</title>"}) {
        EXPECT_THAT(svg, HasSubstr(text));
    }
    EXPECT_THAT(svg, StartsWith("<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"wide\""));
    EXPECT_THAT(svg, HasSubstr(" role=\"group\" "));
    const std::string alone = svgOf(figureOf({point(1, 10), point(4, 30)}));
    EXPECT_THAT(alone, Not(HasSubstr(">one</text>")));  // its axis has its name
    EXPECT_THAT(alone, Not(HasSubstr("printed")));
}

TEST(FigureSvg, DrawsAReferenceAndNamesItsSlope) {
    tables::Figure figure = twoCurves();
    EXPECT_THAT(svgOf(figure), Not(HasSubstr("slope")));
    figure.isLogX = figure.isLogY = true;
    figure.slope = -0.5;
    figure.panels[0].curves[0].reference = {point(1, 20), point(4, 10)};
    const std::string svg = svgOf(figure);
    EXPECT_THAT(svg, HasSubstr(">slope −0.5</text>"));
    const std::string dashed = "stroke-dasharray";
    EXPECT_EQ(findAll(svg, "(" + dashed + ")").size(), 2U);  // the legend's, that of one curve
}

TEST(FigureSvg, NightsHaveTheirNamesAndMarks) {
    tables::Figure figure = figureOf({point(0, 10), point(1, 10), point(2, 20)});
    figure.xNames = {"2026-11-20", "2026-11-21", "2026-11-22"};
    figure.panels[0].curves[0].points[2].remark = "2026-11-22, c1: 20 ms";
    figure.panels[0].marks = {{1.5, "× 2.000", true}};
    const std::string svg = svgOf(figure);
    EXPECT_THAT(svg, HasSubstr(">2026-11-21</text>"));
    EXPECT_THAT(svg, HasSubstr("<title>2026-11-22, c1: 20 ms</title>"));
    EXPECT_THAT(svg, HasSubstr("<title>size 1, time (ms) 10</title>"));
    EXPECT_THAT(svg, HasSubstr("fill=\"var(--fails)\">× 2.000</text>"));
    figure.panels[0].marks[0].isWorse = false;
    EXPECT_THAT(svgOf(figure), HasSubstr("stroke=\"var(--holds)\""));
}

TEST(FigureSvg, PanelsStandInTwoColumnsOrOne) {
    tables::Figure figure = figureOf({point(1, 10), point(2, 20)});
    figure.panels.assign(3, figure.panels[0]);
    for (std::size_t i = 0; i < 3; ++i) figure.panels[i].title = "panel " + std::to_string(i);
    const auto placesOf = [&](double width, const std::string& text) {
        return findAll(svgOf(figure, width), "<text x=\"([\\d.]+)\"[^>]*>" + text + "</text>");
    };
    EXPECT_THAT(placesOf(kWidePx, "panel \\d"), ElementsAre("0", "313", "0"));
    EXPECT_THAT(placesOf(kNarrowPx, "panel \\d"), ElementsAre("0", "0", "0"));
    EXPECT_EQ(placesOf(kWidePx, "size").size(), 2U);  // below the lowest of each column
    EXPECT_EQ(placesOf(kNarrowPx, "size").size(), 1U);
    EXPECT_EQ(placesOf(kWidePx, "time \\(ms\\)").size(), 1U);  // of all
    figure.panels[2].yLabel = "rays";
    EXPECT_EQ(placesOf(kWidePx, "time \\(ms\\)").size(), 2U);
    EXPECT_EQ(placesOf(kWidePx, "rays").size(), 1U);
}

TEST(FigureSvg, LongTextsAreBroken) {
    tables::Figure figure = twoCurves();
    figure.curveNames[0] = figure.notes[0] = figure.panels[0].yLabel =
        "a name that is so long that no narrow page has room for it in one line, not at all";
    for (const std::string& line : findAll(svgOf(figure, kNarrowPx), ">([^<]*)</text>")) {
        EXPECT_LE(textWidth(line), kNarrowPx) << line;
    }
    EXPECT_THAT(wrapped("one two three", textWidth("one two")), ElementsAre("one two", "three"));
    EXPECT_THAT(wrapped("one", 1.0), ElementsAre("one"));
}

/// What XML might take for something else.
TEST(FigureSvg, TextStaysText) {
    const std::string hostile =
        "it's \"x\" &e; <f> ]]> --> <![CDATA[ \x01 </svg><script>alert(1)</script> µ→\nEOD";
    tables::Figure figure = twoCurves();
    figure.xLabel = figure.notes[0] = hostile;
    figure.curveNames[0] = figure.panels[0].curves[0].name = hostile;
    figure.panels[0].title = figure.panels[0].yLabel = hostile;
    figure.panels.push_back(figure.panels[0]);
    std::set<std::string> ids;
    for (const double width : {kWidePx, kNarrowPx}) {
        const std::string svg = figureSvg(figure, hostile, width);
        EXPECT_EQ(test::xmlProblem(svg, ids), "");
        EXPECT_THAT(svg, Not(HasSubstr("<script")));
        EXPECT_THAT(svg, HasSubstr("&lt;/svg&gt;&lt;script&gt;"));
    }
}

TEST(FigureSvg, DrawsWhatLittleThereIs) {
    const double middle = kTop + 0.5 * kPlotHeight;
    EXPECT_EQ(pointsOf(svgOf(figureOf({}))).size(), 0U);
    EXPECT_EQ(pointsOf(svgOf(tables::Figure())).size(), 0U);
    EXPECT_EQ(pointsOf(svgOf(figureOf({point(3, 7)}))).size(), 1U);
    EXPECT_EQ(pointsOf(svgOf(figureOf({point(1, 7), point(2, 7), point(3, 7)}))).size(), 3U);
    EXPECT_THAT(pointsOf(svgOf(figureOf({point(3, 7)})))[0],
                EndsWith(fmt::format(" {:.5g}", middle)));
    EXPECT_EQ(pointsOf(svgOf(figureOf({point(0, 0), point(kNan, 1), point(1, kNan),
                                       point(1, std::numeric_limits<double>::infinity())})))
                  .size(),
              1U);
    tables::Figure figure = figureOf({point(1, 7), point(1, 0), point(0, 7), point(-2, -7)});
    figure.isLogX = figure.isLogY = true;
    EXPECT_EQ(pointsOf(svgOf(figure)).size(), 1U);
}

/// Of two luminances, as WCAG 2 has it; 3 is asked of graphics.
double contrast(double a, double b) {
    return (std::max(a, b) + 0.05) / (std::min(a, b) + 0.05);
}

double luminance(const std::string& hex) {
    constexpr double kWeights[] = {0.2126, 0.7152, 0.0722};
    double sum = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
        const double c = std::stoi(hex.substr(2 * i, 2), nullptr, 16) / 255.0;
        sum += kWeights[i] * (c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
    }
    return sum;
}

TEST(FigureSvg, ColoursStandOutFromLightAndDark) {
    tables::Figure figure = figureOf({});
    figure.panels[0].curves.assign(7, {"c", {point(1, 10)}, {}});
    figure.curveNames.assign(7, "c");
    const std::string svg = svgOf(figure);
    const auto found = findAll(svg, "=\"#([0-9a-f]{6})\"");
    const std::set<std::string> colours(found.begin(), found.end());
    EXPECT_EQ(colours.size(), 7U);
    for (const std::string& colour : colours) {
        EXPECT_GE(contrast(luminance(colour), luminance("ffffff")), 3.0) << colour;
        EXPECT_GE(contrast(luminance(colour), luminance("15181c")), 3.0) << colour;
    }
    // All else takes the colour of the text around.
    for (const char* fixed : {"black", "white", "rgb", "#000", "#fff"}) {
        EXPECT_THAT(svg, Not(HasSubstr(fixed)));
    }
    EXPECT_THAT(svg, HasSubstr("fill=\"currentColor\""));
}

config::Experiment curveExperiment() {
    return tables::experimentFrom(R"(
sweep: {scene: [a], size: [1, 2, 4]}
layout: {rows: [scene, size], columns: {time_ms: {metric: gpu_time_ms}}}
plots:
  - {x: size, y: time_ms, by: scene}
  - {x: size, y: time_ms, by: scene, log: [x, y], title: By powers}
)");
}

tables::Recorded curveRecords() {
    tables::RecordMaker maker;
    for (const int size : {1, 2, 4}) {
        maker.beginCase("a", "{\"size\":" + std::to_string(size) + "}");
        maker.add("gpu_time_ms", {3.0 * size, 3.1 * size});
    }
    return maker.records();
}

TEST(Curves, EachPlotIsAFile) {
    const TemporaryFolder folder;
    const auto tables = tables::buildTables({curveExperiment()}, curveRecords());
    const auto curves = drawCurves(folder.path(), tables, {curveExperiment()});
    ASSERT_EQ(curves.size(), 2U);
    EXPECT_EQ(curves[0].table, "zju2005/9.9");
    EXPECT_EQ(curves[0].title, "A table");
    EXPECT_EQ(curves[1].title, "By powers");
    for (const auto& [file, curve] :
         {std::pair("zju2005-9.9.svg", curves[0]), std::pair("zju2005-9.9-2.svg", curves[1])}) {
        std::set<std::string> ids;
        const std::string svg = readFile(folder.path() / "plots" / file);
        EXPECT_EQ(test::xmlProblem(svg, ids), "");
        EXPECT_THAT(svg, HasSubstr("class=\"wide\""));
        EXPECT_THAT(curve.svg, StartsWith(svg));
        EXPECT_THAT(curve.svg, HasSubstr("class=\"narrow\""));
    }
    EXPECT_EQ(drawCurves("", tables, {curveExperiment()})[1].svg, curves[1].svg);
}

TEST(Curves, NothingIsDrawnOfNothing) {
    const TemporaryFolder folder;
    const auto stale = folder.write("plots/zju2005-9.9.svg", "old");
    const auto curves = drawCurves(folder.path(), tables::buildTables({curveExperiment()}, {}),
                                   {curveExperiment()});
    EXPECT_EQ(curves.at(0).problem, "no value was measured");
    EXPECT_EQ(curves[0].svg, "");
    EXPECT_FALSE(fs::exists(stale));
}

constexpr double kGap = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<std::string> textsOf(const std::vector<Tick>& ticks) {
    std::vector<std::string> texts;
    for (const Tick& tick : ticks) {
        if (!tick.text.empty()) texts.push_back(tick.text);
    }
    return texts;
}

std::vector<std::string> upward(const PlotAxis& axis, double length = 270.0) {
    return textsOf(ticksOf(axis, length, Along::Y));
}

TEST(PlotAxis, Ranges) {
    const PlotAxis flat = axisOf({3.0, 3.0}, false, true);
    EXPECT_DOUBLE_EQ(flat.low, 2.85);
    EXPECT_DOUBLE_EQ(flat.high, 3.15);
    EXPECT_EQ(axisOf({0.0}, false, true).high, 1.0);
    EXPECT_EQ(axisOf({1.0, 10.0}, false, true).low, 0.0);
    EXPECT_DOUBLE_EQ(axisOf({1.0, 10.0}, false, true).high, 10.45);
    EXPECT_DOUBLE_EQ(axisOf({1.0, 10.0}, false, false).low, 0.55);
    EXPECT_DOUBLE_EQ(axisOf({9.0, 10.0}, false, true).low, 8.95);  // a small change far from zero
    EXPECT_DOUBLE_EQ(axisOf({-1.0, 1.0}, false, true).low, -1.1);
    const PlotAxis powers = axisOf({1.0, 100.0}, true, true);
    EXPECT_DOUBLE_EQ(powers.low, std::pow(10.0, -0.1));
    EXPECT_DOUBLE_EQ(powers.high, std::pow(10.0, 2.1));
}

TEST(PlotAxis, LeavesOutWhatItCannotShow) {
    EXPECT_EQ(axisOf({}, false, true).high, 1.0);
    EXPECT_EQ(axisOf({kGap, kInfinity}, false, true).high, 1.0);
    EXPECT_DOUBLE_EQ(axisOf({kGap, 2.0, 4.0, -kInfinity}, false, false).low, 1.9);
    const PlotAxis powers = axisOf({-1.0, 0.0, 5.0}, true, false);
    EXPECT_DOUBLE_EQ(powers.low, 5.0 / 1.1);
    EXPECT_DOUBLE_EQ(powers.high, 5.0 * 1.1);
    EXPECT_FALSE(powers.shows(0.0));
    EXPECT_FALSE(powers.shows(kGap));
    EXPECT_TRUE(PlotAxis().shows(-3.0));
    EXPECT_FALSE(PlotAxis().shows(kInfinity));
}

TEST(PlotAxis, Places) {
    const PlotAxis linear{2.0, 10.0};
    EXPECT_DOUBLE_EQ(linear.at(2.0), 0.0);
    EXPECT_DOUBLE_EQ(linear.at(4.0), 0.25);
    const PlotAxis powers{1.0, 1e4, true};
    EXPECT_DOUBLE_EQ(powers.at(10.0), 0.25);
    EXPECT_DOUBLE_EQ(powers.at(1e4), 1.0);
}

TEST(PlotAxis, LinearTicksAreRound) {
    EXPECT_THAT(upward({0.0, 21.0}), ElementsAre("0", "5", "10", "15", "20"));
    EXPECT_THAT(upward({0.0, 1.1}), ElementsAre("0", "0.2", "0.4", "0.6", "0.8", "1.0"));
    EXPECT_THAT(upward({0.0, 1.1}, 60.0), ElementsAre("0", "1"));
    EXPECT_THAT(upward({9.6, 12.5}, 150.0), ElementsAre("10", "11", "12"));
    EXPECT_THAT(upward({-0.011, 0.011}, 100.0), ElementsAre("−0.01", "0", "0.01"));
    EXPECT_THAT(upward({0.0, 2.1e6}, 120.0), ElementsAre("0", "10⁶", "2·10⁶"));
    EXPECT_THAT(upward({0.0, 0.00045}, 120.0), ElementsAre("0", "2·10⁻⁴", "4·10⁻⁴"));
    EXPECT_THAT(upward({3.0, 3.0 + 4.5e-5}, 100.0), ElementsAre("3.00000", "3.00002", "3.00004"));
    EXPECT_THAT(upward({1e6 - 1.0, 1e6 + 11.0}, 100.0),
                ElementsAre("10⁶", "1.000005·10⁶", "1.00001·10⁶"));
    const std::vector<Tick> ticks = ticksOf({0.0, 0.35}, 300.0, Along::X);
    EXPECT_EQ(ticks[3].value, 0.3);  // not 0.1 · 3, which is another number
}

/// Whatever the range: within it, two texts or more, one step, which is 1, 2 or 5 times a power.
TEST(PlotAxis, LinearTicksAreRoundEverywhere) {
    for (double high = 1e-9; high < 1e12; high *= 1.37) {
        for (const double low : {0.0, -0.3 * high, 0.9 * high}) {
            for (const double length : {150.0, 270.0, 560.0}) {
                const std::vector<Tick> ticks = ticksOf({low, high}, length, Along::Y);
                ASSERT_GE(ticks.size(), 2U) << low << " " << high;
                const double step = ticks[1].value - ticks[0].value;
                const double mantissa = step / std::pow(10.0, std::floor(std::log10(step) + 1e-6));
                EXPECT_THAT(mantissa,
                            AnyOf(testing::DoubleNear(1, 1e-6), testing::DoubleNear(2, 1e-6),
                                  testing::DoubleNear(5, 1e-6)));
                EXPECT_LE(static_cast<double>(ticks.size()), length / 30.0 + 2.0);
                EXPECT_GE(ticks[0].value, low - 1e-6 * step);
                EXPECT_LE(ticks.back().value, high + 1e-6 * step);
            }
        }
    }
}

TEST(PlotAxis, LogarithmicTicks) {
    EXPECT_THAT(upward({0.5, 2e7, true}),
                ElementsAre("1", "10", "100", "1000", "10⁴", "10⁵", "10⁶", "10⁷"));
    EXPECT_THAT(upward({0.04, 3.0, true}), ElementsAre("0.05", "0.1", "0.2", "0.5", "1", "2"));
    EXPECT_THAT(upward({1e-9, 1e-6, true}, 150.0), ElementsAre("10⁻⁹", "10⁻⁸", "10⁻⁷", "10⁻⁶"));
    EXPECT_THAT(upward({9000, 60000, true}, 150.0), ElementsAre("10⁴", "2·10⁴", "5·10⁴"));
    EXPECT_THAT(upward({0.5, 2e10, true}, 100.0), ElementsAre("1", "10⁵", "10¹⁰"));
    EXPECT_THAT(upward({9.9, 11.1, true}, 100.0), ElementsAre("10.0", "10.5", "11.0"));
    const std::vector<Tick> ticks = ticksOf({0.9, 110.0, true}, 100.0, Along::Y);
    EXPECT_THAT(textsOf(ticks), ElementsAre("1", "10", "100"));
    EXPECT_EQ(ticks.size(), 20U);  // 0.9, and of each decade nine, and 100
}

TEST(PlotAxis, TextsDoNotOverlap) {
    for (double decades = 0.02; decades < 200.0; decades *= 1.1) {
        for (const double length : {120.0, 290.0, 560.0}) {
            for (const bool isLog : {true, false}) {
                const PlotAxis axis{3e-7, 3e-7 * std::pow(10.0, decades), isLog};
                double end = -100.0;
                for (const Tick& tick : ticksOf(axis, length, Along::X)) {
                    if (tick.text.empty()) continue;
                    const double place = length * axis.at(tick.value);
                    EXPECT_GT(place - 0.5 * textWidth(tick.text), end) << decades << " " << length;
                    end = place + 0.5 * textWidth(tick.text);
                }
                EXPECT_GT(end, 0.0) << "no text: " << decades << " " << length;
            }
        }
    }
}

TEST(PlotAxis, ExtremeValuesEndTicksToo) {
    const std::vector<std::vector<double>> extremes = {
        {1e-310, 2e-310}, {1e-200, 1.0, 1e200}, {1e-119, 1e119}, {-1e119, 1e119}, {1e-9, 1e299}};
    for (const auto& values : extremes) {
        for (const bool isLog : {false, true}) {
            const PlotAxis axis = axisOf(values, isLog, false);
            EXPECT_FALSE(ticksOf(axis, 300.0, Along::X).empty()) << values[0] << ' ' << isLog;
            EXPECT_FALSE(ticksOf(axis, 100.0, Along::Y).empty()) << values[0] << ' ' << isLog;
            for (const double value : values) {
                if (!axis.shows(value)) continue;
                EXPECT_GE(axis.at(value), 0.0) << value;
                EXPECT_LE(axis.at(value), 1.0) << value;
            }
        }
    }
}

TEST(PlotAxis, NamesStandAtAsManyPlacesAsHaveRoom) {
    const std::vector<std::string> days(10, "2026-11-21");
    EXPECT_EQ(ticksNamed(days, {-0.5, 9.5}, 1000.0).size(), 10U);
    const std::vector<Tick> some = ticksNamed(days, {-0.5, 9.5}, 300.0);
    ASSERT_EQ(some.size(), 3U);
    EXPECT_EQ(some[0].value, 1.0);
    EXPECT_EQ(some[1].value, 4.0);
    EXPECT_EQ(ticksNamed({"one"}, {-1.0, 1.0}, 300.0).at(0).value, 0.0);
}

TEST(PlotAxis, TicksStandAtFewAndShortValues) {
    EXPECT_THAT(textsOf(ticksAt({512, 64, 128, 256, 64}, {60, 540, true}, 300.0)),
                ElementsAre("64", "128", "256", "512"));
    EXPECT_THAT(textsOf(ticksAt({1, 3, 7}, {0, 8}, 300.0)), ElementsAre("1", "3", "7"));
    // 1 to 3 would overlap; the next have too many digits to be read.
    EXPECT_THAT(textsOf(ticksAt({1, 2, 3, 1000}, {0, 1000}, 300.0)),
                ElementsAre("0", "500", "1000"));
    EXPECT_THAT(textsOf(ticksAt({1.23456, 2.34567}, {1, 2.4}, 300.0)),
                ElementsAre("1.0", "1.5", "2.0"));
    EXPECT_THAT(textsOf(ticksAt({kGap, 2}, {1, 3}, 300.0)), ElementsAre("2"));
    EXPECT_GE(ticksAt({}, {0, 1}, 300.0).size(), 2U);
}

}  // namespace
}  // namespace gfxrepro::report
