#include "runner/config/experiment.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "runner/claims/kinds/kind.h"
#include "tests/support/support.h"
#include "tests/unit/config/experiment_fixture.h"

namespace gfxrepro::config {
namespace {

constexpr const char* kVoxelization = R"(table: zju2005/2.1
title: Voxelization time by model at 256³
extends: [presets/timing.yaml]
technique: voxelization
params: {resolution: 256, voxel: byte, method: worksheet}
sweep:
  scene: [models/duck, models/hugo, models/bunny, models/dragon, models/buddha, models/blade]
layout:
  rows: scene
  columns:
    triangles: triangles
    vertices: {metric: vertices}
    rasterization_ms: {metric: gpu_time_ms, pass: rasterization}
    texelization_ms: {metric: gpu_time_ms, pass: texelization}
    synthesis_ms: {metric: gpu_time_ms, pass: synthesis}
    preprocess_ms: {metric: cpu_time_ms, pass: preprocess, scale: 1e-3, format: "{median:.1f}"}
printed:
  hardware: Radeon 9800 Pro, Pentium 4 2.4 GHz
  values: |
    scene,triangles,vertices,rasterization_ms,texelization_ms,synthesis_ms,preprocess_ms
    models/duck, 1254, 947, 9.0, 8.0, 10, 0.8
    # Hugo's time is lost
    models/hugo, 16928, 8634, , 8.3, 10, 7.0
claims:
  V1:
    says: rasterization grows slower than the number of triangles
    trend: rasterization_ms
    over: triangles
    at_least: 0.3
    at_most: 1.2
  V1b:
    says: the image-space steps do not depend on the model
    independent: [texelization_ms, synthesis_ms]
    of: triangles
    at_most: 25%
  V7:
    says: real time even for the largest model
    bound: rasterization_ms + max(texelization_ms, synthesis_ms)
    at: {scene: models/blade}
    at_most: 16.6
    kind: absolute
assumptions:
  voxel_padding: {value: 1, range: [0, 2], unit: voxels, why: the thesis does not say how the box is fitted}
)";

constexpr const char* kSoftShadows = R"(table: xie2017/10
title: Soft-shadow error against light size
technique: soft_shadows
params: {reference_size: 1024, light_samples: [16, 16]}
sweep:
  scene: [bird_nest, grass, city, tree]
  light_ratio: [0.25, 0.5, 1, 2, 4]   # light diagonal : scene diagonal
  method: [non_redundant, conventional, depth_peeling]
profiles:
  quick:
    params: {reference_size: 256, light_samples: [8, 8]}
    output: {width: 128, height: 96}
    sweep: {light_ratio: null, method: [non_redundant, depth_peeling]}
layout:
  axes: {error: {intensity: intensity_error, visibility: {metric: visibility_error}}}
  rows: [scene, error, light_ratio]
  columns: method
  cell: "{mean:.2f}/{max:.0f}"
printed:
  remark: the non-redundant cell of ratio 2 is lost
  values: |
    scene,error,light_ratio,non_redundant,conventional,depth_peeling
    bird_nest,intensity,0.25,3.22/133,6.42/141,2.90/108
    bird_nest,visibility,0.25,5.94/143,7.13/141,6.17/117
claims:
  R3a:
    says: the non-redundant images beat depth peeling on the city
    order: non_redundant < depth_peeling
    at: {scene: city, light_ratio: [0.5, 1, 2, 4]}
  R3b: {says: by far, ratio: depth_peeling / non_redundant, at: {scene: city, light_ratio: 1.0}, at_least: 3}
)";

constexpr const char* kTerrain = R"(table: zhang2012/1
title: Frame rate and triangles against ΔS
extends: presets/timing.yaml
technique: terrain_tessellation
scene: terrain/puget_sound
params: {method: adaptive, block: 32, tile_patches: 8, tau: 4}
output: {width: 1280, height: 800}
sweep:
  delta_s: {range: [1, 10]}
layout:
  rows: delta_s
  columns: {fps: frame_rate, triangles: primitives}
printed:
  hardware: GeForce GTX 460
  values: |
    delta_s,fps,triangles
    1,68.63,7213870
    2,147.57,2005672
claims:
  T1: {says: fewer triangles, trend: triangles, over: delta_s, at_least: -2.2, at_most: -1.5, direction: decreasing, strictly: true}
  T3: {says: real time, bound: fps, at: {delta_s: 1}, at_least: 60, kind: absolute}
  T4: {says: as printed, tolerance: triangles, at_most: 0.05}
  T5: {says: as printed, exact: triangles, equals: printed, profile: paper}
  T6: {says: cross, crossover: [fps, triangles / 1000], over: delta_s, at_least: 2, at_most: 4}
)";

