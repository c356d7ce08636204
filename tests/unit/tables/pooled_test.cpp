#include <fmt/format.h>

#include "runner/tables/table.h"
#include "tests/support/support.h"
#include "tests/unit/tables/fixture.h"

namespace gfxrepro::tables {
namespace {

/// Two methods at two depths.
Table tableWith(const std::string& layout) {
    RecordMaker maker;
    for (const char* method : {"oct", "snorm"}) {
        for (int bits : {8, 10}) {
            maker.beginCase("", "{\"method\":\"" + std::string(method) +
                                    "\",\"bits\":" + std::to_string(bits) + "}");
            maker.add("error", {bits * (method[0] == 'o' ? 1.0 : 2.0)}, "", "1");
        }
    }
    return buildTable(
        experimentFrom("sweep: {method: [oct, snorm], bits: [8, 10]}\nlayout: " + layout + "\n"),
        maker.records());
}

std::string refusalOf(const std::string& layout) {
    const config::Experiment experiment =
        experimentFrom("sweep: {method: [oct, snorm], bits: [8, 10]}\nlayout: " + layout + "\n");
    const std::string text =
        errorText([&] { requireToldApart(experiment, buildTable(experiment, Recorded())); });
    const std::size_t at = text.find(".yaml:");
    return at == std::string::npos ? text : text.substr(at + 6);
}

TEST(Pooled, ACellSaysOverWhatItIsTaken) {
    const Table table = tableWith("{rows: bits, columns: {e: {metric: error}}}");
    EXPECT_EQ(table.rows[0].cells[0].measured, "12") << "the median of two methods";
    EXPECT_THAT(table.notes, Contains("Each number is taken over method (oct, snorm)."));
    EXPECT_EQ(pooledText(table.rows[0].cells[0]), "method=oct|snorm");
    const Table apart = tableWith("{rows: [bits, method], columns: {e: {metric: error}}}");
    EXPECT_THAT(apart.notes, IsEmpty());
    EXPECT_EQ(pooledText(apart.rows[0].cells[0]), "");
}

TEST(Pooled, SomeRowsAndColumnsAreNamed) {
    const std::string oct = "oct: {where: {method: oct}}";
    const Table row = tableWith("{rows: {" + oct + ", all: {where: {method: [oct, snorm]}}}, " +
                                "columns: {e: {metric: error, where: {bits: 8}}}}");
    EXPECT_THAT(row.notes, Contains("Each number of row all is taken over method (oct, snorm)."));
    const Table average = tableWith("{rows: {" + oct + ", average: {}}, " +
                                    "columns: {e: {metric: error, where: {bits: 8}}}}");
    EXPECT_THAT(average.notes,
                Contains("Each number of row average is taken over method (oct, snorm)."));
    const Table column = tableWith(
        "{rows: bits, columns: {oct: {metric: error, where: {method: oct}}, both: {metric: error, "
        "where: {method: [oct, snorm]}}}}");
    EXPECT_THAT(column.notes,
                Contains("Each number of column both is taken over method (oct, snorm)."));
    const Table two = tableWith("{columns: {e: {metric: error}}}");
    EXPECT_THAT(two.notes,
                Contains("Each number is taken over method (oct, snorm) and bits (8, 10)."));
}

/// Columns and rows that ask for other values of the same axis.
TEST(Pooled, EachColumnsOwnValuesAreSaid) {
    RecordMaker maker;
    for (const char* method : {"a", "b", "c", "d", "e", "f"}) {
        maker.beginCase("", fmt::format(R"({{"method":"{}"}})", method));
        maker.add("error", {1.0}, "", "1").add("steps", {1.0}, "", "1");
    }
    const auto notesOf = [&](const std::string& layout) {
        return buildTable(
                   experimentFrom("sweep: {method: [a, b, c, d, e, f]}\nlayout: " + layout + "\n"),
                   maker.records())
            .notes;
    };
    EXPECT_THAT(notesOf("{columns: {old: {where: {method: [a, b]}}, new: {where: {method: [c, "
                        "d]}}, more: {metric: steps, where: {method: [a, b]}}, one: {where: "
                        "{method: a}}}, cell: {metric: error}}"),
                ElementsAre("Each number of columns old, more is taken over method (a, b).",
                            "Each number of column new is taken over method (c, d)."));
    EXPECT_THAT(notesOf("{rows: {x: {where: {method: [a, b]}}, y: {where: {method: a}}}, columns: "
                        "{e: {metric: error}, most: {metric: error, where: {method: [c, d]}}}}"),
                ElementsAre("Each number of column e in row x is taken over method (a, b).",
                            "Each number of column most is taken over method (c, d)."));
    std::string columns;
    for (const char* pair : {"[a, b]", "[b, c]", "[c, d]", "[d, e]", "[e, f]"}) {
        columns += fmt::format("{}x{}: {{metric: error, where: {{method: {}}}}}",
                               columns.empty() ? "" : ", ", columns.size(), pair);
    }
    EXPECT_THAT(notesOf("{columns: {" + columns + "}}"),
                ElementsAre("Each number is taken over method (some of 6 values)."))
        << "too many to tell apart";
}

TEST(Pooled, AnAxisThatTheLayoutDoesNotNameIsRefused) {
    EXPECT_EQ(refusalOf("{rows: bits, columns: {e: {metric: error}}}"),
              "5:1: layout: each number would be taken over method (oct, snorm), which is swept; "
              "allowed: as an axis of rows or columns, or in a 'where': {method: [oct, snorm]} "
              "takes its values together");
    EXPECT_EQ(refusalOf("{rows: [bits, method], columns: {e: {metric: error}}}"), "no error");
    EXPECT_EQ(
        refusalOf(
            "{rows: bits, columns: {e: {metric: error}}, cell: {where: {method: [oct, snorm]}}}"),
        "no error");
    EXPECT_EQ(refusalOf("{rows: bits, columns: {oct: {metric: error, where: {method: oct}}, all: "
                        "{metric: error}}}"),
              "no error")
        << "an average beside what it is of";
}

/// A column of the file may number trials: what says so is told.
TEST(Pooled, AColumnOfAnImportThatTheConfigDoesNotNameIsRefused) {
    RecordMaker maker;
    for (const char* method : {"oct", "snorm"}) {
        for (const int trial : {0, 1}) {
            maker.beginCase("", fmt::format(R"({{"method":"{}","trial":{}}})", method, trial));
            maker.add("error", {1.0 + trial}, "", "1");
        }
    }
    Recorded records = maker.records();
    for (config::Case& item : records.cases) item.axes = item.params;
    const auto refusal = [&](const std::string& lines) {
        config::Experiment experiment =
            experimentFrom("sweep: {method: [oct, snorm]}\n" + lines + "\n");
        experiment.technique = config::kImported;
        const Table table = tables::buildTable(experiment, records.cases, records);
        const std::string text = errorText([&] { requireToldApart(experiment, table); });
        const std::size_t at = text.find(".yaml:");
        return at == std::string::npos ? text : text.substr(at + 6);
    };
    const std::string what =
        "; what repeats a case has its number in the column 'process', or in 'seed' where each has "
        "random numbers of its own";
    EXPECT_EQ(refusal("layout: {rows: method, columns: {e: {metric: error}}}"),
              "5:1: layout: each number would be taken over trial (0, 1), which is a column of the "
              "file; allowed: in 'sweep', and as an axis of rows or columns, or in a 'where': "
              "{trial: [0, 1]} takes its values together" +
                  what);
    EXPECT_EQ(refusal("layout: {rows: method, columns: {e: {metric: error, pass: other}}}"),
              "no error")
        << "of no case";
}

/// Its cells would all be missing.
TEST(Pooled, AColumnAtEqualErrorNeedsACurve) {
    const std::string columns = ", columns: {at: {metric: ms, equal: {metric: error, is: 1}}}}";
    EXPECT_EQ(refusalOf("{rows: [method, bits]" + columns),
              "5:1: layout: column 'at' has 'equal', and its cells have no curve: each needs the "
              "values of an axis of numbers that is swept and that names neither rows nor columns");
    EXPECT_THAT(refusalOf("{rows: bits" + columns), HasSubstr("has 'equal'")) << "of words";
    EXPECT_EQ(refusalOf("{rows: method" + columns), "no error");
}

/// Frames of a case, and seeds of its scene, as `measure` asks for.
TEST(Pooled, FramesAndSeedsOfScenesAreSaid) {
    RecordMaker frames;
    frames.beginCase("", "{}").frame(-1).add("setup", {1.0}, "", "1");
    for (int frame = 0; frame < 5; ++frame)
        frames.frame(frame).add("error", {1.0 + frame}, "", "1");
    const std::string columns = "columns: {s: {metric: setup}, e: {metric: error}}";
    const Table path = buildTable(experimentFrom("layout: {" + columns + "}\n"), frames.records());
    EXPECT_THAT(path.notes, Contains("Each number of column e is taken over frame (5 of them)."));
    EXPECT_EQ(pooledText(path.rows[0].cells[1]), "frame=5 of them");
    EXPECT_EQ(pooledText(path.rows[0].cells[0]), "") << "what is of no frame";
    const Table byFrame = buildTable(
        experimentFrom("layout: {rows: frame, columns: {e: {metric: error}}}\n"), frames.records());
    EXPECT_EQ(pooledText(byFrame.rows[0].cells[0]), "");
    RecordMaker seeds;
    for (const char* sample : {"0", "1", "2"}) {
        seeds.beginCase("grass", std::string("{\"scene_sample\":") + sample + "}");
        seeds.add("error", {1.0}, "", "1");
    }
    Recorded records = seeds.records();
    for (std::size_t i = 0; i < records.cases.size(); ++i) {
        records.cases[i].sceneSample = static_cast<int>(i);
    }
    const Table table = buildTable(
        experimentFrom("scene: grass\nlayout: {columns: {e: {metric: error}}}\n"), records);
    EXPECT_THAT(table.notes, Contains("Each number is taken over scene seed (3 of them)."));
}

/// What goes together with a row is one value in each.
TEST(Pooled, AxesThatGoTogetherAreNotTakenTogether) {
    const config::Experiment experiment = experimentFrom(
        "sweep: {zip: [{method: [oct, snorm], bits: [8, 10]}]}\n"
        "layout: {rows: bits, columns: {e: {metric: error}}}\n");
    const Table table = buildTable(experiment, Recorded());
    EXPECT_THAT(table.notes, Not(Contains(HasSubstr("taken over"))));
    EXPECT_EQ(errorText([&] { requireToldApart(experiment, table); }), "no error");
}

}  // namespace
}  // namespace gfxrepro::tables
