// What the program says to input that it cannot use: exact words, exit code 2.

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "engine/core/text.h"
#include "runner/config/documents.h"
#include "tests/cli/cli_support.h"

namespace gfxrepro::test {
namespace {

std::string refusal(const std::vector<std::string>& arguments, const TemporaryFolder& folder) {
    const ProcessResult result = gfxrepro(arguments);
    EXPECT_EQ(result.out, "");
    return refusalOf(result, folder);
}

using Usage = FolderTest;

TEST_F(Usage, UnknownCommand) {
    EXPECT_EQ(refusal({"reproduec"}, folder),
              "gfxrepro: unknown command 'reproduec'; did you mean 'reproduce'?; see 'gfxrepro "
              "--help'\n");
    EXPECT_EQ(refusal({"xyzzy"}, folder),
              "gfxrepro: unknown command 'xyzzy'; see 'gfxrepro --help'\n");
    EXPECT_EQ(refusal({}, folder), "gfxrepro: no command; see 'gfxrepro --help'\n");
}

TEST_F(Usage, TextsAreAsWideAsTheTerminal) {
    for (const std::size_t columns : {72U, 100U}) {
        const std::string command = "stty cols " + std::to_string(columns) +
                                    "; '" GFXREPRO_PROGRAM "' describe voxelization";
        const ProcessResult shown = runProgram({"/usr/bin/script", "-qec", command, "/dev/null"});
        std::istringstream lines(shown.out);
        std::size_t longest = 0;
        for (std::string line; std::getline(lines, line);) {
            const auto isBegin = [](char c) { return (c & 0xC0) != 0x80 && c != '\r'; };
            longest =
                std::max(longest, static_cast<std::size_t>(std::ranges::count_if(line, isBegin)));
        }
        EXPECT_LE(longest, columns);
        EXPECT_GT(longest, columns - 15);
    }
}

TEST_F(Usage, UnknownOption) {
    EXPECT_EQ(refusal({"run", "--jbos", "2", "x.yaml"}, folder),
              "gfxrepro: run: unknown option '--jbos'; did you mean '--jobs'?; see 'gfxrepro help "
              "run'\n");
    EXPECT_EQ(refusal({"--verbose"}, folder),
              "gfxrepro: unknown option '--verbose'; see 'gfxrepro --help'\n");
    EXPECT_EQ(refusal({"image", "crop", "--force"}, folder),
              "gfxrepro: crop: unknown option '--force'; see 'gfxrepro help image crop'\n");
}

TEST_F(Usage, MissingConfig) {
    const std::string missing = (folder.path() / "none.yaml").string();
    EXPECT_EQ(refusal({"check", missing}, folder),
              "gfxrepro: cannot read DIR/none.yaml: No such file or directory\n");
}

TEST_F(Usage, WhatIsNotGivenIsNamedWithAnExample) {
    EXPECT_EQ(refusal({"check"}, folder),
              "gfxrepro: check: CONFIG is missing: config files; for example: gfxrepro check "
              "my-scene.yaml\n");
    EXPECT_EQ(refusal({"plan"}, folder),
              "gfxrepro: plan: TABLE is missing: PAPER, PAPER/TABLE or config files; for example: "
              "gfxrepro plan my-scene.yaml --profile quick\n");
}

TEST_F(Usage, VoxelsThatCannotBeWritten) {
    const std::string model = folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const auto refused = [&](const std::string& scene, const std::string& out,
                             const std::vector<std::string>& more = {}) {
        std::vector<std::string> arguments = {"voxelize", scene, "--out", out};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return refusal(arguments, folder);
    };
    const std::string dir = folder.path();
    EXPECT_EQ(refused(model, dir + "/m.stl"),
              "gfxrepro: DIR/m.stl: .npy, .vox and .binvox are allowed\n");
    EXPECT_EQ(refused(model, model),
              "gfxrepro: --out DIR/a.obj is the input DIR/a.obj; allowed: another file\n");
    EXPECT_EQ(refused(model, dir + "/m.vox", {"--resolution", "512"}),
              "gfxrepro: DIR/m.vox: a .vox file has up to 256 voxels along an axis, and the grid "
              "512; allowed: .npy and .binvox\n");
    EXPECT_EQ(refused(model, dir + "/m.npy", {"--resolution", "50000"}),
              "gfxrepro: voxelize: resolution is 50000; allowed: 1 … 16384 voxels\n");
    EXPECT_EQ(refused(model, dir + "/m.npy", {"--fill", "liquid"}),
              "gfxrepro: voxelize: fill is liquid; allowed: surface | solid\n");
    EXPECT_EQ(refused(dir + "/none.obj", dir + "/m.npy"),
              "gfxrepro: scene file 'DIR/none.obj' is not there; looked at DIR/none.obj\n");
    EXPECT_EQ(refused(folder.write("p.xyz", "0 0 0\n1 1 1\n"), dir + "/m.npy"),
              "gfxrepro: scene 'DIR/p.xyz' has no triangles, but 2 points; allowed to voxelize: "
              "triangles that reach from one point to another\n");
    EXPECT_EQ(refused(model, model + "/m.npy", {"--resolution", "32"}),
              "gfxrepro: cannot create DIR/a.obj: Not a directory\n");
}

TEST_F(Usage, BadKeyHasItsPlace) {
    const std::string config = folder.write("bad.yaml",
                                            "sweep_of: bad\ntitle: Bad\ntechnique: template\n"
                                            "params: {brightnes: 1}\n");
    EXPECT_EQ(refusal({"check", config}, folder).substr(0, 33),
              "gfxrepro: DIR/bad.yaml:4:10: tech");
}

TEST_F(Usage, UnknownTechniqueAndScene) {
    const std::string technique =
        folder.write("technique.yaml", "sweep_of: bad\ntitle: Bad\ntechnique: templat\n");
    EXPECT_THAT(refusal({"check", technique}, folder),
                HasSubstr("unknown technique 'templat'; did you mean 'template'?"));
    const std::string scene = folder.write(
        "scene.yaml", "sweep_of: bad\ntitle: Bad\ntechnique: template\nscene: shapes/tours\n");
    EXPECT_THAT(
        refusal({"check", scene}, folder),
        HasSubstr("scene.yaml:4:8: unknown scene 'shapes/tours'; did you mean 'shapes/torus'?"));
}

TEST_F(Usage, CheckHoldsPrintAgainstWhatThereIs) {
    const auto errorOf = [&](const std::string& row) {
        const std::string config = folder.write(
            "t.yaml",
            "table: p/1\ntitle: T\ntechnique: voxelization\nscene: shapes/torus\n"
            "sweep: {resolution: [32, 64]}\nprofiles: {paper: {sweep: {resolution: [128]}}}\n"
            "layout: {rows: resolution, columns: {voxels: {metric: voxels}}}\n"
            "printed:\n  values: |\n    resolution,voxels\n    " +
                row + "\nclaims:\n  C: {says: s, bound: voxels, at_least: 1}\n");
        const ProcessResult result = gfxrepro({"check", config});
        const std::size_t at = result.err.find("t.yaml:");
        return at == std::string::npos ? result.err : result.err.substr(at);
    };
    EXPECT_EQ(errorOf("128,12"), "");
    EXPECT_EQ(errorOf("182,12"),
              "t.yaml:11: printed: no profile measures the row '182,12'; allowed: resolution 32 | "
              "64 | 128\n");
    EXPECT_EQ(errorOf("128,12x8"),
              "t.yaml:11: printed: voxels is '12x8'; allowed: as the cell's format writes numbers, "
              "or empty where it is lost\n");
}

/// Files that a table extends have profiles, values that it sweeps and scenes that it lacks.
TEST_F(Usage, DescribeMergedPrintsOneFileOfTheSamePlan) {
    EXPECT_THAT(
        gfxrepro({"describe", "xie2017/10"}).out,
        HasSubstr("\ncolumns    intensity_mean_non_redundant, intensity_mean_conventional, "))
        << "which claims may name";
    const ProcessResult merged = endedWith(0, gfxrepro({"describe", "xie2017/10", "--merged"}));
    EXPECT_THAT(merged.out, Not(HasSubstr("extends:")));
    EXPECT_EQ(merged.out.find("# table-10.yaml with all that it extends\ntable: xie2017/10\n"), 0u);
    const std::string file = folder.write("merged.yaml", merged.out);
    std::vector<std::string> tables, files;
    const fs::path configs = GFXREPRO_CONFIGS;
    for (const config::Document& document : config::readDocuments(configs / "documents.yaml")) {
        for (const auto& entry : fs::directory_iterator(configs / document.id)) {
            if (entry.path().extension() != ".yaml") continue;
            tables.push_back(entry.path());
            const std::string out = gfxrepro({"describe", tables.back(), "--merged"}).out;
            files.push_back(folder.write("merged" + std::to_string(files.size()) + ".yaml", out));
        }
    }
    ASSERT_GT(tables.size(), 100U);
    std::vector<std::string> check = files;
    check.insert(check.begin(), "check");
    endedWith(0, gfxrepro(check));
    for (const char* profile : {"quick", "full", "paper"}) {
        // What is measured: ids follow from the order of keys, too.
        const auto planOf = [&](std::vector<std::string> command) {
            command.insert(command.begin(), "plan");
            command.insert(command.end(), {"--profile", profile, "--json", "--device", "software"});
            const ProcessResult plan = endedWith(0, gfxrepro(command));
            std::vector<std::string> cases;
            if (plan.exitCode != 0) return cases;
            for (const auto& one : nlohmann::json::parse(plan.out).at("cases")) {
                cases.push_back(one.at("experiment").dump() + one.at("params").dump());
            }
            std::ranges::sort(cases);
            return cases;
        };
        EXPECT_EQ(planOf(files), planOf(tables)) << profile;
    }
    const auto body = [](const std::string& text) { return text.substr(text.find('\n')); };
    EXPECT_EQ(body(gfxrepro({"describe", file, "--merged"}).out), body(merged.out));
    EXPECT_EQ(refusal({"describe", "xie2017/100", "--merged"}, folder),
              "gfxrepro: describe: no table or file is called 'xie2017/100'; did you mean "
              "'xie2017/10'?; --merged is for these alone\n");
}

TEST_F(Usage, UnknownPaperAndKind) {
    EXPECT_EQ(refusal({"reproduce", "zju2006/2.1"}, folder),
              "gfxrepro: unknown paper or table 'zju2006/2.1'; did you mean 'zju2005/2.1'?; "
              "'gfxrepro list tables' shows all\n");
    EXPECT_EQ(refusal({"list", "scene"}, folder),
              "gfxrepro: list: unknown kind 'scene'; did you mean 'scenes'?; known: configs, "
              "generators, runs, scenes, tables, techniques\n");
}

TEST_F(Usage, RunWantsConfigsOrARun) {
    EXPECT_EQ(refusal({"run"}, folder),
              "gfxrepro: run: give PAPER, PAPER/TABLE or config files, or --resume RUN\n");
    EXPECT_EQ(refusal({"table", folder.path()}, folder),
              "gfxrepro: DIR: is not a run directory (it has no plan.json)\n");
}

// What `reproduce` is for on a machine that has nobody's scans.
TEST_F(Usage, EveryTableOfThePapersNeedsNoRealModel) {
    for (const char* profile : {"quick", "paper"}) {
        std::vector<std::string> arguments = {"check", "--assets", folder.path(), "--profile",
                                              profile};
        const fs::path configs = GFXREPRO_CONFIGS;
        for (const config::Document& document : config::readDocuments(configs / "documents.yaml")) {
            for (const auto& file : fs::directory_iterator(configs / document.id)) {
                if (file.path().extension() == ".yaml") arguments.push_back(file.path());
            }
        }
        ASSERT_GT(arguments.size(), 80U);
        endedWith(0, gfxrepro(arguments));
    }
}

// The rows of the thesis that compare methods stay unseen, whichever cell a calibration names.
TEST_F(Usage, CalibrationsCannotReadWhatComparesMethods) {
    const auto errorOf = [&](const std::string& target) {
        const std::string preset =
            target.starts_with("intensity") ? "soft-shadows" : "depth-sampling";
        const std::string config = folder.write(
            "c.yaml", "sweep_of: c\ntitle: T\nextends: [presets/" + preset +
                          "-calibration.yaml]\n"
                          "scene: outdoor/bird_nest\nlayout: {rows: " +
                          (preset == "depth-sampling" ? "[scene, resolution]" : "scene") +
                          "}\nfit:\n  " + target + "\n");
        return refusal({"check", config}, folder);
    };
    const std::string scene = "scene: outdoor/bird_nest}, column: ";
    const std::string lit = "scene: outdoor/bird_nest, light_ratio: 1}, column: intensity_mean_";
    const std::string refused = "the cases of 'conventional'; a fit sees what compares no methods";
    for (const char* method : {"non_redundant", "depth_peeling"}) {
        const std::string name = method;
        for (const std::string& target :
             {"pixel_image_1: {table: xie2017/table-2.yaml, row: {measure: " + name +
                  "_occluded, " + scene + "image_1}",
              "pixel_avg: {table: xie2017/table-4.yaml, row: {" + scene + name + "_avg}",
              "visibility_image_2: {table: xie2017/table-5.yaml, row: {measure: " + name +
                  "_useful, " + scene + "image_2}",
              "visibility_min: {table: xie2017/table-6.yaml, row: {" + scene + name + "_min}",
              "intensity_one: {table: xie2017/table-10.yaml, row: {" + lit + name + "}"}) {
            const std::string error = errorOf(target);
            EXPECT_THAT(error,
                        HasSubstr("the printed cell is of method '" + name + "', " + refused));
            const std::string measured = errorOf(target + "\nparams: {method: " + name + "}");
            EXPECT_THAT(measured, HasSubstr("compares method '" + name + "' with a usual one"));
        }
    }
}

TEST_F(Usage, DescribeSaysWhatItCannot) {
    EXPECT_EQ(refusal({"describe"}, folder),
              "gfxrepro: describe: say what; see 'gfxrepro describe --help'\n");
    EXPECT_EQ(refusal({"describe", "--json-schema", "table"}, folder),
              "gfxrepro: schema 'table'; allowed: experiment, preset, scene, documents\n");
    EXPECT_EQ(refusal({"describe", "--markdown", "voxelization"}, folder),
              "gfxrepro: describe: --markdown is for 'config' alone\n");
    // The name of a command is not taken for one.
    EXPECT_EQ(gfxrepro({"describe", "--json-schema", "scene"}).exitCode, 0);
}

TEST_F(Usage, DescribeListsMetricsAndPassesOnAScreen) {
    for (const char* technique : {"voxelization", "soft_shadows", "point_splatting"}) {
        const std::string text = gfxrepro({"describe", technique}).out;
        std::istringstream lines(text);
        for (std::string line; std::getline(lines, line);) {
            const auto columns =
                std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xC0) != 0x80; });
            EXPECT_LE(columns, 80) << line;
        }
        EXPECT_THAT(text, HasSubstr("\nmetrics\n"));
        EXPECT_THAT(text, HasSubstr("\npasses"));
    }
    EXPECT_THAT(
        gfxrepro({"describe", "voxelization"}).out,
        HasSubstr("  memory_bytes              memory of mesh, fragments and worksheets on the\n"));
}

