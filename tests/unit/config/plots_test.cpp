
#include "runner/config/experiment.h"
#include "tests/unit/config/experiment_fixture.h"

namespace gfxrepro::config {
namespace {

struct PlotTest : ExperimentTest {
    /// A file with row axes scene (text) and size (numbers), columns aa and bb, and these plots.
    static std::string body(const std::string& plots) {
        return "table: p/1\ntitle: t\ntechnique: x\n"
               "sweep: {scene: [s, t], size: [1, 2]}\n"
               "layout: {rows: [scene, size], columns: {aa: m, bb: m}}\n"
               "plots: " +
               plots;
    }
    std::string plotError(const std::string& plot) const {
        return loadError(body("[" + plot + "]\n"));
    }
};

TEST_F(PlotTest, Reads) {
    const Experiment table = load(
        body("\n  - {x: size, y: [aa, bb], panels: scene, log: [x, y], title: Time over size}\n"
             "  - {x: size, y: aa, by: scene, at: {scene: [s, t]}}\n"
             "  - {x: aa, y: bb, log: y}\n"));
    ASSERT_EQ(table.plots.size(), 3U);
    const PlotSpec& plot = table.plots[0];
    EXPECT_EQ(plot.title, "Time over size");
    EXPECT_EQ(plot.x, "size");
    EXPECT_THAT(plot.y, ElementsAre("aa", "bb"));
    EXPECT_THAT(plot.panels, ElementsAre("scene"));
    EXPECT_TRUE(plot.isLogX);
    EXPECT_TRUE(plot.isLogY);
    EXPECT_EQ(plot.location.line, 7);
    EXPECT_EQ(table.plots[1].by, "scene");
    EXPECT_EQ(table.plots[1].at.at(0).second.size(), 2U);
    EXPECT_FALSE(table.plots[2].isLogX);
    EXPECT_TRUE(table.plots[2].isLogY);
}

TEST_F(PlotTest, ASlopeIsOfLogarithmicAxes) {
    const Experiment table = load(
        body("\n  - {x: aa, y: bb}\n  - {x: size, y: aa, by: scene, log: [x, y], slope: -0.5}\n"));
    EXPECT_EQ(table.plots[0].slope, std::nullopt);
    EXPECT_EQ(table.plots[1].slope, -0.5);
    const std::string head = "DIR/zju/a.yaml:6:";
    EXPECT_EQ(plotError("{x: aa, y: bb, log: x, slope: 2}"),
              head +
                  "39: plot 1: slope is a straight line on logarithmic axes alone; allowed: with "
                  "log: [x, y]");
    for (const std::string bad : {"half", "nan", "[1]", ".inf"}) {
        EXPECT_EQ(plotError("{x: aa, y: bb, slope: " + bad + "}"),
                  head + "31: plot 1: slope is " + bad + "; allowed: a number");
    }
}

TEST_F(PlotTest, BadAxes) {
    const std::string head = "DIR/zju/a.yaml:6:";
    EXPECT_EQ(plotError("{y: aa}"), head + "9: plot 1 needs 'x'");
    EXPECT_EQ(plotError("{x: size}"), head + "9: plot 1 needs 'y'");
    EXPECT_EQ(
        plotError("{x: scene, y: aa}"),
        head + "13: plot 1: x is row axis 'scene', whose s is no number; allowed: size, aa, bb");
    EXPECT_EQ(
        plotError("{x: siz, y: aa}"),
        head + "13: plot 1: x is 'siz', neither a row axis nor a column; did you mean 'size'?");
    EXPECT_EQ(
        plotError("{x: width, y: aa}"),
        head + "13: plot 1: x is 'width', neither a row axis nor a column; allowed: size, aa, bb");
    EXPECT_EQ(plotError("{x: size, y: cc}"),
              head + "22: plot 1: unknown column 'cc'; allowed: aa, bb");
    EXPECT_EQ(plotError("{x: size, y: [aa, aa], by: scene}"),
              head + "27: plot 1: column 'aa' stands twice");
    EXPECT_EQ(plotError("{x: size, y: []}"),
              head + "22: plot 1: y is []; allowed: a column, or a list");
    EXPECT_EQ(plotError("{x: size, y: aa, log: [z]}"),
              head + "32: plot 1: log is z; allowed: x | y");
    EXPECT_EQ(plotError("{x: size, y: aa, log: [x, x]}"),
              head + "35: plot 1: log: 'x' stands twice");
    EXPECT_EQ(
        plotError("{x: size, y: aa, zoom: 2}"),
        head + "26: plot 1: unknown key 'zoom'; allowed: x, y, by, panels, at, log, slope, title");
    EXPECT_EQ(loadError(body("{x: size}\n")),
              head + "8: plots is {x: size}; allowed: a list of plots");
}

TEST_F(PlotTest, EveryRowAxisHasItsPlace) {
    const std::string head = "DIR/zju/a.yaml:6:";
    EXPECT_EQ(plotError("{x: size, y: aa}"), head +
                                                 "9: plot 1: row axis 'scene' has no place; "
                                                 "allowed: in by or panels, or one value in at");
    EXPECT_EQ(plotError("{x: size, y: aa, at: {scene: [s, t]}}"),
              head +
                  "9: plot 1: row axis 'scene' has no place; allowed: in by or panels, or one "
                  "value in at");
    EXPECT_EQ(plotError("{x: size, y: aa, at: {scene: t}}"), "no error");
    EXPECT_EQ(plotError("{x: size, y: aa, at: {scene: u}}"),
              head + "38: plot 1: at.scene is u; allowed: s | t");
    EXPECT_EQ(plotError("{x: size, y: aa, by: sceen}"),
              head + "30: plot 1: by is sceen; allowed: scene | size");
    EXPECT_EQ(plotError("{x: size, y: aa, by: scene, panels: [scene]}"),
              head + "46: plot 1: row axis 'scene' is used twice");
    EXPECT_EQ(plotError("{x: size, y: aa, by: size}"),
              head + "30: plot 1: row axis 'size' is used twice");
}

TEST_F(PlotTest, NeedsALayout) {
    EXPECT_EQ(errorWith("plots: []"), "DIR/zju/a.yaml:4:1: 'plots' without 'layout'");
    EXPECT_EQ(loadError("table: p/1\ntitle: t\nprinted: {values: \"a\\n1\"}\nplots: []\n"),
              "DIR/zju/a.yaml:4:1: 'plots' without 'technique'");
}

/// A profile may leave one value of an axis, a plan's document knows none of its values.
TEST_F(PlotTest, HoldsUnderASmallerSweep) {
    const std::string text = body("[{x: size, y: aa, at: {scene: t}}]\n");
    ExperimentOptions options;
    options.sweeps = {parseOverride("scene=s")};
    const Experiment smaller = load(text, options);
    EXPECT_EQ(smaller.plots.size(), 1U);
    EXPECT_EQ(experimentFromDocument(smaller.document, "a.yaml").plots.size(), 1U);
}

}  // namespace
}  // namespace gfxrepro::config
