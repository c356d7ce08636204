// Numbers that leave and come in: export --tidy, import, history.
#include <fmt/format.h>

#include "engine/core/files.h"
#include "runner/records/csv.h"
#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

// A claim that holds, one that fails, a time, a case that fails, and a column a method.
constexpr const char* kLines =
    "scene: shapes/torus\n"
    "sweep: {number: [1, 2, 4], behaviour: [ok, throw]}\n"
    "measure: {lane: timing, processes: 6}\n"
    "layout: {rows: number, columns: {out: {metric: number, where: {behaviour: ok}}, ms: {metric: "
    "wall_time_ms, where: {behaviour: ok}}, bad: {metric: number, where: {behaviour: throw}}}}\n"
    "claims:\n"
    "  grows: {says: it grows, trend: out, over: number, direction: increasing}\n"
    "  small: {says: it is small, bound: out, at_most: 3, bound_from: ours}\n"
    "  bad: {says: what failed, bound: bad, at_most: 3, bound_from: ours}\n"
    "plots: [{x: number, y: out}]\n";

struct Data : FolderTest {
    ProcessResult run(const std::string& lines) {
        config_ = writeMockConfig(folder, lines);
        return mockGfxrepro({"reproduce", config_, "--out", dir("run")});
    }
    std::string dir(const std::string& name) const { return folder.path() / name; }
    std::string refusal(const std::vector<std::string>& arguments) const {
        return refusalOf(mockGfxrepro(arguments), folder);
    }
    /// A config of numbers that are measured elsewhere.
    std::string configOf(const std::string& lines, const std::string& name = "t") const {
        return folder.write(name + ".yaml", "sweep_of: t\ntitle: T\ntechnique: imported\n" + lines);
    }
    ProcessResult imports(const std::string& csv, const std::string& config) const {
        fs::remove_all(dir("t"));
        return mockGfxrepro({"import", csv, "--config", config, "--out", dir("t")});
    }
    /// "grows holds", … of a run's claims.csv.
    std::vector<std::string> verdicts(const std::string& name) const {
        const std::string text = readFile(dir(name) + "/claims.csv");
        records::CsvReader reader(text, "claims.csv");
        std::vector<std::string> fields, lines;
        while (reader.next(fields)) lines.push_back(fields[0] + " " + fields[8]);
        return lines;
    }

    std::string config_;
};

TEST_F(Data, OfManyParametersEachIsAColumn) {
    std::string config =
        "sweep_of: wide\ntitle: T\ntechnique: external\nmeasure: {lane: quality}\n"
        "program:\n  command: \"true";
    for (int i = 0; i < 2100; ++i) config.append(" {p").append(std::to_string(i)).append("}");
    config += "\"\n  params:\n";
    for (int i = 0; i < 2100; ++i) {
        config.append("    p").append(std::to_string(i)).append(": ").append(std::to_string(i));
        config += '\n';
    }
    ASSERT_EQ(
        mockGfxrepro({"run", folder.write("wide.yaml", config), "--out", dir("run")}).exitCode, 0);
    endedWith(0, mockGfxrepro({"export", dir("run"), "--tidy"}));
    EXPECT_THAT(readFile(dir("run-tidy/cases.csv")), HasSubstr(",p2098,p2099,output.width"));
}

