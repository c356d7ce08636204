// A case that fails becomes a row; its neighbours go on.

#include <nlohmann/json.hpp>

#include "engine/core/files.h"
#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

using Faults = test::RunTest;

TEST_F(Faults, EveryFailureBecomesARow) {
    const std::string config = writeMockConfig(
        folder,
        "sweep:\n  behaviour: [ok, crash, exit, hang, throw, bad_alloc, unsupported, device_lost, "
        "not_a_number]\nmeasure: {lane: quality, time_limit_s: 2}\n");
    EXPECT_EQ(endedWith(4, mockGfxrepro({"run", config, "--jobs", "1", "--out", dir})).out,
              "1 of 9 finished, 8 failed; records: " + dir + "/records.csv\n");
    EXPECT_THAT(
        statusLines(dir),
        ElementsAre(
            "ok: ok", "crash: crash (SIGSEGV: about to crash)",
            "exit: crash (the worker ended with exit code 7: leaving)",
            "hang: timeout (not finished after 2 s (in render))", "throw: error (nothing works)",
            "bad_alloc: oom (out of memory)", "unsupported: unsupported (no such extension)",
            "device_lost: device-lost (the device was reset)",
            "not_a_number: error (metric 'number' is nan; a metric is a finite number, or ∞ dB)"));
}

/// 'a-b/c' and 'a/b-c' both have the files a-b-c.csv, .md and .tex, and that place in a page.
TEST_F(Faults, TablesOfOneFileNameAreNoRunTogether) {
    const auto write = [&](const char* file, const std::string& id) {
        return folder
            .write(file, "table: " + id +
                             "\ntitle: T\ntechnique: mock\nsweep: {number: [1]}\n"
                             "measure: {lane: quality}\noutput: {width: 8, height: 8}\n"
                             "layout: {rows: number, columns: {n: {metric: number}}}\n")
            .string();
    };
    const std::string first = write("first.yaml", "a-b/c"), second = write("second.yaml", "a/b-c");
    EXPECT_EQ(endedWith(2, mockGfxrepro({"plan", first, second})).err,
              "gfxrepro: " + second +
                  ": the experiment 'a/b-c' and 'a-b/c' would write the same files, 'a-b-c'; "
                  "allowed: one of them in a run\n");
    const std::string a = folder.path() / "a", b = folder.path() / "b",
                      page = folder.path() / "p.html";
    for (const auto& [config, dir] : {std::pair(first, a), std::pair(second, b)}) {
        ASSERT_EQ(mockGfxrepro({"run", config, "--out", dir}).exitCode, 0);
    }
    endedWith(0, mockGfxrepro({"report", a, b, "--out", page}));
    EXPECT_THAT(readFile(page), HasSubstr("<section class=\"page\" id=\"a-b-c\">"));
    EXPECT_THAT(readFile(page), HasSubstr("<section class=\"page\" id=\"a-b-c-\">"));
}

TEST_F(Faults, WhatPassesAtTheSecondTryIsFlaky) {
    const std::string marker = folder.path() / "marker";
    const std::string config =
        writeMockConfig(folder, "params: {behaviour: flake, marker: " + marker +
                                    "}\nsweep: {number: [1, 2]}\n"
                                    "layout:\n  rows: number\n  columns:\n"
                                    "    n: {metric: number, format: \"{median:.0f}\"}\n");
    const ProcessResult run =
        endedWith(0, mockGfxrepro({"run", config, "--jobs", "1", "--out", dir}));
    EXPECT_EQ(run.out, "2 of 2 finished, 1 flaky; records: " + dir + "/records.csv\n");
    EXPECT_THAT(
        statusLines(dir),
        ElementsAre("flake: flaky (passed at the second try; the first: crash: SIGSEGV: flaking)",
                    "flake: ok"));
    EXPECT_EQ(mockGfxrepro({"table", dir}).exitCode, 0);
    EXPECT_THAT(readFile(dir + "/tables/sweep-mock.md"), HasSubstr("| 1 | 1 (flaky) |"));
    EXPECT_EQ(mockGfxrepro({"run", "--resume", dir}).out,
              "0 of 0 finished; records: " + dir + "/records.csv\n");
}

