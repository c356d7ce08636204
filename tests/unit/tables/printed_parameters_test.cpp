#include "runner/tables/printed.h"
#include "tests/support/support.h"
#include "tests/unit/tables/fixture.h"

namespace gfxrepro::tables {
namespace {

constexpr const char* kDuck = R"(
scene: models/duck
params: {light_grid: 16, bias: 1, cut: 5, view: a, n: 1}
layout: {rows: scene, columns: {ms: {metric: gpu_time_ms}}, cell: "{median:.1f}"}
printed: {values: "scene,ms\nmodels/duck,16.0"}
)";
constexpr const char* kPrinted = R"({"light_grid": 16, "output": {"width": 512, "height": 512}})";

/// The one cell of a table of the duck, measured at `measured`; the paper's at `printed`.
Cell cellAt(const char* measured, const char* printed, const std::string& more = "") {
    RecordMaker maker;
    maker.beginCase("models/duck", measured).add("gpu_time_ms", {8.0});
    const Table table = buildTable(
        withPaperCases(experimentFrom(kDuck + more), {{"models/duck", printed}}), maker.records());
    return table.rows.at(0).cells.at(0);
}

TEST(PrintedParameters, AreTheSame) {
    EXPECT_TRUE(cellAt(kPrinted, kPrinted).isAtPrintedParameters);
    EXPECT_THAT(cellAt(kPrinted, kPrinted).departures, IsEmpty());
    EXPECT_TRUE(cellAt(R"({"bias": 1.0, "p": [1, 2.0]})", R"({"p": [1.0, 2], "bias": 1})")
                    .isAtPrintedParameters)
        << "numbers compare as numbers, names in any order";
    EXPECT_TRUE(cellAt(R"({"pictures": true})", R"({"pictures": false})").isAtPrintedParameters)
        << "more is recorded, nothing else";
    const char* empty = R"({"bias": 1, "cut": null, "name": "", "list": [], "map": {}})";
    EXPECT_TRUE(cellAt(empty, R"({"bias": 1})").isAtPrintedParameters) << "nothing is no value";
    EXPECT_TRUE(cellAt(R"({"bias": 1})", empty).isAtPrintedParameters);
    EXPECT_THAT(cellAt(R"({"cut": null})", R"({"cut": 5})").departures,
                ElementsAre(Departure{"cut", {}, {"5"}, true}));
}

TEST(PrintedParameters, Differ) {
    const Cell cell =
        cellAt(R"({"light_grid": 4, "output": {"width": 128, "height": 512}})", kPrinted);
    EXPECT_FALSE(cell.isAtPrintedParameters);
    EXPECT_THAT(cell.departures, ElementsAre(Departure{"output", {"128×512"}, {"512×512"}, true},
                                             Departure{"light_grid", {"4"}, {"16"}, true}));
    EXPECT_THAT(cellAt("{}", R"({"light_grid": 16})").departures,
                ElementsAre(Departure{"light_grid", {}, {"16"}, true}));
}

TEST(PrintedParameters, FramesAreThoseOfTheProfiles) {
    const std::string frames =
        "output: {frames: 10}\nprofiles: {paper: {output: {frames: 1000}}}\n";
    EXPECT_THAT(cellAt(kPrinted, kPrinted, frames).departures,
                ElementsAre(Departure{"frames", {"10"}, {"1000"}, true}));
    const std::string repeats =
        "measure: {repeats: 1}\n"
        "profiles: {paper: {measure: {repeats: 20, processes: 6, lane: timing}}}\n";
    EXPECT_TRUE(cellAt(kPrinted, kPrinted, repeats).isAtPrintedParameters)
        << "how often something is measured does not make it something else";
}

/// What the profile `paper` itself departs from.
TEST(PrintedParameters, WhatIsPrintedLiesOverTheProfile) {
    const auto departuresAt = [](const std::string& at) {
        std::string body = kDuck;
        body.replace(body.find("values"), 0, "at: {" + at + "}, ");
        RecordMaker maker;
        maker.beginCase("models/duck", kPrinted).add("gpu_time_ms", {8.0});
        return buildTable(withPaperCases(experimentFrom(body), {{"models/duck", kPrinted}}),
                          maker.records())
            .rows.at(0)
            .cells.at(0)
            .departures;
    };
    EXPECT_THAT(departuresAt("light_grid: 16, output.width: 512, output.frames: 1"), IsEmpty());
    EXPECT_THAT(
        departuresAt("light_grid: 32, output.width: 640, output.frames: 500, scene: models/swan"),
        ElementsAre(Departure{"scene", {"models/duck"}, {"models/swan"}},
                    Departure{"output", {"512×512"}, {"640×512"}},
                    Departure{"light_grid", {"16"}, {"32"}}, Departure{"frames", {"1"}, {"500"}}));
}

/// What a config takes need not be printed; `printed.at` says what is.
TEST(PrintedParameters, ANumberOfAConfigIsTheConfigs) {
    const auto lineAt = [](const std::string& at, const std::string& assumptions) {
        std::string body = std::string(kDuck) +
                           "output: {frames: 3}\nprofiles: {paper: {output: {frames: 50}}}\n" +
                           "assumptions: {" + assumptions + "}\n";
        body.replace(body.find("values"), 0, "at: {" + at + "}, ");
        RecordMaker maker;
        maker.beginCase("models/duck", R"({"light_grid": 4, "output": {"width": 8, "height": 8}})");
        maker.add("gpu_time_ms", {8.0});
        return parametersLine(buildTable(
            withPaperCases(experimentFrom(body), {{"models/duck", kPrinted}}), maker.records()));
    };
    const std::string frames = "frames: {value: some, why: not said}";
    EXPECT_EQ(lineAt("", frames),
              "Measured at output 8×8 (the config's 512×512), light grid 4 (16), frames 3 (50).");
    EXPECT_EQ(lineAt("", "output.frames: {why: not said}"), lineAt("", frames));
    EXPECT_EQ(
        lineAt("output.frames: 60", frames),
        "Measured at output 8×8 (the config's 512×512), light grid 4 (16), frames 3 (printed 60).");
    EXPECT_EQ(lineAt("", "output: {range: [8, 512], why: not said}"), lineAt("", frames));
    EXPECT_EQ(
        lineAt("output.width: 512", "output: {range: [8, 512], why: not said}"),
        "Measured at output 8×8 (printed 512×512), light grid 4 (the config's 16), frames 3 (50).");
}

TEST(PrintedParameters, DefaultsAreNotSaidToBePrinted) {
    EXPECT_THAT(
        cellAt(R"({"yaw": 40, "bias": 2})", R"({"yaw": 0, "bias": 1})").departures,
        ElementsAre(Departure{"yaw", {"40"}, {"0"}, true}, Departure{"bias", {"2"}, {"1"}, true}));
}

/// A picture alone, and what is said of it in words.
TEST(PrintedParameters, NoneAreThoseOfATableWithoutPrintedNumbers) {
    const auto lineAt = [](const char* params, const std::string& more) {
        RecordMaker maker;
        maker.beginCase("models/duck", params).add("gpu_time_ms", {8.0});
        std::string body = kDuck;
        body.resize(body.find("printed:"));
        return parametersLine(
            buildTable(withPaperCases(experimentFrom(body + more), {{"models/duck", kPrinted}}),
                       maker.records()));
    };
    constexpr const char* kFewer = R"({"light_grid": 4, "output": {"width": 512, "height": 512}})";
    EXPECT_EQ(lineAt(kPrinted, ""), "Measured at the parameters of the profile paper.");
    EXPECT_EQ(lineAt(kFewer, ""), "Measured at light grid 4 (the config's 16).");
    EXPECT_EQ(lineAt(kFewer, "printed: {at: {light_grid: 32}}\n"),
              "Measured at light grid 4 (printed 32).");
}

TEST(PrintedParameters, AreNamedInTheConfigsWords) {
    const std::string words = "labels: {light_grid: light samples a side, bias: the bias}\n";
    const auto lineAt = [&](const char* params, const std::string& more) {
        RecordMaker maker;
        maker.beginCase("models/duck", params).add("gpu_time_ms", {8.0});
        return parametersLine(
            buildTable(withPaperCases(experimentFrom(kDuck + words + more),
                                      {{"models/duck", R"({"bias": 1, "light_grid": 16})"}}),
                       maker.records()));
    };
    EXPECT_EQ(lineAt(R"({"bias": 1, "light_grid": 4})", ""),
              "Measured at light samples a side 4 (the config's 16).");
    EXPECT_EQ(lineAt(R"({"bias": 1, "light_grid": 16})", "assumptions: {bias: {why: not given}}\n"),
              "Measured at the printed parameters as far as they are given (not: the bias).");
}

/// What the document does not give is the paper profile's, and no printed parameter.
TEST(PrintedParameters, AreThePrintedOnesAsFarAsTheyAreGiven) {
    const std::string open =
        "assumptions: {bias: {why: not given}, scene: {why: ours}, output: {why: not given}}\n";
    const char* params = R"({"bias": 1, "n": 2, "output": {"width": 8, "height": 8}})";
    const Cell cell = cellAt(params, params, open);
    EXPECT_TRUE(cell.isAtPrintedParameters);
    EXPECT_THAT(cell.openParameters, ElementsAre("output", "bias")) << "its source tells the scene";
    EXPECT_THAT(cellAt(R"({"n": 2})", R"({"n": 2})", open).openParameters, ElementsAre("output"));
    EXPECT_THAT(cellAt(R"({"n": 1})", params, open).openParameters, IsEmpty()) << "departs";

    RecordMaker maker;
    maker.beginCase("models/duck", params).add("gpu_time_ms", {8.0});
    const config::Experiment experiment =
        withPaperCases(experimentFrom(kDuck + open), {{"models/duck", params}});
    const Table table = buildTable(experiment, maker.records());
    EXPECT_EQ(parametersLine(table),
              "Measured at the printed parameters as far as they are given (not: output, bias).");
    maker = RecordMaker();
    maker.beginCase("models/duck", R"({"bias": 1, "n": 1, "output": {"width": 8, "height": 8}})");
    maker.add("gpu_time_ms", {8.0});
    EXPECT_EQ(parametersLine(buildTable(experiment, maker.records())),
              "Measured at n 1 (the config's 2); not given: output, bias.");
    EXPECT_EQ(printedCellsLine(countPrintedCells({{experiment}}, {{table}})),
              "Of 1 printed cell of tables 1 was measured again: 1 at the parameters that the "
              "document gives, which leaves some open.");
}

constexpr const char* kGrid = R"(
sweep: {scene: [models/duck], light_grid: [4, 16]}
layout: {rows: light_grid, columns: {ms: {metric: gpu_time_ms}}, cell: "{median:.1f}"}
printed: {values: "light_grid,ms\n4,1\n16,2\n32,3"}
assumptions: {other: {value: some, why: open}}
)";

