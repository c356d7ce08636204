#include "runner/tables/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "runner/tables/cell.h"
#include "tests/support/support.h"
#include "tests/unit/tables/fixture.h"

namespace gfxrepro::tables {
namespace {

std::vector<std::string> columnLabels(const Table& table) {
    std::vector<std::string> labels;
    for (const TableColumn& column : table.columns) labels.push_back(column.label);
    return labels;
}

std::vector<std::vector<std::string>> rowLabels(const Table& table) {
    std::vector<std::vector<std::string>> labels;
    for (const TableRow& row : table.rows) labels.push_back(row.labels);
    return labels;
}

const char* const kPlain = R"(
sweep:
  scene: [models/duck, models/bunny]
layout:
  rows: scene
  columns:
    triangles: {metric: triangles, format: "{median:.0f}"}
    draw_ms: {pass: draw}
  cell: {metric: gpu_time_ms, format: "{median:.1f}"}
)";

std::string withPrinted() {
    return std::string(kPlain) + R"(
printed:
  hardware: Radeon 9800 Pro
  values: |
    scene,triangles,draw_ms
    models/bunny,69451,12.0
    models/duck,1254,9.0
    models/hugo,16928,9.7
)";
}

RecordMaker duckAndBunny() {
    RecordMaker maker;
    maker.beginCase("models/bunny")
        .add("triangles", {69451.0}, "", "triangle")
        .add("gpu_time_ms", {4.0, 2.0, 3.0}, "draw")
        .add("gpu_time_ms", {40.0}, "other");
    maker.beginCase("models/duck")
        .add("triangles", {1254.0}, "", "triangle")
        .add("gpu_time_ms", {1.0, 1.0, 1.0}, "draw")
        .add("scene_source", {1.0}, "", "enum");
    return maker;
}

TEST(Table, WithoutATechniqueThereIsWhatWasPrinted) {
    config::Experiment experiment;
    experiment.id = "p/1";
    experiment.printed.header = {"function", "dimensions", "bound"};
    experiment.printed.rows = {{"light field", "4", "a box"}, {"panorama", "2", ""}};
    const Table table = buildTable(experiment, {});
    EXPECT_TRUE(table.isOnlyPrinted);
    EXPECT_THAT(table.rowAxes, ElementsAre("function"));
    EXPECT_THAT(columnLabels(table), ElementsAre("dimensions", "bound"));
    EXPECT_THAT(rowLabels(table), ElementsAre(ElementsAre("light field"), ElementsAre("panorama")));
    EXPECT_EQ(table.rows[0].cells[1].printed, "a box");
    EXPECT_EQ(table.rows[1].cells[1].printed, std::nullopt);
    EXPECT_FALSE(table.rows[0].cells[0].isPlanned);
    EXPECT_FALSE(table.rows[0].cells[0].isOk());
}

TEST(Table, SetUpCountsWhereNoFrameHasTheSame) {
    RecordMaker maker;
    maker.beginCase("models/duck").frame(records::kSetup).add("cpu_time_ms", {9.0}, "preprocess");
    maker.beginCase("models/bunny").frame(records::kSetup).add("cpu_time_ms", {9.0}, "preprocess");
    maker.frame(0).add("cpu_time_ms", {1.0}, "preprocess");
    maker.frame(1).add("cpu_time_ms", {2.0}, "preprocess");
    const Table table = buildTable(experimentFrom(R"(
sweep: {scene: [models/duck, models/bunny]}
output: {frames: 2}
layout:
  rows: scene
  columns:
    preprocess_ms: {metric: cpu_time_ms, pass: preprocess}
  cell: "{mean:.1f} of {count:.0f}"
)"),
                                   maker.records());
    EXPECT_EQ(table.rows[0].cells[0].measured, "9.0 of 1");
    EXPECT_EQ(table.rows[1].cells[0].measured, "1.5 of 2");
}

TEST(Table, TransposedCellsKeepTheirPlaces) {
    const Table plain = buildTable(experimentFrom(kPlain), duckAndBunny().records());
    const Table table = transposed(plain, 0);
    EXPECT_THAT(table.rowAxes, ElementsAre("column"));
    EXPECT_THAT(columnLabels(table), ElementsAre("models/duck", "models/bunny"));
    EXPECT_THAT(rowLabels(table), ElementsAre(ElementsAre("triangles"), ElementsAre("draw_ms")));
    EXPECT_EQ(table.rows[0].cells[1].measured, "69451");
    EXPECT_EQ(table.rows[1].cells[0].measured, plain.rows[0].cells[1].measured);
    // A place that no row has is not planned.
    Table ragged = plain;
    ragged.rowAxes = {"scene", "step"};
    ragged.rows[0].labels = {"duck", "1"};
    ragged.rows[1].labels = {"bunny", "2"};
    const Table four = transposed(ragged, 0);
    ASSERT_EQ(four.rows.size(), 4u);
    EXPECT_TRUE(four.rows[0].cells[0].isPlanned);
    EXPECT_FALSE(four.rows[0].cells[1].isPlanned);
}

TEST(Table, RowsInSweepOrderMedianOfRepeats) {
    const Table table = buildTable(experimentFrom(kPlain), duckAndBunny().records());
    EXPECT_EQ(table.id, "zju2005/9.9");
    EXPECT_THAT(columnLabels(table), ElementsAre("triangles", "draw_ms"));
    EXPECT_THAT(rowLabels(table),
                ElementsAre(ElementsAre("models/duck"), ElementsAre("models/bunny")));
    const Cell& bunny = table.rows[1].cells[1];
    EXPECT_TRUE(bunny.isOk());
    EXPECT_EQ(bunny.measured, "3.0");
    EXPECT_EQ(bunny.values[0].value, 3.0);
    // Three repeats of one process have a range, no interval.
    EXPECT_EQ(bunny.bounds(), Bounds::Range);
    EXPECT_EQ(bunny.low, "2.0");
    EXPECT_EQ(bunny.high, "4.0");
    EXPECT_EQ(table.rows[1].cells[0].measured, "69451");
    EXPECT_EQ(table.rows[1].cells[0].bounds(), Bounds::None);
    EXPECT_EQ(table.columns[1].unit, "ms");
    EXPECT_EQ(table.rows[0].source, SceneSource::StandIn);
    EXPECT_EQ(table.rows[1].source, SceneSource::Unknown);
    EXPECT_TRUE(table.hasSources());
}

