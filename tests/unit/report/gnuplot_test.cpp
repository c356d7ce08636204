#include "runner/report/gnuplot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <set>

#include "runner/core/files.h"
#include "runner/report/plot.h"
#include "runner/tables/table.h"
#include "tests/support/support.h"
#include "tests/unit/report/well_formed.h"
#include "tests/unit/tables/fixture.h"

namespace gfxrepro::report {
namespace {

using testing::HasSubstr;
using testing::Not;

/// What gnuplot, its enhanced text, XML and our own adapting might take for something else.
constexpr const char* kHostile =
    "it's \"x\" 50 % %d _a ^{b} {/Bold c} @d &e; <f> ]]> `touch g` $h #i \\n \\ µ→ fill=\"black\" "
    "id='j'\nEOD\nprint 1";
constexpr const char* kHostileInSvg =
    "it's \"x\" 50 % %d _a ^{b} {/Bold c} @d &amp;e; &lt;f> ]]&gt; `touch g` $h #i \\n \\ µ→ "
    "fill=\"black\" id='j' EOD print 1";

tables::FigurePoint point(double x, double y, double halfWidth = 0.0) {
    tables::FigurePoint point;
    point.x = x;
    point.y = y;
    point.interval = {y - halfWidth, y + halfWidth};
    if (halfWidth > 0.0) point.bounds = tables::Bounds::Interval;
    return point;
}

tables::Figure twoCurves() {
    tables::Figure figure;
    figure.xLabel = "size";
    figure.curveNames = {"one", "two"};
    tables::FigurePoint gap;
    gap.x = 2.0;
    gap.remark = "crash";
    figure.panels = {{"",
                      "time (ms)",
                      {{"one", {point(1, 10, 0.5), gap, point(4, 30.25)}, {}},
                       {"two", {point(1, 0.1)}, {point(1, 0.2)}}}}};
    figure.notes = {"left out: 1 of 4 values (1 crash)"};
    return figure;
}

tables::Figure hostileFigure() {
    tables::Figure figure = twoCurves();
    figure.xLabel = figure.notes[0] = kHostile;
    figure.curveNames = {kHostile, "two"};
    figure.panels[0].title = figure.panels[0].yLabel = figure.panels[0].curves[0].name = kHostile;
    figure.panels.push_back(figure.panels[0]);
    return figure;
}

/// Puts a program of this name and text in front of PATH, for as long as the object lives.
class ProgramInFront {
  public:
    ProgramInFront(const test::TemporaryFolder& folder, const std::string& name,
                   const std::string& text)
        : before_(std::getenv("PATH")) {
        const std::filesystem::path file = folder.write(name, text);
        std::filesystem::permissions(file, std::filesystem::perms::owner_all);
        ::setenv("PATH", (file.parent_path().string() + ":" + before_).c_str(), 1);
    }
    ~ProgramInFront() { ::setenv("PATH", before_.c_str(), 1); }
    ProgramInFront(const ProgramInFront&) = delete;
    ProgramInFront& operator=(const ProgramInFront&) = delete;

