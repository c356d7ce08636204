#include "runner/tables/nearness.h"

#include <gtest/gtest.h>

#include "tests/unit/tables/fixture.h"

namespace gfxrepro::tables {
namespace {

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

}  // namespace
}  // namespace gfxrepro::tables