TEST_F(Faults, AFlakyCaseIsMeasuredAgainWhereThatIsAskedFor) {
    const std::string config = writeMockConfig(
        folder, "params: {behaviour: flake, marker: " + (folder.path() / "marker").string() +
                    "}\nsweep: {number: [1, 2]}\n");
    mockGfxrepro({"run", config, "--jobs", "1", "--out", dir});
    ASSERT_EQ(statusLines(dir).size(), 2U);
    EXPECT_EQ(endedWith(0, mockGfxrepro({"run", "--resume", dir, "--retry"})).out,
              "1 of 1 finished; records: " + dir + "/records.csv\n");
    EXPECT_THAT(statusLines(dir), ElementsAre("flake: ok", "flake: ok"));
}

TEST_F(Faults, WhatALibraryThrowsNamesTheFile) {
    const std::string name = std::string(300, 'x') + ".obj";
    const std::string config = writeMockConfig(folder, "scene: " + name + "\n");
    const ProcessResult check = endedWith(2, mockGfxrepro({"check", config}));
    EXPECT_THAT(check.err, HasSubstr(name));
    EXPECT_THAT(check.err, HasSubstr("File name too long"));
    EXPECT_THAT(check.err, Not(HasSubstr("filesystem error")));
}

TEST_F(Faults, MeasurementsAreCountedAsCasesAre) {
    const std::string config = writeMockConfig(
        folder, "sweep: {number: [1, 2]}\nmeasure: {lane: quality, processes: 600000}\n");
    const std::string why =
        "the plan has 1200000 measurements (cases × processes); at most 1000000 are allowed\n";
    EXPECT_EQ(mockGfxrepro({"check", config}).err, "gfxrepro: " + config + ": " + why);
    EXPECT_THAT(mockGfxrepro({"run", config}).err, HasSubstr(why));
    // In a plan of someone else it would be as much memory.
    writeMockConfig(folder, "sweep: {number: [1, 2]}\n");
    ASSERT_EQ(mockGfxrepro({"run", config, "--out", dir}).exitCode, 0);
    replaceIn(dir + "/plan.json", "\"processes\":1,", "\"processes\":2147483647,");
    for (const char* command : {"table", "report", "export"}) {
        EXPECT_EQ(mockGfxrepro({command, dir}).err,
                  "gfxrepro: " + dir +
                      "/plan.json: the plan has 2147483648 measurements (cases × processes); at "
                      "most 1000000 are allowed\n");
    }
}

TEST_F(Faults, CheckTellsOfARunWithVeryManyRows) {
    const auto rows = [&](const std::string& lines) {
        const std::string config = writeMockConfig(folder, lines);
        return mockGfxrepro({"check", config}).out;
    };
    const std::string many = "output: {frames: 500}\nmeasure: {lane: quality, processes: ";
    EXPECT_THAT(rows(many + "10}\n"), Not(HasSubstr("million")));
    EXPECT_THAT(
        rows(many + "1000}\n"),
        AllOf(HasSubstr("about 3.5 million rows of records, of at most 64 million in a run\n"),
              HasSubstr("`table`, `report` and the like take 1.2 GB of memory for them")));
    EXPECT_THAT(
        rows(many + "100000}\n"),
        HasSubstr(
            "in a run: it will stop before its end; measure it in parts (--only, --shard)\n"));
}