TEST_F(ExperimentTest, VoxelizationTable) {
    const Experiment table = load(kVoxelization);
    EXPECT_EQ(table.id, "zju2005/2.1");
    EXPECT_EQ(table.slug(), "zju2005-2.1");
    EXPECT_EQ(table.label(), "Table 2.1");
    EXPECT_EQ(table.title, "Voxelization time by model at 256³");
    EXPECT_EQ(table.technique, "voxelization");
    EXPECT_EQ(table.measure.lane, Measure::Lane::Timing);
    EXPECT_EQ(table.measure.repeats, 10);
    EXPECT_EQ(table.measure.timeLimitS, 120.0);
    EXPECT_THAT(table.profiles, ElementsAre("quick"));
    const auto cases = expandCases(table);
    ASSERT_EQ(cases.size(), 6U);
    EXPECT_EQ(cases[2].scene.text(), "models/bunny");
    EXPECT_EQ(cases[2].given.toFlowText(), "{resolution: 256, voxel: byte, method: worksheet}");
    EXPECT_EQ(cases[2].outputWidthPx, 512);

    ASSERT_EQ(table.layout.rows.size(), 1U);
    EXPECT_TRUE(table.layout.rows[0].isSweepAxis());
    ASSERT_EQ(table.layout.columns.size(), 1U);
    EXPECT_EQ(table.layout.columns[0].name, "");
    const auto& columns = table.layout.columns[0].labels;
    ASSERT_EQ(columns.size(), 6U);
    EXPECT_EQ(columns[0].second.metric, "triangles");
    EXPECT_EQ(columns[3].second.pass, "texelization");
    EXPECT_EQ(columns[5].second.scale, 1e-3);
    EXPECT_EQ(table.layout.cell.format, "{median:.4g}");

    EXPECT_THAT(table.printed.rows[1],
                ElementsAre("models/hugo", "16928", "8634", "", "8.3", "10", "7.0"));
    EXPECT_EQ(table.printed.hardware, "Radeon 9800 Pro, Pentium 4 2.4 GHz");

    ASSERT_EQ(table.claims.size(), 3U);
    EXPECT_EQ(table.claims[0].kind->name(), "trend");
    EXPECT_EQ(table.claims[0].over, "triangles");
    EXPECT_EQ(table.claims[0].low, 0.3);
    EXPECT_EQ(table.claims[0].high, 1.2);
    EXPECT_THAT(table.claims[1].operands, ElementsAre("texelization_ms", "synthesis_ms"));
    EXPECT_EQ(table.claims[1].low, std::nullopt);
    EXPECT_EQ(table.claims[1].high, 0.25);
    EXPECT_EQ(table.claims[2].timeKind, ClaimSpec::TimeKind::Absolute);
    EXPECT_EQ(table.claims[2].high, 16.6);
    EXPECT_EQ(table.claims[2].at[0].second[0].text(), "models/blade");
    EXPECT_EQ(table.claims[2].location.line, 36);

    ASSERT_EQ(table.assumptions.size(), 1U);
    EXPECT_EQ(table.assumptions[0].unit, "voxels");
    EXPECT_EQ(table.assumptions[0].range.toFlowText(), "[0, 2]");
}

TEST_F(ExperimentTest, SoftShadowTable) {
    const Experiment table = load(kSoftShadows);
    EXPECT_EQ(expandCases(table).size(), 60U);
    ASSERT_EQ(table.layout.rows.size(), 3U);
    EXPECT_EQ(table.layout.rows[1].name, "error");
    EXPECT_EQ(table.layout.rows[1].labels[1].second.metric, "visibility_error");
    EXPECT_EQ(table.layout.cell.format, "{mean:.2f}/{max:.0f}");
    EXPECT_THAT(table.claims[0].operands, ElementsAre("non_redundant", "depth_peeling"));
    EXPECT_EQ(table.claims[0].at[1].second.size(), 4U);
    EXPECT_EQ(table.claims[1].low, 3.0);
    EXPECT_EQ(table.claims[1].high, std::nullopt);
    EXPECT_THAT(table.claims[1].operands, ElementsAre("depth_peeling", "non_redundant"));
}

TEST_F(ExperimentTest, TerrainTable) {
    const Experiment table = load(kTerrain);
    const auto cases = expandCases(table);
    ASSERT_EQ(cases.size(), 10U);
    EXPECT_EQ(cases[9].given.toFlowText(),
              "{method: adaptive, block: 32, tile_patches: 8, tau: 4, delta_s: 10}");
    EXPECT_EQ(cases[9].axes.entries()[0].value.asInteger(), 10);
    EXPECT_EQ(cases[0].scene.text(), "terrain/puget_sound");
    EXPECT_EQ(cases[0].outputHeightPx, 800);
    EXPECT_EQ(table.claims[2].high, 0.05);
    EXPECT_EQ(table.claims[3].low, std::nullopt);
    EXPECT_EQ(table.claims[3].profile, "paper");
    EXPECT_THAT(table.claims[4].operands, ElementsAre("fps", "triangles / 1000"));
}

