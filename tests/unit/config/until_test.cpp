// `measure: {until: {…}}`.
#include "tests/unit/config/experiment_fixture.h"

namespace gfxrepro::config {
namespace {

using Until = ExperimentTest;

const std::string kHead = "table: p/1\ntitle: t\ntechnique: x\n";

TEST_F(Until, StandsForTheKeysOfMeasure) {
    const Measure measure =
        load(kHead + "measure: {lane: timing, until: {relative_error: 1 %, at_most_s: 60}}")
            .measure;
    EXPECT_DOUBLE_EQ(measure.relativeError, 0.01);
    EXPECT_EQ(measure.timeBudgetS, 60.0);
    EXPECT_EQ(measure.certainRounds(), 1);
    EXPECT_EQ(measure.processes, kFewestRounds);  // those that an interval takes
    EXPECT_TRUE(measure.mayContinue());
    // Nor is it of no effect where a layout is given and no lane.
    const Measure shown = load(kHead +
                               "measure: {until: {relative_error: 1 %}}\n"
                               "layout: {rows: frame, columns: {t: {metric: wall_time_ms}}}\n")
                              .measure;
    EXPECT_EQ(shown.lane, Measure::Lane::Timing);
    EXPECT_TRUE(shown.mayContinue());
    const Measure both = load(kHead +
                              "measure: {lane: timing, processes: 8, until: {relative_error: 0.02, "
                              "processes: 12, repeats: 40}}")
                             .measure;
    EXPECT_EQ(both.relativeError, 0.02);
    EXPECT_EQ(both.processes, 8);
    EXPECT_EQ(both.processesAtMost, 12);
    EXPECT_EQ(both.repeatsAtMost, 40);
    EXPECT_TRUE(both.mayRepeat());
}

TEST_F(Until, IsLaidOverWhatFilesProfilesAndTheCommandLineSay) {
    folder.write("presets/until.yaml",
                 "measure: {lane: timing, relative_error: 0.05, time_budget_s: 20}\n"
                 "profiles: {quick: {measure: {until: {at_most_s: 10}}}}\n");
    const std::string text =
        kHead + "extends: presets/until.yaml\nmeasure: {until: {relative_error: 2%}}\n";
    EXPECT_EQ(load(text).measure.relativeError, 0.02);
    EXPECT_EQ(load(text).measure.timeBudgetS, 20.0);
    ExperimentOptions options;
    options.profile = "quick";
    EXPECT_EQ(load(text, options).measure.relativeError, 0.02);
    EXPECT_EQ(load(text, options).measure.timeBudgetS, 10.0);
    options.sets = {parseOverride("measure.until.relative_error=4 %"),
                    parseOverride("measure.until.at_most_s=3")};
    EXPECT_EQ(load(text, options).measure.relativeError, 0.04);
    EXPECT_EQ(load(text, options).measure.timeBudgetS, 3.0);
    EXPECT_EQ(
        load(kHead + "extends: presets/until.yaml\nmeasure: {until: null}\n").measure.relativeError,
        0.0);
}

TEST_F(Until, RefusesWhatIsWrongInIt) {
    const auto untilError = [&](const std::string& until) {
        return errorWith("measure: {lane: timing, until: " + until + "}");
    };
    const std::string head = "DIR/zju/a.yaml:4:";
    for (const std::string bad : {"0 %", "-1 %", "101 %", "5", "x", "[1 %]"}) {
        EXPECT_EQ(untilError("{relative_error: " + bad + "}"),
                  head + "49: measure: until: relative_error is " + bad +
                      "; allowed: a percentage as 1 %, or a fraction, above 0 and to 1");
    }
    EXPECT_EQ(untilError("{relative_eror: 1 %}"),
              head +
                  "33: measure: until: unknown key 'relative_eror'; did you mean "
                  "'relative_error'?");
    EXPECT_EQ(errorWith("measure: {lane: quality, until: {relative_error: 1 %}}"),
              head +
                  "26: measure: until: times alone are known to an error, and 'lane: quality' "
                  "beside it takes none; allowed: lane: timing");
    EXPECT_EQ(untilError("1 %"), head +
                                     "32: measure: until is 1 %; allowed: a map of "
                                     "relative_error, at_most_s, processes, repeats");
    for (const std::string few : {"1", "5"}) {
        EXPECT_EQ(errorWith("measure: {until: {relative_error: 1 %}, processes: " + few + "}"),
                  head + "52: measure: processes is " + few +
                      ", from which 'until' does not go on, as an interval takes 6; allowed: 6 or "
                      "more, none, or 'repeats' in 'until'");
    }
    EXPECT_TRUE(load(kHead + "measure: {until: {relative_error: 1 %, repeats: 40}, processes: 1}")
                    .measure.mayRepeat())
        << "repeats go on";
    EXPECT_EQ(untilError("{at_most_s: x}").substr(0, head.size()), head);
    EXPECT_EQ(untilError("{at_most_s: 1}, time_budget_s: 2"),
              head +
                  "33: measure: until: at_most_s: 'time_budget_s' beside it says the same; "
                  "allowed: one of them");
}

}  // namespace
}  // namespace gfxrepro::config