TEST(Table, PrintedStandsBesideMeasured) {
    const Table table = buildTable(experimentFrom(withPrinted()), duckAndBunny().records());
    EXPECT_EQ(table.hardware, "Radeon 9800 Pro");
    EXPECT_EQ(table.rows[0].cells[0].printed, "1254");
    EXPECT_EQ(table.rows[1].cells[1].printed, "12.0");
    EXPECT_EQ(table.rows[1].cells[1].printedValues[0], 12.0);
    ASSERT_EQ(table.printedRows.size(), 1U);
    EXPECT_THAT(table.printedRows[0].labels, ElementsAre("models/hugo"));
    EXPECT_EQ(table.printedRows[0].cells[0].printed, "16928");
    EXPECT_EQ(table.printedRows[0].cells[1].printed, "9.7");
    EXPECT_TRUE(table.notes.empty());
}

TEST(Table, PrintedColumnsThatASweepTookAwayAreNoted) {
    config::Experiment experiment = experimentFrom(withPrinted());
    experiment.printed.header.push_back("clear_ms");
    for (auto& row : experiment.printed.rows) row.push_back("1");
    const Table table = buildTable(experiment, duckAndBunny().records());
    EXPECT_EQ(table.rows[0].cells[0].printed, "1254");
    EXPECT_EQ(table.notes.at(0), "printed columns that are not part of this run: clear [ms]");
}

TEST(Table, CasesNotRunAreMissing) {
    RecordMaker maker;
    maker.beginCase("models/bunny").add("gpu_time_ms", {4.0}, "draw");
    const Table table = buildTable(experimentFrom(kPlain), maker.records());
    ASSERT_EQ(table.rows.size(), 2u);
    EXPECT_EQ(table.rows[0].cells[1].status, records::Status::Missing);
    EXPECT_EQ(table.rows[0].cells[1].measured, "missing");
    EXPECT_EQ(table.rows[0].cells[1].message, "not run");
    EXPECT_EQ(table.rows[1].cells[0].message, "no 'triangles' was recorded");
    EXPECT_EQ(table.rows[1].cells[1].measured, "4.0");
    EXPECT_EQ(table.rows[1].cells[1].low, "");
}

TEST(Table, WhatOthersOfItsRowAndColumnRecordIsBlank) {
    config::Experiment experiment = experimentFrom(std::string(kPlain) +
                                                   "printed:\n  values: |\n"
                                                   "    scene,triangles,draw_ms\n"
                                                   "    models/bunny,69451,12.0\n");
    RecordMaker maker;
    maker.beginCase("models/duck").add("gpu_time_ms", {4.0}, "draw");
    maker.beginCase("models/bunny").add("triangles", {69451.0}, "", "triangle");
    const Table table = buildTable(experiment, maker.records());
    EXPECT_FALSE(table.rows[0].cells[0].isPlanned);
    EXPECT_EQ(table.rows[0].cells[0].measured, "");
    EXPECT_TRUE(table.rows[1].cells[1].isPlanned) << "printed, so it should be there";
    EXPECT_EQ(table.rows[1].cells[1].measured, "missing");
    // Of a column that nothing recorded the metric may be misspelt.
    maker = RecordMaker();
    maker.beginCase("models/duck").add("triangles", {1254.0}, "", "triangle");
    maker.beginCase("models/bunny").add("triangles", {69451.0}, "", "triangle");
    experiment.printed = {};
    EXPECT_EQ(buildTable(experiment, maker.records()).rows[0].cells[1].measured, "missing");
}

TEST(Table, WrongPassSaysWhichThereAre) {
    RecordMaker maker;
    maker.beginCase("models/duck").add("gpu_time_ms", {4.0}, "drawing").add("gpu_time_ms", {5.0});
    const Table table = buildTable(experimentFrom(kPlain), maker.records());
    EXPECT_EQ(
        table.rows[0].cells[1].message,
        "no 'gpu_time_ms' of pass 'draw' was recorded; it is there for pass: (no 'pass'), drawing");
}

TEST(Table, AMissingFrameSaysWhichThereAre) {
    RecordMaker maker;
    maker.beginCase("", R"({"m":"b"})").frame(1).add("e", {1.0}, "", "1");
    maker.frame(7).add("e", {2.0}, "", "1");
    maker.beginCase("", R"({"m":"c"})").frame(1).add("e", {3.0}, "", "1");
    config::Experiment experiment = experimentFrom(
        "sweep: {m: [b, c]}\nlayout: {rows: [m, frame], columns: {e: {metric: e}}}\n");
    experiment.technique = config::kImported;
    const Table table = buildTable(experiment, maker.records());
    ASSERT_EQ(table.rows.size(), 4U);
    EXPECT_EQ(table.rowName(3), "m=c, frame=7");
    EXPECT_EQ(table.rows[3].cells[0].message,
              "no 'e' of frame 7 was recorded; it is there for frame: 1");
    EXPECT_FALSE(table.rows[3].cells[0].isMisnamed);
}

TEST(Table, FailedCaseShowsItsStatus) {
    RecordMaker maker = duckAndBunny();
    maker.beginCase("models/bunny").fail(records::Status::Timeout, "longer than 120 s");
    const Table table = buildTable(experimentFrom(kPlain), maker.records());
    const Cell& cell = table.rows[1].cells[1];
    EXPECT_EQ(cell.status, records::Status::Timeout);
    EXPECT_EQ(cell.measured, "timeout");
    EXPECT_EQ(cell.message, "longer than 120 s");
    EXPECT_TRUE(cell.values.empty());
    EXPECT_TRUE(table.rows[0].cells[1].isOk());
}

TEST(Table, SecondAttemptReplacesTheFailure) {
    RecordMaker maker;
    maker.beginCase("models/bunny").fail(records::Status::Crash, "signal 11");
    maker.beginCase("models/bunny").add("gpu_time_ms", {4.0}, "draw");
    const Table table = buildTable(experimentFrom(kPlain), maker.records());
    EXPECT_TRUE(table.rows[1].cells[1].isOk());
    EXPECT_EQ(table.rows[1].cells[1].measured, "4.0");
}