TEST_F(Data, AnImportedRunSaysSoEverywhere) {
    const std::string csv = folder.write("theirs.csv", "samples,mse\n4,0.5\n16,0.125\n64,0.03\n");
    const ProcessResult imported = mockGfxrepro(
        {"import", csv, "--metric", "mse=1", "--machine", "RTX 4090", "--out", dir("theirs")});
    for (const std::string machine : {"RTX\n4090", "RTX\x1b", "RTX \xFF"}) {
        const ProcessResult refused =
            endedWith(2, mockGfxrepro({"import", csv, "--metric", "mse=1", "--machine", machine,
                                       "--out", dir("refused")}));
        EXPECT_EQ(
            refused.err,
            "gfxrepro: the machine's name (--machine): allowed: text of one line, in UTF-8\n");
        EXPECT_FALSE(fs::exists(dir("refused")));
    }
    EXPECT_EQ(imported.exitCode, 0) << imported.err;
    EXPECT_THAT(imported.out,
                HasSubstr("imported 3 numbers of 3 cases into " + dir("theirs") + "\n"));
    const std::string mark =
        "imported: these numbers were measured elsewhere, on RTX 4090, and not by this program; "
        "they are those of theirs.csv (SHA-256 ";
    EXPECT_THAT(imported.out, HasSubstr("warning: " + mark));
    EXPECT_EQ(readFile(dir("theirs") + "/tables/sweep-theirs.csv").substr(0, 8), "samples,");
    EXPECT_THAT(readFile(dir("theirs") + "/tables/sweep-theirs.md"), HasSubstr(mark));
    EXPECT_THAT(readFile(dir("theirs") + "/tables/sweep-theirs.tex"),
                HasSubstr("Note: imported: these numbers were measured elsewhere, on RTX 4090, "));
    const std::string page = readFile(dir("theirs") + "/report.html");
    EXPECT_THAT(page, HasSubstr(mark));
    EXPECT_THAT(page, HasSubstr("gfxrepro import "));
    EXPECT_THAT(page, Not(HasSubstr("gfxrepro run ")));
    EXPECT_THAT(page, Not(HasSubstr("gfxrepro reproduce ")));
    EXPECT_THAT(
        page,
        HasSubstr(
            "<span class=\"badge ambiguous\">imported</span> measured elsewhere, on RTX 4090, "));
    const auto manifest = nlohmann::json::parse(readFile(dir("theirs") + "/manifest.json"));
    EXPECT_EQ(manifest["imported"]["file"], "theirs.csv");
    EXPECT_EQ(manifest["imported"]["rows"], 3);
    EXPECT_TRUE(manifest["sha256"].contains("records.csv"));
    EXPECT_EQ(mockGfxrepro({"table", dir("theirs")}).exitCode, 0);
    EXPECT_THAT(
        mockGfxrepro({"compare", dir("theirs"), dir("theirs"), "--out", dir("compared")}).out,
        HasSubstr(dir("theirs") + ": " + mark));
    // Nor can anyone here measure it by turns.
    const std::string times = folder.write("times.csv", "samples,render_ms\n4,10\n16,20\n");
    endedWith(0,
              mockGfxrepro({"import", times, "--metric", "render_ms=ms", "--out", dir("times")}));
    EXPECT_THAT(mockGfxrepro({"compare", dir("times"), dir("times"), "--out", dir("times-2")}).out,
                AllOf(HasSubstr("\n2 cannot tell; "), Not(HasSubstr("by turns"))));
}

TEST_F(Data, ClaimsOfAConfigAreJudgedOnImportedNumbers) {
    const std::string config =
        folder.write("theirs.yaml",
                     "sweep_of: theirs\ntitle: Another renderer\ntechnique: imported\n"
                     "sweep: {samples: [4, 16, 64]}\n"
                     "layout: {rows: samples, columns: {mse: {metric: mse}}}\n"
                     "claims:\n  slope: {says: error falls as 1 / samples, trend: mse, over: "
                     "samples, at_least: -1.1, at_most: -0.9, bound_from: text}\n"
                     "plots: [{x: samples, y: mse, log: [x, y]}]\n");
    EXPECT_EQ(mockGfxrepro({"check", config}).out,
              config + ": ok, sweep/theirs, 0 cases, 1 claim\n");
    EXPECT_THAT(
        refusal({"run", config, "--device", "software", "--out", dir("none")}),
        EndsWith("gfxrepro: DIR/theirs.yaml:3:12: technique 'imported': its numbers are measured "
                 "elsewhere; `gfxrepro import FILE.csv --config theirs.yaml` takes them\n"));
    const std::string csv =
        folder.write("theirs.csv", "samples,metric,value\n4,mse,0.5\n16,mse,0.125\n64,mse,0.03\n");
    endedWith(0, mockGfxrepro({"import", csv, "--config", config, "--out", dir("theirs")}));
    EXPECT_THAT(verdicts("theirs"), Contains("slope holds"));
    const std::string flat =
        folder.write("flat.csv", "samples,metric,value\n4,mse,0.5\n16,mse,0.5\n64,mse,0.5\n");
    EXPECT_EQ(mockGfxrepro({"import", flat, "--config", config, "--out", dir("flat")}).exitCode, 1);
    EXPECT_THAT(verdicts("flat"), Contains("slope fails"));
}