/// Of each pass, of its pictures, and of all files of a run together.
TEST_F(Faults, CheckTellsOfAPlanThatIsTooLarge) {
    const auto program = [&](const std::string& name, const std::string& lines, int processes,
                             int frames) {
        return folder
            .write(name, "sweep_of: " + name.substr(0, 1) + "\ntitle: T\nprogram:\n" +
                             "  command: /bin/true {n} {frames}\n  frames: all\n" +
                             "  params: {n: 1}\n" + lines +
                             "measure: {lane: quality, processes: " + std::to_string(processes) +
                             "}\noutput: {frames: " + std::to_string(frames) + "}\n")
            .string();
    };
    const auto said = [&](const std::vector<std::string>& files) {
        const ProcessResult result = endedWith(0, mockGfxrepro({"check"}, files));
        return result.out;
    };
    std::string passes = "  passes: {";
    for (int i = 0; i < 50; ++i) passes += (i ? ", p" : "p") + std::to_string(i) + ": a pass";
    const std::string metrics = "  metrics: {rays: ray, hits: ray}\n";
    const std::string some = program("a.yaml", metrics, 1, 100000);
    EXPECT_THAT(said({some}), Not(HasSubstr("million")));
    // 2 × 50 values and the times of 50 passes, of each frame.
    EXPECT_THAT(said({program("b.yaml", metrics + passes + "}\n", 1, 100000)}),
                HasSubstr("about 20 million rows of records, of at most 64 million in a run\n"));
    EXPECT_THAT(said({program("c.yaml", "  images: {r: {file: \"r{frame}.png\"}}\n", 1, 1000000)}),
                HasSubstr("about 1 million pictures, of at most 4 million in a run\n"));
    const std::string half = program("d.yaml", metrics, 8, 1000000);
    const std::string other = program("e.yaml", metrics, 8, 1000000);
    EXPECT_THAT(said({half}), Not(HasSubstr("it will stop")));
    EXPECT_THAT(said({half, other}),
                HasSubstr("all in one run: about 80 million rows of records, of at most 64 million "
                          "in a run: it will stop before its end; measure it in parts"));
    const std::string units = program("f.yaml", "", 600000, 1);
    EXPECT_THAT(said({units, program("g.yaml", "", 600000, 1)}),
                HasSubstr("all in one run: 1200000 measurements (cases × processes), of at most "
                          "1000000 in a run: `plan` and `run` refuse it\n"));
}

TEST_F(Faults, AMetricIsGivenOnce) {
    const std::string config = writeMockConfig(folder, "sweep: {behaviour: [twice]}\n");
    EXPECT_EQ(mockGfxrepro({"run", config, "--out", dir}).exitCode, 4);
    EXPECT_THAT(statusLines(dir),
                ElementsAre("twice: error (metric 'number' is given twice for frame 0, repeat 0)"));
}

TEST_F(Faults, APerfectPictureIsInfinitelyGood) {
    const std::string config =
        writeMockConfig(folder,
                        "sweep: {behaviour: [infinite]}\n"
                        "layout:\n  rows: behaviour\n  columns:\n"
                        "    psnr: {metric: fidelity_db, format: \"{median:.1f} dB\"}\n"
                        "claims:\n  C: {says: it is good, bound: psnr, at_least: 40}\n");
    endedWith(0, mockGfxrepro({"reproduce", config, "--out", dir}));
    ASSERT_EQ(rowsOf(dir, "fidelity_db").size(), 1U);
    EXPECT_EQ(rowsOf(dir, "fidelity_db")[0].value, HUGE_VAL);
    const auto ofPicture = rowsOf(dir, "psnr_db");
    ASSERT_EQ(ofPicture.size(), 1U);
    EXPECT_EQ(ofPicture[0].pass, "flat");
    EXPECT_NEAR(ofPicture[0].value, 12.04, 0.01);
    EXPECT_THAT(readFile(dir + "/tables/sweep-mock.md"), HasSubstr("| infinite | ∞ dB |"));
    EXPECT_THAT(readFile(dir + "/tables/sweep-mock.csv"), HasSubstr("infinite,inf,inf,inf,,ok"));
    EXPECT_THAT(readFile(dir + "/claims.csv"), HasSubstr(",holds,"));
}