TEST(Table, OneProcessOfTwoFailedIsPartial) {
    RecordMaker maker;
    maker.beginCase("models/bunny").add("gpu_time_ms", {4.0, 4.0}, "draw");
    maker.process(1).fail(records::Status::Crash, "signal 11");
    const Table table = buildTable(experimentFrom(kPlain), maker.records());
    const Cell& cell = table.rows[1].cells[1];
    EXPECT_TRUE(cell.isPartial);
    EXPECT_FALSE(cell.isOk());
    EXPECT_EQ(cell.measured, "4.0 (partial: crash)");
}

TEST(Table, FlakyValueIsShownAndMarked) {
    RecordMaker maker;
    maker.beginCase("models/bunny").add("gpu_time_ms", {4.0, 4.0}, "draw");
    Recorded records = maker.records();
    for (records::Record& record : records) record.status = records::Status::Flaky;
    const Table table = buildTable(experimentFrom(kPlain), records);
    const Cell& cell = table.rows[1].cells[1];
    EXPECT_EQ(cell.measured, "4.0 (flaky)");
    EXPECT_EQ(cell.status, records::Status::Flaky);
    EXPECT_FALSE(cell.isPartial);
    EXPECT_FALSE(cell.isOk());
}

TEST(Table, TimesOfTheQualityLaneStayOut) {
    RecordMaker maker;
    maker.beginCase("models/duck").lane("quality").add("triangles", {7.0});
    maker.beginCase("models/bunny").lane("quality").add("gpu_time_ms", {4.0}, "draw");
    maker.add("triangles", {7.0});
    config::Experiment experiment = experimentFrom(kPlain);
    experiment.printed = {};
    const Table table = buildTable(experiment, maker.records());
    EXPECT_EQ(table.rows[0].cells[1].measured, "") << "a pass that others have";
    EXPECT_EQ(table.rows[1].cells[1].status, records::Status::Ambiguous);
    EXPECT_EQ(table.rows[1].cells[1].measured, "not timed");
    EXPECT_EQ(
        table.rows[1].cells[1].message,
        "measured in the quality lane, where cases run side by side; a time needs the timing lane");
    EXPECT_EQ(table.rows[1].cells[0].measured, "7");
}

/// Voided by the equal-work guard, say: the number is there, but it is not shown.
TEST(Table, DoubtfulMeasurementIsNoNumber) {
    RecordMaker maker;
    maker.beginCase("models/bunny").add("gpu_time_ms", {4.0, 5.0}, "draw");
    Recorded records = maker.records();
    for (records::Record& record : records) {
        record.status = records::Status::Ambiguous;
        record.message = "the image is blank";
    }
    const Table table = buildTable(experimentFrom(kPlain), records);
    EXPECT_EQ(table.rows[1].cells[1].measured, "ambiguous");
    EXPECT_EQ(table.rows[1].cells[1].message, "the image is blank");
    EXPECT_TRUE(table.rows[1].cells[1].values.empty());
    records[0].status = records::Status::Ok;
    EXPECT_EQ(buildTable(experimentFrom(kPlain), records).rows[1].cells[1].measured,
              "4.0 (partial: ambiguous)");
}

TEST(Table, OtherExperimentsArePassedOver) {
    Recorded records = duckAndBunny().records();
    for (records::Record& record : records) record.table = "zju2005/9.8";
    for (config::Case& item : records.cases) item.experiment = "zju2005/9.8";
    const Table table = buildTable(experimentFrom(kPlain), records);
    EXPECT_EQ(table.rows[0].cells[1].status, records::Status::Missing);
}

const char* const kMethods = R"(
sweep:
  scene: [city, tree]
  ratio: [0.5, 1]
  method: [ours, peeling]
  exclude: [{scene: tree, ratio: 1, method: peeling}]
layout:
  rows: [scene, error, ratio]
  axes:
    error: {intensity: {metric: intensity_error}, visibility: {metric: visibility_error}}
  columns: method
  cell: "{mean:.2f}/{max:.0f}"
)";

/// 2 x 2 x 2 cases, three frames each; frame f of a case has value `base` + f.
RecordMaker methodRecords() {
    RecordMaker maker;
    double base = 10.0;
    for (const std::string scene : {"city", "tree"}) {
        for (const std::string ratio : {"0.5", "1.0"}) {
            for (const std::string method : {"ours", "peeling"}) {
                if (scene == "tree" && ratio == "1.0" && method == "peeling") continue;
                maker.beginCase(scene, "{\"ratio\":" + ratio + ",\"method\":\"" + method + "\"}");
                for (int frame = 0; frame < 3; ++frame) {
                    maker.frame(frame);
                    maker.add("intensity_error", {base + frame, base + frame, 1000.0});
                    maker.add("visibility_error", {base + frame + 0.5});
                }
                base += 10.0;
            }
        }
    }
    return maker;
}

TEST(Table, ThreeRowAxesAndASweptColumn) {
    const Table table = buildTable(experimentFrom(kMethods), methodRecords().records());
    EXPECT_THAT(columnLabels(table), ElementsAre("ours", "peeling"));
    EXPECT_THAT(
        rowLabels(table),
        ElementsAre(ElementsAre("city", "intensity", "0.5"), ElementsAre("city", "intensity", "1"),
                    ElementsAre("city", "visibility", "0.5"),
                    ElementsAre("city", "visibility", "1"), ElementsAre("tree", "intensity", "0.5"),
                    ElementsAre("tree", "intensity", "1"), ElementsAre("tree", "visibility", "0.5"),
                    ElementsAre("tree", "visibility", "1")));
    // Repeats are reduced to their median for each frame, then mean and max over the frames.
    EXPECT_EQ(table.rows[0].cells[0].measured, "11.00/12");
    EXPECT_EQ(table.rows[0].cells[1].measured, "21.00/22");
    EXPECT_EQ(table.rows[3].cells[1].measured, "41.50/42");
    EXPECT_EQ(table.rows[0].cells[0].find("max")->value, 12.0);
    EXPECT_EQ(table.rows[0].cells[0].find("min"), nullptr);
}

