
#include "runner/report/writers.h"
#include "engine/core/files.h"
#include "runner/claims/claims.h"
#include "runner/claims/kept_claims.h"
#include "runner/tables/table.h"
#include "tests/support/support.h"
#include "tests/unit/tables/fixture.h"

namespace gfxrepro::report {
namespace {

const claims::ReportContext kWritersContext{"llvmpipe", "software", "quick", "abc123",
                                            "gfxrepro reproduce"};

config::Experiment writtenExperiment() {
    return tables::withPaperCases(tables::experimentFrom(R"(
sweep: {scene: [models/duck, "<b>&|_%", models/lost]}
layout:
  rows: scene
  columns:
    error: {metric: error, format: "{mean:.2f}/{max:.0f}"}
    draw_ms: {metric: gpu_time_ms, format: "{median:.1f}"}
printed:
  hardware: "Radeon <9800> & co"
  remark: "100 % sure_of \\nothing"
  values: |
    scene,error,draw_ms
    models/duck,3.00/106,9.0
claims:
  A: {says: "a < b & \"c\"", bound: draw_ms, at_most: 10, at: {scene: models/duck}, origin: ours, kind: algorithmic}
  B: {says: no, bound: draw_ms, at_most: 1, at: {scene: models/duck}, origin: document, bound_from: text, kind: algorithmic, because: {verdict: fails, reason: "slow, measured"}}
  C: {says: maybe, bound: draw_ms, at_most: 1, at: {scene: models/lost}, origin: ours, kind: algorithmic}
assumptions:
  padding: {value: 1, range: [0, 2], unit: voxels, why: "not <said>"}
)"),
                                  {{"models/duck", "{}"}, {"<b>&|_%", "{light_grid: 16}"}});
}

tables::Recorded writtenRecords() {
    tables::RecordMaker maker;
    maker.beginCase("models/duck").add("error", {1.0, 1.0, 4.0}).add("gpu_time_ms", {8.0});
    maker.add("scene_source", {1.0}, "", "enum");
    for (int process = 1; process < 6; ++process) maker.process(process).add("gpu_time_ms", {8.0});
    maker.beginCase("<b>&|_%", R"({"light_grid": 4})")
        .add("error", {2.5})
        .add("gpu_time_ms", {1.0 / 3.0});
    maker.beginCase("models/lost").fail(records::Status::Crash, "signal <11>");
    return maker.records();
}

struct Written {
    TemporaryFolder folder;
    std::string read(const std::string& name) const { return readFile(folder.path() / name); }
};

TEST(Writers, TableFiles) {
    const Written run;
    writeTables(run.folder.path(), tables::buildTables({writtenExperiment()}, writtenRecords()));
    const std::string csv = run.read("tables/zju2005-9.9.csv");
    EXPECT_THAT(
        csv,
        StartsWith("scene,source,error_printed,error_mean_measured,error_mean_low,error_mean_high,"
                   "error_mean_bounds,error_max_measured,error_max_low,error_max_high,error_max_"
                   "bounds,error_status,error_at_printed,draw_ms_printed,draw_ms_measured,draw_ms_"
                   "low,draw_ms_high,draw_ms_bounds,draw_ms_status,draw_ms_at_printed,parameters\n"
                   "models/duck,stand-in,3.00/106,2,1,4,range,4,1,4,range,ok,yes,"));
    EXPECT_THAT(
        csv,
        HasSubstr(",ok,yes,9.0,8,8,8,95 % interval,ok,yes,Measured at the printed parameters\n"));
    EXPECT_THAT(csv, HasSubstr("0.3333333333333333,"));
    EXPECT_THAT(csv, HasSubstr(",ok,no,Measured at light grid 4 (the config's 16)\n"));
    EXPECT_THAT(csv, HasSubstr("models/lost,,,,,,,,,,,crash,,,,,,,crash,,\n"));
    const std::string markdown = run.read("tables/zju2005-9.9.md");
    EXPECT_THAT(markdown, HasSubstr("# Table 9.9. A table\n"));
    EXPECT_THAT(markdown, HasSubstr("\n\nMeasured at the printed parameters.\n\n| scene |"))
        << "of the printed cells: the other row has none";
    EXPECT_THAT(markdown, HasSubstr("| duck | stand-in | 3.00/106 → 2.00/4 (1.00/1 … 4.00/4) |"));
    EXPECT_THAT(markdown, HasSubstr("| \\<b\\>&amp;\\|\\_% |"));
    EXPECT_THAT(markdown, HasSubstr("| 9.0 → 8.0 |"));
    EXPECT_THAT(markdown, HasSubstr("| scene | source | error \\[ms\\] | draw \\[ms\\] |"));
    EXPECT_THAT(markdown, HasSubstr("| lost |  | crash | crash |"));
    const std::string latex = run.read("tables/zju2005-9.9.tex");
    EXPECT_THAT(latex, HasSubstr("\\begin{tabular}{llrrrr}\n\\toprule\n"));
    EXPECT_THAT(latex,
                HasSubstr("\\gfxreproset{zju2005/9.9}{Measured at the printed parameters.}%\n"));
    EXPECT_THAT(
        latex,
        HasSubstr("\\gfxreproset{zju2005/9.9/notes}{\\gfxrepro{zju2005/9.9} Repeats or processes "
                  "came to different numbers, and no seed is declared: error.}%\n"));
    EXPECT_THAT(latex, HasSubstr("\\textless{}b\\textgreater{}\\&\\textbar{}\\_\\%"));
}

TEST(Writers, EveryFormSaysOverWhatItsNumbersAreTaken) {
    tables::RecordMaker maker;
    for (const char* method : {"oct", "snorm"}) {
        maker.beginCase("", R"({"method":")" + std::string(method) + "\"}").add("error", {1.0});
    }
    const Written run;
    writeTables(
        run.folder.path(),
        tables::buildTables({tables::experimentFrom("sweep: {method: [oct, snorm]}\n"
                                                    "layout: {columns: {e: {metric: error}}}\n")},
                            maker.records()));
    const std::string said = "Each number is taken over method (oct, snorm).";
    EXPECT_THAT(run.read("tables/zju2005-9.9.md"), HasSubstr("\nNote: " + said + "\n"));
    EXPECT_THAT(run.read("tables/zju2005-9.9.tex"), HasSubstr(said));
    const std::string csv = run.read("tables/zju2005-9.9.csv");
    EXPECT_THAT(csv, HasSubstr(",e_taken_over,"));
    EXPECT_THAT(csv, HasSubstr(",method=oct|snorm,"));
}

/// Rounds share what lasts as long as a run.
TEST(Writers, IntervalsOfTimesAreOfOneSitting) {
    const Written run;
    std::vector<tables::Table> built = tables::buildTables({writtenExperiment()}, writtenRecords());
    tables::Cell& draw = built[0].rows[0].cells[1];
    ASSERT_TRUE(draw.isTime);
    draw.low = "7.0";
    const auto legend = [&] {
        writeTables(run.folder.path(), built);
        const std::string text = run.read("tables/zju2005-9.9.md");
        return text.substr(text.find("Printed"), text.find("\n\nMeasured") - text.find("Printed"));
    };
    EXPECT_THAT(legend(), HasSubstr(" [95 % interval, of times that of this sitting] (range"));
    draw.unit = "%";
    EXPECT_THAT(legend(), HasSubstr(" [95 % interval, of times that of this sitting] (range"))
        << "a share of a time is of no count";
    draw.isTime = false;
    EXPECT_THAT(legend(), HasSubstr(" [95 % interval; of a share that was counted once, by its"));
}

TEST(Writers, CalibratedCellsAreMarked) {
    const Written run;
    tables::RecordMaker maker;
    maker.beginCase("models/duck").add("error", {2.0});
    maker.beginCase("models/bunny").add("error", {3.0});
    writeTables(run.folder.path(), tables::buildTables({tables::experimentFrom(R"(
sweep: {scene: [models/duck, models/bunny]}
layout: {rows: scene, columns: {error: {metric: error, format: "{median:.0f}"}, again: {metric: error, format: "{median:.0f}"}}}
printed: {calibrated: [{scene: models/duck, column: error}], values: "scene,error,again\nmodels/duck,2,1"}
)")},
                                                       maker.records()));
    const std::string csv = run.read("tables/zju2005-9.9.csv");
    EXPECT_THAT(csv, HasSubstr("error_status,error_at_printed,error_calibrated,again_printed"));
    EXPECT_THAT(csv, Not(HasSubstr("again_calibrated"))) << "none of the column is";
    EXPECT_THAT(csv, HasSubstr("models/duck,2,2,2,2,,ok,,yes,1,"));
    EXPECT_THAT(csv, HasSubstr("models/bunny,,3,3,3,,ok,,no,,"));
    const std::string legend =
        "calibrated: an input of ours, at the value that its config gives, was fitted so that this "
        "comes out, which tells nothing of the method.";
    const std::string markdown = run.read("tables/zju2005-9.9.md");
    EXPECT_THAT(markdown, HasSubstr("| duck | 2 → 2‡ | 1 → 2 |\n| bunny | 3 | 3 |\n"));
    EXPECT_THAT(markdown, HasSubstr("\n\n‡ " + legend + "\n"));
    const std::string latex = run.read("tables/zju2005-9.9.tex");
    EXPECT_THAT(latex,
                HasSubstr("\\gfxreproset{zju2005/9.9/models-duck/error/calibrated}{yes}%\n"));
    EXPECT_THAT(
        latex,
        HasSubstr("& \\gfxrepro{zju2005/9.9/models-duck/error}\\textsuperscript{\\ddag}\n&"));
    EXPECT_THAT(latex, HasSubstr("\\textsuperscript{\\ddag} " + legend + "}%\n"));
}

TEST(Writers, TimesThatAreNotOfOneClockAreMarked) {
    const Written run;
    tables::RecordMaker maker;
    maker.beginCase("models/duck").add("error", {2.0}).add("gpu_time_ms", {4.0});
    maker.beginCase("models/bunny").add("error", {3.0}).add("gpu_time_ms", {5.0});
    std::vector<tables::Table> made = tables::buildTables({tables::experimentFrom(R"(
sweep: {scene: [models/duck, models/bunny]}
layout: {rows: scene, columns: {error: {metric: error, format: "{median:.0f}"}, draw: {metric: gpu_time_ms, format: "{median:.0f}"}}}
)")},
                                                          maker.records());
    tables::markMovedClocks({{"case:models/duck{}", {0.345e9, 1.98e9}}}, made[0]);
    writeTables(run.folder.path(), made);
    const std::string csv = run.read("tables/zju2005-9.9.csv");
    EXPECT_THAT(csv, HasSubstr("draw_at_printed,draw_clock_low_ghz,draw_clock_high_ghz,"));
    EXPECT_THAT(csv, Not(HasSubstr("error_clock")));
    EXPECT_THAT(csv, HasSubstr("models/duck,,2,2,2,,ok,,,4,4,4,,ok,,0.345,1.98,"));
    EXPECT_THAT(csv, HasSubstr("models/bunny,,3,3,3,,ok,,,5,5,5,,ok,,,,"));
    const std::string legend = "timed while the GPU's clock moved between 0.345 and 1.98 GHz.";
    const std::string markdown = run.read("tables/zju2005-9.9.md");
    EXPECT_THAT(markdown, HasSubstr("| duck | 2 | 4§ |\n| bunny | 3 | 5 |\n\n§ " + legend));
    const std::string latex = run.read("tables/zju2005-9.9.tex");
    EXPECT_THAT(
        latex,
        HasSubstr("\\gfxreproset{zju2005/9.9/models-duck/draw/clock}{0.345 and 1.98 GHz}%\n"));
    EXPECT_THAT(latex,
                HasSubstr("\\gfxrepro{zju2005/9.9/models-duck/draw}\\textsuperscript{\\S} \\\\\n"));
    EXPECT_THAT(latex, HasSubstr("\\textsuperscript{\\S} " + legend + "}%\n"));
}

TEST(Writers, ClaimFiles) {
    const Written run;
    const auto tables = tables::buildTables({writtenExperiment()}, writtenRecords());
    claims::ReportContext context = kWritersContext;
    context.tried[{"zju2005/9.9", "A"}] = {claims::Verdict::Holds, "none of the 5 tried"};
    context.tried[{"zju2005/9.9", "B"}] = {claims::Verdict::Holds, "bias (of 5 tried)"};
    auto results = claims::evaluateClaims({writtenExperiment()}, tables, context);
    results[0].rows = "1 of 4 values of scene";
    results[1].sameAs = "zju2005/1 A";
    using Outcome = records::CaseEnd::Outcome;
    const std::vector<records::CaseEnd> cases = {
        {"zju2005/9.9", "zju2005/9.9 scene=a", Outcome::Measured},
        {"zju2005/9.9", "zju2005/9.9 scene=a", Outcome::Failed, "crash: <11>", 0.25},
        {"zju2005/9.9", "zju2005/9.9 scene=b", Outcome::Skipped, "missing: too slow"},
        {"zju2005/9.9", "zju2005/9.9 text=\x01", Outcome::Measured},
        {"zju2005/9.9", "zju2005/9.9 text=\x02", Outcome::Measured}};
    writeClaims(run.folder.path(), cases, results, kWritersContext, "2026-11-30T17:49:34Z");
    EXPECT_EQ(
        run.read("claims.csv"),
        "claim,says,table,device,profile,origin,bound_from,kind,verdict,known,measured,required,"
        "margin,reason,because,rests_on,rows,holds_on,same_as\n"
        "A,\"a < b & \"\"c\"\"\",zju2005/9.9,llvmpipe,quick,ours,ours,algorithmic,holds,holds,\"8 "
        "[8, 8]\",draw_ms ≤ 10,2,by the clock: no CPU time was recorded of these,,none of the 5 "
        "tried,1 of 4 values of scene,,\n"
        "B,no,zju2005/9.9,llvmpipe,quick,document,text,algorithmic,fails,fails,\"8 [8, "
        "8]\",draw_ms ≤ 1,-7,by the clock: no CPU time was recorded of these,\"slow, "
        "measured\",not tried: holds then,,,zju2005/1 A\n"
        "C,maybe,zju2005/9.9,llvmpipe,quick,ours,ours,algorithmic,unmeasured,holds,,draw_ms ≤ "
        "1,,draw_ms at scene=models/lost: crash (signal <11>),,,,,\n");
    const auto kept = claims::readClaims(run.folder.path() / "claims.csv");
    ASSERT_EQ(kept.size(), results.size());
    EXPECT_EQ(kept[1].origin, config::ClaimSpec::Origin::Document);
    EXPECT_EQ(kept[1].boundFrom, config::ClaimSpec::BoundSource::Text);
    EXPECT_EQ(kept[1].timeKind, config::ClaimSpec::TimeKind::Algorithmic);
    EXPECT_EQ(kept[1].known, claims::Verdict::Fails);
    EXPECT_EQ(kept[1].because, "slow, measured");
    EXPECT_EQ(kept[1].text, "no");
    EXPECT_EQ(kept[1].restsOn, "not tried: holds then");
    EXPECT_EQ(kept[0].rows, "1 of 4 values of scene");
    EXPECT_EQ(kept[1].sameAs, "zju2005/1 A");
    const std::string failed =
        "fails: measured 8 [8, 8], required draw_ms ≤ 1 (by the clock: no CPU time was recorded of "
        "these); known: slow, measured";
    EXPECT_EQ(
        run.read("junit.xml"),
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<testsuites>\n"
        "<testsuite name=\"cases\" package=\"gfxrepro\" id=\"0\" tests=\"5\" failures=\"0\" "
        "errors=\"1\" skipped=\"1\" time=\"0.250\" timestamp=\"2026-11-30T17:49:34\" "
        "hostname=\"localhost\">\n<properties/>\n"
        "  <testcase classname=\"zju2005/9.9\" name=\"zju2005/9.9 scene=a\" time=\"0.000\"/>\n"
        "  <testcase classname=\"zju2005/9.9\" name=\"zju2005/9.9 scene=a (2)\" "
        "time=\"0.250\"><error message=\"crash: &lt;11&gt;\" type=\"crash\">crash: "
        "&lt;11&gt;</error></testcase>\n"
        "  <testcase classname=\"zju2005/9.9\" name=\"zju2005/9.9 scene=b\" "
        "time=\"0.000\"><skipped message=\"missing: too slow\"/></testcase>\n"
        "  <testcase classname=\"zju2005/9.9\" name=\"zju2005/9.9 text=\uFFFD\" time=\"0.000\"/>\n"
        "  <testcase classname=\"zju2005/9.9\" name=\"zju2005/9.9 text=\uFFFD (2)\" "
        "time=\"0.000\"/>\n"
        "<system-out/>\n<system-err/>\n</testsuite>\n"
        "<testsuite name=\"claims\" package=\"gfxrepro\" id=\"1\" tests=\"3\" failures=\"1\" "
        "errors=\"0\" skipped=\"1\" time=\"0.000\" timestamp=\"2026-11-30T17:49:34\" "
        "hostname=\"localhost\">\n<properties/>\n"
        "  <testcase classname=\"zju2005/9.9\" name=\"zju2005/9.9 claim A\" time=\"0.000\"/>\n"
        "  <testcase classname=\"zju2005/9.9\" name=\"zju2005/9.9 claim B\" "
        "time=\"0.000\"><failure message=\"" +
            failed + "\" type=\"claim\">" + failed +
            "</failure></testcase>\n"
            "  <testcase classname=\"zju2005/9.9\" name=\"zju2005/9.9 claim C\" "
            "time=\"0.000\"><skipped message=\"unmeasured: measured nothing, required draw_ms ≤ 1 "
            "(draw_ms at scene=models/lost: crash (signal &lt;11&gt;))\"/></testcase>\n"
            "<system-out/>\n<system-err/>\n</testsuite>\n"
            "</testsuites>\n");
}

}  // namespace
}  // namespace gfxrepro::report
