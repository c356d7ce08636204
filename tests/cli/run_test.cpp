// A run from config to report, killed, resumed and refused.
#include <signal.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "engine/core/files.h"
#include "engine/core/json_shape.h"
#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

std::string smokeConfig() {
    return (fs::path(GFXREPRO_CONFIGS) / "smoke/template.yaml").string();
}

using RunCommand = test::RunTest;

TEST_F(RunCommand, SmokeFromConfigToReport) {
    EXPECT_EQ(endedWith(0, gfxrepro({"run", smokeConfig(), "--device", "software", "--jobs", "1",
                                     "--out", dir}))
                  .out,
              "2 of 2 finished; records: " + dir + "/records.csv\n");
    const std::vector<records::Record> rows = rowsOf(dir, "mean_brightness");
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_NEAR(rows[0].value, 0.25, 1e-6);
    EXPECT_NEAR(rows[1].value, 0.5, 1e-6);
    EXPECT_EQ(rows[0].method, "gradient");
    EXPECT_EQ(rowsOf(dir, "wall_time_ms").size(), 2U);
    const std::string picture =
        dir + "/images/sweep-smoke-template/brightness=0.5-" + rows[0].caseId + "-result";
    EXPECT_TRUE(fs::exists(picture + ".exr"));
    EXPECT_TRUE(fs::exists(picture + ".png"));

    endedWith(0, gfxrepro({"table", dir}));
    EXPECT_TRUE(fs::exists(dir + "/tables/sweep-smoke-template.csv"));
    EXPECT_THAT(endedWith(0, gfxrepro({"claims", dir})).out, HasSubstr("1 holds"));
    const ProcessResult report = endedWith(0, gfxrepro({"report", dir}));
    EXPECT_TRUE(fs::exists(dir + "/report.html"));
}

// A user's file has its views where the catalogue's scene has them: nothing looks past the scene.
TEST_F(RunCommand, AnExportedSceneMeasuresAsTheCataloguesDoes) {
    const std::string file = folder.path() / "tree.glb";
    endedWith(0, gfxrepro({"scene", "outdoor/tree", "--export", file}));
    const std::string config = folder.write(
        "tree.yaml",
        "sweep_of: tree\ntitle: T\ntechnique: depth_sampling\nmeasure: {lane: quality}\n"
        "params: {method: conventional, redundancy: visibility, view_distance: 0.55, view_spread: "
        "0.5, output_frames: 10, availability: true}\n"
        "output: {width: 128, height: 128}\nsweep: {scene: [outdoor/tree, tree.glb]}\n");
    endedWith(0, gfxrepro({"run", config, "--device", "software", "--out", dir}));
    for (const char* metric : {"redundant_pct", "available_mean_pct"}) {
        const std::vector<records::Record> rows = rowsOf(dir, metric);
        ASSERT_GE(rows.size(), 2U) << metric;
        const std::size_t half = rows.size() / 2;
        for (std::size_t i = 0; i < half; ++i) {
            EXPECT_NEAR(rows[half + i].value, rows[i].value, 1.5) << metric;
        }
        EXPECT_GT(rows[half - 1].value, 20.0) << metric;
    }
}

// Lights, camera paths and motions, too.
TEST_F(RunCommand, AnExportedRoomShowsTheCataloguesPicture) {
    endedWith(0, gfxrepro({"scene", "indoor/living_room", "--export", folder.path() / "room.glb"}));
    const std::string config =
        folder.write("room.yaml",
                     "sweep_of: room\ntitle: R\ntechnique: reflection_reuse\n"
                     "measure: {lane: quality}\n"
                     "params: {method: ray_traced, pictures: true, view: path_1, path_frames: 9, "
                     "first_frame: 3, motion: true}\n"
                     "output: {width: 64, height: 48, frames: 2}\nsweep: {scene: "
                     "[indoor/living_room, room.glb]}\n");
    endedWith(0, gfxrepro({"run", config, "--device", "software", "--out", dir}));
    std::vector<fs::path> pictures;
    for (const auto& entry : fs::recursive_directory_iterator(dir + "/images")) {
        if (entry.path().string().ends_with("result-f0001.exr")) pictures.push_back(entry.path());
    }
    ASSERT_EQ(pictures.size(), 2U);
    const ProcessResult diff = endedWith(0, gfxrepro({"image", "diff", pictures[0], pictures[1]}));
    EXPECT_THAT(diff.out, ContainsRegex("flip +0(\\.0+)?\n")) << diff.out;
}

