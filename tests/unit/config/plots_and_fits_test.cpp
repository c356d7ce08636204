#include "engine/core/files.h"
#include "runner/config/experiment.h"
#include "runner/config/printed_section.h"
#include "tests/unit/config/experiment_fixture.h"

namespace gfxrepro::config {
namespace {

struct FitTest : ExperimentTest {
    void SetUp() override { writeTable("70"); }

    /// A table of two methods; `conventional` is the one printed number that a fit may see.
    void writeTable(const std::string& conventional, const std::string& others = "1") const {
        folder.write("p/table.yaml",
                     "table: p/1\ntitle: t\ntechnique: x\n"
                     "sweep: {scene: [grass, tree], method: [conventional, better]}\n"
                     "layout:\n  rows: scene\n  columns:\n"
                     "    plain: {where: {method: conventional}, metric: redundant_pct}\n"
                     "    ours: {where: {method: better}, metric: redundant_pct}\n"
                     "    both: {metric: redundant_pct}\n"
                     "    plain_min: {where: {method: conventional}, metric: min_pct}\n"
                     "printed:\n  calibrated: [" +
                         calibrated_ +
                         "]\n"
                         "  values: |\n    scene,plain,ours,both,plain_min\n"
                         "    grass," +
                         conventional + "," + others + "," + others + "," + others + "\n    tree," +
                         others + "," + others + "," + others + ",lost\n");
    }
    std::string calibrated_ = "{column: [plain, ours, both, plain_min]}";
    std::string text(const std::string& row, const std::string& column,
                     const std::string& method = "params: {method: conventional}") const {
        return "sweep_of: c\ntitle: t\ntechnique: x\n" + method +
               "\nscene: grass\nsweep: {spread: [0.1, 0.2]}\n"
               "layout: {rows: spread, columns: {a: redundant_pct}}\n"
               "fit:\n  a: {table: p/table.yaml, row: {scene: " +
               row + "}, column: " + column + "}\n";
    }
    std::string errorOf(const std::string& row, const std::string& column,
                        const std::string& method = "params: {method: conventional}") const {
        return loadError(text(row, column, method));
    }
};

TEST_F(FitTest, SeesTheNamedCellAlone) {
    const Experiment fit = load(text("grass", "plain"));
    ASSERT_EQ(fitTargets(fit).size(), 1U);
    EXPECT_EQ(fitTargets(fit)[0].column, "a");
    EXPECT_EQ(fitTargets(fit)[0].table, "p/1");
    EXPECT_EQ(fitTargets(fit)[0].printed, 70.0);
    // Whatever else is printed there: the experiment is the same, all of it.
    writeTable("70", "99");
    EXPECT_TRUE(load(text("grass", "plain")).document.sameContent(fit.document));
    writeTable("71", "99");
    EXPECT_FALSE(load(text("grass", "plain")).document.sameContent(fit.document));
    const Experiment again = experimentFromDocument(fit.document, fit.file);
    EXPECT_EQ(fitTargets(again).at(0).printed, 70.0) << "a plan has what it needs";
    EXPECT_TRUE(fitTargets(load("sweep_of: c\ntitle: t\ntechnique: x\n")).empty());
}

TEST_F(FitTest, RefusesCellsThatTheirTableDoesNotMark) {
    const std::string error =
        "DIR/zju/a.yaml:9:57: fit: 'a': p/1 does not mark the cell as one that was fitted "
        "('printed.calibrated')";
    for (const char* marked :
         {"", "{column: ours}", "{scene: tree}", "{scene: tree, column: plain}"}) {
        calibrated_ = marked;
        writeTable("70");
        EXPECT_EQ(errorOf("grass", "plain"), error) << marked;
    }
    for (const char* marked : {"{column: plain}", "{scene: [tree, grass]}",
                               "{column: ours}, {scene: grass, column: [both, plain]}"}) {
        calibrated_ = marked;
        writeTable("70");
        EXPECT_EQ(errorOf("grass", "plain"), "no error") << marked;
    }
}

TEST_F(FitTest, RefusesWhatComparesMethods) {
    EXPECT_EQ(errorOf("grass", "ours"),
              "DIR/zju/a.yaml:9:57: fit: 'a': the printed cell is of method 'better', the cases of "
              "'conventional'; a fit sees what compares no methods");
    EXPECT_EQ(errorOf("grass", "both"),
              "DIR/zju/a.yaml:9:57: fit: 'a': the printed cell is of method '', the cases of "
              "'conventional'; a fit sees what compares no methods");
    EXPECT_THAT(errorOf("grass", "plain", "params: {}"),
                StartsWith("DIR/zju/a.yaml:9:6: fit: 'a': the cases are not all of one method"));
    EXPECT_EQ(loadError("sweep_of: c\ntitle: t\ntechnique: x\nscene: grass\n"
                        "sweep: {method: [conventional, better]}\n"
                        "layout: {rows: method, columns: {a: redundant_pct}}\n"
                        "fit:\n  a: {table: p/table.yaml, row: {scene: grass}, column: plain}\n"),
              "DIR/zju/a.yaml:8:6: fit: 'a': the cases are not all of one method in 'params'");
}

TEST_F(FitTest, FindsAColumnByTheLabelsOfAllItsAxes) {
    folder.write("p/table.yaml",
                 "table: p/1\ntitle: t\ntechnique: x\n"
                 "sweep: {scene: [grass, tree], method: [conventional, better]}\n"
                 "layout:\n  axes:\n    error:\n"
                 "      mean: {metric: redundant_pct}\n      worst: {metric: min_pct}\n"
                 "  rows: scene\n  columns: [error, method]\n"
                 "printed:\n  calibrated: [{scene: grass}]\n"
                 "  values: |\n    scene,mean_conventional,mean_better,worst_conventional\n"
                 "    grass,70,1,2\n    tree,3,4,5\n");
    EXPECT_EQ(fitTargets(load(text("grass", "mean_conventional"))).at(0).printed, 70.0);
    EXPECT_EQ(errorOf("grass", "mean_better"),
              "DIR/zju/a.yaml:9:57: fit: 'a': the printed cell is of method 'better', the cases of "
              "'conventional'; a fit sees what compares no methods");
    EXPECT_EQ(
        errorOf("grass", "worst_conventional"),
        "DIR/zju/a.yaml:9:57: fit: 'a': the column is redundant_pct, the printed cell min_pct");
}

TEST_F(FitTest, RefusesMethodsThatThePaperComparesEvenIfItMeasuresThem) {
    EXPECT_EQ(errorOf("grass", "ours", "params: {method: better}"), "no error");
    const std::string path = "p/table.yaml";
    const std::string table = readFile(folder.path() / path);
    folder.write(path, table + "  compared: [better]\n");
    EXPECT_EQ(errorOf("grass", "ours", "params: {method: better}"),
              "DIR/zju/a.yaml:9:57: fit: 'a': p/1 compares method 'better' with a usual one "
              "('compared'); a fit sees what compares no methods");
    EXPECT_EQ(errorOf("grass", "plain"), "no error");
}

TEST_F(FitTest, RefusesCellsThatAreNotThere) {
    EXPECT_EQ(errorOf("gras", "plain"), "DIR/zju/a.yaml:9:56: fit: 'a': no row gras is printed");
    EXPECT_EQ(errorOf("grass", "plane"),
              "DIR/zju/a.yaml:9:57: fit: 'a': the printed cell is of method '', the cases of "
              "'conventional'; a fit sees what compares no methods");
    EXPECT_EQ(
        errorOf("grass", "plain_min"),
        "DIR/zju/a.yaml:9:57: fit: 'a': the column is redundant_pct, the printed cell min_pct");
    const std::string start =
        "sweep_of: c\ntitle: t\ntechnique: x\nparams: {method: conventional}\n"
        "layout: {rows: method, columns: {a: redundant_pct}}\n";
    EXPECT_EQ(
        loadError(start + "fit: {b: {table: p/table.yaml, row: {scene: grass}, column: x}}\n"),
        "DIR/zju/a.yaml:6:7: fit: no column 'b'; did you mean 'a'?");
    EXPECT_THAT(
        loadError(start + "fit: {a: {table: p/none.yaml, row: {scene: grass}, column: x}}\n"),
        StartsWith("DIR/zju/a.yaml:6:18: fit: 'a': no file 'p/none.yaml' in DIR"));
    EXPECT_THAT(loadError(start + "fit: {a: {table: p/table.yaml, printed: 3}}\n"),
                StartsWith("DIR/zju/a.yaml:6:32: fit: 'a': unknown key 'printed'"));
    EXPECT_EQ(loadError("sweep_of: c\ntitle: t\ntechnique: x\nfit: {}\n"),
              "DIR/zju/a.yaml:4:1: 'fit' without 'layout'");
}

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
    const ExperimentOptions options{.sweeps = {parseOverride("scene=s")}};
    const Experiment smaller = load(text, options);
    EXPECT_EQ(smaller.plots.size(), 1U);
    EXPECT_EQ(experimentFromDocument(smaller.document, "a.yaml").plots.size(), 1U);
}

}  // namespace
}  // namespace gfxrepro::config