TEST_F(ExperimentTest, ProfilesAreLaidOverTheWhole) {
    // The light ratio leaves the sweep, yet the file names it in rows: it has to come back in
    // params.
    const std::string quickRatio = "    params: {reference_size: 256, light_ratio: 1,";
    std::string text = kSoftShadows;
    const std::string before = "    params: {reference_size: 256,";
    text.replace(text.find(before), before.size(), quickRatio);
    ExperimentOptions quick{.profile = "quick"};
    const Experiment table = load(text, quick);
    EXPECT_EQ(expandCases(table).size(), 8U);
    EXPECT_EQ(table.outputWidthPx, 128);
    EXPECT_EQ(table.params.toFlowText(),
              "{reference_size: 256, light_samples: [8, 8], light_ratio: 1}");
    EXPECT_EQ(load(kTerrain, quick).measure.repeats, 2);
    quick.profile = "paper";
    EXPECT_EQ(load(kTerrain, quick).measure.repeats, 10);
    quick.profile = "fast";
    EXPECT_EQ(loadError(kTerrain, quick), "profile 'fast'; allowed: quick, full, paper");
    EXPECT_EQ(errorWith("profiles: {full: {}}"),
              "DIR/zju/a.yaml:4:12: profiles: unknown key 'full'; allowed: quick, paper");
    EXPECT_EQ(errorWith("profiles: {quick: {ouptut: {}}}"),
              "DIR/zju/a.yaml:4:20: profile 'quick': unknown key 'ouptut'; did you mean 'output'?");
}

TEST_F(ExperimentTest, DocumentsRecreateTheExperiment) {
    const ExperimentOptions options{.sets = {parseOverride("measure.repeats=4")}};
    for (const char* text : {kVoxelization, kSoftShadows, kTerrain}) {
        const Experiment first = load(text, options);
        const std::string json = first.document.toJson().dump(1);
        const Experiment again = experimentFromDocument(parseYaml(json, "plan.json"), first.file);
        EXPECT_EQ(again.document.toJson().dump(1), json);
        EXPECT_EQ(again.id, first.id);
        EXPECT_EQ(again.measure.repeats, 4);
        EXPECT_EQ(again.printed.rows, first.printed.rows);
        EXPECT_EQ(again.profiles, first.profiles);
        EXPECT_EQ(again.claims.size(), first.claims.size());
        const auto cases = expandCases(first);
        const auto casesAgain = expandCases(again);
        ASSERT_EQ(casesAgain.size(), cases.size());
        for (std::size_t i = 0; i < cases.size(); ++i) {
            EXPECT_TRUE(casesAgain[i].given.sameContent(cases[i].given));
            EXPECT_TRUE(casesAgain[i].scene.sameContent(cases[i].scene));
        }
    }
}

TEST_F(ExperimentTest, TablesThatAreOnlyPrinted) {
    const Experiment table = load(
        "table: xie2017/1\ntitle: Reductions of the plenoptic function\n"
        "printed:\n  values: |\n    function,dimensions\n    light field,4\n");
    EXPECT_TRUE(expandCases(table).empty());
    EXPECT_THAT(table.printed.header, ElementsAre("function", "dimensions"));
    EXPECT_EQ(loadError("table: p/1\ntitle: t\nprinted: {values: \"a\\n1\"}\nscene: s\n"),
              "DIR/zju/a.yaml:4:1: 'scene' without 'technique'");
    EXPECT_EQ(loadError("table: p/1\ntitle: t\n"),
              "DIR/zju/a.yaml:1:1: neither 'technique' nor 'printed'; allowed: either or both");
}

TEST_F(ExperimentTest, NamesOfExperiments) {
    const auto labelOf = [&](const std::string& name) {
        const Experiment experiment = load(name + "\ntitle: t\ntechnique: x\n");
        return experiment.id + " | " + experiment.label() + " | " + experiment.slug();
    };
    EXPECT_EQ(labelOf("table: xie2017/9"), "xie2017/9 | Table 9 | xie2017-9");
    EXPECT_EQ(labelOf("figure: xie2017/9"), "xie2017/figure-9 | Figure 9 | xie2017-figure-9");
    EXPECT_EQ(labelOf("section: zju2005/2.5.3"), "zju2005/2.5.3 | Section 2.5.3 | zju2005-2.5.3");
    EXPECT_EQ(labelOf("sweep_of: speed"), "sweep/speed | Sweep speed | sweep-speed");
    EXPECT_EQ(loadError("title: t\ntechnique: x\n"),
              "DIR/zju/a.yaml:1:1: nothing names the experiment; allowed: one of table, figure, "
              "section, sweep_of");
    EXPECT_EQ(errorWith("figure: p/1"),
              "DIR/zju/a.yaml:4:1: both 'table' and 'figure' name the experiment; allowed: one");
    EXPECT_EQ(loadError("table: '10'\ntitle: t\n"),
              "DIR/zju/a.yaml:1:8: table is \"10\"; allowed: PAPER/NUMBER, such as zju2005/2.1");
    EXPECT_EQ(loadError("table: ../1/2\ntitle: t\n"),
              "DIR/zju/a.yaml:1:8: table is ../1/2; allowed: PAPER/NUMBER, such as zju2005/2.1");
    EXPECT_EQ(loadError("table: zju/" + std::string(300, '1') + "\ntitle: t\n"),
              "DIR/zju/a.yaml:1:8: table: a name of 300 letters; at most 80, for files are named "
              "after it");
    EXPECT_EQ(loadError("sweep_of: a/b\ntitle: t\n"),
              "DIR/zju/a.yaml:1:11: sweep_of is a/b; allowed: letters, digits, - _ .");
    EXPECT_EQ(loadError("table: p/1\ntechnique: x\n"), "DIR/zju/a.yaml:1:1: config needs 'title'");
}