/// Errors of two samplers that are alike, over seeds: one of them is nearer by chance.
TEST_F(Data, SeedsOfImportedNumbersAreRounds) {
    const std::string config = configOf(
        "sweep: {method: [a, b]}\n"
        "layout: {rows: method, columns: {e: {metric: rmse}}}\n"
        "claims: {nearer: {says: a is nearer to its truth, order: [a, b], of: e}}\n");
    const auto verdictOf = [&](const std::string& column, int count, double apart) {
        std::string text = "method,metric,value," + column + "\n";
        for (int i = 0; i < count; ++i) {
            text += fmt::format("a,rmse,{},{}\nb,rmse,{},{}\n", 1.0 + 0.1 * (i % 3), 10 * i,
                                apart + 0.1 * ((i + 1) % 4), 10 * i);
        }
        imports(folder.write("t.csv", text), config);
        return verdicts("t");
    };
    for (const char* column : {"seed", "repeat"}) {
        EXPECT_THAT(verdictOf(column, 8, 1.0), Contains("nearer ambiguous")) << column;
    }
    EXPECT_THAT(verdictOf("seed", 8, 1.5), Contains("nearer holds"));
    EXPECT_THAT(verdictOf("seed", 8, 0.5), Contains("nearer fails"));
    EXPECT_THAT(verdictOf("seed", 5, 1.5), Contains("nearer ambiguous"));
    EXPECT_THAT(verdictOf("repeat", 8, 1.5), Contains("nearer ambiguous"));
}

TEST_F(Data, ASweptSeedIsAParameter) {
    const std::string csv = folder.write("t.csv", "seed,metric,value\n1,rmse,2\n2,rmse,3\n");
    endedWith(0, imports(csv, configOf("sweep: {seed: [1, 2]}\n"
                                       "layout: {rows: seed, columns: {e: {metric: rmse}}}\n")));
    EXPECT_THAT(readFile(dir("t") + "/tables/sweep-t.csv"), HasSubstr("\n2,"));
}

TEST_F(Data, WhatCheckRefusesIsNotImported) {
    const std::string csv = folder.write("t.csv", "samples,metric,value\n4,mse,0.5\n16,mse,0.1\n");
    const auto refusals = [&](const std::string& lines) {
        const std::string config = configOf(
            "sweep: {samples: [4, 16]}\n"
            "layout: {rows: samples, columns: {mse: {metric: mse}}}\n" +
            lines);
        const ProcessResult checked = mockGfxrepro({"check", config});
        EXPECT_THAT(endedWith(checked.exitCode, imports(csv, config)).err, StartsWith(checked.err));
        return checked.err;
    };
    EXPECT_EQ(refusals("printed: {values: \"samples,mse\\n4,0.5\"}\n"), "");
    EXPECT_THAT(
        refusals("printed: {values: \"samples,mse\\n8,0.5\"}\n"),
        EndsWith(":6:19: printed: no profile measures the row '8,0.5'; allowed: samples 4 | 16\n"));
    EXPECT_THAT(refusals("claims: {C: {says: so, bound: mse, at_most: 1, kind: absolute}}\n"),
                EndsWith(": claim 'C' has a 'kind' and reads no time\n"));
}