TEST_F(Faults, WhatSetUpMeasuredIsNoFrame) {
    const std::string config = writeMockConfig(
        folder, "output: {frames: 2}\nmeasure: {lane: timing, processes: 1, repeats: 2}\n");
    EXPECT_EQ(mockGfxrepro({"run", config, "--out", dir}).exitCode, 0);
    ASSERT_EQ(rowsOf(dir, "setup_time_ms").size(), 1U);
    EXPECT_EQ(rowsOf(dir, "setup_time_ms")[0].frame, records::kSetup);
    EXPECT_EQ(rowsOf(dir, "setup_time_ms")[0].repeat, records::kSetup);
}

/// In the place of / a machine of which nothing but a heat is told.
TEST_F(Faults, AMachineThatIsNotQuietIsWarnedOfAndRecorded) {
    const std::string zone = "machine/sys/class/thermal/thermal_zone0/";
    folder.write(zone + "temp", "97000\n");
    const std::string machine = folder.path() / "machine";
    const std::string config = writeMockConfig(
        folder, "measure: {lane: timing, processes: 1, repeats: 2}\nsweep: {number: [1, 2]}\n");
    const auto run = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments = {GFXREPRO_MOCK_PROGRAM, "reproduce"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return runProgram(arguments, {"GFXREPRO_MACHINE_ROOT=" + machine});
    };
    const ProcessResult hot = endedWith(0, run({config, "--device", "software", "--out", dir}));
    const std::string warning =
        "warning: the machine was not quiet: while sweep/mock was timed it was hot, 97 °C of 95 °C "
        "at which it is slowed\n";
    ASSERT_THAT(hot.err, HasSubstr(warning));
    EXPECT_EQ(hot.err.find(warning), hot.err.rfind(warning)) << "once";
    const auto manifest = nlohmann::json::parse(readFile(dir + "/manifest.json"));
    EXPECT_EQ(manifest["machine_states"]["sweep/mock"]["hottest_c"], 97.0);
    const std::string note = "The machine was disturbed while this was timed: it was hot, 97 °C";
    EXPECT_THAT(readFile(dir + "/tables/sweep-mock.md"), HasSubstr(note));
    EXPECT_THAT(readFile(dir + "/report.html"), HasSubstr(note));
    // A run that goes on keeps what it saw.
    folder.write(zone + "temp", "40000\n");
    run({"--resume", dir});
    const auto again = nlohmann::json::parse(readFile(dir + "/manifest.json"));
    EXPECT_EQ(again["machine_states"], manifest["machine_states"]);
    // Nothing is told of a machine that tells nothing, nor said of one that is cool.
    const ProcessResult cool =
        run({config, "--device", "software", "--out", folder.path() / "cool"});
    EXPECT_THAT(cool.err, Not(HasSubstr("not quiet")));
}

TEST_F(Faults, SideBySideAndInFreshProcesses) {
    const std::string config = writeMockConfig(
        folder,
        "sweep:\n  number: [1, 2, 3]\nmeasure: {lane: quality, processes: 2, repeats: 2}\n");
    endedWith(0, mockGfxrepro({"run", config, "--jobs", "2", "--out", dir}));
    EXPECT_EQ(rowsOf(dir, "number").size(), 6U);
    EXPECT_EQ(rowsOf(dir, "wall_time_ms").size(), 12U);
}