TEST_F(ExperimentTest, ExtendsIsFollowedAndChecked) {
    folder.write("presets/base.yaml", "params: {a: 1, b: 2}\nextends: timing.yaml\n");
    folder.write("zju/near.yaml", "params: {b: 3}\n");
    const Experiment table = load(
        "table: p/1\ntitle: t\ntechnique: x\nextends: [presets/base.yaml, near.yaml]\n"
        "params: {c: 4}\n");
    EXPECT_EQ(table.params.toFlowText(), "{a: 1, b: 3, c: 4}");
    EXPECT_EQ(table.measure.repeats, 10);
    EXPECT_EQ(table.params.find("b")->location().file, (folder.path() / "zju/near.yaml").string());

    EXPECT_EQ(errorWith("extends: none.yaml"),
              "DIR/zju/a.yaml:4:10: extends: no file 'none.yaml' in DIR or DIR/zju");
    folder.write("presets/loop.yaml", "extends: loop2.yaml\n");
    folder.write("presets/loop2.yaml", "extends: [presets/loop.yaml]\n");
    EXPECT_EQ(
        errorWith("extends: presets/loop.yaml"),
        "DIR/presets/loop2.yaml:1:11: extends: 'presets/loop.yaml' extends this file in turn");
    folder.write("presets/table.yaml", "table: p/2\n");
    EXPECT_EQ(errorWith("extends: presets/table.yaml"),
              "DIR/presets/table.yaml:1:1: 'table' in a file that is extended; only the "
              "experiment's own file names it");
    folder.write("presets/bad.yaml", "\nmeasure: {repeats: 0}\n");
    EXPECT_EQ(errorWith("extends: presets/bad.yaml"),
              "DIR/presets/bad.yaml:2:20: measure: repeats is 0; allowed: 1 … 1000000");
    EXPECT_EQ(loadError(""),
              "DIR/zju/a.yaml:1:1: a config is a map of keys and values, found nothing");
    EXPECT_EQ(errorText([&] { loadExperiment(folder.path() / "x.yaml", {}, folder.path()); },
                        folder.path()),
              "cannot read DIR/x.yaml: No such file or directory");
}

TEST_F(ExperimentTest, ParametersOfScenesMergeByKey) {
    folder.write("presets/views.yaml",
                 "params_by_scene: {a: {spread: 0.1, distance: 1}, b: {spread: 0.2}}\n");
    const std::string text =
        "table: p/1\ntitle: t\ntechnique: x\nextends: presets/views.yaml\n"
        "sweep: {scene: [a, b]}\nparams: {spread: 0.9, n: 1}\n"
        "params_by_scene: {a: {spread: 0.3}, b: {spread: null}}\n"
        "layout: {rows: scene, columns: {c: {where: {spread: 0.3}, metric: m}}}\n";
    const auto paramsOf = [&](const ExperimentOptions& options) {
        std::vector<std::string> params;
        for (const Case& item : expandCases(load(text, options))) {
            params.push_back(item.given.toFlowText());
        }
        return params;
    };
    EXPECT_EQ(paramsOf({}), (std::vector<std::string>{"{spread: 0.3, n: 1, distance: 1}",
                                                      "{spread: 0.9, n: 1}"}));
    ExperimentOptions options;
    options.sets = {parseOverride("spread=0.5")};
    EXPECT_EQ(paramsOf(options),
              (std::vector<std::string>{"{spread: 0.5, n: 1, distance: 1}", "{spread: 0.5, n: 1}"}))
        << "what the command line sets is of all scenes";
}

/// A file is the same in whichever spelling, and of whichever folder.
TEST_F(ExperimentTest, ScenesThatAreKeysMergeByFile) {
    folder.write("presets/views.yaml",
                 "params_by_scene: {../zju/a.ply: {n: 1, m: 2}}\n"
                 "scene_instead: {../zju/a.ply: b.ply}\n"
                 "profiles: {quick: {params_by_scene: {../zju/./a.ply: {m: 7}}}}\n");
    const std::string text =
        "table: p/1\ntitle: t\ntechnique: x\nextends: presets/views.yaml\nscene: a.ply\n"
        "params: {n: 0, m: 0}\nparams_by_scene: {./a.ply: {n: 3}}\n";
    const Experiment table = load(text);
    const std::string file = (folder.path() / "zju/a.ply").string();
    ASSERT_EQ(table.paramsByScene.entries().size(), 1U);
    EXPECT_EQ(table.paramsByScene.find(file)->toFlowText(), "{n: 3, m: 2}");
    EXPECT_EQ(table.sceneInstead.find(file)->text(), (folder.path() / "presets/b.ply").string());
    const ExperimentOptions quick{.profile = "quick"};
    EXPECT_EQ(load(text, quick).paramsByScene.find(file)->toFlowText(), "{n: 3, m: 7}");
    EXPECT_EQ(load(text + "scene_instead: {a.ply}\n").sceneInstead.toFlowText(), "{}");
    EXPECT_EQ(
        errorWith("scene_instead: {./a.ply}\n"),
        "DIR/zju/a.yaml:4:17: scene_instead: './a.ply' has no value; allowed: {scene: scene}");
    EXPECT_EQ(errorWith("params_by_scene: {a/b: }\n"),
              "DIR/zju/a.yaml:4:19: params_by_scene: 'a/b' has no value; allowed: {scene: {name: "
              "value}}");
}