TEST_F(RunCommand, TableThatIsOnlyPrinted) {
    const std::string config = folder.write(
        "table-1.yaml",
        "table: p/1\ntitle: T\nprinted: {values: \"function,dimensions\\npanorama,2\"}\n");
    EXPECT_EQ(gfxrepro({"check", config}).out, config + ": ok, p/1, 0 cases, 0 claims\n");
    endedWith(0, gfxrepro({"reproduce", config, "--device", "software", "--out", dir}));
    EXPECT_EQ(readFile(dir + "/tables/p-1.md"),
              "# Table 1. T\n\nAs printed; nothing is measured.\n\n"
              "| function | dimensions |\n| --- | ---: |\n| panorama | 2 |\n");
    const std::string latex = readFile(dir + "/tables/p-1.tex");
    EXPECT_EQ(latex.substr(latex.rfind("\\gfxreproset")),
              "\\gfxreproset{p/1/panorama/dimensions/printed}{2}%\n"
              "\\begin{tabular}{lr}\n\\toprule\n{function}\n& {dimensions} \\\\\n\\midrule\n"
              "{panorama}\n& \\gfxrepro{p/1/panorama/dimensions/printed} \\\\\n"
              "\\bottomrule\n\\end{tabular}%\n");
}

/// A table whose profiles differ, with a printed value a row.
std::string printedConfig(const TemporaryFolder& folder, const std::string& more = "") {
    return folder.write(
        "table-2.yaml",
        "table: demo2026/2\ntitle: A demonstration\ntechnique: mock\n"
        "output: {width: 8, height: 8}\nparams: {pause_ms: 2}\nsweep: {number: [1, 2]}\n"
        "layout:\n  rows: number\n  columns: {n: {metric: number}}\n  cell: \"{median:.0f}\"\n"
        "printed:\n  values: |\n    number,n\n    1,1\n    2,4\n"
        "profiles:\n  quick: {params: {pause_ms: 1}, output: {width: 4}}\n" +
            more);
}

/// The line of parameters in the Markdown table of a run with these arguments.
std::string parametersOf(const std::string& config, const std::string& dir,
                         const std::vector<std::string>& arguments) {
    EXPECT_EQ(mockGfxrepro({"run", config, "--out", dir}, arguments).exitCode, 0);
    EXPECT_EQ(mockGfxrepro({"table", dir}).exitCode, 0);
    const std::string text = readFile(dir + "/tables/demo2026-2.md");
    const std::size_t start = text.find("\n\n", text.find("Printed →")) + 2;
    return text.substr(start, text.find("\n\n", start) - start);
}

TEST_F(RunCommand, TablesSayAtWhichParametersTheyWereMeasured) {
    const std::string config = printedConfig(folder);
    const std::string whole = folder.path() / "whole";
    EXPECT_EQ(parametersOf(config, whole, {}), "Measured at the parameters of the profile paper.");
    EXPECT_EQ(gfxrepro({"table", whole}).out,
              "demo2026/2: tables/demo2026-2.csv .md .tex\n"
              "Of 2 printed cells of tables 2 were measured again: 2 at parameters of which it is "
              "not known.\n");
    EXPECT_EQ(parametersOf(config, folder.path() / "quick", {"--profile", "quick"}),
              "Measured at output 4×8 (the config's 8×8), pause 1 ms (2).");
    EXPECT_EQ(parametersOf(config, folder.path() / "set", {"--set", "pause_ms=3"}),
              "Measured at pause 3 ms (the config's 2).");
    EXPECT_EQ(parametersOf(config, folder.path() / "swept", {"--sweep", "number=2,3"}),
              "Measured at the parameters of the profile paper.")
        << "the printed cell; 3 is not printed";
    EXPECT_EQ(parametersOf(config, folder.path() / "only", {"--only", "number=1"}),
              "Measured at the parameters of the profile paper.");
    const std::string at = printedConfig(
        folder, "  paper: {printed: {at: {output.frames: 500}}, output: {frames: 3}}\n");
    EXPECT_EQ(parametersOf(at, folder.path() / "at", {"--profile", "paper"}),
              "Measured at frames 3 (printed 500).");
}

TEST_F(RunCommand, PrintedParametersHaveToBeParameters) {
    const std::string config = printedConfig(folder, "  paper: {printed: {at: {pause_m: 500}}}\n");
    EXPECT_EQ(endedWith(2, mockGfxrepro({"check", config})).err,
              "gfxrepro: " + config +
                  ":18:35: printed.at: 'pause_m' is no parameter; did you mean 'pause_ms'?\n");
}