Table gridTable(const char* four, const char* sixteen) {
    RecordMaker maker;
    maker.beginCase("models/duck", four).add("gpu_time_ms", {1.0});
    maker.beginCase("models/duck", sixteen).add("gpu_time_ms", {2.0});
    return buildTable(withPaperCases(experimentFrom(kGrid),
                                     {{"models/duck", R"({"light_grid": 16, "bias": 1})"},
                                      {"models/duck", R"({"light_grid": 32, "bias": 1})"}}),
                      maker.records());
}

TEST(PrintedParameters, RowsAreComparedWithTheSameRow) {
    const Table table =
        gridTable(R"({"light_grid": 4, "bias": 1})", R"({"light_grid": 16, "bias": 1})");
    ASSERT_EQ(table.rows.size(), 2U);
    EXPECT_FALSE(table.rows[0].cells[0].isAtPrintedParameters) << "the paper has no such row";
    EXPECT_THAT(table.rows[0].cells[0].departures, IsEmpty());
    EXPECT_TRUE(table.rows[1].cells[0].isAtPrintedParameters);
    EXPECT_EQ(parametersLine(table),
              "Measured at the printed parameters in 1 of 2 cells; 1 cell where the profile paper "
              "has no case.");
    EXPECT_EQ(parametersLine(table, table.rows[0]), "Measured where the profile paper has no case");
    EXPECT_EQ(parametersLine(table, table.rows[1]), "Measured at the printed parameters");
    PrintedCells count;
    count.add(experimentFrom(kGrid), table);
    EXPECT_EQ(printedCellsLine(count),
              "Of 3 printed cells of tables 2 were measured again: 1 at the printed parameters; 1 "
              "at other parameters, which each table names.");
}