TEST_F(ExperimentTest, FilesThatExtendTheNextOneTwiceAreNotReadForAnHour) {
    for (int i = 0; i < 20; ++i) {
        const std::string next = "e" + std::to_string(i + 1) + ".yaml";
        folder.write("e" + std::to_string(i) + ".yaml", "extends: [" + next + ", " + next + "]\n");
    }
    folder.write("e20.yaml", "params: {a: 1}\n");
    EXPECT_EQ(errorWith("extends: e12.yaml"), "no error");
    EXPECT_THAT(
        errorWith("extends: e0.yaml"),
        HasSubstr("extends: more than 1000 files, those that are extended twice counted twice"));
}

TEST_F(ExperimentTest, WhatIsSetToNothingIsNoValue) {
    EXPECT_EQ(errorText([] { parseOverride("a="); }),
              "'a=' on the command line has no value; null removes the key");
    const ExperimentOptions options{.sweeps = {parseOverride("a=null")}};
    EXPECT_EQ(loadError("table: p/1\ntitle: t\ntechnique: x\n", options),
              "command line, a=null: 'a' is not swept; nothing to remove");
    EXPECT_EQ(expandCases(load("table: p/1\ntitle: t\ntechnique: x\nsweep: {a: [1, 2]}\n", options))
                  .size(),
              1U);
}

TEST_F(ExperimentTest, Overrides) {
    ExperimentOptions options{
        .sets = {parseOverride("resolution=64"), parseOverride("output.width=100"),
                 parseOverride("params.voxel=null"), parseOverride("measure.lane=quality")},
        .sweeps = {parseOverride("scene=models/duck, models/bunny"),
                   parseOverride("slices={log2: [2, 8]}"), parseOverride("params.k=5")}};
    const Experiment table = load(kVoxelization, options);
    EXPECT_EQ(table.params.toFlowText(), "{resolution: 64, method: worksheet}");
    EXPECT_EQ(table.outputWidthPx, 100);
    EXPECT_EQ(table.measure.lane, Measure::Lane::Quality);
    const auto cases = expandCases(table);
    ASSERT_EQ(cases.size(), 6U);
    EXPECT_EQ(cases[5].scene.text(), "models/bunny");
    EXPECT_EQ(cases[5].given.toFlowText(), "{resolution: 64, method: worksheet, slices: 8, k: 5}");

    EXPECT_EQ(errorText([] { parseOverride("resolution"); }),
              "'resolution' on the command line; allowed: key=value");
    EXPECT_EQ(errorText([] { parseOverride("a=[1"); }),
              "command line, a=[1:1:1: a key must be text, found a list; perhaps a bracket is not "
              "closed");
    options = {};
    options.sets = {parseOverride("delta_s=3")};
    EXPECT_EQ(loadError(kTerrain, options),
              "command line, delta_s=3: 'delta_s' is swept here; allowed: --sweep delta_s=VALUES");
    options.sets = {parseOverride("measure.repeats=0")};
    EXPECT_EQ(loadError(kTerrain, options),
              "command line, measure.repeats=0: measure: repeats is 0; allowed: 1 … 1000000");
    options.sets = {parseOverride("technique.x=0")};
    EXPECT_EQ(
        loadError(kTerrain, options),
        "command line, technique.x=0: cannot set 'technique.x': 'technique' is text, not a map");
}

TEST_F(ExperimentTest, SceneFilesStandBesideTheirConfig) {
    folder.write("presets/scene.yaml", "scene: mine.ply\n");
    EXPECT_EQ(
        load("table: p/1\ntitle: t\ntechnique: x\nextends: presets/scene.yaml\n").scene.text(),
        (folder.path() / "presets/mine.ply").string());
    const Experiment table = load(
        "table: p/1\ntitle: t\ntechnique: x\n"
        "sweep: {scene: [../m.obj, models/duck, /abs/m.glb], exclude: [{scene: /abs/m.glb}]}\n"
        "layout: {rows: scene, columns: {a: {metric: m, where: {scene: ../m.obj}}}}\n"
        "claims: {C: {says: s, bound: a, at_least: 1, at: {scene: ../m.obj}}}\n");
    const auto cases = expandCases(table);
    ASSERT_EQ(cases.size(), 2U);
    const std::string file = (folder.path() / "m.obj").string();
    EXPECT_EQ(cases[0].scene.text(), file);
    EXPECT_EQ(cases[1].scene.text(), "models/duck");
    EXPECT_EQ(table.claims[0].at[0].second[0].text(), file);
    EXPECT_EQ(errorWith("params_by_scene: {a.ply: {n: 1}, ./a.ply: {n: 2}}\n"),
              "DIR/zju/a.yaml:4:34: params_by_scene has the scene './a.ply' twice; allowed: once");
    EXPECT_EQ(table.layout.columns[0].labels[0].second.where[0].value.text(), file);
}