/// Whatever asks for it: nothing of it is measured, which is no missing measurement.
TEST_F(Data, WhatNoNumberIsCalledIsAnError) {
    const std::string csv = folder.write("t.csv",
                                         "m,metric,value,unit,pass\na,err,1,1,p\nb,err,2,1,p\n"
                                         "a,t_ms,1,ms,p\nb,t_ms,2,ms,p\na,n,3,1,\nb,n,4,1,\n");
    const auto errorsOf = [&](const std::string& lines) {
        const std::string imported =
            endedWith(2, imports(csv, configOf("sweep: {m: [a, b]}\n" + lines))).err;
        for (const char* command : {"table", "claims", "report"}) {
            EXPECT_EQ(endedWith(2, mockGfxrepro({command, dir("t")})).err, imported) << command;
        }
        const std::string page = folder.path() / "page.html";
        EXPECT_EQ(endedWith(2, mockGfxrepro({"report", dir("t"), "--embed", "--out", page})).err,
                  imported);
        return imported;
    };
    const std::string recorded = " was recorded; did you mean 'err'? (recorded: err, n, t_ms)\n";
    EXPECT_EQ(errorsOf("layout: {rows: m, columns: {e: {metric: errr}, n: {metric: n}}}\n"),
              "error: sweep/t: column 'e': no 'errr'" + recorded);
    EXPECT_EQ(
        errorsOf(
            "layout: {rows: {x: {metric: n}, y: {metric: errr}}, columns: {a: {where: {m: a}}}}\n"),
        "error: sweep/t: row 'y': no 'errr'" + recorded);
    for (const char* metric : {"err", "t_ms"}) {
        EXPECT_EQ(
            errorsOf(fmt::format(
                "layout: {{rows: m, columns: {{e: {{metric: {}, pass: q}}, n: {{metric: n}}}}}}\n",
                metric)),
            fmt::format("error: sweep/t: column 'e': no '{}' of pass 'q' was recorded; it is there "
                        "for pass: p\n",
                        metric));
    }
    EXPECT_THAT(errorsOf("claims: {c: {says: so, bound: errr, at_most: 1}}\n"),
                StartsWith("error: sweep/t: claim 'c': 'errr' is no column"));
}

TEST_F(Data, ValuesOfAnAxisAreComparedWithoutALayout) {
    const std::string csv = folder.write("t.csv", "m,metric,value\na,err,1\nb,err,2\n");
    const std::string claim = "claims: {c: {says: so, order: [m=a, m=b], of: err}}\n";
    const std::string config = configOf("sweep: {m: [a, b]}\n" + claim);
    endedWith(0, mockGfxrepro({"check", config}));
    endedWith(0, imports(csv, config));
    EXPECT_THAT(verdicts("t"), Contains("c holds"));
    EXPECT_THAT(
        refusal({"check", configOf(claim)}),
        HasSubstr("axis of order is m; allowed: an axis of 'sweep', or of 'layout: {rows}'"));
}

/// A layout chooses of the frames that the file has.
TEST_F(Data, AnImportHasTheFramesOfItsFile) {
    const std::string csv =
        folder.write("t.csv", "m,frame,metric,value\na,0,e,1\nb,0,e,2\na,1,e,9\nb,1,e,2\n");
    const auto ofFrame = [&](const std::string& frame) {
        return configOf(
            "sweep: {m: [a, b]}\nlayout: {rows: m, columns: {e: {metric: e, where: "
            "{frame: " +
            frame + "}}}}\nclaims: {C: {says: so, order: [m=a, m=b], of: e}}\n");
    };
    for (const auto& [frame, verdict] : {std::pair("0", "C holds"), {"1", "C fails"}}) {
        const std::string config = ofFrame(frame);
        endedWith(0, mockGfxrepro({"check", config}));
        imports(csv, config);
        EXPECT_THAT(verdicts("t"), Contains(verdict)) << frame;
    }
    EXPECT_EQ(refusal({"import", csv, "--config", ofFrame("2"), "--out", dir("u")}),
              "gfxrepro: DIR/t.yaml:5:59: layout: where.frame is 2; allowed: 0 | 1\n");
}