/// A table of one row of measured cells beside printed values, which depart so.
std::string lineOf(const std::vector<std::vector<Departure>>& cells) {
    Table table;
    table.isPublished = table.knowsPrintedParameters = true;
    table.rows.resize(1);
    for (const std::vector<Departure>& departures : cells) {
        Cell& cell = table.rows[0].cells.emplace_back();
        cell.values.resize(1);
        cell.printed = "1";
        cell.departures = departures;
        cell.isAtPrintedParameters = departures.empty();
    }
    return parametersLine(table);
}

TEST(PrintedParameters, LinesCountWhatIsGiven) {
    Table table;
    table.isPublished = table.knowsPrintedParameters = true;
    table.rows.resize(1);
    const auto add = [&](const std::vector<std::string>& open) {
        Cell& cell = table.rows[0].cells.emplace_back();
        cell.values.resize(1);
        cell.isAtPrintedParameters = true;
        cell.openParameters = open;
        cell.printed = "1";
    };
    add({});
    add({"bias"});
    add({"bias", "view"});
    EXPECT_EQ(parametersLine(table),
              "Measured at the printed parameters in 1 of 3 cells, the printed parameters as far "
              "as they are given (not: bias, view) in 2 of 3 cells.");
    table.rows[0].cells.emplace_back().values.resize(1);
    table.rows[0].cells.back().printed = "1";
    table.rows[0].cells.back().departures = {{"n", {"1"}, {"2"}}};
    EXPECT_EQ(
        parametersLine(table),
        "Measured at the printed parameters in 1 of 4 cells, the printed parameters as far as they "
        "are given (not: bias, view) in 2 of 4 cells, in the others at n 1 (printed 2).");
}