TEST_F(ExperimentTest, SweepsTakeTheSceneFilesThatMatch) {
    for (const char* name : {"zju/scans/b.ply", "zju/scans/a.ply", "zju/scans/c.obj"})
        folder.write(name, "");
    const auto scenes = [&](const std::string& sweep) {
        std::string all;
        for (const Case& item :
             expandCases(load("table: p/1\ntitle: t\ntechnique: x\nsweep: {" + sweep + "}\n"))) {
            std::string scene = item.scene.text();
            if (scene.starts_with(folder.path().string())) {
                scene = scene.substr(folder.path().string().size());
            }
            all += scene + ' ';
        }
        return all;
    };
    EXPECT_EQ(scenes("scene: 'scans/*.ply'"), "/zju/scans/a.ply /zju/scans/b.ply ");
    EXPECT_EQ(scenes("scene: ['scans/*.obj', m/x, 'scans/b*.ply?up=z']"),
              "/zju/scans/c.obj m/x /zju/scans/b.ply?up=z ");
    // In points that are spelt out, and beside axes that go together.
    EXPECT_EQ(scenes("list: [[{scene: 'scans/*.ply', n: 1}, {scene: m/x}]]"),
              "/zju/scans/a.ply /zju/scans/b.ply m/x ");
    EXPECT_EQ(scenes("list: [[{scene: scans/a.ply}], [{n: 1}, {n: 2}]]"),
              "/zju/scans/a.ply /zju/scans/a.ply ");
    EXPECT_EQ(scenes("zip: [{scene: ['scans/*.ply'], n: [1, 2]}]"),
              "/zju/scans/a.ply /zju/scans/b.ply ");
    // A folder is no file; brackets, of the config's own folder, too, are letters.
    folder.write("zju/scans/dir.ply/none.txt", "");
    EXPECT_EQ(scenes("scene: 'scans/*.ply'"), "/zju/scans/a.ply /zju/scans/b.ply ");
    folder.write("zju/old [1]*/d.ply", "");
    folder.write("zju/old 1/d.ply", "");
    EXPECT_EQ(scenes("scene: 'old [1]*/*.ply'"), "/zju/old [1]*/d.ply ");
    folder.write("n [x]*/scans/e.ply", "");
    const auto path = folder.write(
        "n [x]*/a.yaml",
        "table: p/1\ntitle: t\ntechnique: x\nsweep: {scene: 'scans/../scans/*.ply'}\n");
    for (const auto& sets :
         {std::vector<Override>(), std::vector<Override>{parseOverride("output.width=64")}}) {
        EXPECT_EQ(
            expandCases(loadExperiment(path, {.sets = sets}, folder.path())).at(0).scene.text(),
            folder.path().string() + "/n [x]*/scans/e.ply");
    }
    EXPECT_EQ(errorText([&] { scenes("scene: 'scans/*.stl'"); }, folder.path()),
              "DIR/zju/a.yaml:4:16: no file is called 'scans/*.stl'; looked beside DIR/zju/a.yaml");
    EXPECT_EQ(errorText([&] { scenes("list: [[{scene: 'scans/*.stl'}]]"); }, folder.path()),
              "DIR/zju/a.yaml:4:25: no file is called 'scans/*.stl'; looked beside DIR/zju/a.yaml");
    EXPECT_EQ(errorText([&] { scenes("scene: ['scans/*']"); }, folder.path()),
              "DIR/zju/a.yaml:4:17: 'scans/*' names no files of scenes; allowed: with their "
              "ending, as 'scans/*.ply'");
}

TEST_F(ExperimentTest, SceneFilesOfTheCommandLineStandInTheCurrentFolder) {
    ExperimentOptions options{.sets = {parseOverride("scene=m.obj")}};
    const std::string here = (fs::current_path() / "m.obj").string();
    EXPECT_EQ(load("table: p/1\ntitle: t\ntechnique: x\n", options).scene.text(), here);
    options.sets.clear();
    options.sweeps = {parseOverride("scene=m.obj,models/duck")};
    const auto cases = expandCases(load("table: p/1\ntitle: t\ntechnique: x\n", options));
    ASSERT_EQ(cases.size(), 2U);
    EXPECT_EQ(cases[0].scene.text(), here);
    EXPECT_EQ(cases[1].scene.text(), "models/duck");
}

TEST_F(ExperimentTest, SweptOutputSizes) {
    const Experiment table = load(
        "sweep_of: size\ntitle: t\ntechnique: x\n"
        "sweep: {zip: [{output.width: [64, 128], output.height: [32, 64]}]}\n");
    const auto cases = expandCases(table);
    ASSERT_EQ(cases.size(), 2U);
    EXPECT_EQ(cases[1].outputWidthPx, 128);
    EXPECT_EQ(cases[1].outputHeightPx, 64);
    EXPECT_EQ(cases[1].given.toFlowText(), "{}");
    EXPECT_EQ(errorWith("sweep: {output.width: [0]}"),
              "DIR/zju/a.yaml:4:24: output.width is 0; allowed: 1 … 16384");
    EXPECT_EQ(errorWith("sweep: {output.size: [1]}"),
              "DIR/zju/a.yaml:4:9: axis 'output.size'; allowed: output.width, output.height");
}