  private:
    std::string before_;
};

TEST(Gnuplot, OneThatDoesNotEndIsKilled) {
    const test::TemporaryFolder folder;
    const ProgramInFront program(folder, "gnuplot", "#!/bin/sh\nexec sleep 20\n");
    const auto begin = std::chrono::steady_clock::now();
    const Drawn drawn =
        runGnuplot(folder.write("a.gp", "plot 1\n"), std::chrono::milliseconds(500));
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
    EXPECT_EQ(drawn.problem, "gnuplot did not end in 0.5 s");
    EXPECT_EQ(drawn.svg, "");
}

TEST(Gnuplot, EndsWithTheProgramThatBeganIt) {
    const test::TemporaryFolder folder;
    const auto script = folder.write("a.gp", "plot 1\n");
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    const ProgramInFront program(
        folder, "gnuplot", "#!/bin/sh\necho >&" + std::to_string(ends[1]) + "\nexec sleep 20\n");
    const pid_t beginner = ::fork();
    if (beginner == 0) {
        runGnuplot(script);
        ::_exit(0);
    }
    ::close(ends[1]);
    char begun = 0;
    EXPECT_EQ(::read(ends[0], &begun, 1), 1);
    ::kill(beginner, SIGTERM);
    ::waitpid(beginner, nullptr, 0);
    pollfd closed{ends[0], POLLIN, 0};  // once nobody has the other end
    EXPECT_EQ(::poll(&closed, 1, 10'000), 1) << "gnuplot goes on";
    ::close(ends[0]);
}

class Drawing : public testing::Test {
  protected:
    void SetUp() override {
        const auto script = folder.write("probe.gp", "set terminal svg\nplot 1\n");
        if (!runGnuplot(script).problem.empty()) GTEST_SKIP() << "gnuplot is not installed";
    }
    /// The SVG as it is written; the test fails where there is none.
    std::string svgOf(const tables::Figure& figure, const std::string& name) const {
        const auto script = folder.write(name + ".gp", gnuplotScript(figure, name, kHostile));
        const Drawn drawn = runGnuplot(script);
        EXPECT_EQ(drawn.problem, "");
        return adaptedSvg(drawn.svg, name);
    }
    test::TemporaryFolder folder;
};

TEST(GnuplotScript, HoldsItsData) {
    const std::string script = gnuplotScript(twoCurves(), "p", "Table 1: t");
    EXPECT_THAT(script, testing::StartsWith("# Table 1: t\n"));
    EXPECT_THAT(script, HasSubstr("$panel1_curve1 << EOD\n1 10 9.5 10.5\n2 NaN NaN NaN  # crash\n4 "
                                  "30.25 NaN NaN\nEOD\n"));
    EXPECT_THAT(script, HasSubstr("$panel1_curve2_printed << EOD\n1 0.2\nEOD\n"));
    EXPECT_THAT(script, HasSubstr("title 'printed'"));
    EXPECT_THAT(script, HasSubstr("title '95 % interval'"));
    EXPECT_THAT(script, HasSubstr("set xlabel 'size'"));
    EXPECT_THAT(script, HasSubstr("'left out: 1 of 4 values (1 crash)'"));
    EXPECT_THAT(script, HasSubstr("$panel1_curve1 using 1:($3):(0):($4 - $3) with vectors"));
    EXPECT_THAT(script, Not(HasSubstr("$panel1_curve2 using 1:($3)")));  // one sample each
    EXPECT_THAT(script, Not(HasSubstr("logscale")));
}

TEST(GnuplotScript, NamesOnlyWhatIsThere) {
    tables::Figure figure = twoCurves();
    figure.isLogX = figure.isLogY = true;
    figure.curveNames = {"one"};
    figure.panels[0].curves = {{"one", {point(1, 10), point(4, 30)}, {}}};
    const std::string script = gnuplotScript(figure, "p", "s");
    EXPECT_THAT(script, Not(HasSubstr("keyentry")));  // a line alone is named by its axis
    EXPECT_THAT(script, HasSubstr("set logscale x\nset logscale y\n"));
}

TEST(GnuplotScript, DrawsAReferenceAndNamesItsSlope) {
    tables::Figure figure = twoCurves();
    EXPECT_THAT(gnuplotScript(figure, "p", "s"), Not(HasSubstr("slope")));
    figure.isLogX = figure.isLogY = true;
    figure.slope = -0.5;
    figure.panels[0].curves[0].reference = {point(1, 20), point(4, 10)};
    const std::string script = gnuplotScript(figure, "p", "s");
    EXPECT_THAT(script, HasSubstr("$panel1_curve1_slope << EOD\n1 20\n4 10\nEOD\n"));
    EXPECT_THAT(script, HasSubstr("keyentry with lines dashtype 2 linewidth 1.2 linecolor black "
                                  "title 'slope −0.5'"));
    EXPECT_THAT(script, HasSubstr("$panel1_curve1_slope using 1:2 with lines dashtype 2"));
    EXPECT_THAT(script, Not(HasSubstr("$panel1_curve2_slope")));
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

TEST(GnuplotScript, ColoursStandOutFromLightAndDark) {
    tables::Figure figure = twoCurves();
    figure.panels[0].curves.assign(7, {"c", {point(1, 10)}, {}});
    figure.curveNames.assign(7, "c");
    const std::string script = gnuplotScript(figure, "p", "s");
    std::set<std::string> colours;
    const std::string head = "linespoints linecolor rgb '#";
    for (std::size_t at = script.find(head); at != std::string::npos;
         at = script.find(head, at + 1)) {
        colours.insert(script.substr(at + head.size(), 6));
    }
    EXPECT_EQ(colours.size(), 7U);
    for (const std::string& colour : colours) {
        EXPECT_GE(contrast(luminance(colour), luminance("ffffff")), 3.0) << colour;
        EXPECT_GE(contrast(luminance(colour), luminance("15181c")), 3.0) << colour;
    }
}

TEST(GnuplotScript, Quotes) {
    EXPECT_EQ(gnuplotQuoted("it's\n\\"), "'it''s \\'");
    EXPECT_EQ(gnuplotQuoted("'a'"), "'’a'''");
    const std::string script = gnuplotScript(hostileFigure(), "p", kHostile);
    EXPECT_THAT(script, Not(HasSubstr("\nEOD\nprint 1")));
    EXPECT_THAT(script, HasSubstr("set xlabel 'it''s \"x\" 50 %"));
}

TEST_F(Drawing, IsWellFormedAndSafe) {
    const std::string svg = svgOf(hostileFigure(), "plot_x");
    std::set<std::string> ids;
    EXPECT_EQ(test::xmlProblem(svg, ids), "");
    EXPECT_GT(ids.size(), 10U);
    for (const std::string& id : ids) EXPECT_THAT(id, testing::StartsWith("plot_x_"));
    // Both labels, the note, the panels' titles, the legend.
    const std::string text = "<text>" + std::string(kHostileInSvg) + "</text>";
    int count = 0;
    for (std::size_t at = svg.find(text); at != std::string::npos; at = svg.find(text, at + 1)) {
        ++count;
    }
    EXPECT_EQ(count, 7);
    EXPECT_FALSE(std::filesystem::exists("g"));
    for (const char* forbidden : {"<script", "<image", "@font-face",
                                  "http://www.w3.org/2000/svg\">"
                                  "<",
                                  "<?xml"}) {
        EXPECT_THAT(svg, Not(HasSubstr(forbidden)));
    }
}

TEST_F(Drawing, TakesTheColourOfThePage) {
    const std::string svg = svgOf(twoCurves(), "p");
    EXPECT_THAT(svg, HasSubstr("fill=\"currentColor\""));
    for (const char* fixed :
         {"\"black\"", "'black'", "\"white\"", " color='white'", "rgb(  0,   0,   0)"}) {
        EXPECT_THAT(svg, Not(HasSubstr(fixed)));
    }
    EXPECT_THAT(svg, HasSubstr("fill=\"none\"/>"));  // the ground
}

/// The gap at x = 2 parts the line: it is begun twice, and no segment leads from 1 to 4.
TEST_F(Drawing, LeavesGaps) {
    const auto segments = [](const std::string& svg) {
        const std::size_t path = svg.find("d='", svg.find("stroke='rgb( 31, 119, 201)'"));
        const std::string d = svg.substr(path, svg.find('/', path) - path);
        return std::count(d.begin(), d.end(), 'L');
    };
    tables::Figure figure = twoCurves();
    figure.panels[0].curves.resize(1);
    figure.curveNames.resize(1);
    figure.panels[0].curves[0].points = {point(1, 10), point(2, 20), point(4, 30)};
    EXPECT_EQ(segments(svgOf(figure, "whole")), 2);
    figure.panels[0].curves[0].points[1].y.reset();
    EXPECT_EQ(segments(svgOf(figure, "parted")), 0);
}

TEST_F(Drawing, SaysWhatGnuplotSays) {
    const auto script = folder.write("bad.gp", "set terminal svg\nplot nothing\n");
    EXPECT_THAT(runGnuplot(script).problem, testing::StartsWith("gnuplot failed: "));
    EXPECT_THAT(runGnuplot(script).problem, HasSubstr("undefined variable: nothing"));
    const auto empty = folder.write("empty.gp", "");
    EXPECT_EQ(runGnuplot(empty).problem, "gnuplot failed: it wrote no SVG");
}

config::Experiment experiment() {
    return tables::experimentFrom(R"(
sweep: {scene: [a], size: [1, 2, 4]}
layout: {rows: [scene, size], columns: {time_ms: {metric: gpu_time_ms}}}
plots:
  - {x: size, y: time_ms, by: scene}
  - {x: size, y: time_ms, by: scene, log: [x, y], title: By powers}
)");
}

tables::Recorded records() {
    tables::RecordMaker maker;
    for (const int size : {1, 2, 4}) {
        maker.beginCase("a", "{\"size\":" + std::to_string(size) + "}");
        maker.add("gpu_time_ms", {3.0 * size, 3.1 * size});
    }
    return maker.records();
}

TEST_F(Drawing, WritesFilesOfEachPlot) {
    std::chrono::milliseconds patience = kGnuplotPatience;
    const auto files = writePlots(folder.path(), tables::buildTables({experiment()}, records()),
                                  {experiment()}, patience);
    ASSERT_EQ(files.size(), 2U);
    EXPECT_EQ(files[0].table, "zju2005/9.9");
    EXPECT_EQ(files[0].title, "A table");
    EXPECT_EQ(files[0].svg, "plots/zju2005-9.9.svg");
    EXPECT_EQ(files[0].script, "plots/zju2005-9.9.gp");
    EXPECT_EQ(files[1].title, "By powers");
    EXPECT_EQ(files[1].svg, "plots/zju2005-9.9-2.svg");
    // Both may stand in one page.
    std::set<std::string> ids;
    const std::string both =
        readFile(folder.path() / files[0].svg) + readFile(folder.path() / files[1].svg);
    EXPECT_EQ(test::xmlProblem("<html>" + both + "</html>", ids), "");
}

TEST_F(Drawing, DrawsNothingOfNothing) {
    std::chrono::milliseconds patience = kGnuplotPatience;
    const auto stale = folder.write("plots/zju2005-9.9.svg", "old");
    const auto files = writePlots(folder.path(), tables::buildTables({experiment()}, {}),
                                  {experiment()}, patience);
    EXPECT_EQ(files.at(0).problem, "no value was measured");
    EXPECT_EQ(files[0].svg, "");
    EXPECT_EQ(files[0].script, "");
    EXPECT_FALSE(std::filesystem::exists(stale));
}

TEST(Plots, AllTogetherWaitForGnuplotNoLongerThanOne) {
    const test::TemporaryFolder folder;
    const ProgramInFront program(folder, "gnuplot", "#!/bin/sh\nexec sleep 20\n");
    std::chrono::milliseconds patience(500);
    const auto files = writePlots(folder.path(), tables::buildTables({experiment()}, records()),
                                  {experiment()}, patience);
    ASSERT_EQ(files.size(), 2U);
    EXPECT_EQ(files[0].problem, "gnuplot did not end in 1.5 s");
    EXPECT_EQ(files[1].problem, "gnuplot did not end in 1 s");
    EXPECT_EQ(patience, std::chrono::milliseconds(0));
}

TEST(Plots, GoWithoutGnuplot) {
    std::chrono::milliseconds patience = kGnuplotPatience;
    const test::TemporaryFolder folder;
    const auto stale = folder.write("plots/zju2005-9.9.svg", "old");
    const std::string path = std::getenv("PATH");
    ::setenv("PATH", folder.path().c_str(), 1);
    const auto files = writePlots(folder.path(), tables::buildTables({experiment()}, records()),
                                  {experiment()}, patience);
    ::setenv("PATH", path.c_str(), 1);
    EXPECT_EQ(files.at(0).problem, "gnuplot is not installed");
    EXPECT_EQ(files[0].svg, "");
    EXPECT_FALSE(std::filesystem::exists(stale));
    EXPECT_THAT(readFile(folder.path() / files[0].script), HasSubstr("$panel1_curve1 << EOD\n1 "));
}

}  // namespace
}  // namespace gfxrepro::report