/// A claim could mean either.
TEST_F(Data, AnImportedMetricHasANameOfItsOwn) {
    const std::string config =
        configOf("sweep: {m: [a]}\nlayout: {rows: m, columns: {e: {metric: err}}}\n");
    for (const char* metric : {"m", "seed", "scene", "frame"}) {
        const std::string csv =
            folder.write("t.csv", fmt::format("m,metric,value\na,err,1\na,{},2\n", metric));
        EXPECT_EQ(
            refusal({"import", csv, "--config", config, "--out", dir("t")}),
            fmt::format(
                "gfxrepro: DIR/t.csv:3: metric '{}' has the name of an axis; allowed: another\n",
                metric));
        endedWith(0, mockGfxrepro({"import", csv, "--out", dir(metric)}));
    }
}

/// As of a program of which one process a side was measured.
TEST_F(Data, OneValueASideOfAnImportCannotTell) {
    for (const char* value : {"1", "2"}) {
        const std::string csv =
            folder.write("t.csv", fmt::format("m,metric,value\na,e,{}\n", value));
        endedWith(0, mockGfxrepro({"import", csv, "--out", dir(value)}));
    }
    EXPECT_THAT(
        endedWith(0, mockGfxrepro({"compare", dir("1"), dir("2"), "--out", dir("compared")})).out,
        HasSubstr("\n1 cannot tell; "));
}

/// A count that has no seed beside errors that have, and a baseline that has none in the sweep.
TEST_F(Data, WhatHasNoSeedDrawsNone) {
    const auto verdictOf = [&](const std::string& csv, const std::string& sweep,
                               const std::string& column, const std::string& claim) {
        const std::string config =
            configOf("sweep: {m: [a, b]" + sweep + "}\nlayout: {rows: m, columns: {c: {" + column +
                     "}}}\nclaims: {C: {says: so, " + claim + "}}\n");
        endedWith(0, imports(folder.write("t.csv", csv), config));
        return verdicts("t").back();
    };
    std::string text = "m,seed,metric,value\na,,n,4\nb,,n,5\n";
    std::string swept = "m,seed,metric,value\na,,e,0.4\n", seeds = "[";
    for (int seed = 1; seed <= 6; ++seed) {
        const std::string of = fmt::format("b,{},e,{}\n", seed, 0.5 + 0.01 * seed);
        text += fmt::format("{}a,{},e,0.4\n", of, seed);
        swept += of;
        seeds += fmt::format("{}{}", seed == 1 ? "" : ", ", seed);
    }
    seeds += "]";
    EXPECT_EQ(verdictOf(text, "", "metric: n", "order: [a, b], of: c"), "C holds");
    EXPECT_EQ(verdictOf(text, "", "metric: n", "exact: c, equals: 4, at: {m: a}"), "C holds");
    EXPECT_EQ(verdictOf(swept, ", seed: " + seeds + ", when: {seed: {m: b}}",
                        "metric: e, where: {seed: " + seeds + "}", "order: [a, b], of: c"),
              "C holds");
    const std::string without =
        configOf("sweep: {m: [a, b], seed: " + seeds +
                     "}\nlayout: {rows: [m, seed], columns: {c: {metric: e}}}\n",
                 "u");
    EXPECT_THAT(
        refusal({"import", folder.write("u.csv", swept), "--config", without, "--out", dir("u")}),
        EndsWith(", or 'when: {seed: …}' in the sweep leaves it without\n"));
    const auto refused = [&](const std::string& row) {
        return refusal({"import", folder.write("u.csv", swept + row), "--config",
                        (folder.path() / "t.yaml").string(), "--out", dir("u")});
    };
    EXPECT_EQ(refused("b,,e,0.1\n"),
              "gfxrepro: DIR/u.csv:9: column 'seed': is empty, and 'e' has one in line 3; allowed: "
              "nothing only where 'when' of the sweep leaves a case without one\n");
    EXPECT_EQ(refused("a,3,e,0.1\n"),
              "gfxrepro: DIR/u.csv:9: column 'seed': '3'; allowed: nothing, as 'when' of the sweep "
              "leaves this case without one\n");
}