TEST(PrintedParameters, LinesNameOnlyWhatDiffers) {
    const Departure output{"output", {"128×128"}, {"512×512"}}, grid{"light_grid", {"4"}, {"16"}},
        frames{"frames", {"10"}, {"1000"}};
    EXPECT_EQ(lineOf({{}, {}}), "Measured at the printed parameters.");
    EXPECT_EQ(lineOf({{output, grid, frames}}),
              "Measured at output 128×128 (printed 512×512), light grid 4 (16), frames 10 (1000).");
    EXPECT_EQ(lineOf({{}, {grid}, {}, {frames}}),
              "Measured at the printed parameters in 2 of 4 cells, in the others at light grid 4 "
              "(printed 16), frames 10 (1000).");
    EXPECT_EQ(lineOf({{grid}, {{"light_grid", {"8"}, {"16"}}}}),
              "Measured at light grid 4 / 8 (printed 16).");
    EXPECT_EQ(lineOf({{{"n", {"1", "2", "3", "4", "5"}, {}}}}),
              "Measured at n 1 / 2 / … / 5 (printed none).");
    EXPECT_EQ(openText({"a", "b", "c", "d", "e"}), "a, b, c, d, e");
    EXPECT_EQ(openText({"a", "b", "c", "d", "e", "f"}), "a, b, c, d, e, f");
    const Departure open{"frames", {"3"}, {"50"}, true}, view{"view", {"a"}, {"b"}, true};
    EXPECT_EQ(lineOf({{open}}), "Measured at frames 3 (the config's 50).");
    EXPECT_EQ(lineOf({{output, grid, view, open}}),
              "Measured at output 128×128 (printed 512×512), light grid 4 (16), view a (the "
              "config's b), frames 3 (50).");
    EXPECT_EQ(lineOf({{{"view", {"path_1"}, {"path_1", "path_2"}, true}}}),
              "Measured at view path 1 (the config's path 1 / path 2).");
    EXPECT_EQ(lineOf({{view, output}}),
              "Measured at view a (the config's b), output 128×128 (printed 512×512).");
    EXPECT_EQ(lineOf({{}, {open}}),
              "Measured at the printed parameters in 1 of 2 cells, in the others at frames 3 (the "
              "config's 50).");
}

/// Behind a cell several cases, over which its mean is taken.
TEST(PrintedParameters, SeveralCasesOfACell) {
    const auto departuresOf = [](std::initializer_list<const char*> measured) {
        RecordMaker maker;
        for (const char* params : measured) {
            maker.beginCase("models/duck", params).add("gpu_time_ms", {1.0});
        }
        const config::Experiment experiment =
            withPaperCases(experimentFrom(kDuck), {{"models/duck", R"({"view": "a", "n": 1})"},
                                                   {"models/duck", R"({"view": "b", "n": 1})"},
                                                   {"models/duck", R"({"view": "a", "n": 2})"},
                                                   {"models/duck", R"({"view": "b", "n": 2})"}});
        return buildTable(experiment, maker.records()).rows.at(0).cells.at(0).departures;
    };
    const char *a1 = R"({"view": "a", "n": 1})", *a2 = R"({"view": "a", "n": 2})",
               *b1 = R"({"view": "b", "n": 1})", *b2 = R"({"view": "b", "n": 2})";
    EXPECT_THAT(departuresOf({b2, a1, a2, b1}), IsEmpty());
    EXPECT_THAT(departuresOf({a1, a2}), ElementsAre(Departure{"view", {"a"}, {"a", "b"}, true}));
    EXPECT_THAT(departuresOf({a1, b2}), ElementsAre(Departure{"cases", {"2"}, {"4"}, true}));
}