TEST_F(Faults, BlankPicturesUnequalWorkAndSuspensionsVoidTimesAndNothingElse) {
    const std::string config =
        writeMockConfig(folder,
                        "sweep: {behaviour: [ok, blank, unequal, suspended]}\n"
                        "measure: {lane: timing, processes: 1, repeats: 3}\n"
                        "layout:\n  rows: behaviour\n  columns:\n    fps: {metric: frame_rate}\n"
                        "    n: {metric: number, format: \"{median:.0f}\"}\n");
    EXPECT_EQ(endedWith(4, mockGfxrepro({"run", config, "--out", dir})).out,
              "4 of 4 finished, 3 with void times; records: " + dir + "/records.csv\n");
    std::vector<std::string> messages;
    for (const records::Record& row : rowsOf(dir, "frame_rate")) {
        messages.push_back(std::string(records::statusName(row.status)) + ": " + row.message);
    }
    const std::string blank =
        "ambiguous: frame 0: the picture of repeat 0 is blank: all its pixels are the same";
    const std::string another =
        "ambiguous: frame 0: repeat 1 drew a different picture than repeat 0";
    const std::string suspended = "ambiguous: frame 0: the process was suspended meanwhile";
    EXPECT_THAT(messages, UnorderedElementsAre("ok: ", "ok: ", "ok: ", blank, blank, blank, another,
                                               another, another, suspended, suspended, suspended));
    for (const records::Record& row : rowsOf(dir, "number"))
        EXPECT_EQ(row.status, records::Status::Ok);
    EXPECT_EQ(rowsOf(dir, "work_image_digest").size(), 12U);
    EXPECT_EQ(mockGfxrepro({"table", dir}).exitCode, 4);
    const std::string table = readFile(dir + "/tables/sweep-mock.md");
    EXPECT_THAT(table, HasSubstr("| blank | ambiguous | 0 |"));
    EXPECT_THAT(table, HasSubstr("| unequal | ambiguous | 0 |"));
    EXPECT_THAT(table, HasSubstr("| suspended | ambiguous | 0 |"));
}

std::vector<std::pair<int, double>> roundsOf(const std::string& dir) {
    std::vector<std::pair<int, double>> units;
    for (const records::Record& row : rowsOf(dir, "number")) {
        units.emplace_back(row.process, row.value);
    }
    return units;
}

/// Cases take turns, forth and back, and rounds go on while times are too uncertain.
TEST_F(Faults, TimesAreMeasuredInRounds) {
    const auto measure = [&](const std::string& keys, const std::string& into) {
        const std::string config = writeMockConfig(
            folder, "sweep: {number: [1, 2]}\nparams: {behaviour: uneven, busy_ms: 2, marker: " +
                        (folder.path() / "turn").string() + "}\nmeasure: {lane: timing, " + keys +
                        "}\n"
                        "layout:\n  rows: number\n  columns:\n    ms: {metric: wall_time_ms}\n");
        endedWith(0, mockGfxrepro({"run", config, "--out", into}));
        EXPECT_EQ(mockGfxrepro({"table", into}).exitCode, 0);
        return readFile(into + "/tables/sweep-mock.md");
    };
    const std::string fixed = folder.path() / "fixed";
    EXPECT_THAT(measure("processes: 3", fixed), HasSubstr("bounds are a range"));
    EXPECT_THAT(roundsOf(fixed),
                ElementsAre(std::pair(0, 1.0), std::pair(0, 2.0), std::pair(1, 2.0),
                            std::pair(1, 1.0), std::pair(2, 1.0), std::pair(2, 2.0)));
    // Uneven times are never known: rounds go on until they are as many as allowed.
    const std::string table = measure("processes: 6, time_budget_s: 60", dir);
    EXPECT_THAT(table, HasSubstr("Times of 20 rounds, the most that are allowed"));
    EXPECT_THAT(table, HasSubstr("Noise of this table"));
    EXPECT_EQ(roundsOf(dir).size(), 40U);
    EXPECT_GT(rowsOf(dir, "process_time_ms").size(), 0U);
    const std::string manifest = readFile(dir + "/manifest.json");
    EXPECT_THAT(manifest, HasSubstr("\"ended_by\": \"most_rounds\""));
    // What was decided stays; a unit that is lost is measured again.
    EXPECT_EQ(mockGfxrepro({"run", "--resume", dir}).out,
              "0 of 0 finished; records: " + dir + "/records.csv\n");
    const std::string last = records::readRecords(dir + "/records.csv").back().caseId;
    loseRows(dir, [&](const auto& row) { return row.process == 19 && row.caseId == last; });
    EXPECT_EQ(mockGfxrepro({"run", "--resume", dir}).out,
              "1 of 1 finished; records: " + dir + "/records.csv\n");
}