TEST_F(ExperimentTest, SeveralScenesAreSwept) {
    EXPECT_EQ(
        errorWith("scene: [a.ply, b.ply]\n"),
        "DIR/zju/a.yaml:4:8: scene is [a.ply, b.ply]; allowed: one; several stand below 'sweep'");
    EXPECT_EQ(errorWith("scene: \"*.ply\"\n"),
              "DIR/zju/a.yaml:4:8: scene is \"*.ply\"; allowed: one; several stand below 'sweep'");
}

TEST_F(ExperimentTest, AllIsWhatAProgramsParameterLists) {
    const std::string text =
        "sweep_of: s\ntitle: t\nprogram:\n  command: t {pattern} {n} {tone}\n"
        "  params: {pattern: [sobol, jittered], n: 4, tone: {default: b, choices: [a, b]}}\n";
    const Experiment experiment = load(text + "sweep: {pattern: all, tone: all}\n");
    std::vector<std::string> points;
    for (const AxisPoint& point : expandSweep(experiment.sweep)) {
        points.push_back(point[0].value.text() + ' ' + point[1].value.text());
    }
    EXPECT_THAT(points, ElementsAre("sobol a", "sobol b", "jittered a", "jittered b"));
    EXPECT_EQ(
        loadError(text + "sweep: {n: all}\n"),
        "DIR/zju/a.yaml:6:12: axis 'n' is all; allowed: a list, {range: [first, last, step]}, "
        "{log2: [first, last]}, or all, of a program's parameter that lists its values");
}

/// Of one's own sweep of a technique, with these lines.
TEST_F(ExperimentTest, KeysOfWhichNothingFollowsAreRefused) {
    const auto errorOf = [&](const std::string& lines) {
        return loadError("sweep_of: s\ntitle: t\ntechnique: x\n" + lines);
    };
    EXPECT_EQ(errorOf("measure: {lane: quality, time_budget_s: 9}\n"),
              "DIR/zju/a.yaml:4:26: 'time_budget_s': in the quality lane no rounds are timed; "
              "allowed: lane: timing");
    for (const char* few : {"measure: {processes: 5,", "measure: {processes: 20,"}) {
        EXPECT_EQ(errorOf(std::string(few) + " time_budget_s: 9}\n"),
                  fmt::format("DIR/zju/a.yaml:4:{}: 'time_budget_s': no rounds follow; allowed: "
                              "with 6 to 19 'processes', or without",
                              std::string(few).size() + 2));
    }
    EXPECT_EQ(errorOf("measure: {processes: 6, time_budget_s: 9}\n"), "no error");
    EXPECT_EQ(errorOf("measure: {warmup: 2}\n"),
              "DIR/zju/a.yaml:4:11: measure: unknown key 'warmup'; allowed: lane, repeats, "
              "processes, time_budget_s, time_limit_s");
    EXPECT_EQ(errorOf("printed: {at: {n: 3}}\n"),
              "DIR/zju/a.yaml:4:11: 'at': nothing is printed that could have been measured there; "
              "allowed: with 'values'");
    EXPECT_EQ(errorOf("printed: {calibrated: [{n: 1, column: a}]}\n"),
              "DIR/zju/a.yaml:4:11: printed: 'calibrated' without 'layout'");
    EXPECT_EQ(errorOf("printed: {compared: [usual]}\n"),
              "DIR/zju/a.yaml:4:11: 'compared': no fit reads a table without printed cells; "
              "allowed: with 'values'");
    EXPECT_EQ(errorOf("printed: {unfit: [grass]}\n"),
              "DIR/zju/a.yaml:4:11: 'unfit': it takes scenes from the claims of a document, and "
              "there are none");
    EXPECT_EQ(errorOf("measure: {time_budget_s: 9}\n"), "no error");
    EXPECT_EQ(errorOf("scene_params: {up: z}\n"),
              "DIR/zju/a.yaml:4:1: 'scene_params': no case has a scene");
    EXPECT_EQ(errorOf("scene: wood\nparams_by_scene: {grass: {n: 3}}\n"),
              "DIR/zju/a.yaml:5:19: 'grass': no case has the scene of params_by_scene");
    EXPECT_EQ(errorOf("sweep: {scene: [a@2, b]}\nparams_by_scene: {a: {n: 3}}\n"), "no error");
    EXPECT_EQ(errorOf("sweep: {scene: [a@2, b], n: [1, 2]}\nparams_by_scene: {a: {n: 3}}\n"),
              "DIR/zju/a.yaml:5:23: 'n': each case of the scene has it from the sweep, which wins "
              "over params_by_scene");
    EXPECT_EQ(errorOf("sweep: {m: [x, y], n: [1, 2], when: {n: {m: y}}}\nscene: a\n"
                      "params_by_scene: {a: {n: 3}}\n"),
              "no error");
    EXPECT_EQ(errorOf("assumptions: {scene: {why: w}}\n"),
              "DIR/zju/a.yaml:4:15: 'scene': no case has a scene");
    EXPECT_EQ(errorOf("sweep: {a: [1, 2], exclude: [{a: 2}, {a: 7}]}\n"),
              "DIR/zju/a.yaml:4:38: exclude: no point of the sweep has {a: 7}");
    EXPECT_EQ(errorOf("sweep: {a: [1, 2], exclude: [{a: 2}]}\n"), "no error");
    EXPECT_EQ(errorOf("sweep: {m: [x, y], n: [1, 2], when: {n: {m: nope}}}\n"),
              "DIR/zju/a.yaml:4:45: when: n.m is nope; allowed: x | y");
    EXPECT_EQ(errorOf("sweep: {m: [x, y], n: [1, 2], when: {n: {m: [x, others]}}}\n"), "no error");
    // Another profile may have what the file lacks; what is extended serves others, too.
    EXPECT_EQ(errorOf("extends: presets/timing.yaml\nmeasure: {time_budget_s: 9, processes: 6}\n"
                      "profiles: {quick: {measure: {time_budget_s: 0}}}\n"),
              "no error");
    folder.write("presets/more.yaml",
                 "scene_params: {up: z}\nmeasure: {processes: 5, time_budget_s: 9}\n");
    EXPECT_EQ(errorOf("extends: presets/more.yaml\n"), "no error");
}

