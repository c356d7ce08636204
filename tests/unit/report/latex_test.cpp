#include "runner/report/writers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <set>

#include "tests/unit/tables/fixture.h"

namespace gfxrepro::report {
namespace {

using testing::HasSubstr;
using testing::Not;

std::vector<std::string> keysOf(const std::string& latex) {
    const std::regex definition(R"(\\gfxreproset\{([^}]*)\}\{)");
    std::vector<std::string> keys;
    for (std::sregex_iterator at(latex.begin(), latex.end(), definition), end; at != end; ++at) {
        keys.push_back((*at)[1]);
    }
    return keys;
}

tables::Table tableFrom(const std::string& body, const tables::Recorded& records) {
    return tables::buildTable(tables::experimentFrom(body), records);
}

TEST(Latex, DefinesEachNumberOnceAndSetsTheTableByThem) {
    tables::RecordMaker maker;
    maker.beginCase("models/duck");
    for (int process = 0; process < 3; ++process) {
        maker.process(process).add("gpu_time_ms", {8.0 + process});
    }
    maker.beginCase("models/bunny").fail(records::Status::Crash, "signal 11");
    const std::string latex = tableLatex(tableFrom(R"(
sweep: {scene: [models/duck, models/bunny]}
layout: {rows: scene, columns: {draw_ms: {metric: gpu_time_ms}}, cell: "{median:.1f}"}
printed: {values: "scene,draw_ms\nmodels/duck,9.0"}
)",
                                                   maker.records()));
    EXPECT_THAT(keysOf(latex),
                testing::ElementsAre(
                    "zju2005/9.9",  // its parameters
                    "zju2005/9.9/models-duck/draw_ms/printed", "zju2005/9.9/models-duck/draw_ms",
                    "zju2005/9.9/models-duck/draw_ms/low", "zju2005/9.9/models-duck/draw_ms/high",
                    "zju2005/9.9/models-duck/draw_ms/bounds", "zju2005/9.9/models-bunny/draw_ms"));
    EXPECT_THAT(latex, HasSubstr("\\gfxreproset{zju2005/9.9/models-duck/draw_ms}{9.0}\n"));
    EXPECT_THAT(latex, HasSubstr("\\gfxreproset{zju2005/9.9/models-bunny/draw_ms}{crash}\n"));
    EXPECT_THAT(latex,
                HasSubstr("{models/duck} & \\gfxrepro{zju2005/9.9/models-duck/draw_ms/printed} & "
                          "\\gfxrepro{zju2005/9.9/models-duck/draw_ms} "
                          "{\\scriptsize(\\gfxrepro{zju2005/9.9/models-duck/draw_ms/low} "
                          "\\ldots\\ "
                          "\\gfxrepro{zju2005/9.9/models-duck/draw_ms/high})} \\\\\n"));
    EXPECT_THAT(latex, HasSubstr("{zju2005/9.9/models-duck/draw_ms/bounds}{range}\n"));
    EXPECT_THAT(latex, HasSubstr(" & printed & measured \\\\\n\\midrule\n"));
    EXPECT_THAT(latex, HasSubstr("%   \\gfxrepro{zju2005/9.9/models-duck/draw_ms}  as measured\n"));
}

TEST(Latex, StatisticsHaveKeysBelowTheCell) {
    tables::RecordMaker maker;
    maker.beginCase("a").add("error", {1.0, 2.0, 6.0});
    const std::string latex = tableLatex(tableFrom(R"(
scene: a
layout: {rows: scene, columns: {e: {metric: error}}, cell: "{mean:.2f}/{max:.0f}"}
)",
                                                   maker.records()));
    EXPECT_THAT(latex, HasSubstr("{zju2005/9.9/a/e}{3.00/6}"));
    EXPECT_THAT(latex, HasSubstr("{zju2005/9.9/a/e/mean}{3.00}"));
    EXPECT_THAT(latex, HasSubstr("{zju2005/9.9/a/e/max}{6}"));
    EXPECT_THAT(latex, HasSubstr("{zju2005/9.9/a/e/max/low}{"));
}