TEST(PrintedParameters, FailedCasesAreNotBehindACell) {
    RecordMaker maker;
    maker.beginCase("models/duck", R"({"view": "a"})").add("gpu_time_ms", {1.0});
    maker.beginCase("models/duck", R"({"view": "b"})").fail(records::Status::Crash, "signal 11");
    const Table table = buildTable(
        withPaperCases(experimentFrom(kDuck),
                       {{"models/duck", R"({"view": "a"})"}, {"models/duck", R"({"view": "b"})"}}),
        maker.records());
    EXPECT_FALSE(table.rows[0].cells[0].isAtPrintedParameters);
    EXPECT_EQ(parametersLine(table), "Measured at view a (the config's a / b).");
}

/// Another seed of a generated scene is another sample of it; another scene is not.
TEST(PrintedParameters, SeedsAreNoParameters) {
    const auto isAtPrinted = [](const char* scene) {
        RecordMaker maker;
        maker.beginCase(scene, R"({"stands_for": "models/duck", "scene_sample": 1})");
        maker.add("gpu_time_ms", {1.0});
        const Table table = buildTable(withPaperCases(experimentFrom(R"(
scene: models/duck
layout: {columns: {ms: {metric: gpu_time_ms}}}
)"),
                                                      {{"models/duck", "{}"}}),
                                       maker.records());
        return table.rows.at(0).cells.at(0).isAtPrintedParameters;
    };
    EXPECT_TRUE(isAtPrinted("models/duck@2"));
    EXPECT_FALSE(isAtPrinted("models/goose"));
}

/// A profile may lay the table out otherwise; a column goes by its name.
TEST(PrintedParameters, TheLayoutOfTheProfileDecidesWhatIsPrinted) {
    RecordMaker maker;
    maker.beginCase("models/duck", R"({"light_grid": 4})").add("gpu_time_ms", {1.0});
    const Table table = buildTable(withPaperCases(experimentFrom(R"(
sweep: {scene: [models/duck], light_grid: [4, 16]}
layout:
  rows: scene
  columns: {small: {where: {light_grid: 4}}, ours: {where: {light_grid: 4}}}
  cell: {metric: gpu_time_ms}
profiles:
  paper: {layout: {columns: {small: {where: {light_grid: 16}}, ours: null}}}
)"),
                                                  {{"models/duck", R"({"light_grid": 4})"},
                                                   {"models/duck", R"({"light_grid": 16})"}}),
                                   maker.records());
    EXPECT_THAT(table.rows.at(0).cells.at(0).departures,
                ElementsAre(Departure{"light_grid", {"4"}, {"16"}, true}));
    EXPECT_FALSE(table.rows[0].cells.at(1).isAtPrintedParameters);
    EXPECT_THAT(table.rows[0].cells[1].departures, IsEmpty()) << "the paper has no such column";
}

TEST(PrintedParameters, AreNotKnownOfOlderRuns) {
    RecordMaker maker;
    maker.beginCase("models/duck", kPrinted).add("gpu_time_ms", {8.0});
    const config::Experiment experiment = experimentFrom(kDuck);
    const Table table = buildTable(experiment, maker.records());
    EXPECT_FALSE(table.knowsPrintedParameters);
    EXPECT_FALSE(table.rows.at(0).cells.at(0).isAtPrintedParameters);
    EXPECT_EQ(parametersLine(table),
              "Whether it was measured at the printed parameters is not known: the run's plan does "
              "not have them.");
    PrintedCells count;
    count.add(experiment, table);
    EXPECT_EQ(printedCellsLine(count),
              "Of 1 printed cell of tables 1 was measured again: 1 at parameters of which it is "
              "not known.");
}