TEST_F(Faults, NoSuchDevice) {
    const std::string config = writeMockConfig(folder, "");
    EXPECT_EQ(endedWith(3, mockGfxrepro({"run", config, "--device", "77", "--out",
                                         (folder.path() / "run").string()}))
                  .err.substr(0, 10),
              "gfxrepro: ");
}

/// It would stand in every line of the log, which could not be read any more.
TEST(Titles, AreRefusedBeforeTheyAreMeasured) {
    const TemporaryFolder folder;
    const fs::path config = writeMockConfig(
        folder, "sweep: {number: [1, 2], marker: [x, " + std::string(1'100'000, 'y') + "]}\n");
    const std::string why = "gfxrepro: " + config.string() +
                            ":5:37: a value of axis 'marker' has 1100000 bytes, its case's title "
                            "1100027; at most 4096 are allowed\n";
    EXPECT_EQ(mockGfxrepro({"check", config}).err, why);
    const std::string dir = folder.path() / "run";
    EXPECT_THAT(endedWith(2, mockGfxrepro({"run", config, "--out", dir})).err,
                EndsWith(why));  // behind the device
    EXPECT_FALSE(fs::exists(dir));
    writeMockConfig(folder, "sweep: {marker: [x, " + std::string(4000, 'y') + "]}\n");
    EXPECT_EQ(mockGfxrepro({"check", config}).exitCode, 0);
}

using Overrides = test::RunTest;

TEST_F(Overrides, WhatTheyTakeFromClaimsIsUnmeasuredAndSaidBefore) {
    const std::string config = writeMockConfig(
        folder,
        "sweep: {marker: [x, y], number: [1, 2]}\n"
        "layout:\n  rows: number\n  columns: marker\n"
        "  cell: {metric: number, format: \"{median:.0f}\"}\n"
        "claims:\n  order: {says: it is, order: x < y}\n"
        "  two: {says: it is, bound: x, bound_from: ours, less_than: 9, at: {number: 2}}\n");
    const auto checked = [&](const std::string& sweep) {
        return mockGfxrepro({"check", config, "--sweep", sweep}).out;
    };
    EXPECT_EQ(mockGfxrepro({"check", config}).out,
              config + ": ok, sweep/mock, 4 cases, 2 claims\n");
    EXPECT_EQ(checked("marker=x"), config + ": ok, sweep/mock, 2 cases, 2 claims\n" + config +
                                       ": claim 'order' will be unmeasured: 'y' is no column; did "
                                       "you mean 'x'? (columns: x)\n");
    EXPECT_EQ(
        checked("number=1"),
        config + ": ok, sweep/mock, 2 cases, 2 claims\n" + config +
            ": claim 'two' will be unmeasured: no row is of {number: 2}; there are: {number: 1}\n");
    endedWith(0,
              mockGfxrepro({"reproduce", config, "--sweep", "marker=x", "--quiet", "--out", dir}));
    EXPECT_THAT(readFile(dir + "/claims.csv"),
                HasSubstr("not among what was measured: 'y' is no column"));
    EXPECT_TRUE(fs::exists(dir + "/tables/sweep-mock.csv"));
}

TEST_F(Overrides, CheckSaysHowManyCasesOnlyLeaves) {
    const std::string config = writeMockConfig(folder, "sweep: {marker: [x, y], number: [1, 2]}\n");
    const auto checked = [&](const std::string& only) {
        return mockGfxrepro({"check", config, "--only", only});
    };
    EXPECT_EQ(checked("marker=x").out,
              config + ": ok, sweep/mock, 4 cases, 0 claims\n--only leaves 2 of 4 cases\n");
    EXPECT_THAT(endedWith(2, checked("number=3")).err,
                HasSubstr("no case has that value; there are 1, 2"));
    EXPECT_THAT(checked("numbr=1").err, HasSubstr("did you mean 'number'?"));
}

