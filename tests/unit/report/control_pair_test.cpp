#include "runner/report/control_pair.h"

#include <gmock/gmock.h>

#include "tests/unit/report/fixture.h"

namespace gfxrepro::report {
namespace {

RecordMaker pair(std::initializer_list<double> first, std::initializer_list<double> second) {
    RecordMaker maker;
    maker.beginCase("models/duck").process(-2).add("wall_time_ms", first);
    maker.process(-1).add("wall_time_ms", second);
    return maker;
}

TEST(ControlPair, StatesTheChangeThatTwoEqualMeasurementsShowed) {
    EXPECT_THAT(controlNotes(pair({10, 10, 10}, {11, 11, 11}).records()),
                testing::ElementsAre(
                    "A/A pair at the begin of the run (zju2005/9.9 models/duck): 10 and 11 ms. "
                    "Changes of a time below 10.0 % cannot be told from none."));
    // The medians agree, the repeats do not: the interval tells.
    EXPECT_THAT(controlNotes(pair({10, 8, 12}, {10, 8, 12}).records()),
                testing::ElementsAre(testing::HasSubstr("below 50.0 %")));
    EXPECT_THAT(controlNotes(pair({10}, {10}).records()),
                testing::ElementsAre(testing::HasSubstr("below 0.0 %")));
}

TEST(ControlPair, NeedsBothSides) {
    RecordMaker maker;
    maker.beginCase("models/duck").process(-2).add("wall_time_ms", {1, 2});
    maker.process(0).add("wall_time_ms", {1, 2});
    EXPECT_TRUE(controlNotes(maker.records()).empty());
}

TEST(ControlPair, EntersNoCell) {
    const config::Experiment experiment = experimentFrom(
        "sweep: {scene: [models/duck]}\nmeasure: {lane: timing}\n"
        "layout:\n  rows: scene\n  columns: {ms: {metric: wall_time_ms, format: \"{max:.0f}\"}}\n");
    RecordMaker maker = pair({50}, {60});
    maker.process(0).add("wall_time_ms", {10});
    EXPECT_EQ(buildTable(experiment, maker.records()).rows.at(0).cells.at(0).measured, "10");
}

}  // namespace
}  // namespace gfxrepro::report