/// Whoever says of no parameter whether it is printed or open has not said that all are printed.
TEST(PrintedParameters, AreTheConfigsWhereNobodySaysThatTheyArePrinted) {
    RecordMaker maker;
    maker.beginCase("models/duck", kPrinted).add("gpu_time_ms", {8.0});
    const config::Experiment experiment =
        withPaperCases(experimentFrom(kDuck), {{"models/duck", kPrinted}});
    const Table table = buildTable(experiment, maker.records());
    EXPECT_EQ(parametersLine(table), "Measured at the parameters of the profile paper.");
    PrintedCells count;
    count.add(experiment, table);
    EXPECT_EQ(printedCellsLine(count),
              "Of 1 printed cell of tables 1 was measured again: 1 at parameters of which it is "
              "not known.");
}

TEST(PrintedParameters, NothingIsSaidOfWhatIsNotPublished) {
    RecordMaker maker;
    maker.beginCase("models/duck", kPrinted).add("gpu_time_ms", {8.0});
    config::Experiment own = experimentFrom(kDuck);
    own.kind = config::ExperimentKind::Sweep;
    own.printed = {};
    EXPECT_EQ(parametersLine(buildTable(own, maker.records())), "");
    const Table unmeasured = buildTable(experimentFrom(kDuck), {});
    EXPECT_EQ(parametersLine(unmeasured), "Nothing of it is measured.");
    EXPECT_EQ(parametersLine(unmeasured, unmeasured.rows.at(0)), "");
}

TEST(PrintedParameters, CellsOfTablesAreCounted) {
    RecordMaker maker;
    maker.beginCase("models/duck", kPrinted).add("gpu_time_ms", {8.0});
    const std::string open = "assumptions: {other: {value: some, why: open}}\n";
    config::Experiment experiment =
        withPaperCases(experimentFrom(kDuck + open), {{"models/duck", kPrinted}});
    const Table table = buildTable(experiment, maker.records());
    PrintedCells count = countPrintedCells({{experiment, experiment}}, {{table, table}});
    EXPECT_EQ(printedCellsLine(count),
              "Of 2 printed cells of tables 2 were measured again: 2 at the printed parameters.");
    experiment.kind = config::ExperimentKind::Figure;
    count.add(experiment, table);
    EXPECT_EQ(count.printed, 2) << "a figure's";
    EXPECT_EQ(printedCellsLine({}), "");

    // What is only printed counts, too: it stands in the document.
    config::Experiment alone;
    alone.printed.header = {"a", "b", "c"};
    alone.printed.rows = {{"x", "1", ""}, {"y", "2", "3"}};
    count = {};
    count.add(alone, buildTable(alone, {}));
    EXPECT_EQ(printedCellsLine(count), "Of 3 printed cells of tables none was measured again.");
}

/// Of a table with rows scene (duck, bunny) and a profile that measures the dragon, too.
std::string errorOf(const std::string& rows) {
    const std::string body =
        "layout: {rows: scene, columns: {ms: {metric: m, format: \"{mean:.2f}\"}, both: {metric: "
        "m, format: \"{mean:.1f}/{max:.1f}\"}}}\n"
        "printed:\n  values: |\n    scene,ms,both\n    # a remark\n" +
        rows;
    const config::Experiment whole = experimentFrom("sweep: {scene: [duck, bunny]}\n" + body);
    const config::Experiment paper = experimentFrom("sweep: {scene: [duck, dragon]}\n" + body);
    const std::vector<Table> tables = {buildTable(whole, Recorded()),
                                       buildTable(paper, Recorded())};
    const std::string text = errorText([&] { requirePrintedValues(whole, tables); });
    const std::size_t at = text.find(".yaml:");
    return at == std::string::npos ? text : text.substr(at + 6);
}

TEST(PrintedValues, HaveARowInSomeProfile) {
    EXPECT_EQ(errorOf("    duck,1,2/3\n    dragon,1,\n"), "no error");
    EXPECT_EQ(errorOf("    duck,1,2/3\n    dargon,1,\n"),
              "11: printed: no profile measures the row 'dargon,1,'; allowed: scene duck | bunny | "
              "dragon");
}

TEST(PrintedValues, AreWrittenAsTheirCells) {
    EXPECT_EQ(errorOf("    duck,12x8,\n"),
              "10: printed: ms is '12x8'; allowed: as the cell's format writes numbers, or empty "
              "where it is lost");
    EXPECT_EQ(errorOf("    duck,1,2\n").substr(0, 26), "10: printed: both is '2'; ");
    EXPECT_EQ(errorOf("    dragon,1e3,2/\n").substr(0, 25), "10: printed: both is '2/'");
    EXPECT_EQ(errorOf("    duck,,\n"), "no error");
}

}  // namespace
}  // namespace gfxrepro::tables
