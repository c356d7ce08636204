#include <fmt/format.h>

#include "runner/config/experiment.h"
#include "tests/unit/config/experiment_fixture.h"

namespace gfxrepro::config {
namespace {

TEST_F(ExperimentTest, BadSections) {
    EXPECT_EQ(errorWith("titl: u"),
              "DIR/zju/a.yaml:4:1: config: unknown key 'titl'; did you mean 'title'?");
    EXPECT_EQ(errorWith("output: {width: 20000}"),
              "DIR/zju/a.yaml:4:17: output: width is 20000; allowed: 1 … 16384 pixels");
    EXPECT_EQ(errorWith("measure: {lane: fast}"),
              "DIR/zju/a.yaml:4:17: measure: lane is fast; allowed: quality | timing");
    EXPECT_EQ(errorWith("measure: {repeat: 3}"),
              "DIR/zju/a.yaml:4:11: measure: unknown key 'repeat'; did you mean 'repeats'?");
    EXPECT_EQ(errorWith("params: [1]"), "DIR/zju/a.yaml:4:9: params is [1]; allowed: a map");
    EXPECT_EQ(errorWith("assumptions: {a: {value: 1}}"),
              "DIR/zju/a.yaml:4:15: assumption 'a' needs 'why'");
    EXPECT_EQ(errorWith("assumptions:\n  a: {value: 1, why: it is, or is not}\n"),
              "DIR/zju/a.yaml:5:29: assumptions.a: 'or is not' has no value; a text that holds a "
              "comma needs quotes");
    EXPECT_EQ(errorWith("assumptions: {a: {valu: 1, why: w}}"),
              "DIR/zju/a.yaml:4:19: assumption 'a': unknown key 'valu'; did you mean 'value'?");
    const std::string table =
        "sweep: {scene: [s]}\nlayout: {rows: scene, columns: {aa: {metric: m, ";
    for (const auto& [scale, allowed] :
         {std::pair("big", "a number, above 0"), {"0", "above 0"}, {"-1", "above 0"}}) {
        EXPECT_EQ(errorWith(table + "scale: " + scale + "}}}"),
                  fmt::format("DIR/zju/a.yaml:5:56: scale is {}; allowed: {}", scale, allowed));
    }
    EXPECT_EQ(errorWith("claims: {}"), "DIR/zju/a.yaml:4:1: 'claims' without 'layout'");
    EXPECT_EQ(loadError("sweep_of: own\ntitle: t\ntechnique: x\nsweep: {n: [1, 2]}\nclaims:\n"
                        "  C: {says: s, order: [m=1, m=2]}\n"),
              "DIR/zju/a.yaml:6:23: claim 'C': axis of order is m; allowed: n");
    EXPECT_EQ(errorWith("printed: {values: \"a\\n1\"}"),
              "DIR/zju/a.yaml:4:11: printed: 'values' without 'layout'");
}

TEST_F(ExperimentTest, ShowsPicturesThatTheProgramLeaves) {
    const auto error = [&](const std::string& name) {
        return loadError(
            "sweep_of: own\ntitle: t\nprogram: {command: t, images: {result: r.png}}\n"
            "shows: [" +
            name + "]\n");
    };
    EXPECT_EQ(error("result"), "no error");
    EXPECT_EQ(error("nothing"), "DIR/zju/a.yaml:4:9: shows is nothing; allowed: result");
}

TEST_F(ExperimentTest, AProgramNeedsNoTechnique) {
    const Experiment own = load("sweep_of: own\ntitle: t\nprogram: {command: t}\n");
    EXPECT_EQ(own.technique, "external");
    EXPECT_EQ(load("sweep_of: own\ntitle: t\ntechnique: x\nprogram: {command: t}\n").technique,
              "x");
    EXPECT_EQ(loadError("sweep_of: own\ntitle: t\n"),
              "DIR/zju/a.yaml:1:1: neither 'technique' nor 'printed'; allowed: either or both");
}

TEST_F(ExperimentTest, WhatAPresetSaysOfThePrintNeedsNoLayout) {
    folder.write("presets/print.yaml", "printed: {hardware: a card, at: {output.frames: 900}}\n");
    const Experiment own =
        load("sweep_of: own\ntitle: t\ntechnique: x\nextends: [presets/print.yaml]\n");
    EXPECT_EQ(own.printed.hardware, "a card");
    EXPECT_TRUE(own.printed.rows.empty());
}

TEST_F(ExperimentTest, BadLayouts) {
    const auto layoutError = [&](const std::string& layout) {
        return errorWith("params: {method: m}\nsweep: {scene: [s]}\nlayout: " + layout);
    };
    const std::string head = "DIR/zju/a.yaml:6:";
    EXPECT_EQ(layoutError("{rows: scnee, cell: {metric: m}}"),
              head + "16: layout: unknown axis 'scnee'; allowed: method, scene, frame");
    EXPECT_EQ(layoutError("{rows: [scene, methd], cell: {metric: m}}"),
              head + "24: layout: unknown axis 'methd'; did you mean 'method'?");
    EXPECT_EQ(layoutError("{rows: scene, columns: scene, cell: {metric: m}}"),
              head + "32: layout: axis 'scene' is used twice");
    EXPECT_EQ(layoutError("{cell: {metric: m}}"), head + "9: layout has neither rows nor columns");
    EXPECT_EQ(layoutError("{rows: scene, columns: {a: {metric: m}, b: {pass: p}}}"),
              head +
                  "9: layout: some cell has no metric; allowed: a metric in `cell`, or in every "
                  "label of one axis");
    EXPECT_EQ(layoutError("{axes: {e: {a: m}}, rows: scene, cell: {metric: m}}"),
              head + "17: layout: axis 'e' is neither in rows nor in columns");
    EXPECT_EQ(layoutError("{axes: {scene: {a: m}}, rows: scene}"),
              head + "17: layout: axis 'scene' is an axis of the cases already");
    EXPECT_EQ(layoutError("{rows: scene, columns: {a: {metrics: m}}}"),
              head + "37: a cell's selection: unknown key 'metrics'; did you mean 'metric'?");
    EXPECT_EQ(layoutError("{rows: scene, columns: {a: {metric: m, where: {metod: x}}}}"),
              head + "56: where: unknown key 'metod'; did you mean 'method'?");
    EXPECT_EQ(layoutError("{rows: scene, columns: {a: {metric: m, equal: {metric: e, is: x}}}}"),
              head + "71: equal: is is x; allowed: a number");
    const auto computed = [&](const std::string& of) {
        return layoutError("{rows: scene, columns: {a: {metric: m}, b: {of: \"" + of + "\"}}}");
    };
    const std::string place = head + "52: layout: of: ";
    EXPECT_EQ(computed("a / c"), place + "'c' is no column; did you mean 'a'? (columns: a)");
    EXPECT_EQ(computed("b / a"), place + "'b' is no column; did you mean 'a'? (columns: a)")
        << "itself";
    EXPECT_EQ(computed("a[methd=x] / a"),
              place + "a[methd=x]: 'methd' is no row axis; allowed: scene");
    EXPECT_EQ(computed("a[scene] / a"), place + "a[scene]; allowed: column[axis=value, …]");
    EXPECT_EQ(computed("a / a[scene=t]"), place + "a[scene=t]: scene is t; allowed: s");
    const auto shown = [&](const std::string& format, const std::string& of) {
        return layoutError("{rows: scene, columns: {a: {metric: m, format: '" + format +
                           "'}, b: {of: '" + of + "'}}}");
    };
    EXPECT_THAT(shown("{mean:.1f}", "2 * a"),
                EndsWith("layout: of: 'a' shows mean, and this column median; allowed: of both the "
                         "same, as format: \"{mean:.4g}\""));
    EXPECT_THAT(shown("{p95:.1f} {{}} {max}", "a[scene=s] / 2"), HasSubstr("shows p95, max, and"));
    EXPECT_EQ(shown("{median:.1f} {mean}", "a / a[scene=s]"), "no error");
    EXPECT_EQ(layoutError("{rows: scene, columns: {a: {metric: m}, b: {of: a, metric: m}}}"),
              head + "60: a computed column: unknown key 'metric'; allowed: of, format");
    EXPECT_EQ(layoutError("{rows: {a: {of: a}}, columns: scene, cell: {metric: m}}"),
              head + "20: layout: of: it stands in a column, not a row");
    EXPECT_EQ(layoutError("{rows: scene, columns: {}}"),
              head + "32: labels is {}; allowed: a map {label: selection}");
    EXPECT_EQ(layoutError("{row: scene}"),
              head + "10: layout: unknown key 'row'; did you mean 'rows'?");
}

TEST_F(ExperimentTest, CellFormats) {
    const auto formatError = [&](const std::string& format) {
        return errorWith("sweep: {scene: [s]}\nlayout: {rows: scene, columns: {a: m}, cell: '" +
                         format + "'}");
    };
    for (const char* format :
         {"{mean:.2f}/{max:.0f}", "{median}", "{{{count:.0f}}}", "{min:8.3e} ms"}) {
        EXPECT_EQ(formatError(format), "no error") << format;
    }
    const std::string head = "DIR/zju/a.yaml:5:46: ";
    EXPECT_EQ(formatError("{avg:.2f}"), head +
                                            "statistic is avg; allowed: median, mean, min, max, "
                                            "sum, count, rate, stddev, p95, p99");
    // The words in brackets are those of fmt 9, or of 10.
    const std::string ofNumbers =
        head + "format is \"{mean:.2d}\"; allowed: number formats such as {mean:.2f} ";
    EXPECT_THAT(formatError("{mean:.2d}"), AnyOf(ofNumbers + "(invalid type specifier)",
                                                 ofNumbers + "(invalid format specifier)"));
    EXPECT_EQ(formatError("{mean:999999999f}"), head +
                                                    "format is \"{mean:999999999f}\"; allowed: "
                                                    "number formats such as {mean:.2f} (too long)");
    EXPECT_EQ(formatError("mean"),
              head + "format is mean; allowed: a statistic in braces, as {median:.4g}");
    EXPECT_EQ(formatError("{mean"), head + "format is \"{mean\"; allowed: a } for every {");
    EXPECT_EQ(formatError("{mean} }"),
              head + "format is \"{mean} }\"; allowed: } only after {, or }}");
}

TEST_F(ExperimentTest, BadPrintedValues) {
    const auto printedError = [&](const std::string& lines) {
        return errorWith(
            "sweep: {scene: [s]}\n"
            "layout: {axes: {e: {p: {pass: p}, q: {pass: q}}}, rows: [scene, e], columns: {time: "
            "m}}\n"
            "printed:\n  values: |\n" +
            lines);
    };
    EXPECT_EQ(printedError("    # remark\n    scene,e,time\n\n    s,p,1\n    s,q,\n"), "no error");
    EXPECT_EQ(printedError("    scene,e,\n    time\n    s,p,1\n    s,q,\n"), "no error");
    EXPECT_EQ(printedError("    scene,e,\n    time\n    s,p\n"),
              "DIR/zju/a.yaml:10: printed: 2 cells in a row; the header has 3");
    EXPECT_EQ(printedError("    scene,e,\n    tme\n    s,p,1\n"),
              "DIR/zju/a.yaml:9: printed: 'tme' is neither a row axis nor a column; did you mean "
              "'time'?");
    EXPECT_EQ(printedError("    scene,e,tme\n    s,p,1\n"),
              "DIR/zju/a.yaml:8: printed: 'tme' is neither a row axis nor a column; did you mean "
              "'time'?");
    EXPECT_EQ(printedError("    scene,e,speed\n    s,p,1\n"),
              "DIR/zju/a.yaml:8: printed: 'speed' is neither a row axis nor a column; allowed: "
              "scene, e, time");
    EXPECT_EQ(printedError("    scene,time\n    s,1\n"),
              "DIR/zju/a.yaml:8: printed: row axis 'e' has no column");
    EXPECT_EQ(printedError("    scene,e,time,time\n"),
              "DIR/zju/a.yaml:8: printed: column 'time' stands twice");
    EXPECT_EQ(printedError("    scene,e,time\n    # x\n    s,p\n"),
              "DIR/zju/a.yaml:10: printed: 2 cells in a row; the header has 3");
    EXPECT_EQ(printedError("    scene,e,time\n    s,r,1\n"),
              "DIR/zju/a.yaml:9: printed: e is 'r'; allowed: p | q");
    EXPECT_EQ(printedError("    scene,e,time\n    s,p,1\n    s,p,2\n"),
              "DIR/zju/a.yaml:10: printed: the row 's,p,2' stands twice");
    EXPECT_EQ(printedError("    scene,e,time\n"),
              "DIR/zju/a.yaml:7:11: printed: values has no rows");
}

TEST_F(ExperimentTest, CalibratedCellsAreTheTables) {
    const auto error = [&](const std::string& calibrated) {
        return errorWith(
            "sweep: {scene: [s, t]}\nlayout: {rows: scene, columns: {aa: m, bb: m}}\n"
            "printed: {calibrated: " +
            calibrated + "}");
    };
    const std::string head = "DIR/zju/a.yaml:6:";
    EXPECT_EQ(error("[{column: aa}, {scene: [s, t], column: [aa, bb]}, {scene: s}]"), "no error");
    EXPECT_EQ(error("[{column: cc}]"),
              head + "33: printed.calibrated.column is cc; allowed: aa | bb");
    EXPECT_EQ(error("[{scene: u}]"), head + "32: printed.calibrated.scene is u; allowed: s | t");
    EXPECT_EQ(error("[{scen: s}]"),
              head + "25: printed.calibrated: unknown key 'scen'; did you mean 'scene'?");
    EXPECT_EQ(error("aa"),
              head + "23: printed.calibrated is aa; allowed: [{row axis: value, column: name}]");
}

TEST_F(ExperimentTest, SourcesOfPrintedCellsStandBehindTheRemark) {
    const auto with = [](const std::string& sources) {
        return "table: p/1\ntitle: t\ntechnique: x\nsweep: {scene: [s, t]}\n"
               "layout: {rows: scene, columns: {aa: m, bb: m}}\nprinted:\n  sources: " +
               sources + "\n";
    };
    const std::string values = "\n  values: |\n    scene,aa\n    s,1";
    EXPECT_EQ(load(with("{read off: {scene: [s, t], column: bb}, a copy: {scene: s}}\n"
                        "  remark: as printed" +
                        values))
                  .printed.remark,
              "as printed; at scene s, t and column bb: read off; at scene s: a copy");
    EXPECT_EQ(load(with("{a copy: {scene: s}}" + values)).printed.remark, "at scene s: a copy");
    EXPECT_EQ(loadError(with("{a copy: {scene: s}}")),
              "DIR/zju/a.yaml:7:3: printed: 'sources' without 'values'");
    const std::string head = "DIR/zju/a.yaml:7:";
    EXPECT_EQ(loadError(with("{a copy: {scene: u}}" + values)),
              head + "29: printed.sources.scene is u; allowed: s | t");
    EXPECT_EQ(loadError(with("{a copy: {}}" + values)),
              head +
                  "21: printed.sources is {}; allowed: {row axis: value}; of the whole table "
                  "'remark' says it");
    EXPECT_EQ(loadError(with("a copy" + values)),
              head + "12: printed.sources is a copy; allowed: {TEXT: {row axis: value}}");
    EXPECT_EQ(
        loadError("table: p/1\ntitle: t\nprinted: {values: \"a\\n1\", sources: {b: {a: 1}}}\n"),
        "DIR/zju/a.yaml:3:27: printed: 'sources' without 'technique'");
}

TEST_F(ExperimentTest, PrintedParameters) {
    const std::string table =
        "table: p/1\ntitle: t\ntechnique: x\nsweep: {scene: [s], grid: [4, 8]}\n"
        "layout: {rows: scene, columns: {aa: m}}\n";
    const auto at = [&](const std::string& values) {
        return table + "printed: {at: " + values + "}\n";
    };
    const Experiment read = load(at("{output.frames: 500, output.width: 1024, depth: deep}"));
    ASSERT_EQ(read.printed.at.size(), 3U);
    EXPECT_EQ(read.printed.at[0].key(), "output.frames");
    EXPECT_EQ(read.printed.at[0].value.asInteger(), 500);
    EXPECT_EQ(read.printed.at[2].value.text(), "deep");
    EXPECT_EQ(loadError(at("500")),
              "DIR/zju/a.yaml:6:15: printed.at is 500; allowed: a map {parameter: printed value}");
    EXPECT_EQ(loadError(at("{measure.repeats: 5}")),
              "DIR/zju/a.yaml:6:16: printed.at: 'measure.repeats'; allowed: a parameter, scene, "
              "output.width, output.height, output.frames");
    EXPECT_EQ(loadError(at("{output.frames: all}")),
              "DIR/zju/a.yaml:6:31: printed.at: output.frames is all; allowed: a whole number, 1 … "
              "1000000");
    EXPECT_EQ(loadError(at("{output.width: 20000}")),
              "DIR/zju/a.yaml:6:30: printed.at: output.width is 20000; allowed: 1 … 16384");
    EXPECT_EQ(loadError(at("{grid: 16}")),
              "DIR/zju/a.yaml:6:22: printed.at: 'grid' is swept; allowed: what all cases share");
    EXPECT_EQ(loadError("table: p/1\ntitle: t\nprinted: {values: \"a\\n1\", at: {grid: 1}}\n"),
              "DIR/zju/a.yaml:3:27: printed: 'at' without 'technique'");
}

/// What the paper measured at does not depend on what is asked for.
TEST_F(ExperimentTest, PaperDocumentIsTheProfileWithoutOverrides) {
    const std::string body =
        "title: t\ntechnique: x\nparams: {grid: 8}\nsweep: {scene: [s]}\n"
        "layout: {rows: scene, columns: {aa: m}}\n";
    const std::string profiles =
        "profiles: {quick: {params: {grid: 4}}, paper: {params: {grid: 16}}}\n";
    const auto gridOf = [](const Node& document) {
        return document.find("params")->find("grid")->asInteger();
    };
    const ExperimentOptions quick{.profile = "quick",
                                  .sets = {parseOverride("depth=1")},
                                  .sweeps = {parseOverride("scene=t,u")}};
    const Experiment table = load("table: p/1\n" + body + profiles, quick);
    EXPECT_EQ(gridOf(table.document), 4);
    EXPECT_EQ(gridOf(table.paperDocument), 16);
    EXPECT_FALSE(table.paperDocument.find("params")->find("depth"));
    EXPECT_EQ(table.paperDocument.find("sweep")->toFlowText(), "{scene: [s]}");
    EXPECT_EQ(gridOf(load("figure: p/1\n" + body, quick).paperDocument), 8) << "no such profile";
    EXPECT_TRUE(load("sweep_of: p\n" + body + profiles, quick).paperDocument.isNull());
    const std::string printed = "printed: {values: \"scene,aa\\ns,1\"}\n";
    EXPECT_EQ(gridOf(load("sweep_of: p\n" + body + printed, quick).paperDocument), 8);
}

TEST_F(ExperimentTest, ColumnsOfSeveralAxesAreJoined) {
    const std::string text =
        "table: p/1\ntitle: t\ntechnique: x\nsweep: {scene: [s], method: [nr, dp], size: [512, "
        "1024]}\n"
        "layout: {rows: scene, columns: [method, size], cell: {metric: m}}\n"
        "claims: {C: {says: s, ratio: (dp_512 + 1) / nr_512, at_least: 1, at_most: 2}}\n"
        "printed: {values: \"scene,nr_512,dp_1024\\ns,1,2\"}\n";
    const Experiment table = load(text);
    EXPECT_THAT(table.claims[0].operands, ElementsAre("(dp_512 + 1)", "nr_512"));
    // What an override takes out of the sweep may still be printed and claimed.
    const ExperimentOptions options{.sweeps = {parseOverride("size=512")}};
    EXPECT_EQ(load(text, options).printed.header.size(), 3U);
}

TEST_F(ExperimentTest, BadClaims) {
    const std::string head = "DIR/zju/a.yaml:7:";
    EXPECT_EQ(claimError("{says: s, order: aa < bb}"), "no error");
    EXPECT_EQ(claimError("{order: aa < bb}"), head + "3: claim 'C' needs 'says'");
    EXPECT_EQ(claimError("{says: s}"),
              head +
                  "3: claim 'C' has no type; allowed: order, ratio, trend, independent, bound, "
                  "exact, tolerance, crossover, same_mean");
    EXPECT_EQ(claimError("{says: s, order: aa < bb, bound: aa}"),
              head + "32: claim 'C' is of two types, 'order' and 'bound'");
    EXPECT_EQ(claimError("{says: s, order: aa < bb, at_least: 1}"),
              head +
                  "32: claim 'C': 'order' has no 'at_least'; allowed: 'ratio: b / a' of two of "
                  "them, or 'ratio: AXIS=b / AXIS=a', with a bound");
    EXPECT_EQ(claimError("{says: s, ratio: bb / aa, at_least: 1}"), "no error");
    EXPECT_EQ(claimError("{says: s, exact: aa, equals: 1, at_most: 2}"),
              head + "38: claim 'C': 'exact' has no 'at_most'; allowed: 'bound: a' with it");
    EXPECT_EQ(claimError("{says: s, bound: aa, at_most: 2}"), "no error");
    EXPECT_EQ(claimError("{says: s, order: aa < bb, above: 1}"),
              head +
                  "32: claim 'C': unknown key 'above'; allowed: says, at, across, of, profile, "
                  "origin, same_as, bound_from, kind, because, order");
    EXPECT_EQ(
        claimError("{says: s, order: aa}"),
        head + "23: claim 'C': order is aa; allowed: a < b < … | [AXIS=VALUE, AXIS=VALUE, …]");
    EXPECT_EQ(claimError("{says: s, order: aa < bb < aa}"),
              head + "23: claim 'C' compares 'aa' with itself");
    EXPECT_EQ(claimError("{says: s, order: aa < }"),
              head + "23: claim 'C' is aa <; allowed: an expression over columns");
    EXPECT_EQ(claimError("{says: s, order: aa < bc}"),
              head + "23: claim 'C': 'bc' is no column; did you mean 'bb'? (columns: aa, bb)");
    EXPECT_EQ(claimError("{says: s, bound: 'aa[n=1] / bb', at_most: 1}"),
              head +
                  "23: claim 'C': 'aa[n=1] / bb' reads a row by its name; allowed: a column of the "
                  "layout that does, 'NAME: {of: \"aa[n=1] / bb\"}', or rows held against each "
                  "other, 'order: [AXIS=VALUE, …]' or 'ratio: AXIS=VALUE / AXIS=VALUE'");
    EXPECT_EQ(claimError("{says: s, ratio: aa, at_least: 1}"),
              head + "23: claim 'C': ratio is aa; allowed: a / b");
    EXPECT_EQ(claimError("{says: s, ratio: aa / bb}"),
              head + "3: claim 'C' needs at_least, more_than, at_most or less_than");
    EXPECT_EQ(claimError("{says: s, ratio: aa / bb, at_least: 2, at_most: 1}"),
              head + "54: claim 'C': the lower bound exceeds the upper");
    EXPECT_EQ(claimError("{says: s, bound: aa}"),
              head + "3: claim 'C' needs at_least, more_than, at_most or less_than");
    EXPECT_EQ(claimError("{says: s, bound: aa, at_least: 1, more_than: 1}"),
              head + "51: claim 'C': 'at_least' and 'more_than'; one is allowed");
    EXPECT_EQ(claimError("{says: s, bound: aa, more_than: 1, less_than: 1}"),
              head + "52: claim 'C': less_than is 1; allowed: bounds with a number between them");
    EXPECT_EQ(claimError("{says: s, ratio: aa / bb, more_than: 1, at_most: 1}"),
              head + "43: claim 'C': more_than is 1; allowed: bounds with a number between them");
    EXPECT_EQ(claimError("{says: s, ratio: aa / bb, at_least: 1, at_most: 1}"), "no error");
    EXPECT_EQ(claimError("{says: s, bound: aa, more_than: 2, less_than: 1}"),
              head + "52: claim 'C': the lower bound exceeds the upper");
}

TEST_F(ExperimentTest, BadClaimsOverAxes) {
    const std::string head = "DIR/zju/a.yaml:7:";
    EXPECT_EQ(claimError("{says: s, trend: aa, at_least: 1, at_most: 2}"),
              head + "3: claim 'C' needs 'over'");
    EXPECT_EQ(claimError("{says: s, trend: aa, over: bb}"),
              head + "3: claim 'C' needs at_least, more_than, at_most, less_than or direction");
    EXPECT_EQ(
        claimError("{says: s, trend: aa, over: scen, direction: decreasing}"),
        head + "33: claim 'C': 'scen' is neither a row axis nor a column; did you mean 'scene'?");
    EXPECT_EQ(claimError("{says: s, trend: aa, over: bb, direction: down}"),
              head + "48: claim 'C': direction is down; allowed: increasing | decreasing");
    EXPECT_EQ(claimError("{says: s, trend: aa, over: bb, direction: increasing, strictly: maybe}"),
              head + "70: claim 'C': strictly is maybe; allowed: true | false");
    EXPECT_EQ(claimError("{says: s, bound: aa, at_least: big}"),
              head + "37: claim 'C': at_least is big; allowed: a number");
    EXPECT_EQ(claimError("{says: s, trend: aa, over: bb, at_least: 1, at_most: 2, strictly: true}"),
              head + "72: claim 'C': strictly needs 'direction'");
    for (const char* share : {"25", "x%", "-1%", "[1]"}) {
        EXPECT_EQ(
            claimError(std::string("{says: s, independent: aa, of: bb, at_most: ") + share + "}"),
            head + "50: claim 'C': at_most is " + share +
                "; allowed: a percentage as 25%, or a fraction, 0 … 1");
    }
    EXPECT_EQ(claimError("{says: s, exact: aa}"), head + "3: claim 'C' needs 'equals'");
    EXPECT_EQ(claimError("{says: s, exact: aa, equals: printed}"),
              head + "3: claim 'C' needs printed values");
    EXPECT_EQ(claimError("{says: s, tolerance: aa, at_most: 5%}"),
              head + "3: claim 'C' needs printed values");
    EXPECT_EQ(claimError("{says: s, crossover: [aa], over: scene, at_least: 1, at_most: 2}"),
              head + "27: claim 'C': crossover is [aa]; allowed: [a, b]");
    EXPECT_EQ(claimError("{says: s, same_mean: aa, false_alarms: 1%}"), "no error");
    EXPECT_EQ(claimError("{says: s, same_mean: aa}"), head + "3: claim 'C' needs 'false_alarms'");
    for (const char* rate : {"0", "11%", "1", "-1%", "few"}) {
        EXPECT_EQ(claimError(std::string("{says: s, same_mean: aa, false_alarms: ") + rate + "}"),
                  head + "45: claim 'C': false_alarms is " + rate +
                      "; allowed: a percentage as 25%, or a fraction, above 0, at most 0.1");
    }
    // At 100 % of the printed value nothing would be too little.
    for (const char* width : {"1", "100%", "-1%"}) {
        EXPECT_EQ(errorWith("sweep: {scene: [s, t]}\nlayout: {rows: scene, columns: {aa: m}}\n"
                            "printed: {values: \"scene,aa\\ns,1\"}\n"
                            "claims: {C: {says: s, tolerance: aa, at_most: " +
                            std::string(width) + "}}"),
                  head + "47: claim 'C': at_most is " + width +
                      "; allowed: a percentage as 25%, or a fraction, at least 0, below 1");
    }
}

TEST_F(ExperimentTest, BadClaimScopes) {
    const std::string head = "DIR/zju/a.yaml:7:";
    EXPECT_EQ(claimError("{says: s, bound: aa, at_least: 1, at: {scene: u}}"),
              head + "52: claim 'C': at.scene is u; allowed: s | t");
    EXPECT_EQ(claimError("{says: s, bound: aa, at_least: 1, at: {scnene: s}}"),
              head + "45: claim 'C': at: unknown key 'scnene'; did you mean 'scene'?");
    EXPECT_EQ(claimError("{says: s, bound: aa, at_least: 1, profile: fast}"),
              head + "49: claim 'C': profile is fast; allowed: quick | full | paper");
    EXPECT_EQ(claimError("{says: \"s\\nt\", bound: aa, at_least: 1}"),
              head + "13: claim 'C': says is \"s\\nt\"; allowed: one line of text");
}

TEST_F(ExperimentTest, ClaimsSayWhoseTheyAreAndWhatIsKnown) {
    const std::string layout =
        "sweep: {scene: [s]}\nlayout: {rows: scene, columns: {aa: m, bb: m}}\nclaims:\n  C: ";
    const auto error = [&](const std::string& keys) {
        return errorWith(layout + "{says: s, bound: aa, less_than: 1, " + keys + "}");
    };
    const std::string head = "DIR/zju/a.yaml:7:";
    EXPECT_EQ(error("origin: mine"), head +
                                         "49: claim 'C': origin is mine; allowed: document | "
                                         "derived | ours | definition | calibrated | existence");
    EXPECT_EQ(error("same_as: D"), head + "50: claim 'C': same_as is D; allowed: TABLE CLAIM");
    EXPECT_EQ(error("bound_from: paper"),
              head + "53: claim 'C': bound_from is paper; allowed: print | text | ours");
    EXPECT_EQ(
        error("kind: fast"),
        head + "47: claim 'C': kind is fast; allowed: algorithmic | architectural | absolute");
    EXPECT_EQ(errorWith(layout + "{says: s, order: aa < bb, bound_from: print}"),
              head + "44: claim 'C': bound_from, and there is no number in what it requires");
    EXPECT_EQ(error("because: {verdict: fails}"), head + "50: claim 'C': because needs 'reason'");
    EXPECT_EQ(
        error("because: {verdict: holds, reason: r}"),
        head + "60: claim 'C': because: verdict is holds; allowed: fails | ambiguous | unmeasured");
    EXPECT_EQ(error("because: [{verdict: fails, reason: r, device: cpu}]"),
              head + "87: claim 'C': because: device is cpu; allowed: software | gpu");
    const auto known = [&](const std::string& first, const std::string& second) {
        return error("because: [{verdict: fails, reason: r" + first +
                     "}, {verdict: ambiguous, reason: r" + second + "}]");
    };
    const std::string rule =
        "; allowed: one for each device, profile and kind of scenes, what is of more behind what "
        "is of less";
    EXPECT_EQ(known("", ""), head +
                                 "80: claim 'C': because is of any device, any profile, and an "
                                 "earlier one of any device, any profile" +
                                 rule);
    EXPECT_EQ(known(", profile: quick", ", profile: quick"),
              head +
                  "96: claim 'C': because is of any device, quick, and an earlier one of any "
                  "device, quick" +
                  rule);
    EXPECT_EQ(known("", ", device: gpu"), head +
                                              "80: claim 'C': because is of gpu, any profile, and "
                                              "an earlier one of any device, any profile" +
                                              rule)
        << "never reached";
    EXPECT_EQ(known(", device: software", ", profile: quick"),
              head +
                  "98: claim 'C': because is of any device, quick, and an earlier one of software, "
                  "any profile" +
                  rule);
    EXPECT_EQ(known(", scenes: files", ", scenes: files"),
              head +
                  "95: claim 'C': because is of any device, any profile, scenes: files, and an "
                  "earlier one of any device, any profile, scenes: files" +
                  rule);
    EXPECT_EQ(error("because: [{verdict: fails, reason: r, scenes: real}]"),
              head + "87: claim 'C': because: scenes is real; allowed: files | generated");
    EXPECT_EQ(known(", scenes: files", ", scenes: generated"), "no error");
    EXPECT_EQ(known(", scenes: files", ""), "no error");
    EXPECT_EQ(known(", profile: quick", ", profile: paper"), "no error");
    EXPECT_EQ(known(", profile: quick", ""), "no error");
    EXPECT_EQ(known(", device: gpu, profile: quick", ", device: gpu"), "no error");
}

TEST_F(ExperimentTest, ProvenanceOfAClaim) {
    const Experiment table = load(
        "table: zju/1\ntitle: t\ntechnique: voxelization\nsweep: {scene: [s]}\n"
        "layout: {rows: scene, columns: {aa: m}}\nclaims:\n"
        "  C: {says: s, bound: aa, more_than: 0, origin: derived, same_as: zju/2 D, bound_from: "
        "print, kind: architectural, because: [{verdict: fails, profile: quick, reason: r, "
        "shown_by: s, scenes: files}]}\n");
    const ClaimSpec& claim = table.claims.at(0);
    EXPECT_EQ(claim.origin, ClaimSpec::Origin::Derived);
    EXPECT_EQ(claim.sameAs, "zju/2 D");
    EXPECT_EQ(claim.boundFrom, ClaimSpec::BoundSource::Print);
    EXPECT_EQ(claim.timeKind, ClaimSpec::TimeKind::Architectural);
    EXPECT_TRUE(claim.isLowExcluded);
    ASSERT_EQ(claim.because.size(), 1u);
    EXPECT_EQ(claim.because[0].profile, "quick");
    EXPECT_EQ(claim.because[0].shownBy, "s");
    EXPECT_EQ(claim.because[0].scenes, "files");
    EXPECT_EQ(claim.because[0].device, std::nullopt);
}

TEST_F(ExperimentTest, AClaimIsItsTablesUnlessItSaysOtherwise) {
    const std::string body =
        "title: t\ntechnique: voxelization\nsweep: {scene: [s]}\n"
        "layout: {rows: scene, columns: {aa: m, bb: m}}\n"
        "claims: {A: {says: s, bound: aa, more_than: 0}, B: {says: s, order: aa < bb}}\n";
    const Experiment table = load("table: zju/1\n" + body);
    EXPECT_EQ(table.claims[0].origin, ClaimSpec::Origin::Document);
    EXPECT_EQ(table.claims[0].boundFrom, ClaimSpec::BoundSource::Ours);
    EXPECT_EQ(table.claims[1].boundFrom, std::nullopt) << "it requires no number";
    const Experiment sweep = load("sweep_of: zju\n" + body);
    EXPECT_EQ(sweep.claims[0].origin, ClaimSpec::Origin::Ours);
    EXPECT_EQ(sweep.claims[0].boundFrom, std::nullopt);
}

TEST_F(ExperimentTest, ClaimsAcrossARowAxisNameItsLabels) {
    const auto error = [&](const std::string& claim) {
        return errorWith(
            "sweep: {scene: [s, t]}\nlayout: {axes: {e: {p: {pass: p}, q: {pass: q}}}, rows: [e, "
            "scene], columns: {aa: m, bb: m}}\nclaims:\n  C: {says: s, " +
            claim);
    };
    const std::string head = "DIR/zju/a.yaml:7:";
    EXPECT_EQ(error("order: [e=p, e=q], of: [aa, bb], at: {scene: s}}"), "no error");
    EXPECT_EQ(error("across: e, order: p / q < q, of: aa, at: {scene: s}}"), "no error");
    EXPECT_EQ(error("across: e, trend: p / q, over: scene, at_least: 1, at_most: 2}"), "no error");
    EXPECT_EQ(error("across: f, order: p / q < q}"),
              head + "24: claim 'C': across is f; allowed: e | scene");
    EXPECT_EQ(error("across: e, order: aa < bb}"),
              head + "34: claim 'C': 'aa' is no column (columns: p, q)");
    EXPECT_EQ(error("order: [e=p, e=q], at: {e: p}}"),
              head + "40: claim 'C': at: unknown key 'e'; allowed: scene");
    const std::string columns =
        "claim 'C': at: 'column' is no axis of the rows; columns are chosen by 'of'";
    EXPECT_EQ(error("order: [e=p, e=q], at: {column: aa}}"), head + "40: " + columns);
    const std::string named = "allowed: AXIS=VALUE, or words that one swept axis alone has";
    EXPECT_EQ(error("order: [p, q]}"), head + "24: claim 'C': order is p; " + named);
    EXPECT_EQ(error("order: [t, s, 1]}"), head + "30: claim 'C': order is 1; " + named);
    EXPECT_EQ(error("order: [s, s]}"), head + "24: claim 'C': order is s; " + named);
    EXPECT_EQ(error("order: [t, s], of: aa, at: {e: p}}"), "no error");
    EXPECT_EQ(error("order: [t, s], of: [aa, bb]}"), "no error");
    EXPECT_EQ(error("order: [t, s], of: p}"), head + "35: claim 'C': of is p; allowed: aa | bb");
    EXPECT_EQ(error("order: aa < bb, of: aa}"),
              head +
                  "32: claim 'C': 'of' is of a claim that compares rows; allowed: with "
                  "[AXIS=VALUE, …] or across: e | scene");
    EXPECT_EQ(error("ratio: p / oops, of: aa, at_most: 1}"),
              head +
                  "33: claim 'C': 'of' is of a claim that compares rows; allowed: with AXIS=VALUE "
                  "/ AXIS=VALUE (e=p) or across: e | scene");
    EXPECT_EQ(
        error("bound: aa, of: aa, at_most: 1}"),
        head + "27: claim 'C': 'of' is of a claim that compares rows; allowed: across: e | scene");
    EXPECT_EQ(error("order: [e=p, scene=s]}"),
              head + "29: claim 'C': order: 'e' and 'scene' are two axes; allowed: values of one");
    EXPECT_EQ(error("order: [e=p, e=rrr]}"),
              head + "29: claim 'C': 'rrr' is no column (columns: p, q)");
    EXPECT_EQ(
        error("order: [e=p]}"),
        head + "23: claim 'C': order is [e=p]; allowed: a < b < … | [AXIS=VALUE, AXIS=VALUE, …]");
    EXPECT_EQ(error("order: [e=p, e=q], across: e}"),
              head + "43: claim 'C': across, and order names its axis");
    EXPECT_EQ(error("across: e, order: p < q}"),
              head + "34: claim 'C': order is p < q; allowed: [e=p, e=q]");
    EXPECT_EQ(error("order: p < q}"), head + "23: claim 'C': order is p < q; allowed: [e=p, e=q]");
    // What is missing is said.
    const std::string hint = " is no column (columns: aa, bb); ";
    EXPECT_EQ(error("order: p / 2 < q}"), head + "23: claim 'C': 'p'" + hint +
                                              "'p' is a value of row axis 'e': add 'across: e'");
    EXPECT_EQ(
        error("ratio: \"max(p, q) / aa\", at_most: 1}"),
        head + "23: claim 'C': 'p'" + hint + "'p' is a value of row axis 'e': add 'across: e'");
    EXPECT_EQ(error("order: aa < bb, at: {column: aa}}"), head + "37: " + columns);
}

TEST_F(ExperimentTest, ValuesThatOneAxisAloneHasSayWhichItIs) {
    const std::string text =
        "sweep_of: s\ntitle: t\ntechnique: x\n"
        "sweep: {method: [plain, fast, both], filter: [plain, both], size: [1, 2]}\nclaims:\n"
        "  C: {says: s, order: [fast, plain], of: wall}\n"
        "profiles: {quick: {sweep: {method: [both]}}}\n";
    for (const char* profile : {"full", "quick"}) {  // without the two the claim stays what it is
        const ClaimSpec claim = load(text, {profile, {}, {}}).claims.at(0);
        EXPECT_EQ(claim.across, "method") << profile;
        EXPECT_THAT(claim.operands, ElementsAre("fast", "plain"));
        ASSERT_EQ(claim.at.size(), 1U);
        EXPECT_EQ(claim.at[0].first, "column");
        EXPECT_EQ(claim.at[0].second.at(0).text(), "wall");
    }
    std::string several = text;
    several.replace(several.find("[fast, plain], of"), 13, "[both, plain]");
    EXPECT_EQ(loadError(several),
              "DIR/zju/a.yaml:6:24: claim 'C': order is both; allowed: AXIS=VALUE, or words that "
              "one swept axis alone has");
}

TEST_F(ExperimentTest, OneRowHasNoTrend) {
    const auto error = [&](const std::string& claim, const std::string& sweep = "n: [1]") {
        return errorWith(
            "sweep: {" + sweep +
            "}\nlayout: {rows: [n], columns: {aa: m, bb: m}}\nclaims:\n  C: {says: s, " + claim +
            "}\n");
    };
    const std::string head = "DIR/zju/a.yaml:7:";
    EXPECT_EQ(error("trend: aa, over: n, direction: increasing"),
              head + "33: claim 'C': there is one row along 'n'; allowed: two or more");
    EXPECT_EQ(error("trend: aa, over: bb, direction: increasing"),
              head + "33: claim 'C': there is one row along 'bb'; allowed: two or more");
    EXPECT_EQ(error("independent: aa, of: n, at_most: 5%"),
              head + "37: claim 'C': there is one row along 'n'; allowed: two or more");
    EXPECT_EQ(error("crossover: [aa, bb], over: n, at_most: 5, at: {n: 2}", "n: [1, 2]"),
              head + "43: claim 'C': there is one row along 'n'; allowed: two or more");
    EXPECT_EQ(error("trend: aa, over: n, direction: increasing", "n: [1, 2]"), "no error");
}

TEST_F(ExperimentTest, KeysOfASectionSayWhereTheyBelong) {
    const std::string head = "sweep_of: own\ntitle: t\ntechnique: x\n";
    EXPECT_EQ(
        loadError(head + "scene: a.ply\nup: z\n"),
        "DIR/zju/a.yaml:5:1: config: 'up' is of 'scene_params'; allowed: scene_params: {up: z}");
    EXPECT_EQ(loadError(head + "processes: 9\n"),
              "DIR/zju/a.yaml:4:1: config: 'processes' is of 'measure'; allowed: measure: "
              "{processes: …}");
    EXPECT_EQ(loadError(head + "width: 9\n"),
              "DIR/zju/a.yaml:4:1: config: 'width' is of 'output'; allowed: output: {width: …}");
}

TEST_F(ExperimentTest, RatiosOfValuesOfAnAxis) {
    EXPECT_EQ(claimError("{says: s, ratio: scene=s / scene=t, at_least: 1}\n"), "no error");
    EXPECT_THAT(claimError("{says: s, ratio: scene=s / scene=u, at_least: 1}\n"),
                HasSubstr("'u' is no column; did you mean 's'? (columns: s, t)"));
}

}  // namespace
}  // namespace gfxrepro::config
