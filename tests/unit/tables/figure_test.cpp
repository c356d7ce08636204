#include "runner/tables/figure.h"

#include <cmath>

#include "runner/tables/nearness.h"
#include "tests/support/support.h"
#include "tests/unit/tables/fixture.h"

namespace gfxrepro::tables {
namespace {

/// Scenes a and b, sizes 0 to 4; `plots` are checked against it.
config::Experiment sized(const std::string& plots, const std::string& printed = "") {
    return experimentFrom(R"(
sweep: {scene: [a, b], size: [4, 1, 0, 2]}
layout:
  rows: [scene, size]
  columns:
    draw_ms: {metric: gpu_time_ms}
    load_ms: {metric: cpu_time_ms}
    count: {metric: count}
  cell: "{median:.1f}"
)" + printed + "plots: " + plots);
}

/// Scene a: draw_ms is 10 · size by three processes, failed at size 1; b is not run.
Recorded sizedRecords() {
    RecordMaker maker;
    for (const int size : {0, 2, 4}) {
        maker.beginCase("a", "{\"size\":" + std::to_string(size) + "}");
        for (int process = 0; process < 3; ++process) {
            maker.process(process).add("gpu_time_ms", {10.0 * size + process - 1});
        }
        maker.process(0).add("cpu_time_ms", {7.0});
        maker.add("count", {100.0 + size}, "", "triangle");
    }
    maker.beginCase("a", "{\"size\":1}").fail(records::Status::Crash, "signal 11");
    return maker.records();
}

Figure figureOf(const config::Experiment& experiment, const Recorded& records) {
    return makeFigure(experiment.plots.at(0), buildTable(experiment, records));
}

TEST(Figure, OrdersPointsAndLeavesGaps) {
    const Figure figure = figureOf(sized("[{x: size, y: draw_ms, panels: scene}]"), sizedRecords());
    EXPECT_EQ(figure.xLabel, "size");
    ASSERT_EQ(figure.panels.size(), 1U);  // of scene b there is nothing
    EXPECT_EQ(figure.panels[0].title, "a");
    EXPECT_EQ(figure.panels[0].yLabel, "draw [ms]");
    const FigureCurve& curve = figure.panels[0].curves.at(0);
    EXPECT_EQ(curve.name, "draw");
    ASSERT_EQ(curve.points.size(), 4U);
    EXPECT_EQ(curve.points[0].x, 0.0);
    EXPECT_EQ(curve.points[0].y, 0.0);
    EXPECT_EQ(curve.points[1].x, 1.0);
    EXPECT_FALSE(curve.points[1].y.has_value());
    EXPECT_EQ(curve.points[1].remark, "crash");
    EXPECT_EQ(curve.points[3].y, 40.0);
    EXPECT_EQ(curve.points[3].bounds, Bounds::Range) << "of three processes";
    EXPECT_EQ(curve.points[3].interval.low, 39.0);
    EXPECT_THAT(figure.notes, ElementsAre("left out: 5 of 8 values (1 crash, 4 missing)"));
}

TEST(Figure, AReferenceGoesThroughTheMeanOfThePoints) {
    const config::Experiment experiment =
        sized("[{x: size, y: draw_ms, panels: scene, log: [x, y], slope: 2}]");
    const Table table = buildTable(experiment, sizedRecords());
    Figure figure = makeFigure(experiment.plots[0], table);
    EXPECT_TRUE(figure.panels[0].curves[0].reference.empty());
    addReference(figure, 2.0);
    EXPECT_EQ(figure.slope, 2.0);
    // 20 at size 2 and 40 at 4: √800 at √8, of which the line's ends are a factor of √2 away.
    const std::vector<FigurePoint>& ends = figure.panels[0].curves[0].reference;
    ASSERT_EQ(ends.size(), 2U);
    EXPECT_EQ(ends[0].x, 2.0);
    EXPECT_NEAR(*ends[0].y, std::sqrt(800.0) / 2.0, 1e-9);
    EXPECT_EQ(ends[1].x, 4.0);
    EXPECT_NEAR(*ends[1].y, std::sqrt(800.0) * 2.0, 1e-9);
}

TEST(Figure, PanelsAreNamedWithoutFoldersThatAllCanDoWithout) {
    const auto titles = [](const std::string& first, const std::string& second) {
        RecordMaker maker;
        for (const std::string& scene : {first, second}) {
            maker.beginCase(scene, "{\"size\":1}").add("gpu_time_ms", {1.0});
        }
        const config::Experiment experiment =
            experimentFrom("sweep: {scene: [" + first + ", " + second +
                           "], size: [1]}\nlayout: {rows: [scene, size], columns: {draw_ms: "
                           "{metric: gpu_time_ms}}, cell: \"{median:.1f}\"}\nplots: [{x: size, y: "
                           "draw_ms, panels: scene}]\n");
        const Figure figure = figureOf(experiment, maker.records());
        return figure.panels.at(0).title + "; " + figure.panels.at(1).title;
    };
    EXPECT_EQ(titles("outdoor/bird_nest", "outdoor/grass"), "bird nest; grass");
    EXPECT_EQ(titles("outdoor/room", "indoor/room"), "outdoor/room; indoor/room");
}

TEST(Figure, OneSampleHasNoInterval) {
    const Figure figure =
        figureOf(sized("[{x: size, y: load_ms, panels: scene, at: {scene: a}}]"), sizedRecords());
    EXPECT_EQ(figure.panels[0].curves[0].points[0].y, 7.0);
    EXPECT_EQ(figure.panels[0].curves[0].points[0].bounds, Bounds::None);
}

TEST(Figure, LogarithmicAxesLeaveOutWhatIsNotPositive) {
    const Figure figure = figureOf(
        sized("[{x: size, y: [draw_ms, load_ms], at: {scene: a}, log: [x, y]}]"), sizedRecords());
    for (const FigureCurve& curve : figure.panels.at(0).curves) {
        ASSERT_EQ(curve.points.size(), 3U) << curve.name;  // not size 0
        EXPECT_EQ(curve.points[0].x, 1.0);
    }
    EXPECT_THAT(figure.notes, ElementsAre("left out: 2 of 8 values (2 crash)",
                                          "left out: 2 values not positive on a logarithmic axis"));
    // Only draw_ms is 0 at size 0; its place stays, as a gap.
    const Figure half = figureOf(
        sized("[{x: size, y: [draw_ms, load_ms], at: {scene: a}, log: y}]"), sizedRecords());
    EXPECT_FALSE(half.panels.at(0).curves[0].points[0].y.has_value());
    EXPECT_EQ(half.panels.at(0).curves[1].points[0].y, 7.0);
    EXPECT_EQ(half.notes.at(1), "left out: 1 value not positive on a logarithmic axis");
}

TEST(Figure, PrintedStandsOverThePrintedX) {
    const std::string printed = R"(printed:
  values: |
    scene,size,draw_ms,count
    a,2,25,1000
    a,4,,2000
    a,8,99,4000
    c,8,77,4000
)";
    const Figure over =
        figureOf(sized("[{x: size, y: draw_ms, by: scene}]", printed), sizedRecords());
    EXPECT_EQ(over.curveNames.size(), 2U);  // scene c is not part of the run, size 8 is not of a's
    ASSERT_EQ(over.panels.at(0).curves.at(0).printed.size(), 2U);
    EXPECT_EQ(over.panels[0].curves[0].printed[1].x, 8.0);
    EXPECT_EQ(over.panels[0].curves[0].printed[1].y, 99.0);
    EXPECT_EQ(over.panels[0].curves[0].printed[0].x, 2.0);
    EXPECT_EQ(over.panels[0].curves[0].printed[0].y, 25.0);
    const Figure column =
        figureOf(sized("[{x: count, y: draw_ms, by: scene}]", printed), sizedRecords());
    EXPECT_EQ(column.xLabel, "count [triangle]");
    EXPECT_EQ(column.panels.at(0).curves.at(0).printed.at(0).x, 1000.0);
    ASSERT_EQ(column.panels[0].curves[0].points.size(), 3U);  // where there is a count
    EXPECT_EQ(column.panels[0].curves[0].points[1].x, 102.0);
}

TEST(Figure, CurvesAreColumnsOfEachValue) {
    const Figure figure =
        figureOf(sized("[{x: size, y: [draw_ms, load_ms], by: scene}]"), sizedRecords());
    EXPECT_THAT(figure.curveNames, ElementsAre("a, draw", "a, load", "b, draw", "b, load"));
    EXPECT_EQ(figure.panels.at(0).yLabel, "time [ms]");  // two metrics, one unit
    EXPECT_TRUE(figure.panels[0].curves[2].points[0].remark == "missing");
    const Figure sizes =
        figureOf(sized("[{x: count, y: draw_ms, by: size, at: {scene: a}}]"), sizedRecords());
    EXPECT_EQ(sizes.curveNames.at(0), "size 4");
}

/// A count and a time of two scenes, printed for both.
config::Experiment experiment(const std::string& printed = "") {
    return withPaperCases(experimentFrom(R"(
sweep: {scene: [models/duck, models/hugo]}
layout: {rows: scene, columns: {voxels: {metric: voxels}, draw_ms: {metric: gpu_time_ms}}}
assumptions: {padding: {value: 1, range: [0, 2], unit: voxels, why: not said}}
printed:
  values: |
    scene,voxels,draw_ms
    models/duck,100,5
    models/hugo,100,0
)" + printed),
                          {{"models/duck", "{}"}, {"models/hugo", "{}"}});
}

Table nearTable(const config::Experiment& experiment, double duck, double hugo) {
    RecordMaker maker;
    for (const auto& [scene, value] : {std::pair("models/duck", duck), {"models/hugo", hugo}}) {
        maker.beginCase(scene).add("voxels", {value}, "", "voxel").add("gpu_time_ms", {50.0});
    }
    return buildTable(experiment, maker.records());
}

TEST(Nearness, IsOfWhatIsPrintedAndMeasuredAtTheSameParameters) {
    const Nearness near = nearnessOf(experiment(), nearTable(experiment(), 110, 49));
    ASSERT_EQ(near.cells.size(), 3U);
    EXPECT_EQ(near.zeros, 1U) << "of 0 nothing is a multiple";
    EXPECT_DOUBLE_EQ(near.cells[0].ratio(), 1.1);
    EXPECT_TRUE(near.cells[0].isWithin(kTenthLow, kTenthHigh));
    EXPECT_FALSE(near.cells[0].isTime);
    EXPECT_TRUE(near.cells[1].isTime);
    EXPECT_DOUBLE_EQ(near.cells[1].ratio(), 10.0);
    EXPECT_EQ(near.cells[2].row, 1U);
    EXPECT_EQ(near.cells[2].column, 0U);
    EXPECT_FALSE(near.cells[2].isWithin(kTwiceLow, kTwiceHigh));
    EXPECT_EQ(nearnessLine({{near}}),
              "How near: 2 printed numbers that are no times were measured at the parameters that "
              "the document gives: 1 lies within 10 % of the printed ones, 1 within a factor of 2. "
              "Of 1 time or rate, printed on another machine, none lies within 10 % of the printed "
              "one, none within a factor of 2. Left out: 1 printed as 0.");
}

TEST(Nearness, OtherParametersAndFittedCellsAreNoEvidence) {
    config::Experiment other = experiment();
    for (config::Case& item : other.paperCases) item.params.set("size", Node::number(512));
    EXPECT_TRUE(nearnessOf(other, nearTable(other, 100, 100)).cells.empty());
    EXPECT_EQ(nearnessLine({{nearnessOf(other, nearTable(other, 100, 100))}}), "");

    const config::Experiment fitted = experiment("  calibrated: [{scene: models/duck}]\n");
    const Nearness near = nearnessOf(fitted, nearTable(fitted, 100, 100));
    EXPECT_EQ(near.calibrated, 2U);
    ASSERT_EQ(near.cells.size(), 1U);
    EXPECT_EQ(near.cells[0].row, 1U);

    config::Experiment figure = experiment();
    figure.kind = config::ExperimentKind::Figure;
    EXPECT_TRUE(nearnessOf(figure, nearTable(figure, 100, 100)).cells.empty())
        << "as they are not counted as printed cells of tables";
}

TEST(Figure, SeveralRunsLieOverOneAnother) {
    const Figure figure = figureOf(sized("[{x: size, y: draw_ms, by: scene}]"), sizedRecords());
    Figure other = figure;
    other.curveNames.erase(other.curveNames.begin());
    other.panels[0].curves.erase(other.panels[0].curves.begin());
    const Figure both = overlaid({figure, other}, {"A", "C"});
    EXPECT_EQ(both.runCount, 2U);
    EXPECT_THAT(both.curveNames, ElementsAre("A: a", "A: b", "C: a", "C: b"));
    ASSERT_EQ(both.panels.size(), 1U);
    const std::vector<FigureCurve>& curves = both.panels[0].curves;
    ASSERT_EQ(curves.size(), 4U);
    EXPECT_TRUE(curves[2].points.empty()) << "C has no a";
    EXPECT_EQ(curves[3].name, "C: b");
    EXPECT_EQ(curves[3].points.size(), curves[1].points.size());
    EXPECT_EQ(overlaid({figure}, {"A"}).curveNames, figure.curveNames) << "one stays as it is";
}

}  // namespace
}  // namespace gfxrepro::tables