/// "of the mesh" asks a reader to begin the sentence with the metric's name.
TEST_F(Usage, MetricsSayInWordsOfTheirOwnWhatTheyAre) {
    for (const char* technique :
         {"voxelization", "point_splatting", "shadow_mapping", "depth_sampling", "soft_shadows",
          "clustered_reflections", "reflection_reuse", "terrain_tessellation"}) {
        std::string text = gfxrepro({"describe", technique}).out;
        text.erase(text.find("\npasses"), text.find("\nmetrics of every") - text.find("\npasses"));
        text.erase(0, text.find("\nmetrics\n"));
        static const std::regex kMetric("\n  (\\w+)\\s+([^\n]+)");
        int count = 0;
        for (std::sregex_iterator metric(text.begin(), text.end(), kMetric), end; metric != end;
             ++metric, ++count) {
            const std::string doc = (*metric)[2];
            for (const char* begin : {"of the ", "of a ", "that ", "whose ", "likewise", "with ",
                                      "within ", "less ", "a frame,", "a pass"}) {
                EXPECT_FALSE(doc.starts_with(begin))
                    << technique << ' ' << (*metric)[1] << ": " << doc;
            }
        }
        EXPECT_GT(count, 20) << text;
    }
}

TEST_F(Usage, HelpAndVersionAreCommandsToo) {
    EXPECT_EQ(gfxrepro({"help"}).out, gfxrepro({"--help"}).out);
    EXPECT_EQ(gfxrepro({"help", "image", "diff"}).out, gfxrepro({"image", "diff", "--help"}).out);
    EXPECT_EQ(refusal({"help", "reprodcue"}, TemporaryFolder()),
              "gfxrepro: unknown command 'reprodcue'; did you mean 'reproduce'?; see 'gfxrepro "
              "--help'\n");
    EXPECT_EQ(gfxrepro({"version"}).out, gfxrepro({"--version"}).out);
    EXPECT_THAT(gfxrepro({"--version"}).out,
                MatchesRegex("gfxrepro [0-9]+\\.[0-9]+\\.[0-9]+ \\(commit [^ ]+\\)\n"));
}

TEST_F(Usage, TablesAndCasesAreChosenByPatterns) {
    const auto count = [](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "plan");
        arguments.insert(arguments.end(), {"--json", "--device", "software"});
        const ProcessResult result = endedWith(0, gfxrepro(arguments));
        return nlohmann::json::parse(result.out)["cases"].size();
    };
    EXPECT_EQ(count({"zju2005/table-4.?"}),
              count({"zju2005/table-4.1", "zju2005/table-4.2", "zju2005/table-4.3"}));
    const std::string config = folder.write(
        "a.yml", "sweep_of: a\ntitle: A\ntechnique: template\nsweep: {brightness: [0, 0.5, 1]}\n");
    EXPECT_EQ(count({config}), 3U);
    EXPECT_EQ(count({config, "--only", "brightness=0|1.0"}), 2U);
    EXPECT_EQ(count({config, "--only", "brightness=[0, 0.5]"}), 2U);
    EXPECT_EQ(count({config, "--only", "brightness=0*"}), 2U);
}

}  // namespace
}  // namespace gfxrepro::test