TEST(Table, ExcludedCombinationIsBlankNotMissing) {
    const Table table = buildTable(experimentFrom(kMethods), methodRecords().records());
    EXPECT_FALSE(table.rows[5].cells[1].isPlanned);
    EXPECT_EQ(table.rows[5].cells[1].measured, "");
    EXPECT_TRUE(table.rows[5].cells[0].isOk());
}

TEST(Table, AxisOutsideOfTheLayoutIsAggregatedAndMarkedWhenNotWhole) {
    const std::string body = R"(
sweep: {scene: [a, b, c], method: [ours]}
layout:
  rows: method
  columns:
    error: {metric: error, format: "{mean:.1f}"}
)";
    RecordMaker maker;
    maker.beginCase("a", R"({"method":"ours"})").add("error", {1.0});
    maker.beginCase("b", R"({"method":"ours"})").add("error", {3.0});
    Table table = buildTable(experimentFrom(body), maker.records());
    EXPECT_EQ(table.rows[0].cells[0].measured, "2.0 (partial: missing)");
    EXPECT_EQ(table.rows[0].cells[0].message, "1 of 3 cases were not run");
    maker.beginCase("c", R"({"method":"ours"})").add("error", {5.0});
    table = buildTable(experimentFrom(body), maker.records());
    EXPECT_EQ(table.rows[0].cells[0].measured, "3.0");
}

TEST(Table, FixedSceneAndWhereOnAParameter) {
    const std::string body = R"(
scene: models/wagner
sweep: {voxel_bits: [1, 8]}
layout:
  rows: scene
  columns:
    bit_ms: {where: {voxel_bits: 1}}
    byte_mb: {where: {voxel_bits: 8}, metric: bytes, scale: 9.5367431640625e-7}
  cell: {metric: gpu_time_ms, format: "{min:.1f}..{max:.1f}"}
)";
    RecordMaker maker;
    maker.beginCase("models/wagner", R"({"voxel_bits":1})").add("gpu_time_ms", {3.0, 1.0, 2.0});
    maker.beginCase("models/wagner", R"({"voxel_bits":8})").add("bytes", {4194304.0}, "", "byte");
    const Table table = buildTable(experimentFrom(body), maker.records());
    ASSERT_EQ(table.rows.size(), 1u);
    EXPECT_THAT(table.rows[0].labels, ElementsAre("models/wagner"));
    EXPECT_EQ(table.rows[0].cells[0].measured, "1.0..3.0");
    EXPECT_EQ(table.rows[0].cells[1].find("max")->value, 4.0);
    EXPECT_EQ(table.columns[1].unit, "");  // scaled: megabytes are no bytes
}

constexpr const char* kShares = R"(
scene: models/duck
layout:
  axes: {step: {draw: {metric: gpu_time_ms, pass: draw}, all: {metric: wall_time_ms}}}
  rows: step
  columns:
    ms: {format: "{mean:.1f}/{max:.0f}"}
    pct: {of: "100 * ms / ms[step=all]", format: "{mean:.1f}"}
    of_draw_pct: {of: "100 * ms / ms[step=draw]", format: "{mean:.0f}/{max:.0f}"}
    without_draw_ms: {of: "ms - ms[step=draw]"}
    twice_pct: {of: pct * 2}
    seconds: {of: ms / 1000}
    nothing: {of: ms / (pct - pct)}
  cell: {format: "{mean:.1f}"}
)";

/// Frames of 10, 12, 14 … ms by process; in the first draw takes 1 ms, in the last 3, between none.
Table sharesOf(int processes) {
    RecordMaker maker;
    maker.beginCase("models/duck");
    for (int process = 0; process < processes; ++process) {
        maker.process(process).frame(0).add("gpu_time_ms", {1.0}, "draw");
        for (int frame = 0; frame < 3; ++frame) {
            maker.frame(frame).add("wall_time_ms", {10.0 + 2.0 * process});
        }
        maker.add("gpu_time_ms", {3.0}, "draw").add("voxels", {5.0}, "", "voxel");
    }
    return buildTable(experimentFrom(kShares), maker.records());
}

TEST(Table, ColumnsOfColumnsAreComputedInEachProcess) {
    const Table six = sharesOf(6);
    const Cell& draw = six.rows[0].cells[1];
    // 2 ms of 10, 12, … 20 ms.
    EXPECT_DOUBLE_EQ(draw.values[0].rounds.at(0), 20.0);
    EXPECT_DOUBLE_EQ(draw.values[0].rounds.at(5), 10.0);
    EXPECT_DOUBLE_EQ(draw.values[0].value, (200.0 / 14.0 + 200.0 / 16.0) / 2.0);
    EXPECT_EQ(draw.bounds(), Bounds::Interval);
    EXPECT_EQ(draw.low, "10.0");
    EXPECT_EQ(draw.high, "20.0");
    EXPECT_EQ(draw.unit, "") << "a ratio has none";
    EXPECT_TRUE(draw.isTime);
    EXPECT_EQ(draw.timePower, 0);
    EXPECT_EQ(six.rows[1].cells[1].measured, "100.0");
    EXPECT_EQ(six.rows[0].cells[4].measured, fmt::format("{:.1f}", 2.0 * draw.values[0].value));
    EXPECT_EQ(six.rows[0].cells[2].measured, "100/100") << "each statistic of the same of others";

    const Cell& rest = six.rows[1].cells[3];
    EXPECT_DOUBLE_EQ(rest.values[0].rounds.at(0), 8.0);
    EXPECT_DOUBLE_EQ(rest.values[0].rounds.at(5), 18.0);
    EXPECT_EQ(rest.measured, "13.0");
    EXPECT_EQ(rest.low, "8.0");
    EXPECT_EQ(rest.high, "18.0");
    EXPECT_EQ(rest.unit, "ms");
    EXPECT_EQ(rest.timePower, 1);
    EXPECT_EQ(six.columns[3].unit, "ms");
    EXPECT_EQ(six.columns[5].unit, "") << "no longer that of what it reads";
    EXPECT_EQ(six.rows[0].cells[6].message, "no number comes out");
    EXPECT_EQ(six.rows[0].cells[6].measured, "missing");

    EXPECT_EQ(sharesOf(5).rows[0].cells[1].bounds(), Bounds::Range);
    EXPECT_EQ(sharesOf(1).rows[0].cells[1].measured, "20.0");
    EXPECT_EQ(sharesOf(1).rows[0].cells[1].bounds(), Bounds::None);
}

