#include "runner/report/writers.h"

#include <regex>
#include <set>

#include "runner/report/markup.h"
#include "tests/support/support.h"
#include "tests/unit/tables/fixture.h"

namespace gfxrepro::report {
namespace {

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
    EXPECT_THAT(
        keysOf(latex),
        ElementsAre("zju2005/9.9",  // its parameters
                    "zju2005/9.9/notes", "zju2005/9.9/models-duck/draw_ms/printed",
                    "zju2005/9.9/models-duck/draw_ms", "zju2005/9.9/models-duck/draw_ms/low",
                    "zju2005/9.9/models-duck/draw_ms/high",
                    "zju2005/9.9/models-duck/draw_ms/bounds", "zju2005/9.9/models-bunny/draw_ms"));
    EXPECT_THAT(latex, HasSubstr("\\gfxreproset{zju2005/9.9/models-duck/draw_ms}{9.0}%\n"));
    EXPECT_THAT(latex, HasSubstr("\\gfxreproset{zju2005/9.9/models-bunny/draw_ms}{crash}%\n"));
    EXPECT_THAT(latex,
                HasSubstr("{duck}\n& \\gfxrepro{zju2005/9.9/models-duck/draw_ms/printed}\n& "
                          "\\gfxrepro{zju2005/9.9/models-duck/draw_ms} \\\\\n"
                          "&\n& \\scriptsize (\\gfxrepro{zju2005/9.9/models-duck/draw_ms/low} "
                          "\\ldots\\ \\gfxrepro{zju2005/9.9/models-duck/draw_ms/high}) \\\\\n"));
    EXPECT_THAT(latex, HasSubstr("{zju2005/9.9/models-duck/draw_ms/bounds}{range}%\n"));
    EXPECT_THAT(latex, HasSubstr("\\begin{tabular}{lrr}\n\\toprule\n{scene}\n"
                                 "& \\multicolumn{2}{c}{{draw [ms]}} \\\\\n"
                                 "\\cmidrule(lr){2-3}\n"
                                 "& printed\n& measured \\\\\n\\midrule\n"));
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
                ElementsAre("zju2005/9.9", "zju2005/9.9/notes", "zju2005/9.9/ring.obj/e",
                            "zju2005/9.9/-a-x.obj/e", "zju2005/9.9/-b-x.obj/e"));
    EXPECT_THAT(latex, HasSubstr("{ring.obj}\n& "));
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
    ASSERT_EQ(keys.size(), 29U);
    EXPECT_EQ(std::set<std::string>(keys.begin(), keys.end()).size(), keys.size());
    EXPECT_EQ(keys[0], "zju2005/9.9");
    EXPECT_EQ(keys[1], "zju2005/9.9/notes");
    keys.erase(keys.begin(), keys.begin() + 2);
    for (const std::string& key : keys) {
        EXPECT_THAT(key, MatchesRegex("zju2005/9\\.9/[-A-Za-z0-9.+_]+/[-A-Za-z0-9.+_]+"));
    }
    EXPECT_EQ(keys[0], "zju2005/9.9/a-b/x_1");
    EXPECT_EQ(keys[1], "zju2005/9.9/a-b/x-1");
    EXPECT_EQ(keys[2], "zju2005/9.9/a-b/x-1-2");
    EXPECT_EQ(keys[3], "zju2005/9.9/a-b-2/x_1");
    EXPECT_EQ(latexKeyPart("é~$"), "---");
    EXPECT_EQ(latexKeyPart(""), "none");
    // After \\ a bracket would be its argument.
    EXPECT_THAT(latex, HasSubstr("\\\\\n{[0, 1]}\n& "));
}

TEST(Latex, WhatHoldsOfTheRunStandsBelowTheTable) {
    const tables::Table table{.id = "p/1", .columns = {{"b", ""}}};
    EXPECT_THAT(tableLatex(table), Not(HasSubstr("Note")));
    const std::string latex = tableLatex(table, {"imported: 5 % elsewhere"});
    EXPECT_THAT(latex, HasSubstr("\\gfxreproset{p/1/notes}{Note: imported: 5 \\% elsewhere.}%\n"));
    EXPECT_THAT(latex,
                HasSubstr("%     \\par\\smallskip\\parbox{\\linewidth}{\\gfxrepro{p/1/notes}}\n%   "
                          "\\end{table*}\n"));
    EXPECT_THAT(latex, Not(HasSubstr("\n\\par")));
    EXPECT_THAT(latex, EndsWith("\\end{tabular}%\n")) << "nothing widens a box around it";
}

TEST(Latex, WithoutPrintedCellsThereAreMeasuredColumnsAlone) {
    tables::Table table{.id = "p/1", .rowAxes = {"a"}, .columns = {{"b", ""}}};
    tables::Cell cell;
    cell.measured = "5";
    table.rows = {{{"1"}, tables::SceneSource::Unknown, {cell}}};
    const std::string latex = tableLatex(table);
    EXPECT_THAT(latex, HasSubstr("\\begin{tabular}{lr}\n\\toprule\n{a}\n& {b} "
                                 "\\\\\n\\midrule\n{1}\n& \\gfxrepro{p/1/1/b} \\\\\n"));
    EXPECT_THAT(latex, Not(HasSubstr("printed")));
}