/// A column of the file that the config does not name: nothing says whether its rows are other
/// cases or the same again.
TEST_F(Data, WhatDiffersBesideTheConfigIsRefused) {
    const std::string others =
        folder.write("t.csv",
                     "method,trial,host,metric,value\na,0,,e,1\na,1,,e,5\nb,0,,e,2\nb,1,,e,7\n"
                     "a,,x,n,3\nb,,x,n,4\n");
    const std::string trials =
        folder.write("u.csv", "method,trial,metric,value\na,0,e,1\na,1,e,5\nb,0,e,2\nb,1,e,7\n");
    const auto swept = [&](const std::string& lines, const std::string& csv) {
        return imports(csv, configOf("sweep: {method: [a, b]" + lines));
    };
    const std::string how =
        "; what repeats a case has its number in the column 'process', or in 'seed' where each has "
        "random numbers of its own\n";
    EXPECT_THAT(
        endedWith(2, swept("}\nlayout: {rows: method, columns: {e: {metric: e}}}\n", trials)).err,
        EndsWith("t.yaml:5:1: layout: each number would be taken over trial (0, 1), which is a "
                 "column of the file; allowed: in 'sweep', and as an axis of rows or columns, or "
                 "in a 'where': {trial: [0, 1]} takes its values together" +
                 how));
    EXPECT_FALSE(fs::exists(dir("t")));
    EXPECT_THAT(
        endedWith(2, swept("}\nclaims: {c: {says: so, order: [a, b], of: e}}\n", trials)).err,
        EndsWith("t.yaml:5:1: claims: rows that are alike in 'sweep' differ by 'trial' (0, 1), a "
                 "column of the file; allowed: in 'sweep', as a parameter" +
                 how));
    endedWith(0, swept("}\nlayout: {rows: method, columns: {n: {metric: n}}}\n", others));
    endedWith(0, swept("}\nclaims: {}\n", trials));
    endedWith(0, swept(", trial: [0, 1]}\nlayout: {rows: method, columns: {e: {metric: e, where: "
                       "{trial: [0, 1]}}}}\n"
                       "claims: {c: {says: so, order: [a, b], of: e}}\n",
                       trials));
    EXPECT_THAT(readFile(dir("t") + "/tables/sweep-t.md"),
                HasSubstr("Each number is taken over trial (0, 1)."));
    EXPECT_THAT(verdicts("t"), Contains("c ambiguous"));
}

/// Of a config whose technique is here, too.
TEST_F(Data, APointOfASweepIsImportedOnce) {
    const std::string config = writeMockConfig(
        folder, "layout: {rows: number, columns: {n: {metric: number}}}\nsweep: {number: [1]}\n");
    const std::string csv =
        folder.write("t.csv", "number,trial,metric,value\n1,0,number,5\n1,1,number,6\n");
    EXPECT_EQ(refusal({"import", csv, "--config", config, "--out", dir("t")}),
              "gfxrepro: DIR/t.csv:3: differs from line 2 by 'trial', which the sweep of "
              "sweep/mock does not have; allowed: one case at each point of it; what repeats a "
              "case has its number in the column 'process'\n");
}

/// The same of a value that no case has.
TEST_F(Data, AWrongValueOfAnImportsWhereIsRefused) {
    const std::string csv = folder.write("t.csv", "m,metric,value\na,e,1\nb,e,2\n");
    const auto refused = [&](const std::string& where) {
        const std::string config = configOf(
            "sweep: {m: [a, c]}\nlayout: {rows: m, columns: {e: {metric: e, where: " + where +
            "}}}\n");
        return refusal({"import", csv, "--config", config, "--out", dir("t")});
    };
    EXPECT_EQ(refused("{m: d}"),
              "gfxrepro: DIR/t.yaml:5:55: layout: where.m is d; allowed: a | c | b\n");
    EXPECT_THAT(refused("{m: [a, d]}"), HasSubstr(": layout: where.m is d; allowed: a | c | b\n"));
}