TEST_F(ExperimentTest, OfAnImportNothingIsMeasured) {
    const std::string head = "sweep_of: s\ntitle: t\ntechnique: imported\nsweep: {m: [a, b]}\n";
    EXPECT_EQ(loadError(head), "no error");
    for (const char* line :
         {"scene: a", "scene_params: {up: z}", "scene_instead: {a: b}", "params: {n: 3}",
          "params_by_scene: {a: {n: 3}}", "params_instead: {n: 3}", "measure: {processes: 3}",
          "measure: {lane: quality}", "shows: [p]", "program: {command: t}"}) {
        const std::string key(line, std::string(line).find(':'));
        EXPECT_EQ(loadError(head + line + '\n'),
                  "DIR/zju/a.yaml:5:1: '" + key +
                      "': nothing is measured with technique imported; allowed: columns of the "
                      "file that is imported");
    }
    folder.write("presets/rounds.yaml", "measure: {processes: 6}\n");
    EXPECT_EQ(loadError(head + "extends: presets/rounds.yaml\n"), "no error");
}

TEST_F(ExperimentTest, TimesAreNotAskedOfALaneThatTakesNone) {
    const std::string head = "sweep_of: s\ntitle: t\ntechnique: x\nmeasure: {lane: quality}\n";
    EXPECT_EQ(loadError(head + "layout: {columns: {t: {metric: render_ms}}}\n"),
              "DIR/zju/a.yaml:4:17: 'lane: quality' takes no times, and the layout shows some; "
              "allowed: lane: timing");
    EXPECT_EQ(loadError(head + "claims: {c: {says: y, bound: 2 * render_ms, at_most: 4}}\n"),
              "DIR/zju/a.yaml:5:10: 'lane: quality' takes no times, and claim 'c' reads "
              "'render_ms'; allowed: lane: timing");
    EXPECT_EQ(loadError(head + "claims: {c: {says: y, bound: rays, at_most: 4}}\n"), "no error");
    EXPECT_EQ(loadError(head + "layout: {columns: {t: {metric: rays}}}\n"), "no error");
}

/// Another seed in each process wants several.
TEST_F(ExperimentTest, RandomErrorsAloneAreOfSixProcesses) {
    const std::string head =
        "sweep_of: s\ntitle: t\nprogram:\n  command: t {seed} {frame} {n}\n  params: {n: 1}\n"
        "  images: {p: {file: p.pfm, truth: {n: 9, seed: 99}}}\n";
    const std::string layout = "layout: {columns: {e: {metric: rmse, pass: p}}}\n";
    Measure measure = load(head + layout).measure;
    EXPECT_EQ(measure.lane, Measure::Lane::Quality);
    EXPECT_EQ(measure.seeds, Measure::Seeds::Process);
    EXPECT_EQ(measure.processes, kFewestRounds);
    EXPECT_EQ(load(head + layout + "sweep: {seed: [1, 2]}\n").measure.processes, 1);
    EXPECT_EQ(load(head + layout + "measure: {processes: 2}\n").measure.processes, 2);
    // Without {seed} frames are its random numbers, where a truth is of others: of one seed.
    std::string frames = head + layout;
    frames.replace(frames.find("{seed} "), 7, "");
    frames.replace(frames.find("seed: 99"), 8, "frame: 99");
    measure = load(frames + "output: {frames: 3}\n").measure;
    EXPECT_EQ(measure.seeds, Measure::Seeds::Case);
    EXPECT_EQ(measure.processes, 1);
    frames.replace(frames.find(", frame: 99"), 11, "");
    EXPECT_EQ(load(frames).measure.seeds, Measure::Seeds::None);
}

}  // namespace
}  // namespace gfxrepro::config