TEST(Latex, PrintedAloneHasNoMeasuredColumns) {
    tables::Table table{
        .id = "p/1", .isOnlyPrinted = true, .rowAxes = {"a"}, .columns = {{"b", ""}}};
    tables::Cell cell;
    cell.isPlanned = false;
    cell.printed = "5";
    table.rows = {{{"1"}, tables::SceneSource::Unknown, {cell}}};
    const std::string latex = tableLatex(table);
    EXPECT_THAT(keysOf(latex), ElementsAre("p/1/1/b/printed"));
    EXPECT_THAT(latex, HasSubstr("\\begin{tabular}{lr}\n\\toprule\n{a}\n& {b} "
                                 "\\\\\n\\midrule\n{1}\n& \\gfxrepro{p/1/1/b/printed} \\\\\n"));
}

/// Of a published table, too: a column for print stands beside what is printed alone.
TEST(Latex, EachColumnAloneSaysWhatIsPrinted) {
    tables::Table table{
        .id = "p/1", .isPublished = true, .rowAxes = {"a"}, .columns = {{"b", ""}, {"lit_ms", ""}}};
    tables::Cell printed, measured;
    printed.measured = measured.measured = "5";
    printed.printed = "6";
    table.rows = {{{"1"}, tables::SceneSource::Unknown, {printed, measured}}};
    EXPECT_THAT(tableLatex(table),
                HasSubstr("\\begin{tabular}{lrrr}\n\\toprule\n{a}\n& \\multicolumn{2}{c}{{b}}\n"
                          "& \\gfxreprohead{r}{{lit}\\\\{[ms]}} \\\\\n\\cmidrule(lr){2-3}\n"
                          "& printed\n& measured& \\\\\n\\midrule\n{1}\n& "
                          "\\gfxrepro{p/1/1/b/printed}\n& \\gfxrepro{p/1/1/b}\n"
                          "& \\gfxrepro{p/1/1/lit_ms} \\\\\n"));
}

tables::Table wideTable(std::size_t columns) {
    tables::Table table{
        .id = "p/1", .rowAxes = {"a"}, .rows = {{{"1"}, tables::SceneSource::Unknown, {}}}};
    for (std::size_t i = 0; i < columns; ++i) {
        table.columns.push_back({"quantity_" + std::to_string(i), ""});
        tables::Cell cell;
        cell.measured = "1,234,567";
        table.rows.front().cells.push_back(cell);
    }
    return table;
}

TEST(Latex, AWideTableLiesAcrossAndAWiderOneIsInBlocks) {
    const std::string upright = tableLatex(wideTable(9)), across = tableLatex(wideTable(12)),
                      blocks = tableLatex(wideTable(20));
    EXPECT_THAT(upright, HasSubstr("%   \\begin{table*}"));
    EXPECT_THAT(across, HasSubstr("\\usepackage{rotating}"));
    EXPECT_THAT(across, HasSubstr("%   \\begin{sidewaystable*}"));
    EXPECT_THAT(blocks, HasSubstr("%   \\begin{table*}"));
    EXPECT_THAT(blocks, HasSubstr("\n\\begin{tabular}{@{}l@{}}\n\\begin{tabular}{lrrrrrrrrrr}\n"));
    const std::string label = "\\midrule\n{1}\n& ";
    std::size_t count = 0;
    for (std::size_t at = 0; (at = blocks.find(label, at)) != blocks.npos; ++at) ++count;
    EXPECT_EQ(count, 2U) << "each block has the labels";
    for (std::size_t i = 0; i < 20; ++i) {
        const std::string number = "& \\gfxrepro{p/1/1/quantity_" + std::to_string(i) + "}";
        EXPECT_THAT(blocks, HasSubstr(number));
        EXPECT_EQ(blocks.find(number), blocks.rfind(number)) << "each number stands once";
    }
}

TEST(Markup, Xml) {
    EXPECT_EQ(escapeXml("<script>alert(\"x\" & 'y')</script>"),
              "&lt;script&gt;alert(&quot;x&quot; &amp; &#39;y&#39;)&lt;/script&gt;");
    EXPECT_EQ(escapeXml(std::string_view("a\0b\x1b\n", 5)),
              "a\xEF\xBF\xBD"
              "b\xEF\xBF\xBD&#10;");
    EXPECT_EQ(escapeXml("256³ ≤ \U0001F40E"), "256³ ≤ \U0001F40E");
    // No UTF-8 (cut, overlong, a surrogate, beyond the last), and what XML has no place for.
    for (const std::string_view bad :
         {"\xE2\x89", "\xC0\xAF", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xFF", "\xEF\xBF\xBE"}) {
        const std::string text = escapeXml("a" + std::string(bad) + "b");
        EXPECT_EQ(text.find(bad), text.npos) << bad;
        EXPECT_EQ(text.substr(0, 4), "a\xEF\xBF\xBD") << bad;
        EXPECT_EQ(text.back(), 'b') << bad;
    }
}

TEST(Markup, Latex) {
    EXPECT_EQ(escapeLatex("50 % of a_b & \\input{x} $1$ #2 ^~"),
              "50 \\% of a\\_b \\& \\textbackslash{}input\\{x\\} \\$1\\$ \\#2 "
              "\\textasciicircum{}\\textasciitilde{}");
    EXPECT_EQ(escapeLatex("256³ × 2"), "256$^3$ $\\times$ 2");
    EXPECT_EQ(escapeLatex("10⁻⁴ ≤ xᵢ"), "10$^-$$^4$ $\\leq$ x$_i$");
}

TEST(Markup, Markdown) {
    EXPECT_EQ(escapeMarkdown("a|b\n<b> *x* & `y`"), "a\\|b \\<b\\> \\*x\\* &amp; \\`y\\`");
}

/// The vectors of RFC 4648, section 10.
TEST(Markup, Base64) {
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foo"), "Zm9v");
    EXPECT_EQ(base64("foob"), "Zm9vYg==");
    EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
    EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
    EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

}  // namespace
}  // namespace gfxrepro::report