/// Which a claim reads by its label, as a report shows it.
TEST_F(Data, AColumnMayHaveAnyName) {
    for (const char* metric : {"Δ", "error (mean)", "err/px", "log2"}) {
        const std::string csv =
            folder.write("t.csv", fmt::format("m,metric,value\na,{0},1\nb,{0},2\n", metric));
        const auto bounded = [&](const std::string& bound) {
            return imports(csv, configOf("sweep: {m: [a, b]}\nclaims: {c: {says: so, bound: \"" +
                                         bound + "\", at_most: 3}}\n"));
        };
        for (const std::string& bound :
             {std::string(metric), fmt::format("log2 ('{}') + 1", metric)}) {
            endedWith(0, bounded(bound));
            EXPECT_THAT(verdicts("t"), Contains("c holds")) << bound;
        }
        EXPECT_THAT(endedWith(2, bounded(fmt::format("'{}' +", metric))).err,
                    HasSubstr("t.yaml:5:10: claim 'c': ''" + std::string(metric) +
                              "' +' is no expression: "));
    }
}

TEST_F(Data, WhatIsMissingOfAnImportMakesItIncomplete) {
    const std::string csv = folder.write(
        "a.csv", "n,metric,value,process,status\n1,mse,5,0,\n1,mse,6,2,\n2,,,0,crash\n");
    EXPECT_THAT(endedWith(4, mockGfxrepro({"import", csv, "--out", dir("a")})).out,
                HasSubstr("incomplete: 1 not measured, 1 failed\n"));
}

TEST_F(Data, NothingIsMeasuredIntoAnImportedRun) {
    const std::string csv = folder.write("a.csv", "n,metric,value\n1,mse,5\n2,mse,6\n");
    ASSERT_EQ(mockGfxrepro({"import", csv, "--out", dir("a")}).exitCode, 0);
    EXPECT_EQ(refusal({"run", "--resume", dir("a"), "--device", "software"}),
              "gfxrepro: DIR/a: was imported; there is nothing to go on with\n");
    EXPECT_EQ(refusal({"export", dir("a"), "--out", dir("b")}),
              "gfxrepro: DIR/a: was imported; there is nothing to measure again; `export --tidy` "
              "gives its numbers\n");
    EXPECT_THAT(refusal({"import", csv, "--out", dir("a")}), HasSubstr("DIR/a"));
}

TEST_F(Data, BadImportsAreOneErrorEach) {
    const std::string csv = folder.write("a.csv", "n,metric,value\n1,mse,fast\n");
    EXPECT_EQ(refusal({"import", csv, "--out", dir("a")}),
              "gfxrepro: DIR/a.csv:2: column 'value': 'fast'; allowed: a number, inf, or nothing "
              "in a row whose status is not ok\n");
    EXPECT_FALSE(fs::exists(dir("a")));
    folder.write("b.csv", "n,metric,value\n1,mse,+1e-400\n2,mse,1e400\n");
    EXPECT_EQ(refusal({"import", dir("b.csv"), "--out", dir("a")}),
              "gfxrepro: DIR/b.csv:3: column 'value': '1e400'; allowed: a number, inf, or nothing "
              "in a row whose status is not ok\n");
    EXPECT_EQ(refusal({"import", csv, "--metric", "value", "--out", dir("a")}),
              "gfxrepro: --metric 'value'; allowed: COLUMN=UNIT, such as render_time_ms=ms; 1 is "
              "the unit of what has none\n");
    const std::string config = writeMockConfig(
        folder, "layout: {rows: number, columns: {n: {metric: number}}}\nsweep: {number: [1]}\n");
    const std::string other =
        folder.write("b.csv", "experiment,number,metric,value\nsweep/mine,1,number,5\n");
    EXPECT_EQ(refusal({"import", other, "--config", config, "--out", dir("a")}),
              "gfxrepro: DIR/b.csv:2: column 'experiment': 'sweep/mine'; allowed, as of the "
              "configs given: sweep/mock\n");
    const std::string twice = folder.write("c.csv", "n,metric,value\n1,mse,5\n1.0,mse,6\n");
    EXPECT_EQ(refusal({"import", twice, "--out", dir("a")}),
              "gfxrepro: DIR/c.csv:3: the same case as in line 2: sweep/c\n");
    const std::string time = folder.write("e.csv", "n,time\n1,5\n");
    EXPECT_EQ(refusal({"import", time, "--metric", "time=s", "--out", dir("a")}),
              "gfxrepro: DIR/e.csv:2: 'time' has the unit 's'; a time has a name that ends in _ms "
              "and the unit ms, by which claims know it, and nothing else has\n");
    const std::string output = folder.write("f.csv", "output,metric,value\na,mse,5\nb,mse,6\n");
    EXPECT_EQ(
        refusal({"import", output, "--out", dir("a")}),
        "gfxrepro: DIR/f.csv:2: column 'output'; allowed of that: output.width, output.height\n");
    const std::string size = folder.write("d.csv", "output.width,metric,value\nwide,mse,5\n");
    EXPECT_EQ(refusal({"import", size, "--out", dir("a")}),
              "gfxrepro: DIR/d.csv:2: column 'output.width' is wide; allowed: a whole number, 1 … "
              "16384\n");
}