/// Of columns `check` says so.
TEST(Table, ARowsFormatMayLackWhatAColumnIsComputedOf) {
    RecordMaker maker;
    maker.beginCase("models/duck").add("wall_time_ms", {4.0});
    const Table table = buildTable(experimentFrom(R"(
scene: models/duck
layout:
  rows: {all: {format: "{mean:.1f}"}}
  columns: {ms: {metric: wall_time_ms}, least: {of: ms, format: "{min:.1f}"}}
)"),
                                   maker.records());
    EXPECT_EQ(table.rows[0].cells[1].message, "a cell that it reads shows 'mean' and no 'min'");
}

TEST(Table, AColumnOfWhatIsMissingIsMissing) {
    RecordMaker maker;
    maker.beginCase("models/duck").add("gpu_time_ms", {1.0}, "draw");
    const Cell cell = buildTable(experimentFrom(kShares), maker.records()).rows[0].cells[1];
    EXPECT_EQ(cell.measured, "missing");
    EXPECT_EQ(cell.message, "no 'wall_time_ms' was recorded");
    EXPECT_TRUE(cell.values.empty());
}

/// On a software device claims read the CPU time, of the part as of the whole.
TEST(Table, SharesOfTimesAreAlsoByProcessTime) {
    RecordMaker maker;
    maker.beginCase("models/duck").add("gpu_time_ms", {1.0}, "draw").add("wall_time_ms", {4.0});
    maker.add("process_time_ms", {6.0}, "draw").add("process_time_ms", {8.0});
    const Cell cell = buildTable(experimentFrom(kShares), maker.records()).rows[0].cells[1];
    EXPECT_EQ(cell.measured, "25.0");
    ASSERT_EQ(cell.byProcess.size(), 1U);
    EXPECT_DOUBLE_EQ(cell.byProcess[0].value, 75.0);
}

constexpr const char* kEqual = R"(
scene: models/duck
sweep: {method: [a, b], samples: [1, 4, 16]}
layout:
  rows: method
  columns:
    error_at_2_ms: {metric: rmse, equal: {metric: wall_time_ms, is: 2}, format: "{median:.3f}"}
    ms_at_quarter: {metric: wall_time_ms, equal: {metric: rmse, is: 0.25}, format: "{median:.2f}"}
    ms_at_tenth: {metric: wall_time_ms, equal: {metric: rmse, is: 0.1}, format: "{median:.2f}"}
)";

/// A millisecond a sample, a little more in each process; an error of 1 / sqrt(samples), of b half.
Table equalOf(int processes) {
    RecordMaker maker;
    for (const auto& [method, factor] : {std::pair("a", 1.0), std::pair("b", 0.5)}) {
        for (const int samples : {1, 4, 16}) {
            maker.beginCase("models/duck",
                            fmt::format(R"({{"method": "{}", "samples": {}}})", method, samples));
            maker.lane("timing");
            for (int process = 0; process < processes; ++process) {
                maker.process(process).add("wall_time_ms", {samples * (1.0 + 0.01 * process)});
                maker.add("process_time_ms", {2.0 * samples});
                if (process == 0) maker.add("rmse", {factor / std::sqrt(samples)}, "", "1");
            }
        }
    }
    return buildTable(experimentFrom(kEqual), maker.records());
}

TEST(Table, AtEqualTimeAndAtEqualError) {
    const Table table = equalOf(6);
    // Powers are lines on logarithmic scales: 1 / sqrt(2) at 2 ms, 16 ms at a quarter.
    EXPECT_DOUBLE_EQ(table.rows[0].cells[0].values[0].rounds.at(0), std::sqrt(0.5));
    EXPECT_EQ(table.rows[0].cells[1].measured, "16.40");
    EXPECT_EQ(table.rows[1].cells[1].measured, "4.10") << "half the error, a quarter of the time";
    EXPECT_EQ(table.rows[0].cells[1].low, "16.00");
    EXPECT_EQ(table.rows[0].cells[1].high, "16.80");
    EXPECT_EQ(table.rows[0].cells[1].bounds(), Bounds::Interval);
    EXPECT_EQ(table.rows[0].cells[1].unit, "ms");
    EXPECT_TRUE(table.rows[0].cells[0].isTime) << "its clock decides";
    EXPECT_TRUE(table.rows[0].cells[0].byProcess.empty()) << "2 ms are by the clock that it shows";
    ASSERT_EQ(table.rows[0].cells[1].byProcess.size(), 1U);
    EXPECT_DOUBLE_EQ(table.rows[0].cells[1].byProcess[0].value, 32.0);
    const Cell& beyond = table.rows[0].cells[2];
    EXPECT_EQ(beyond.status, records::Status::Missing);
    EXPECT_EQ(beyond.message, "'rmse' goes from 0.25 to 1 and does not reach 0.1");
    EXPECT_EQ(equalOf(1).rows[0].cells[1].bounds(), Bounds::None);
}

/// Which of three times has the error nobody can tell.
TEST(Table, ACurveThatComesBySeveralTimesHasNoValueThere) {
    RecordMaker maker;
    const double errors[] = {0.5, 0.1, 0.12, 0.09};
    for (int i = 0; i < 4; ++i) {
        maker.beginCase("models/duck", fmt::format(R"({{"method": "a", "samples": {}}})", 1 << i));
        maker.lane("timing").add("wall_time_ms", {10.0 * (1 << i)});
        maker.add("rmse", {errors[i]}, "", "1");
    }
    const char* body = R"(
scene: models/duck
sweep: {method: [a], samples: [1, 2, 4, 8]}
layout:
  rows: method
  columns:
    ms_at_11_pct: {metric: wall_time_ms, equal: {metric: rmse, is: 0.11}}
    ms_at_30_pct: {metric: wall_time_ms, equal: {metric: rmse, is: 0.3}}
)";
    const Table table = buildTable(experimentFrom(body), maker.records());
    EXPECT_EQ(table.rows[0].cells[0].status, records::Status::Missing);
    EXPECT_EQ(table.rows[0].cells[0].message,
              "'rmse' passes 0.11 more than once, or not in every process");
    EXPECT_TRUE(table.rows[0].cells[1].isOk()) << table.rows[0].cells[1].message;
}