TEST_F(Overrides, WhatTheyTakeFromPlotsIsLeftOutAndSaidBefore) {
    const std::string config =
        writeMockConfig(folder,
                        "sweep: {marker: [x, y], number: [1, 2]}\n"
                        "layout:\n  rows: number\n  columns: marker\n"
                        "  cell: {metric: number, format: \"{median:.0f}\"}\n"
                        "plots:\n  - {x: number, y: x}\n  - {x: number, y: [x, y], title: Both}\n");
    EXPECT_EQ(mockGfxrepro({"check", config}).out,
              config + ": ok, sweep/mock, 4 cases, 0 claims\n");
    EXPECT_EQ(mockGfxrepro({"check", config, "--sweep", "marker=x"}).out,
              config + ": ok, sweep/mock, 2 cases, 0 claims\n" + config +
                  ": plot 2 will be left out: 'y' is no column (columns: x)\n");
    endedWith(0,
              mockGfxrepro({"reproduce", config, "--sweep", "marker=x", "--quiet", "--out", dir}));
    EXPECT_TRUE(fs::exists(dir + "/tables/sweep-mock.csv"));
    EXPECT_TRUE(fs::exists(dir + "/plots/sweep-mock.svg"));
    EXPECT_FALSE(fs::exists(dir + "/plots/sweep-mock-2.svg"));
    EXPECT_THAT(readFile(dir + "/report.html"),
                HasSubstr("not among what was measured: &#39;y&#39; is no column (columns: x)"));
}

TEST_F(Overrides, ANumberThatWasAColumnIsNoConstant) {
    const std::string config =
        writeMockConfig(folder,
                        "sweep: {number: [1, 2]}\n"
                        "layout:\n  rows: number\n  columns: {n: {metric: number}}\n"
                        "  cell: \"{median:.0f}\"\n"
                        "claims:\n  rises: {says: it does, order: [number=1, number=2]}\n");
    EXPECT_EQ(mockGfxrepro({"check", config, "--sweep", "number=7,8"}).out,
              config + ": ok, sweep/mock, 2 cases, 1 claim\n" + config +
                  ": claim 'rises' will be unmeasured: '1' is no column (columns: 7, 8)\n");
    endedWith(
        0, mockGfxrepro({"reproduce", config, "--sweep", "number=7,8", "--quiet", "--out", dir}));
    EXPECT_THAT(readFile(dir + "/claims.csv"), HasSubstr("unmeasured"));
    const std::string unclear =
        writeMockConfig(folder,
                        "sweep: {number: [1, 2]}\n"
                        "layout:\n  rows: number\n  columns: {n: {metric: number}}\n"
                        "  cell: \"{median:.0f}\"\n"
                        "claims:\n  rises: {says: it does, across: number, order: 2 * 1 < 2}\n");
    EXPECT_THAT(mockGfxrepro({"check", unclear}).err,
                HasSubstr("claim 'rises': '2' may be the column or the number (quoted it is the "
                          "column; written otherwise, as 2.0, the number)\n"));
}

TEST_F(Faults, FramesThatATechniqueDoesNotHaveAreRefusedBeforeTheRun) {
    const std::string config = writeMockConfig(folder, "output: {frames: 501}\n");
    for (const char* command : {"check", "plan", "run"}) {
        EXPECT_THAT(endedWith(2, mockGfxrepro({command, config})).err,
                    HasSubstr(":39: the mock has 500 frames\n"));
    }
    const std::string all = writeMockConfig(folder, "output: {frames: 500}\n");
    EXPECT_EQ(mockGfxrepro({"check", all}).exitCode, 0);
}