TEST_F(Data, ARunHasItsCasesAsATable) {
    ASSERT_EQ(run(kLines).exitCode, 4);
    endedWith(0, mockGfxrepro({"export", dir("run"), "--tidy", "--out", dir("t")}));
    EXPECT_THAT(readFile(dir("run") + "/cases.csv"), StartsWith("case_id,experiment,technique,"));
    EXPECT_EQ(readFile(dir("run") + "/cases.csv"), readFile(dir("t") + "/cases.csv"));
}

TEST_F(Data, ColumnsThatDifferByCaseAloneAreExported) {
    const std::string csv =
        folder.write("a.csv", "scene,Scene,N,n,metric,value\ns,1,2,3,mse,5\ns,2,2,4,mse,6\n");
    ASSERT_EQ(mockGfxrepro({"import", csv, "--out", dir("a")}).exitCode, 0);
    endedWith(0, mockGfxrepro({"export", dir("a"), "--tidy", "--out", dir("t")}));
    EXPECT_THAT(readFile(dir("t") + "/cases.csv"), HasSubstr(",n,output.width,"));
}

TEST_F(Data, ExportGoesOverNothing) {
    ASSERT_EQ(run("").exitCode, 0);
    folder.write("there/a.txt", "mine");
    EXPECT_EQ(refusal({"export", dir("run"), "--tidy", "--out", dir("there")}),
              "gfxrepro: DIR/there: is there already; give another folder\n");
}

TEST_F(Data, AHistoryBecomesAPage) {
    std::string csv =
        "time,commit,machine,table,technique,method,scene,params,pass,metric,unit,value\n";
    for (int night = 10; night < 40; ++night) {
        csv += "2026-01-" + std::to_string(night) + "T00:00:00Z,c" + std::to_string(night) +
               ",m,t,k,,,{},,wall_time_ms,ms," + (night < 25 ? "1" : "2") + "." +
               std::to_string(night) + "\n";
    }
    const std::string file = folder.write("history.csv", csv);
    EXPECT_EQ(endedWith(0, mockGfxrepro({"history", file, "--out", dir("history.html")})).out,
              "m: 30 nights, 1 series, 1 changes\nhistory: " + dir("history.html") + "\n");
    EXPECT_THAT(readFile(dir("history.html")), HasSubstr("<td>c24</td><td>c25</td>"));
    const std::string text = folder.write("thesis.html", "four years");
    EXPECT_EQ(refusal({"history", file, "--out", text}),
              "gfxrepro: DIR/thesis.html: is there and is not a report; give another file\n");
    EXPECT_EQ(refusal({"history", dir("none.csv")}),
              "gfxrepro: cannot read DIR/none.csv: No such file or directory\n");
    const std::string header = folder.write("empty.csv", csv.substr(0, csv.find('\n') + 1));
    EXPECT_EQ(refusal({"history", header}), "gfxrepro: DIR/empty.csv: has no night\n");
}

}  // namespace
}  // namespace gfxrepro::test