/// An error is of a picture, whose name is its pass.
TEST(Table, TheTimeToAnErrorOfAPicture) {
    RecordMaker maker;
    for (const int samples : {1, 4}) {
        maker.beginCase("models/duck", fmt::format(R"({{"samples": {}}})", samples));
        maker.add("wall_time_ms", {1.0 * samples});
        maker.add("rmse", {1.0 / std::sqrt(samples)}, "picture", "1");
    }
    const Table table = buildTable(experimentFrom(R"(
scene: models/duck
sweep: {samples: [1, 4]}
layout:
  rows: {all: {where: {}}}
  columns: {t: {metric: wall_time_ms, equal: {metric: rmse, is: 0.7071067811865476}}}
)"),
                                   maker.records());
    ASSERT_TRUE(table.rows[0].cells[0].isOk()) << table.rows[0].cells[0].message;
    EXPECT_NEAR(table.rows[0].cells[0].values[0].value, 2.0, 1e-9);
}

/// Six processes; the errors of the last case have the seeds `last`, those before it `others`.
/// `scatters`: they differ whatever is declared.
Table tableOfSeeds(config::Measure::Seeds others, config::Measure::Seeds last,
                   bool scatters = false) {
    RecordMaker maker;
    for (const int samples : {1, 4, 16}) {
        const config::Measure::Seeds seeds = samples == 16 ? last : others;
        maker.beginCase("models/duck", fmt::format(R"({{"samples": {}}})", samples)).seeds(seeds);
        for (int process = 0; process < 6; ++process) {
            const bool isOther = scatters || seeds == config::Measure::Seeds::Process;
            const double noise = isOther ? 0.01 * process : 0.0;
            maker.process(process).add("wall_time_ms", {samples * (1.0 + 0.01 * process)});
            maker.add("rmse", {(1.0 + noise) / std::sqrt(samples)}, "", "1");
        }
    }
    return buildTable(experimentFrom(R"(
scene: models/duck
sweep: {samples: [1, 4, 16]}
layout:
  rows: {all: {where: {}}}
  columns:
    ms: {metric: wall_time_ms, where: {samples: 1}}
    error: {metric: rmse, where: {samples: 1}}
    last_error: {metric: rmse, where: {samples: 16}}
    pooled_error: {metric: rmse, where: {samples: [1, 4]}}
    ms_at_half: {metric: wall_time_ms, equal: {metric: rmse, is: 0.4}}
    cost: {of: error * ms}
    errors: {of: error * last_error}
    of_pooled: {of: pooled_error * ms}
    speedup: {of: ms_at_half / ms}
)"),
                      maker.records());
}

/// However often the rest was measured.
TEST(Table, WhatIsComputedOfOneSeedIsOneSample) {
    using Seeds = config::Measure::Seeds;
    const auto bounded = [](const Table& table) {
        std::vector<std::string> labels;
        for (std::size_t i = 0; i < table.columns.size(); ++i) {
            const Cell& cell = table.rows[0].cells[i];
            EXPECT_TRUE(cell.isOk()) << table.columns[i].label << ": " << cell.message;
            EXPECT_EQ(cell.bounds() == Bounds::None, cell.isOfOneSeed()) << table.columns[i].label;
            if (cell.bounds() == Bounds::Interval) labels.push_back(table.columns[i].label);
        }
        return labels;
    };
    EXPECT_THAT(bounded(tableOfSeeds(Seeds::Case, Seeds::Case)), ElementsAre("ms"));
    EXPECT_EQ(bounded(tableOfSeeds(Seeds::Process, Seeds::Process)).size(), 9U);
    const Table mixed = tableOfSeeds(Seeds::Process, Seeds::Case);
    EXPECT_THAT(bounded(mixed), ElementsAre("ms", "error", "pooled_error", "cost", "of_pooled"));
    EXPECT_EQ(mixed.rows[0].cells[5].seedCount, 6U);
    EXPECT_THAT(mixed.notes,
                Contains(HasSubstr("numbers: last error, ms at half, errors, speedup.")));
}

/// Processes of one seed whose pictures differ by a hair, as where threads add up in another order.
TEST(Table, OneSeedIsOneSampleHoweverItsPicturesDiffer) {
    using Seeds = config::Measure::Seeds;
    const auto cellOf = [](Seeds seeds, std::size_t column) {
        RecordMaker maker;
        maker.beginCase("models/duck", "{}").seeds(seeds);
        for (int process = 0; process < 6; ++process) {
            maker.process(process).add("wall_time_ms", {10.0 + 0.1 * process});
            maker.add("rmse", {0.1 + 1e-6 * process}, "", "1");
        }
        return buildTable(experimentFrom("scene: models/duck\nlayout: {columns: {e: {metric: "
                                         "rmse}, ms: {metric: wall_time_ms}}}\n"),
                          maker.records())
            .rows[0]
            .cells[column];
    };
    EXPECT_TRUE(cellOf(Seeds::Case, 0).isOfOneSeed());
    EXPECT_EQ(cellOf(Seeds::Case, 0).bounds(), Bounds::None);
    EXPECT_EQ(cellOf(Seeds::Case, 1).bounds(), Bounds::Interval) << "a time is of its processes";
    EXPECT_EQ(cellOf(Seeds::None, 0).bounds(), Bounds::Interval);
    EXPECT_TRUE(cellOf(Seeds::None, 0).scatters);
    EXPECT_FALSE(cellOf(Seeds::None, 1).scatters) << "a time is known to";
    EXPECT_EQ(cellOf(Seeds::Process, 0).seedCount, 6U);
    EXPECT_FALSE(cellOf(Seeds::Process, 0).scatters);
    EXPECT_EQ(cellOf(Seeds::Process, 0).bounds(), Bounds::Interval);
}

/// Of an import, or a program that seeds itself: what is computed of it, and read off its curve,
/// too.
TEST(Table, WhatScattersWithoutASeedIsSaid) {
    const Table table =
        tableOfSeeds(config::Measure::Seeds::Process, config::Measure::Seeds::Process);
    EXPECT_THAT(table.notes, Not(Contains(HasSubstr("no seed is declared"))));
    using Seeds = config::Measure::Seeds;
    const Table unseeded = tableOfSeeds(Seeds::None, Seeds::None, true);
    EXPECT_THAT(
        unseeded.notes,
        Contains("Repeats or processes came to different numbers, and no seed is declared: error, "
                 "last error, pooled error, ms at half, cost, errors, of pooled, speedup."));
}