/// Of three cases alike: told at the end, once.
TEST_F(RunCommand, WhatCasesWarnOfIsTold) {
    const std::string config = writeMockConfig(folder, "sweep: {number: [1, 2, 3]}\n");
    const ProcessResult run =
        endedWith(0, runProgram({GFXREPRO_MOCK_PROGRAM, "run", config, "--device", "software",
                                 "--out", folder.path() / "run"},
                                {"GFXREPRO_MOCK_WARNING=a frame shows no reflector"}));
    const std::string warning = "warning: a frame shows no reflector\n";
    const std::size_t at = run.err.find(warning);
    ASSERT_NE(at, std::string::npos) << run.err;
    EXPECT_EQ(run.err.find(warning, at + 1), std::string::npos) << run.err;
}

/// Before the first case, once; the manifest and the report keep it.
TEST_F(RunCommand, WhatLoadersWarnOfIsToldAndKept) {
    folder.write("own.obj", "mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 1\nv 5 5 5\nf 1 2 3\n");
    const std::string config = writeMockConfig(
        folder, "scene: own.obj\nsweep: {number: [1, 2]}\nmeasure: {lane: timing, processes: 2}\n");
    const ProcessResult run =
        endedWith(0, mockGfxrepro({"reproduce", config, "--device", "software", "--out", dir}));
    const std::string unused = "left out: a vertex that no face uses";
    const std::string absent =
        "material file 'none.mtl' is not beside the model: its materials are grey";
    const auto manifest = parseJsonObject(readFile(dir + "/manifest.json"), {});
    const std::string scene = "scene '" + (folder.path() / "own.obj").string() + "': ";
    EXPECT_EQ(manifest.at("warnings"), (Json{scene + unused, scene + absent}));
    const std::string page = readFile(dir + "/report.html");
    for (const std::string& line : {unused, absent}) {
        EXPECT_THAT(run.err, HasSubstr("own.obj: " + line + '\n'));
        EXPECT_EQ(run.err.find(line), run.err.rfind(line)) << run.err;
        EXPECT_THAT(page, HasSubstr(line.substr(0, 13)));
    }
}

TEST_F(RunCommand, SecondRunIntoOneFolderIsRefused) {
    const std::string config = writeMockConfig(folder, "params: {pause_ms: 4000}\n");
    BackgroundProgram first(
        {GFXREPRO_MOCK_PROGRAM, "run", config, "--device", "software", "--out", dir});
    while (!fs::exists(dir + "/plan.json")) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    EXPECT_THAT(endedWith(2, mockGfxrepro({"run", config, "--out", dir})).err,
                EndsWith("gfxrepro: " + dir + ": another run is writing to this folder\n"));
    EXPECT_EQ(first.wait().exitCode, 0);
    const ProcessResult third = mockGfxrepro({"run", config, "--out", dir});
    EXPECT_THAT(third.err,
                EndsWith("gfxrepro: " + dir + ": holds a run already; continue it with --resume " +
                         dir + ", or give another folder\n"));
}

const char* const kSixCases =
    "params: {pause_ms: 300}\nsweep:\n  number: {range: [1, 6]}\n"
    "measure: {lane: timing, processes: 1}\n"
    "layout:\n  rows: number\n  columns:\n    n: {metric: number, format: \"{median:.0f}\"}\n";

/// Starts six cases and waits until one is recorded.
void waitForFirstCase(const std::string& dir) {
    while (!fs::exists(dir + "/records.csv") || rowsOf(dir, "number").empty()) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
}

TEST_F(RunCommand, InterruptedRunIsResumable) {
    const std::string config = writeMockConfig(folder, kSixCases);
    BackgroundProgram run(
        {GFXREPRO_MOCK_PROGRAM, "run", config, "--device", "software", "--out", dir});
    waitForFirstCase(dir);
    run.signal(SIGINT);
    EXPECT_THAT(endedWith(130, run.wait()).err,
                HasSubstr("interrupted; continue with: gfxrepro run --resume " + dir));
    EXPECT_EQ(mockGfxrepro({"run", "--resume", dir}).exitCode, 0);
    EXPECT_EQ(rowsOf(dir, "number").size(), 6U);
}

