// An experiment of who writes five lines: what they give, and what check says of them.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "engine/core/files.h"
#include "engine/image/png_io.h"
#include "runner/records/images.h"
#include "runner/tables/labels.h"
#include "tests/cli/cli_support.h"
#include "tests/support/grid.h"

namespace gfxrepro::test {
namespace {

/// The processes of the rows that are no controls.
std::set<int> processesOf(const std::vector<records::Record>& rows) {
    std::set<int> processes;
    for (const records::Record& row : rows) {
        if (row.process >= 0) processes.insert(row.process);
        EXPECT_EQ(row.lane, "timing");
    }
    return processes;
}

using OwnExperiment = FolderTest;

TEST_F(OwnExperiment, AFewLinesGiveTimesPicturesAndACurve) {
    const std::string config =
        folder.write("mine.yaml",
                     "sweep_of: mine\ntitle: Mine at three\ntechnique: template\n"
                     "sweep: {brightness: [0.25, 0.5, 1]}\n");
    const fs::path dir = folder.path() / "run";
    endedWith(0, gfxrepro({"reproduce", config, "--device", "software", "--out", dir.string()}));
    EXPECT_EQ(processesOf(rowsOf(dir, "wall_time_ms")), (std::set{0, 1, 2, 3, 4, 5}));
    const std::string table = readFile(dir / "tables" / "sweep-mine.csv");
    EXPECT_TRUE(table.starts_with("brightness,frame_ms_measured")) << table;
    const std::string page = readFile(dir / "report.html");
    EXPECT_THAT(page, HasSubstr("<title>gfxrepro: Mine at three</title>"));
    EXPECT_THAT(page, HasSubstr("<h1 tabindex=\"-1\">Mine at three</h1>"));
    EXPECT_THAT(page, HasSubstr("<figcaption>brightness 0.25: result</figcaption>"));
    EXPECT_THAT(page, Not(HasSubstr("ambiguous</span>")));
    EXPECT_LT(page.find("id=\"sweep-mine\""), page.find("id=\"overview\""));
    EXPECT_THAT(page, HasSubstr("<figure class=\"curve\"><svg"));
    EXPECT_THAT(page, HasSubstr("Times over brightness (lower is better)"));
}

/// An experiment of five lines: the technique, its scene, and what is swept.
struct FiveLines {
    const char* technique;
    const char* scene;
    const char* swept;  // the parameter
    const char* values;
    std::vector<std::string> smaller = {};  // --set, so that a test can wait for it
};

class OwnExperimentOf : public testing::TestWithParam<FiveLines> {};

/// What a stranger gets of each technique, the map of a mountain of their own among them.
TEST_P(OwnExperimentOf, FiveLinesGivesTimesPicturesAndACurve) {
    const FiveLines& lines = GetParam();
    const TemporaryFolder folder;
    image::Image16 heights(65, 65, 1);
    for (const auto [y, x] : test::grid(65, 65)) {
        const int rim = std::min({x, y, 64 - x, 64 - y});
        heights.at(x, y) = static_cast<std::uint16_t>(400 * rim);
    }
    image::writePng(folder.path() / "mountain.png", heights);
    const std::string config = folder.write(
        "mine.yaml",
        fmt::format("sweep_of: mine\ntitle: Mine\ntechnique: {}\nscene: {}\nsweep: {{{}: {}}}\n",
                    lines.technique, lines.scene, lines.swept, lines.values));
    const fs::path dir = folder.path() / "run";
    std::vector<std::string> command = {"reproduce", config, "--device", "software", "--out", dir};
    std::vector<std::string> sets = {"output.width=48", "output.height=32",
                                     "measure.time_budget_s=1"};
    sets.insert(sets.end(), lines.smaller.begin(), lines.smaller.end());
    for (const std::string& set : sets) command.insert(command.end(), {"--set", set});
    endedWith(0, gfxrepro(command));
    EXPECT_GE(processesOf(rowsOf(dir, "wall_time_ms")).size(), 1u);
    const std::string table = readFile(dir / "tables" / "sweep-mine.csv");
    EXPECT_TRUE(table.starts_with(std::string(lines.swept) + ",")) << table.substr(0, 80);
    EXPECT_THAT(table, Not(HasSubstr("ambiguous")));
    std::set<std::string> pictured;
    for (const records::ImageEntry& image : records::readImages(dir)) pictured.insert(image.caseId);
    EXPECT_EQ(pictured.size(), 2u) << "a picture of every row";
    const std::string page = readFile(dir / "report.html");
    EXPECT_THAT(page, HasSubstr("<h1 tabindex=\"-1\">Mine</h1>"));
    EXPECT_THAT(page, HasSubstr("<figure class=\"curve\"><svg"));
    EXPECT_THAT(page, HasSubstr("Times over " + tables::quantityOf(lines.swept).words));
}

const FiveLines kFiveLines[] = {
    {"voxelization", "shapes/torus", "resolution", "[32, 64]"},
    {"depth_sampling", "shapes/torus", "view_spread", "[0.1, 0.5]"},
    {"point_splatting", "shapes/torus", "target_radius_px", "[0.6, 2]", {"points=20000"}},
    {"shadow_mapping", "shapes/torus", "shadow_map_size", "[64, 256]"},
    {"soft_shadows", "shapes/torus", "light_ratio", "[0.25, 1]", {"light_grid=2"}},
    {"clustered_reflections", "indoor/bathroom", "bin_gain", "[1, 4]", {"supersampling=1"}},
    {"reflection_reuse", "indoor/bathroom", "threshold", "[0, 1]"},
    {"terrain_tessellation", "mountain.png", "delta_s", "[2, 8]", {"cache=false"}},
};
INSTANTIATE_TEST_SUITE_P(Each, OwnExperimentOf, testing::ValuesIn(kFiveLines),
                         [](const auto& each) { return std::string(each.param.technique); });

TEST_F(OwnExperiment, WhatIsSaidOfAModelIsSaidOnce) {
    folder.write("m.obj",
                 "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nl 1 2\nf 1 3 2\nf 1 2 4\nf 1 4 3\n"
                 "f 2 3 4\n");
    const auto config = [&](const std::string& name) {
        return folder
            .write(name + ".yaml", "sweep_of: " + name +
                                       "\ntitle: T\ntechnique: voxelization\n"
                                       "sweep: {scene: [m.obj, 'm.obj?up=z']}\n")
            .string();
    };
    const std::string a = config("a"), b = config("b");
    const std::string said =
        "warning: " + (folder.path() / "m.obj").string() + ": left out: the line 'l'\n";
    for (const char* command : {"check", "plan"}) {
        const std::string err = endedWith(0, gfxrepro({command, a, b, "--device", "software"})).err;
        EXPECT_THAT(err, HasSubstr(said)) << command;
        EXPECT_EQ(err.find(said), err.rfind(said)) << command;
    }
}

TEST_F(OwnExperiment, RoundsOfWhoNamesNoLaneEndWithTheirBudget) {
    const std::string config =
        folder.write("mine.yaml",
                     "sweep_of: mine\ntitle: T\ntechnique: mock\nparams: {pause_ms: 300}\n"
                     "measure: {time_budget_s: 1}\n");
    const fs::path dir = folder.path() / "run";
    endedWith(0, mockGfxrepro({"run", config, "--out", dir.string()}));
    EXPECT_EQ(processesOf(rowsOf(dir, "wall_time_ms")), std::set{0});
    EXPECT_THAT(readFile(dir / "journal.jsonl"), HasSubstr("\"ended_by\":\"time_budget_s\""));
}

TEST_F(OwnExperiment, LatestIsTheNewestAndRunsAreListed) {
    const std::string config = writeMockConfig(folder, "");
    const auto inFolder = [&](const std::string& words) {
        return shell("cd '" + folder.path().string() + "' && '" + GFXREPRO_MOCK_PROGRAM + "' " +
                     words);
    };
    EXPECT_THAT(inFolder("table latest").err, HasSubstr("latest: there is no run in runs/"));
    for (const char* name : {"runs/20260101-a", "runs/20260102-b"}) {
        ASSERT_EQ(inFolder("run mock.yaml --device software --out " + std::string(name)).exitCode,
                  0);
    }
    EXPECT_EQ(inFolder("table latest").exitCode, 0);
    EXPECT_TRUE(fs::exists(folder.path() / "runs/20260102-b/tables/sweep-mock.csv"));
    EXPECT_FALSE(fs::exists(folder.path() / "runs/20260101-a/tables"));
    const std::string listed = inFolder("list runs").out;
    EXPECT_THAT(listed, HasSubstr("runs/20260101-a  gfxrepro run mock.yaml"));
    EXPECT_LT(listed.find("20260101-a"), listed.find("20260102-b"));
    folder.write("runs/20260103-c/plan.json", "{}");
    folder.write("runs/20260103-c/manifest.json", "{\"x\": " + std::string(300, '['));
    folder.write("runs/20260104-d/plan.json", "{}");
    fs::create_symlink("/etc/passwd", folder.path() / "runs/20260104-d/manifest.json");
    folder.write("runs/20260105-e/plan.json", "{}");
    const std::string others = inFolder("list runs").out;
    EXPECT_THAT(others,
                HasSubstr("runs/20260103-c  runs/20260103-c/manifest.json: is nested deeper than "
                          "200 levels\nruns/20260104-d  runs/20260104-d/manifest.json: a link, a "
                          "pipe or a device, which a run folder does not hold\n"
                          "runs/20260105-e  not begun\n"));
}

/// What check says of a config with these lines and a file beside it.
std::string checked(const TemporaryFolder& folder, const std::string& lines) {
    const std::string head = "sweep_of: mine\ntitle: Mine\n";
    return refusalOf(gfxrepro({"check", folder.write("mine.yaml", head + lines)}), folder);
}

TEST_F(OwnExperiment, CheckFindsWhatARunWouldFailBy) {
    folder.write("model.glb", "no model");
    folder.write("model.fbx", "no model");
    const std::string voxels = "technique: voxelization\n";
    const std::string terrain = "technique: terrain_tessellation\n";
    EXPECT_EQ(
        checked(folder, voxels),
        "gfxrepro: DIR/mine.yaml:3:12: technique 'voxelization' needs a scene: `scene:` with a "
        "name of `gfxrepro list scenes`, or a model (.glb, .gltf, .obj, .ply) beside this file\n");
    EXPECT_THAT(checked(folder, voxels + "scene: model.fbx\n"),
                HasSubstr("mine.yaml:4:8: scene file DIR/model.fbx: unknown extension '.fbx'"));
    EXPECT_THAT(checked(folder, voxels + "scene: model.glb\n"), HasSubstr("mine.yaml:4:8: "));
    EXPECT_THAT(checked(folder, terrain + "scene: model.glb\n"),
                HasSubstr("model.glb' is a model; technique 'terrain_tessellation' takes a height "
                          "map (.png, .tif, .hgt, .raw)"));
    folder.write("map.png", "no picture");
    EXPECT_THAT(checked(folder, terrain + "scene: map.png\nscene_params: {spacing: 2}\n"),
                HasSubstr("has no parameter 'spacing'; did you mean 'spacing_m'?"));
    EXPECT_THAT(checked(folder, terrain + "scene: map.png\n"), HasSubstr("mine.yaml:4:8: "));
    EXPECT_THAT(checked(folder, voxels + "scene: map.png\n"),
                HasSubstr("map.png' is a height map"));
    EXPECT_EQ(checked(folder, voxels + "scene: shapes/torus\nparams: {resolution: 64}\n"
                                       "sweep: {resolution: [32, 64]}\n"),
              "gfxrepro: DIR/mine.yaml:5:22: 'resolution' is swept, too, in DIR/mine.yaml:6:9; "
              "allowed: in 'params' or in 'sweep'\n");
}

TEST_F(OwnExperiment, CheckFindsWhatIsBothFixedAndSweptInEveryFormOfASweep) {
    const std::string scene = "technique: voxelization\nscene: shapes/torus\n";
    const std::string allowed = "allowed: in 'params' or in 'sweep'\n";
    EXPECT_EQ(checked(folder, scene + "params: {resolution: 64}\n"
                                      "sweep: {zip: [{resolution: [32, 64], voxel_bits: [1, 8]}]}"),
              "gfxrepro: DIR/mine.yaml:5:22: 'resolution' is swept, too, in DIR/mine.yaml:6:16; " +
                  allowed);
    EXPECT_EQ(checked(folder, scene + "params: {resolution: 64}\n"
                                      "sweep: {list: [[{resolution: 32}, {resolution: 128}]]}"),
              "gfxrepro: DIR/mine.yaml:5:22: 'resolution' is swept, too, in DIR/mine.yaml:6:18; " +
                  allowed);
    EXPECT_EQ(checked(folder,
                      "technique: soft_shadows\nscene: outdoor/city\n"
                      "scene_params: {building_height: 2}\nsweep: {scene.building_height: [1, 2]}"),
              "gfxrepro: DIR/mine.yaml:5:33: 'scene.building_height' is swept, too, in "
              "DIR/mine.yaml:6:9; allowed: in 'scene_params' or in 'sweep'\n");
    EXPECT_EQ(checked(folder, scene + "output: {width: 64}\nsweep: {output.width: [32, 64]}"),
              "gfxrepro: DIR/mine.yaml:5:17: 'output.width' is swept, too, in DIR/mine.yaml:6:9; "
              "allowed: in 'output' or in 'sweep'\n");
    EXPECT_EQ(checked(folder, scene + "sweep: {scene: [shapes/torus, shapes/sphere]}"),
              "gfxrepro: DIR/mine.yaml:4:8: 'scene' is swept, too, in DIR/mine.yaml:5:9; allowed: "
              "in 'scene' or in 'sweep'\n");
    folder.write("preset.yaml", "sweep: {resolution: [32, 64]}\n");
    EXPECT_EQ(checked(folder, "extends: preset.yaml\n" + scene + "params: {resolution: 64}\n"),
              "gfxrepro: DIR/mine.yaml:6:22: 'resolution' is swept, too, in DIR/preset.yaml:1:9; " +
                  allowed);
}

TEST_F(OwnExperiment, CheckFindsWhatASceneReferenceOrAProfileFixesAndTheFileSweeps) {
    EXPECT_EQ(checked(folder,
                      "technique: soft_shadows\nscene: outdoor/city?building_height=2\n"
                      "sweep: {scene.building_height: [1, 2]}"),
              "gfxrepro: DIR/mine.yaml:4:8: 'scene.building_height' is swept, too, in "
              "DIR/mine.yaml:5:9; allowed: in 'scene' or in 'sweep'\n");
    EXPECT_EQ(checked(folder,
                      "technique: voxelization\nscene: shapes/torus\n"
                      "sweep: {resolution: [32, 64]}\n"
                      "profiles: {quick: {params: {resolution: 64}}}"),
              "gfxrepro: DIR/mine.yaml:6:41: 'resolution' is swept, too, in DIR/mine.yaml:5:9; "
              "allowed: in 'params' or in 'sweep'\n");
}

/// Stands at `name`: 17 × 17 samples that rise by `step` a column.
void writeRamp(const TemporaryFolder& folder, const std::string& name, int step) {
    image::Image16 heights(17, 17, 1);
    for (const auto [y, x] : test::grid(17, 17))
        heights.at(x, y, 0) = static_cast<std::uint16_t>(x * step);
    image::writePng(folder.path() / name, heights);
}

TEST_F(OwnExperiment, HeightsThatStandAsSpikesAreSaidBeforeTheyAreMeasured) {
    writeRamp(folder, "steep.png", 100);
    const std::string head =
        "sweep_of: mine\ntitle: Mine\ntechnique: terrain_tessellation\n"
        "scene: steep.png\noutput: {width: 32, height: 32}\n"
        "params: {cache: false}\nmeasure: {lane: quality}\n";
    const std::string config = folder.write("mine.yaml", head);
    const std::string warning =
        "steep.png: heights from 0 to 1600 m over 16 m of ground (17 x 17 samples, 1 m apart) look "
        "like spikes; `scene_params: {spacing_m: …, height_scale_m: …}` says how far its samples "
        "stand apart and how many metres a value is\n";
    const ProcessResult check = endedWith(0, gfxrepro({"check", config}));
    EXPECT_THAT(check.err, HasSubstr(warning));
    const std::string dir = (folder.path() / "run").string();
    const ProcessResult run =
        endedWith(0, gfxrepro({"run", config, "--device", "software", "--out", dir}));
    EXPECT_THAT(run.err, HasSubstr(warning));
    EXPECT_EQ(run.err.find("look like spikes"), run.err.rfind("look like spikes")) << run.err;
    EXPECT_THAT(readFile(dir + "/manifest.json"), HasSubstr("steep.png': heights from 0 to 1600"));
    const std::string flat =
        folder.write("flat.yaml", head + "scene_params: {spacing_m: 30, height_scale_m: 0.1}\n");
    EXPECT_EQ(gfxrepro({"check", flat}).err, "");
    const ProcessResult shown =
        endedWith(0, gfxrepro({"scene", (folder.path() / "steep.png").string()}));
    EXPECT_THAT(shown.out, HasSubstr("heights    17 x 17 samples, 1 m apart, 0 filled"));
    EXPECT_THAT(shown.out, HasSubstr("warning    heights from 0 to 1600 m"));
}

TEST_F(OwnExperiment, CheckLooksForASecondModelBesideTheFile) {
    const std::string voxels = "technique: voxelization\nscene: shapes/torus\n";
    EXPECT_THAT(checked(folder, voxels + "params: {csg: union, scene_b: none.obj}\n"),
                AllOf(HasSubstr("mine.yaml:5:31: "), HasSubstr("none.obj")));
    EXPECT_THAT(checked(folder, voxels + "params: {csg: union, scene_b: models/none}\n"),
                HasSubstr("models/none"));
    folder.write("second.obj", "v 0 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 3\n");
    const std::string config = folder.write(
        "mine.yaml", "sweep_of: mine\ntitle: Mine\n" + voxels +
                         "params: {csg: union, scene_b: second.obj, resolution: 32}\n");
    EXPECT_EQ(gfxrepro({"check", config}).exitCode, 0);
}

TEST_F(OwnExperiment, ARunDoesNotGoOnWithAnotherSecondModel) {
    const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 3\n";
    folder.write("second.obj", triangle);
    const std::string config =
        folder.write("mine.yaml",
                     "sweep_of: mine\ntitle: Mine\ntechnique: voxelization\nscene: shapes/torus\n"
                     "params: {csg: union, scene_b: second.obj, resolution: 32}\n"
                     "measure: {lane: quality}\n");
    const std::string dir = (folder.path() / "run").string();
    const ProcessResult run =
        endedWith(0, gfxrepro({"run", config, "--device", "software", "--out", dir}));
    folder.write("second.obj", "v 0 0 0.5\n" + triangle);
    const ProcessResult other = gfxrepro({"run", "--resume", dir});
    EXPECT_NE(other.exitCode, 0);
    EXPECT_THAT(other.err, HasSubstr("second.obj' changed"));
    folder.write("second.obj", triangle);
    endedWith(0, gfxrepro({"run", "--resume", dir}));
}

TEST_F(OwnExperiment, CheckAsksTheTechniqueWhetherItTakesTheScene) {
    folder.write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 1\np 1 2 3\n");
    folder.write("rough.obj", "v 0 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 3\n");
    EXPECT_THAT(checked(folder, "technique: voxelization\nscene: points.obj\n"),
                AllOf(HasSubstr("mine.yaml:4:8: "),
                      HasSubstr("has no triangles, but 3 points; allowed to voxelize: triangles")));
    EXPECT_THAT(checked(folder, "technique: soft_shadows\nscene: points.obj\n"),
                HasSubstr("mine.yaml:4:8: technique 'soft_shadows' needs a scene with triangles, "
                          "and this one has 3 points\n"));
    const auto isTaken = [&](const std::string& lines) {
        const std::string head = "sweep_of: taken\ntitle: Taken\n";
        return gfxrepro({"check", folder.write("taken.yaml", head + lines)}).exitCode == 0;
    };
    EXPECT_TRUE(isTaken("technique: point_splatting\nscene: points.obj\n"));
    const std::string points = (folder.path() / "points.obj").string();
    const std::string picture = (folder.path() / "points.png").string();
    EXPECT_EQ(endedWith(2, gfxrepro({"scene", points, "--render", picture})).err,
              "gfxrepro: --render " + picture + ": " + points +
                  " has 3 points and no triangles; allowed to draw: triangles\n");
    EXPECT_FALSE(fs::exists(picture));
    EXPECT_THAT(checked(folder,
                        "technique: voxelization\nscene: shapes/torus\n"
                        "params: {csg: union, scene_b: points.obj, resolution: 32}\n"),
                AllOf(HasSubstr("mine.yaml:5:31: "), HasSubstr("no triangles, but 3 points")));
    EXPECT_THAT(checked(folder,
                        "technique: shadow_mapping\nscene: rough.obj\n"
                        "params: {light_place: scene}\n"),
                HasSubstr("mine.yaml:4:8: 'light_place: scene' with 1 lights: the scene has 0\n"));
    for (const char* scene : {"rough.obj", "shapes/torus"}) {
        const std::string reflections =
            std::string("technique: clustered_reflections\nscene: ") + scene + "\n";
        EXPECT_THAT(checked(folder, reflections),
                    AllOf(HasSubstr("mine.yaml:4:8: scene '"),
                          HasSubstr("has no reflectors: no material's roughness is at most 0.4; "
                                    "'reflector_roughness: 1' takes them all\n")));
        EXPECT_TRUE(isTaken(reflections + "params: {reflector_roughness: 1}\n"));
        EXPECT_THAT(checked(folder, reflections + "params: {reflector_roughness: 1, view: walk}\n"),
                    HasSubstr("mine.yaml:4:8: the scene has no path or camera 'walk'"));
    }
}
TEST_F(OwnExperiment, AFixedValueIsThatOfTheCasesThatASweepLeavesItTo) {
    const std::string config = folder.write(
        "mine.yaml",
        "sweep_of: mine\ntitle: Mine\ntechnique: voxelization\nscene: shapes/torus\n"
        "params: {resolution: 64}\nsweep: {list: [[{resolution: 32}, {voxel_bits: 8}]]}\n");
    EXPECT_EQ(gfxrepro({"check", config}).exitCode, 0);
}

TEST_F(OwnExperiment, ThePageRunsAgainWhatTheRunWasAskedFor) {
    const std::string config = folder.write(
        "mine.yaml", "sweep_of: mine\ntitle: T\ntechnique: template\nmeasure: {lane: quality}\n");
    const std::string dir = folder.path() / "run";
    ASSERT_EQ(
        gfxrepro({"reproduce", config, "--device", "software", "--quiet", "--out", dir, "--set",
                  "measure.repeats=2", "--sweep", "brightness=0.25,1", "--only", "brightness=1"})
            .exitCode,
        0);
    EXPECT_THAT(readFile(dir + "/report.html"),
                HasSubstr("<pre>gfxrepro reproduce " + config +
                          " --profile full --device software --set measure.repeats=2 --sweep "
                          "brightness=0.25,1 --only brightness=1</pre>"));
}

TEST_F(OwnExperiment, CheckSaysHowToNameAParameter) {
    EXPECT_THAT(
        checked(folder,
                "technique: soft_shadows\nscene: shapes/torus\n"
                "sweep: {light_size: [1, 2]}\n"),
        HasSubstr(
            "unknown parameter 'light_size'; of 'light' there are light_ratio, light_height, "
            "light_azimuth_deg, light_elevation_deg, light_view_frame, light_grid, light_views\n"));
    EXPECT_EQ(checked(folder,
                      "technique: clustered_reflections\nscene: shapes/linked_tori\nsweep: "
                      "{method: [clustered, environment_map], bin_exponent: [0.25]}\n"),
              "gfxrepro: DIR/mine.yaml:5:62: 'bin_exponent' needs 'method: clustered'; or `when: "
              "{bin_exponent: {method: clustered}}` in `sweep`, for the cases that have it\n");
}

TEST_F(OwnExperiment, NoTableIsNamedWhereNoCaseHasAResult) {
    const std::string config =
        folder.write("mine.yaml",
                     "sweep_of: mine\ntitle: Mine\ntechnique: voxelization\nscene: shapes/torus\n"
                     "params: {resolution: 1024}\n"
                     "measure: {lane: quality, time_limit_s: 0.001}\n");
    const std::string dir = folder.path() / "run";
    const ProcessResult run = endedWith(
        4, gfxrepro({"reproduce", config, "--device", "software", "--quiet", "--out", dir}));
    EXPECT_FALSE(fs::exists(dir + "/tables"));
    EXPECT_THAT(run.out, Not(HasSubstr("tables: ")));
    EXPECT_THAT(gfxrepro({"table", dir}).out,
                HasSubstr("sweep/mine: no table, for no case has a result\n"));
}

TEST_F(OwnExperiment, AValueOfWhatIsExtendedMayBeSwept) {
    folder.write("base.yaml", "params: {number: 1}\n");
    const fs::path config =
        writeMockConfig(folder, "extends: [base.yaml]\nsweep: {number: [2, 3]}\n");
    const std::string dir = folder.path() / "run";
    endedWith(0, mockGfxrepro({"run", config, "--quiet", "--out", dir}));
    endedWith(0, mockGfxrepro({"table", dir}));  // the plan has both in one document
}

TEST_F(OwnExperiment, CheckKnowsMetricsAndPasses) {
    const std::string head = "technique: voxelization\nscene: shapes/torus\n";
    const auto laidOut = [&](const std::string& column) {
        return checked(folder, head + "layout: {rows: scene, columns: {a: " + column + "}}\n");
    };
    EXPECT_EQ(laidOut("{metric: gpu_tme_ms, pass: draw}"),
              "gfxrepro: DIR/mine.yaml:5:36: technique 'voxelization' has no metric 'gpu_tme_ms'; "
              "did you mean 'gpu_time_ms'?\n");
    EXPECT_EQ(laidOut("{metric: gpu_time_ms, pass: synthesys}"),
              "gfxrepro: DIR/mine.yaml:5:36: technique 'voxelization' has no pass 'synthesys'; did "
              "you mean 'synthesis'?\n");
    EXPECT_EQ(
        laidOut("{metric: wall_time_ms, pass: synthesis}"),
        "gfxrepro: DIR/mine.yaml:5:36: metric 'wall_time_ms' is not taken of a pass; those that "
        "are: gpu_time_ms, cpu_time_ms, process_time_ms, and metrics of the technique\n");
    EXPECT_THAT(laidOut("{metric: voxels}, b: {of: a /}"), HasSubstr("'a /' is no expression"));
    EXPECT_THAT(laidOut("{metric: gpu_time_ms}"),
                HasSubstr("DIR/mine.yaml:5:36: metric 'gpu_time_ms' is of a pass, and the cell "
                          "names none; allowed: with pass: preprocess | "));
    // A picture is no step that takes time, and a step is no picture.
    const auto ofTemplate = [&](const std::string& column) {
        return checked(
            folder, "technique: template\nparams: {errors: true}\nlayout: {columns: {a: " + column +
                        "}}\n");
    };
    EXPECT_EQ(ofTemplate("{metric: cpu_time_ms, pass: result}"),
              "gfxrepro: DIR/mine.yaml:5:23: metric 'cpu_time_ms' is not taken of 'result'; "
              "allowed: draw\n");
    EXPECT_EQ(
        ofTemplate("{metric: rmse, pass: draw}"),
        "gfxrepro: DIR/mine.yaml:5:23: metric 'rmse' is not taken of 'draw'; allowed: result\n");
    EXPECT_EQ(ofTemplate("{metric: cpu_time_ms}"),
              "gfxrepro: DIR/mine.yaml:5:23: metric 'cpu_time_ms' is of a pass, and the cell names "
              "none; allowed: with pass: draw\n");
    EXPECT_EQ(checked(folder,
                      "technique: template\nparams: {errors: true}\nlayout: {columns: {a: {metric: "
                      "cpu_time_ms}}, cell: {pass: result}}\n"),
              "gfxrepro: DIR/mine.yaml:5:23: metric 'cpu_time_ms' is not taken of 'result'; "
              "allowed: draw\n");
    EXPECT_THAT(checked(folder,
                        "technique: template\nparams: {errors: true}\nlayout: {rows: {x: {pass: "
                        "draw}}, columns: {a: {metric: rmse}}}\n"),
                HasSubstr("metric 'rmse' is not taken of 'draw'; allowed: result\n"));
    for (const char* column : {"{metric: cpu_time_ms, pass: draw}", "{metric: rmse, pass: result}",
                               "{metric: wrong_pct, pass: result}"}) {
        const auto good = folder.write(
            "good.yaml",
            std::string(
                "sweep_of: good\ntitle: Good\ntechnique: template\nlayout: {columns: {a: ") +
                column + "}}\n");
        EXPECT_EQ(gfxrepro({"check", good}).err, "") << column;
    }
    const auto curve = folder.write(
        "curve.yaml",
        "sweep_of: curve\ntitle: Time to an error\ntechnique: template\nparams: {errors: true}\n"
        "sweep: {brightness: [0.1, 0.5, 1]}\nmeasure: {lane: timing, processes: 6}\n"
        "layout: {rows: {all: {where: {}}}, columns: {a: {metric: wall_time_ms, equal: {metric: "
        "rmse, is: 0.1}}}}\n");
    EXPECT_EQ(gfxrepro({"check", curve}).err, "") << "of the only picture";
    // What a technique gives of passes alone is known of it.
    for (const auto& [technique, metric] :
         {std::pair("depth_sampling", "coverage_pct"), std::pair("soft_shadows", "missing_pct"),
          std::pair("shadow_mapping", "fetches"), std::pair("point_splatting", "display_psnr_db"),
          std::pair("terrain_tessellation", "edge_jump")}) {
        const std::string of = fmt::format("technique: {}\nscene: outdoor/grass\n", technique);
        const std::string table =
            fmt::format("layout: {{columns: {{a: {{metric: {}}}}}}}\n", metric);
        EXPECT_THAT(checked(folder, of + table),
                    HasSubstr(fmt::format(
                        "metric '{}' is of a pass, and the cell names none; allowed: with pass: ",
                        metric)));
    }
    const std::string computed =
        "layout: {rows: scene, columns: {a: {pass: draw}, b: {of: 2 * a}}, cell: {metric: "
        "gpu_time_ms}}\n";
    const auto file = folder.write("of.yaml", "sweep_of: mine\ntitle: Mine\n" + head + computed);
    EXPECT_EQ(gfxrepro({"check", file}).err, "");
}

/// Cells of no case would be blank, or missing.
TEST_F(OwnExperiment, CheckKnowsCases) {
    const std::string head =
        "technique: voxelization\nscene: shapes/torus\nmeasure: {lane: quality}\n"
        "sweep: {fill: [surface, solid], resolution: [32, 64], exclude: [{fill: solid, resolution: "
        "64}]}\n";
    const auto laidOut = [&](const std::string& columns, const std::string& more = "") {
        return checked(folder, head + more + "layout: {rows: scene, columns: {" + columns + "}}\n");
    };
    EXPECT_EQ(
        laidOut("a: {metric: voxels, where: {fill: sold, resolution: 32}}"),
        "gfxrepro: DIR/mine.yaml:7:67: layout: where.fill is sold; allowed: surface | solid\n");
    EXPECT_THAT(laidOut("a: {metric: voxels, where: {fill: surface, resolution: [32, 128]}}"),
                EndsWith(": layout: where.resolution is 128; allowed: 32 | 64\n"));
    EXPECT_THAT(
        laidOut("a: {metric: voxels, where: {fill: surface, resolution: 32, frame: 1}}"),
        EndsWith(
            ": layout: where.frame is 1; allowed: 0; 'output: {frames: N}' draws N of them\n"));
    EXPECT_THAT(laidOut("a: {metric: voxels, where: {fill: solid, resolution: 64}}"),
                EndsWith(": layout: column 'a' is of no case: none has fill=solid, resolution=64, "
                         "scene=shapes/torus\n"));
    const std::string solid = "a: {metric: voxels, where: {fill: solid, resolution: 32}}";
    const std::string file = folder.write(
        "quick.yaml", "sweep_of: mine\ntitle: Mine\n" + head +
                          "profiles: {quick: {sweep: {fill: [surface], exclude: []}}}\n"
                          "layout: {rows: scene, columns: {" +
                          solid + "}}\n");
    for (const char* profile : {"full", "quick"}) {  // in one of which it is blank
        EXPECT_EQ(gfxrepro({"check", file, "--profile", profile}).err, "") << profile;
    }
    EXPECT_THAT(
        laidOut("a: {metric: voxels, where: {fill: solid, resolution: 32}, format: '{sum:.0f}'}"),
        EndsWith(": layout: column 'a' shows the sum of one value in each process; allowed: "
                 "median, or 'output: {frames}'\n"));
    EXPECT_THAT(
        laidOut(
            "a: {metric: voxels, where: {fill: solid, resolution: 32}, format: '{stddev:.0f}'}"),
        HasSubstr("shows the stddev of one value"));
}

TEST_F(OwnExperiment, WhatNoMeasurementCouldJudgeIsRefusedBeforeAnyIsMade) {
    const std::string file = folder.write(
        "mine.yaml",
        "sweep_of: mine\ntitle: Mine\ntechnique: voxelization\nscene: shapes/torus\n"
        "sweep: {fill: [surface, solid]}\nlayout: {rows: fill, columns: {a: voxels}}\nclaims:\n"
        "  C: {says: it grows, trend: a, over: fill, direction: increasing}\n");
    for (const char* command : {"check", "run"}) {
        const ProcessResult result = gfxrepro({command, file});
        EXPECT_EQ(result.exitCode, 2) << command;
        EXPECT_THAT(
            result.err,
            HasSubstr(
                "mine.yaml:8:3: claim 'C' needs numbers along 'fill', which holds 'surface'"));
    }
}

TEST_F(OwnExperiment, WhatCheckRefusesIsNotMeasured) {
    const std::string head =
        "sweep_of: mine\ntitle: Mine\ntechnique: voxelization\nscene: shapes/torus\n"
        "sweep: {fill: [surface, solid], resolution: [32, 64]}\n";
    const std::map<std::string, std::string> wrong = {
        {"layout: {rows: resolution, columns: {a: voxels}}\n",
         ":6:1: layout: each number would be taken over fill (surface, solid), which is swept; "
         "allowed: as an axis of rows or columns, or in a 'where': {fill: [surface, solid]} takes "
         "its values together\n"},
        {"layout: {rows: [fill, resolution], columns: {a: voxels}}\n"
         "printed: {values: \"fill,resolution,a\\nsurface,128,7\"}\n",
         ":7:19: printed: no profile measures the row 'surface,128,7'; allowed: fill surface | "
         "solid; resolution 32 | 64\n"},
        {"layout: {rows: [fill, resolution], columns: {a: {metric: voxels, format: '{max:.0f}'}}}\n"
         "printed: {values: \"fill,resolution,a\\nsurface,32,many\"}\n",
         ":7:19: printed: a is 'many'; allowed: as the cell's format writes numbers, or empty "
         "where it is lost\n"},
        {"layout: {rows: [fill, resolution], columns: {a: voxels}}\n"
         "claims: {C: {says: so, order: [fill=surface, fill=solid], kind: algorithmic}}\n",
         ":7:10: claim 'C' has a 'kind' and reads no time\n"}};
    for (const auto& [lines, error] : wrong) {
        const std::string file = folder.write("mine.yaml", head + lines);
        for (const char* command : {"check", "reproduce"}) {
            const ProcessResult result = gfxrepro({command, file});
            EXPECT_EQ(result.exitCode, 2) << command << lines;
            EXPECT_THAT(result.err, EndsWith(error)) << command;
            EXPECT_THAT(result.out, IsEmpty()) << command;
        }
    }
}

TEST_F(OwnExperiment, ClaimsReadTheColumnsOfATableThatNobodyLaidOut) {
    const auto configOf = [&](const std::string& operand) {
        return folder.write("mine.yaml",
                            "sweep_of: mine\ntitle: Mine\ntechnique: voxelization\n"
                            "scene: shapes/torus\nmeasure: {lane: quality}\n"
                            "sweep: {resolution: [32, 64], fill: [surface, solid]}\n"
                            "claims:\n  grows: {says: there are more voxels, trend: " +
                                operand +
                                ", over: resolution, direction: increasing}\n"
                                "  solid: {says: a solid has more, order: [fill=surface, "
                                "fill=solid], of: voxels}\n");
    };
    EXPECT_THAT(endedWith(2, gfxrepro({"check", configOf("voxel")})).err,
                HasSubstr(":8:3: claim 'grows': 'voxel' is no column; did you mean 'voxels'? "
                          "(columns: frame_ms, "));
    const std::string dir = folder.path() / "run";
    endedWith(0, gfxrepro({"reproduce", configOf("voxels"), "--out", dir}));
    const std::string claims = readFile(dir + "/claims.csv");
    EXPECT_THAT(claims, HasSubstr("\ngrows,there are more voxels,sweep/mine,"));
    EXPECT_THAT(claims, HasSubstr("\nsolid,a solid has more,sweep/mine,"));
    EXPECT_THAT(claims, Not(HasSubstr(",unmeasured,")));
}

TEST_F(OwnExperiment, CheckGoesOnBehindABadFile) {
    const std::string rest = "title: t\ntechnique: voxelization\nscene: shapes/torus\n";
    const std::string bad = folder.write("bad.yaml", "sweep_of: bad\nsweeep: {}\n" + rest);
    const std::string good = folder.write("good.yaml", "sweep_of: good\n" + rest);
    const ProcessResult result = endedWith(2, gfxrepro({"check", bad, good, bad}));
    EXPECT_EQ(result.out, good + ": ok, sweep/good, 1 case, 0 claims\n");
    const std::string line =
        "gfxrepro: " + bad + ":2:1: config: unknown key 'sweeep'; did you mean 'sweep'?\n";
    EXPECT_EQ(result.err, line + line);
}

}  // namespace
}  // namespace gfxrepro::test