TEST_F(Faults, EveryCommandThatReadsARunTellsThatCasesDidNotFinish) {
    const std::string config = writeMockConfig(folder, "sweep: {behaviour: [ok, throw]}\n");
    const std::string out = folder.path() / "out.html";
    ASSERT_EQ(mockGfxrepro({"run", config, "--out", dir}).exitCode, 4);
    for (const std::vector<std::string>& command : {std::vector<std::string>{"table", dir},
                                                    {"claims", dir},
                                                    {"report", dir},
                                                    {"claims", dir, "--config", config},
                                                    {"report", dir, "--out", out},
                                                    {"report", dir, dir, "--out", out}}) {
        const ProcessResult result = mockGfxrepro(command);
        EXPECT_EQ(result.exitCode, 4) << command.front() << ' ' << command.back() << result.err;
        EXPECT_THAT(result.out, HasSubstr("incomplete: 0 not run, 1 failed (1 error)\n"));
    }
    const std::string crashing =
        writeMockConfig(folder, "params: {behaviour: crash}\nsweep: {number: [1, 2]}\n");
    ASSERT_EQ(mockGfxrepro({"run", crashing, "--out", dir + "2"}).exitCode, 4);
    EXPECT_THAT(mockGfxrepro({"table", dir + "2"}).out,
                HasSubstr("incomplete: 0 not run, 2 failed (2 crash); no case has a result\n"));
}

TEST_F(Faults, NamesOfThreeHundredLettersAreNoReasonToLoseACase) {
    const std::string config = writeMockConfig(folder, "params: {number: 1}\n");
    const std::string name(300, 'n');
    endedWith(
        0, runProgram({GFXREPRO_MOCK_PROGRAM, "run", config, "--device", "software", "--out", dir},
                      {"GFXREPRO_MOCK_PICTURE=" + name}));
    const std::string index = readFile(dir + "/images/index.csv");
    EXPECT_THAT(index, HasSubstr(",0," + name + ",images/sweep-mock/")) << "its name stays";
    ASSERT_EQ(mockGfxrepro({"report", dir}).exitCode, 0);
    std::size_t count = 0;
    for (const auto& entry : fs::directory_iterator(dir + "/images/sweep-mock")) {
        EXPECT_LE(entry.path().filename().string().size(), 120U);
        ++count;
    }
    EXPECT_EQ(count, 6U);  // an EXR and a PNG of the named, of "flat" and of its truth
    const std::string named =
        folder.write("long.yaml", "sweep_of: " + name + "\ntitle: t\ntechnique: mock\n");
    EXPECT_EQ(
        endedWith(2, mockGfxrepro({"check", named})).err,
        "gfxrepro: " + named +
            ":1:11: sweep_of: a name of 300 letters; at most 80, for files are named after it\n");
}

TEST_F(Faults, WhatAConfigMayNameARunMayReadAgain) {
    // The character DEL, escaped, and a path longer than a key of YAML may be.
    fs::path deep = folder.path();
    for (int i = 0; i < 6; ++i) deep /= std::string(200, 'd');
    fs::create_directories(deep);
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
        "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    writeFileAtomic(deep / "a.ply", ply);
    const std::string config =
        folder.write("mock.yaml",
                     "sweep_of: mock\ntitle: \"A \\x7f mock\"\ntechnique: mock_of_scenes\n"
                     "output: {width: 8, height: 8}\nparams: {marker: \"/a\\x7fb\"}\n"
                     "scene: " +
                         (deep / "a.ply").string() + "\n");
    const ProcessResult run = endedWith(0, mockGfxrepro({"run", config, "--out", dir}));
    for (const std::vector<std::string>& command : {std::vector<std::string>{"table", dir},
                                                    {"claims", dir},
                                                    {"report", dir},
                                                    {"run", "--resume", dir}}) {
        const ProcessResult result = mockGfxrepro(command);
        EXPECT_EQ(result.exitCode, 0) << command.front() << result.err;
    }
}

}  // namespace
}  // namespace gfxrepro::test