/// Six of eight processes took 100 ms, two took 800.
Cell cellOfProcesses(const std::string& columns, int processes) {
    RecordMaker maker;
    maker.beginCase("models/duck", "{}");
    for (int process = 0; process < processes; ++process) {
        maker.process(process).add("wall_time_ms", {process % 4 == 3 ? 800.0 : 100.0});
        maker.add("triangles", {7.0}, "", "triangle");
    }
    return buildTable(experimentFrom("scene: models/duck\nlayout: {columns: {" + columns + "}}\n"),
                      maker.records())
        .rows[0]
        .cells.back();
}

TEST(Table, TheMeanOfProcessesIsTheirMean) {
    const std::string mean = "t: {metric: wall_time_ms, format: \"{mean:.0f} ± {stddev:.0f}\"}";
    const Cell cell = cellOfProcesses(mean, 8);
    EXPECT_EQ(cell.measured, "275 ± 324");
    EXPECT_EQ(cell.bounds(), Bounds::None) << "the interval of the median is another's";
    EXPECT_TRUE(cell.values[0].rounds.empty());
    EXPECT_EQ(cellOfProcesses("t: {metric: wall_time_ms, format: \"{median:.0f}\"}", 8).measured,
              "100");
    const Cell twice = cellOfProcesses(mean + ", twice: {of: 2 * t, format: \"{mean:.0f}\"}", 8);
    EXPECT_EQ(twice.measured, "550");
    EXPECT_EQ(twice.bounds(), Bounds::None);
    EXPECT_TRUE(twice.values[0].isOverProcesses);
    EXPECT_EQ(cellOfProcesses("t: {metric: wall_time_ms, format: \"{mean:.0f}\"}", 1).measured,
              "100");
}

/// Of one value each: the median of processes would stand under the name of another statistic.
TEST(Table, ExtremesOfProcessesAreOfAllOfThem) {
    const auto cellOf = [](const std::string& format, const char* metric = "wall_time_ms") {
        return cellOfProcesses(
            fmt::format("t: {{metric: {}, format: \"{{{}:.0f}}\"}}", metric, format), 8);
    };
    EXPECT_EQ(cellOf("max").measured, "800");
    EXPECT_EQ(cellOf("max").bounds(), Bounds::None);
    EXPECT_EQ(cellOf("min").measured, "100");
    EXPECT_EQ(cellOf("p95").measured, "800");
    EXPECT_TRUE(cellOf("p95").values[0].isOverProcesses);
    for (const char* of : {"mean", "max", "min", "p95", "rate", "sum"}) {
        const Cell alike = cellOf(of, "triangles");
        EXPECT_EQ(alike.measured, "7") << of;
        EXPECT_EQ(alike.values[0].rounds.size(), 8U) << of << ": alike in each process";
    }
    EXPECT_EQ(cellOf("stddev", "triangles").measured, "0");
}

/// However many processes drew them.
TEST(Table, OneSeedHasNoStandardDeviation) {
    using Seeds = config::Measure::Seeds;
    const auto cellOf = [](Seeds seeds) {
        RecordMaker maker;
        maker.beginCase("models/duck", "{}").seeds(seeds);
        for (int process = 0; process < 6; ++process) {
            maker.process(process).add("rmse", {seeds == Seeds::Case ? 0.5 : 0.1 * process});
        }
        return buildTable(experimentFrom("scene: models/duck\nlayout: {columns: {e: {metric: rmse, "
                                         "format: \"{mean:.2f} ± {stddev:.2f}\"}}}\n"),
                          maker.records())
            .rows[0]
            .cells[0];
    };
    const Cell one = cellOf(Seeds::Case);
    EXPECT_EQ(one.measured, "one seed");
    EXPECT_EQ(one.status, records::Status::Missing);
    EXPECT_EQ(one.message, "'stddev' needs two seeds or more");
    EXPECT_TRUE(one.values.empty());
    EXPECT_EQ(cellOf(Seeds::Process).measured, "0.25 ± 0.19");
}

TEST(Table, StatisticsBesideTheMedianOfProcessesAreSaid) {
    RecordMaker maker;
    maker.beginCase("models/duck");
    for (int process = 0; process < 6; ++process) {
        for (int frame = 0; frame < 2; ++frame) {
            maker.process(process).frame(frame).add("wall_time_ms", {10.0 + process + frame});
            maker.add("triangles", {7.0}, "", "triangle");
        }
        maker.frame(records::kSetup).add("cpu_time_ms", {1.0 + process}, "load");
    }
    const Table table = buildTable(experimentFrom(R"x(
scene: models/duck
output: {frames: 2}
layout:
  columns:
    frame_ms: {metric: wall_time_ms, format: "{mean:.1f}"}
    most_ms: {metric: wall_time_ms, format: "{max:.1f}"}
    usual_ms: {metric: wall_time_ms, format: "{median:.1f}"}
    triangles: {metric: triangles, format: "{max:.0f}"}
    load_ms: {metric: cpu_time_ms, pass: load, format: "{mean:.1f}"}
)x"),
                                   maker.records());
    EXPECT_THAT(
        table.notes,
        IsSupersetOf({"In column most [ms] the max is taken in each process; a number and its "
                      "bounds are of the median process.",
                      "In column frame [ms] the mean is taken in each process; a number and its "
                      "bounds are of the median process.",
                      "In column load [ms] the mean is over processes, and has no interval: what "
                      "is rare moves it by any amount. No claim is decided by it."}));
    EXPECT_EQ(std::ranges::count_if(
                  table.notes, [](const std::string& note) { return note.starts_with("In "); }),
              3);
}