TEST(Latex, AFileOfOnesOwnIsCalledByItsName) {
    const std::string latex = tableLatex(tableFrom(R"(
sweep: {scene: [/home/me/ring.obj, /a/x.obj, /b/x.obj]}
layout: {rows: scene, columns: {e: {metric: error}}}
)",
                                                   {}));
    EXPECT_THAT(keysOf(latex),
                testing::ElementsAre("zju2005/9.9", "zju2005/9.9/ring.obj/e",
                                     "zju2005/9.9/-a-x.obj/e", "zju2005/9.9/-b-x.obj/e"));
    EXPECT_THAT(latex, HasSubstr("{ring.obj} & "));
    EXPECT_THAT(latex, Not(HasSubstr("/home/me")));
}

/// Labels that differ only in what a key cannot hold, and some that TeX would act on.
TEST(Latex, KeysAreSafeAndUnique) {
    const std::string latex = tableLatex(tableFrom(R"(
sweep: {scene: ["a/b", "a-b", "a b", "a-b-2", "\\input{x}", "#1", "50 %", "é~$&^", "[0, 1]"]}
layout: {rows: scene, columns: {"x_1": {metric: m}, "x 1": {metric: m}, "x/1": {metric: m}}}
)",
                                                   {}));
    std::vector<std::string> keys = keysOf(latex);
    ASSERT_EQ(keys.size(), 28U);
    EXPECT_EQ(std::set<std::string>(keys.begin(), keys.end()).size(), keys.size());
    EXPECT_EQ(keys[0], "zju2005/9.9");
    keys.erase(keys.begin());
    for (const std::string& key : keys) {
        EXPECT_THAT(key, testing::MatchesRegex("zju2005/9\\.9/[-A-Za-z0-9.+_]+/[-A-Za-z0-9.+_]+"));
    }
    EXPECT_EQ(keys[0], "zju2005/9.9/a-b/x_1");
    EXPECT_EQ(keys[1], "zju2005/9.9/a-b/x-1");
    EXPECT_EQ(keys[2], "zju2005/9.9/a-b/x-1-2");
    EXPECT_EQ(keys[3], "zju2005/9.9/a-b-2/x_1");
    EXPECT_EQ(latexKeyPart("é~$"), "---");
    EXPECT_EQ(latexKeyPart(""), "none");
    // After \\ a bracket would be its argument.
    EXPECT_THAT(latex, HasSubstr("\\\\\n{[0, 1]} & "));
}

TEST(Latex, WhatHoldsOfTheRunStandsBelowTheTable) {
    tables::Table table;
    table.id = "p/1";
    table.columns = {{"b", ""}};
    EXPECT_THAT(tableLatex(table), Not(HasSubstr("Note")));
    EXPECT_THAT(tableLatex(table, {"imported: 5 % elsewhere"}),
                HasSubstr("\\end{tabular}\n\\par{\\footnotesize Note: imported: 5 \\% "
                          "elsewhere.\\par}\n"));
}

TEST(Latex, WithoutPrintedCellsThereAreMeasuredColumnsAlone) {
    tables::Table table;
    table.id = "p/1";
    table.rowAxes = {"a"};
    table.columns = {{"b", ""}};
    tables::Cell cell;
    cell.measured = "5";
    table.rows = {{{"1"}, tables::SceneSource::Unknown, {cell}}};
    const std::string latex = tableLatex(table);
    EXPECT_THAT(latex, HasSubstr("\\begin{tabular}{lr}\n\\toprule\na & b \\\\\n\\midrule\n{1} & "
                                 "\\gfxrepro{p/1/1/b} \\\\\n"));
    EXPECT_THAT(latex, Not(HasSubstr("printed")));
}

TEST(Latex, PrintedAloneHasNoMeasuredColumns) {
    tables::Table table;
    table.id = "p/1";
    table.isOnlyPrinted = true;
    table.rowAxes = {"a"};
    table.columns = {{"b", ""}};
    tables::Cell cell;
    cell.isPlanned = false;
    cell.printed = "5";
    table.rows = {{{"1"}, tables::SceneSource::Unknown, {cell}}};
    const std::string latex = tableLatex(table);
    EXPECT_THAT(keysOf(latex), testing::ElementsAre("p/1/1/b/printed"));
    EXPECT_THAT(latex, HasSubstr("\\begin{tabular}{lr}\n\\toprule\na & b \\\\\n\\midrule\n{1} & "
                                 "\\gfxrepro{p/1/1/b/printed} \\\\\n"));
}

}  // namespace
}  // namespace gfxrepro::report