TEST_F(RunCommand, ResumeGoesOnWithWhatWasPlanned) {
    const std::string config =
        writeMockConfig(folder, "params: {number: 1}\nsweep: {pause_ms: [0, 1]}\n");
    ASSERT_EQ(mockGfxrepro({"run", config, "--out", dir}).exitCode, 0);
    const std::string last = records::readRecords(dir + "/records.csv").back().caseId;
    const auto loseACase = [&] {
        loseRows(dir, [&](const auto& row) { return row.caseId == last; });
    };
    const std::string goesOn = "; the run goes on with its configs as they were when it began\n";
    loseACase();
    writeMockConfig(folder, "params: {number: 2}\nsweep: {pause_ms: [0, 1]}\n");
    const ProcessResult changed = endedWith(0, mockGfxrepro({"run", "--resume", dir}));
    EXPECT_THAT(changed.err, HasSubstr("warning: " + config + " changed" + goesOn));
    for (const records::Record& row : rowsOf(dir, "number")) EXPECT_EQ(row.value, 1.0);
    EXPECT_EQ(rowsOf(dir, "number").size(), 2U);
    loseACase();
    fs::remove(config);
    EXPECT_THAT(endedWith(0, mockGfxrepro({"run", "--resume", dir})).err,
                HasSubstr("No such file or directory" + goesOn));
    EXPECT_EQ(rowsOf(dir, "number").size(), 2U);
}

TEST_F(RunCommand, ResumeRefusesAPlanThatWasChanged) {
    const std::string config = writeMockConfig(folder, "params: {number: 1}\n");
    ASSERT_EQ(mockGfxrepro({"run", config, "--out", dir}).exitCode, 0);
    const std::string plan = readFile(dir + "/plan.json");
    const auto resumedWith = [&](const std::string& from, const std::string& to) {
        std::string text = plan;
        const std::size_t at = text.find(from, text.find("\"cases\": ["));
        text.replace(at, from.size(), to);
        writeFileAtomic(dir + "/plan.json", text);
        return mockGfxrepro({"run", "--resume", dir});
    };
    EXPECT_THAT(endedWith(2, resumedWith("\"number\":1", "\"number\":77")).err,
                HasSubstr("is not the one that was planned: plan.json was changed"));
    for (const char* text : {"", "[]", "3", "{\"schema\": 1, \"request\": 7}", "{\"schema\": "}) {
        writeFileAtomic(dir + "/plan.json", text);
        for (const char* command : {"table", "claims", "report"}) {
            const ProcessResult result = mockGfxrepro({command, dir});
            EXPECT_EQ(result.exitCode, 2) << command << ' ' << text << result.err;
            EXPECT_THAT(result.err, HasSubstr("plan.json"));
        }
    }
}

/// `reproduce` over a data folder with one paper whose claim asks for `minimum`.
ProcessResult reproduceDemo(const TemporaryFolder& folder, const std::string& minimum,
                            const std::string& behaviours) {
    folder.write("configs/scenes/README.md", "empty");
    folder.write(
        "configs/demo2026/table-1.yaml",
        "table: demo2026/1\ntitle: A demonstration\ntechnique: mock\n"
        "params: {number: 5}\nsweep: {behaviour: " +
            behaviours +
            "}\n"
            "layout:\n  rows: behaviour\n  columns:\n    n: {metric: number, format: "
            "\"{median:.0f}\"}\n"
            "claims:\n  D1: {says: the number is large, bound: n, at: {behaviour: ok}, at_least: " +
            minimum + "}\n");
    return runProgram({GFXREPRO_MOCK_PROGRAM, "reproduce", "demo2026/1", "--device", "software",
                       "--quiet", "--out", (folder.path() / "run").string()},
                      {"GFXREPRO_DATA=" + folder.path().string()});
}

TEST(Reproduce, ExitCodesFollowClaimsAndCases) {
    const TemporaryFolder holds;
    EXPECT_THAT(endedWith(0, reproduceDemo(holds, "4", "[ok]")).out,
                HasSubstr("claims: of the documents' own claims 1 holds\n"));
    for (const char* file : {"records.csv", "claims.csv", "junit.xml", "report.html",
                             "tables/demo2026-1.csv", "tables/demo2026-1.md"}) {
        EXPECT_TRUE(fs::exists(holds.path() / "run" / file)) << file;
    }
    const TemporaryFolder fails;
    EXPECT_THAT(endedWith(1, reproduceDemo(fails, "6", "[ok]")).out,
                HasSubstr("demo2026/1 fails: the number is large (D1); measured 5"));
    const TemporaryFolder incomplete;
    EXPECT_EQ(reproduceDemo(incomplete, "4", "[ok, throw]").exitCode, 4);
}

}  // namespace
}  // namespace gfxrepro::test