/// A baseline without the others' parameter is one for all values of it.
TEST(Table, ARowElsewhereMayHaveLeftOutAxes) {
    RecordMaker maker;
    for (const char* params : {R"({"method": "none"})", R"({"method": "bins", "gain": 2})",
                               R"({"method": "bins", "gain": 4})"}) {
        maker.beginCase("models/duck", params).lane("timing");
        maker.add("wall_time_ms", {params[12] == 'n' ? 10.0 : 5.0});
    }
    const char* body = R"(
scene: models/duck
sweep: {method: [none, bins], gain: [2, 4], when: {gain: {method: bins}}}
layout:
  rows: [method, gain]
  columns:
    ms: {metric: wall_time_ms, format: "{median:.0f}"}
    speedup: {of: "ms[method=none] / ms", format: "{median:.0f}"}
)";
    const Table table = buildTable(experimentFrom(body), maker.records());
    ASSERT_EQ(table.rows.size(), 3U);
    for (const TableRow& row : table.rows) {
        EXPECT_EQ(row.cells[1].measured, row.labels[0] == "none" ? "1" : "2");
    }
}

TEST(Table, ASpreadOfOneValueIsMissing) {
    const char* body = R"(
scene: models/duck
layout: {rows: scene, columns: {ms: {metric: wall_time_ms, format: "{mean:.1f} ± {stddev:.2f}"}}}
)";
    RecordMaker maker;
    maker.beginCase("models/duck").lane("timing").process(0).add("wall_time_ms", {4.0});
    const Cell one = buildTable(experimentFrom(body), maker.records()).rows[0].cells[0];
    EXPECT_EQ(one.measured, "missing");
    EXPECT_EQ(one.message, "'stddev' needs two values or more");
    maker.process(1).add("wall_time_ms", {6.0});
    const Cell two = buildTable(experimentFrom(body), maker.records()).rows[0].cells[0];
    EXPECT_EQ(two.measured, "5.0 ± 1.41") << "over processes of one value each";
}

TEST(Sampling, AnIntervalIsOverProcesses) {
    const auto samplesOf = [](std::initializer_list<double> processes) {
        Samples samples;
        // Repeats within a process differ by much, and do not count.
        int number = 0;
        for (const double value : processes) {
            samples.processes[number++][0] = {value / 2.0, value, value * 2.0};
        }
        return samples;
    };
    Summary summary = summarize(samplesOf({10, 11, 12, 13, 14, 19}), metrics::Statistic::Median);
    EXPECT_EQ(summary.value, 12.5);
    EXPECT_EQ(summary.bounds, Bounds::Interval);
    EXPECT_EQ(summary.interval.low, 10.0);
    EXPECT_EQ(summary.interval.high, 19.0);
    EXPECT_EQ(summary.rounds.at(5), 19.0);
    // Five processes cannot give 95 %.
    summary = summarize(samplesOf({10, 11, 12, 13, 14}), metrics::Statistic::Median);
    EXPECT_EQ(summary.bounds, Bounds::Range);
    EXPECT_EQ(summary.interval.high, 14.0);
    // One process: the range of its repeats, which is none of processes.
    summary = summarize(samplesOf({10}), metrics::Statistic::Median);
    EXPECT_EQ(summary.bounds, Bounds::Range);
    EXPECT_EQ(summary.interval.low, 5.0);
    EXPECT_EQ(summary.interval.high, 20.0);
    EXPECT_EQ(summarize(samplesOf({10}), metrics::Statistic::Count).bounds, Bounds::None);
    const Samples once{{{0, {{0, {10.0}}, {1, {12.0}}}}}};
    EXPECT_EQ(summarize(once, metrics::Statistic::Mean).bounds, Bounds::None);
}

TEST(Sampling, FramesAreSummarizedInEachProcess) {
    Samples samples;
    for (int process = 0; process < 3; ++process) {
        samples.processes[process] = {{0, {10.0 + process}}, {1, {40.0}}};
    }
    samples.processes[3] = {{0, {99.0}}};  // a frame is missing: no round
    const Summary mean = summarize(samples, metrics::Statistic::Mean);
    EXPECT_EQ(mean.value, 25.5);
    EXPECT_EQ(mean.rounds.size(), 3U);
    EXPECT_EQ(mean.interval.low, 25.0);
    EXPECT_EQ(mean.interval.high, 26.0);
    EXPECT_EQ(summarize(samples, metrics::Statistic::Max).value, 40.0);
}

/// frames ÷ time, beside the mean of the frames' rates.
TEST(Table, RateOverAPath) {
    RecordMaker maker;
    maker.beginCase("s");
    const double rates[] = {10.0, 40.0};
    for (int frame = 0; frame < 2; ++frame) {
        maker.frame(frame).add("frame_rate", {rates[frame]}, "", "1/s");
    }
    const std::string body = R"x(
scene: s
output: {frames: 2}
layout:
  rows: scene
  columns: {fps: {metric: frame_rate, format: "{rate:.1f} ({mean:.1f})"}}
)x";
    const Table table = buildTable(experimentFrom(body), maker.records());
    EXPECT_EQ(table.rows[0].cells[0].measured, "16.0 (25.0)");
}

TEST(Table, OnesOwnExperimentNeedsNoLayout) {
    RecordMaker maker;
    for (const double n : {1.0, 2.0}) {
        const std::string params = n == 1.0 ? R"({"resolution": 64})" : R"({"resolution": 128})";
        maker.beginCase("models/duck", params).add("triangles", {n}, "", "triangle");
        maker.add("scene_source", {1.0}, "", "enum").add("gpu_time_ms", {n, 3.0 * n}, "draw");
    }
    config::Experiment own = experimentFrom("scene: models/duck\nsweep: {resolution: [64, 128]}\n");
    EXPECT_TRUE(buildTable(own, maker.records()).columns.empty()) << "a paper's shows pictures";
    own.kind = config::ExperimentKind::Sweep;
    const Table table = buildTable(own, maker.records());
    ASSERT_EQ(table.rowAxes, (std::vector<std::string>{"resolution"}));
    ASSERT_EQ(table.columns.size(), 2U);
    EXPECT_EQ(table.columns[0].label, "triangles");
    EXPECT_EQ(table.columns[1].label, "draw_ms") << "the steps of a frame last";
    ASSERT_EQ(table.rows.size(), 2U);
    EXPECT_EQ(table.rows[1].labels[0], "128");
    EXPECT_EQ(table.rows[1].cells[1].measured, "4");
    EXPECT_TRUE(buildTable(own, {}).columns.empty());
}

}  // namespace
}  // namespace gfxrepro::tables
