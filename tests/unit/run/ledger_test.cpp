#include "runner/run/ledger.h"

#include <nlohmann/json.hpp>

#include "runner/tables/case_records.h"
#include "scenes/registry.h"
#include "tests/support/support.h"

namespace gfxrepro::run {
namespace {

struct Still : technique::Technique {
    explicit Still(Params& params) {
        const double bias = params.getDouble("bias", 0.5, {"taken from the depth", "texels", 0, 1});
        const bool isStatic = params.getBool("static", false, {"drawn once"});
        isStatic_ = isStatic;
        params.getInt("last", 0, {"frame that is drawn"});
        params.getText("view", "", {"a camera of the scene"});
        if (!isStatic) params.refuseGiven({"last"}, "'static: true'");
        if (isStatic && bias == 0.0) {
            throw Error(params.locationOf("bias"), "bias is 0, but static needs one");
        }
    }
    /// A test says by its lines whether it is of scenes.
    static inline bool drawsScenes = false;
    technique::SceneNeed sceneNeed() const override {
        return drawsScenes && !isStatic_ ? technique::SceneNeed::Model
                                         : technique::SceneNeed::Nothing;
    }
    void requireFrames(int frameCount) const override {
        if (isStatic_) Technique::requireFrames(frameCount);
    }
    void setup(technique::SetupContext&) override {}
    void render(technique::FrameContext&) override {}
    void record(technique::Recorder&) override {}

  private:
    bool isStatic_ = false;
};

const technique::TechniqueInfo kTechniques[] = {
    {"still", "measures nothing",
     [](Params& params) -> std::unique_ptr<technique::Technique> {
         return std::make_unique<Still>(params);
     },
     [] { return config::Outputs(); }}};

/// A config with two generated scenes and one of a file; it ends with `lines`.
struct Ledger {
    TemporaryFolder folder;

    Ledger() {
        for (const char* name : {"grass", "tree"}) {
            folder.write(std::string("configs/scenes/") + name + ".yaml",
                         std::string("scene: ") + name + "\ndoc: d\nsources:\n  - {generator: " +
                             name + ", params: {triangles: 12000}, seed: 3}\n");
        }
        folder.write("configs/scenes/scan.yaml",
                     "scene: scan\ndoc: d\nsources:\n  - file: s.obj\n");
        folder.write("assets/s.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    }
    scene::Catalog catalog() const {
        return {folder.path() / "configs/scenes", folder.path() / "assets",
                scene::registeredGenerators()};
    }
    config::Experiment load(const std::string& lines) const {
        Still::drawsScenes = lines.find("scene: ") != std::string::npos;
        const auto file =
            folder.write("t.yaml", "sweep_of: t\ntitle: t\ntechnique: still\n" + lines);
        return config::loadExperiment(file, {}, folder.path() / "configs");
    }
    std::vector<Case> cases(const config::Experiment& experiment) const {
        return resolveCases(experiment, catalog(), kTechniques, 1);
    }
    config::Experiment bound(const std::string& lines) const {
        config::Experiment experiment = load(lines);
        bindAssumptions(experiment, cases(experiment), catalog(), kTechniques);
        return experiment;
    }
    std::string errorOf(const std::string& lines) const {
        const auto check = [&] {
            const config::Experiment experiment = bound(lines);
            requireRanges(experiment, cases(experiment), catalog(), kTechniques);
        };
        return errorText(check, folder.path());
    }
};

TEST(ResolveCases, RefusesKeysThatNothingReads) {
    const Ledger ledger;
    const auto errorOf = [&](const std::string& lines) {
        return errorText([&] { ledger.cases(ledger.load(lines)); }, ledger.folder.path());
    };
    EXPECT_EQ(errorOf("scene: scan\nscene_seeds: 5\nmeasure: {lane: quality}\n"),
              "DIR/t.yaml:5:14: 'scene_seeds' is 5, and no case has a generated scene");
    EXPECT_EQ(errorOf("scene_seeds: 5\nmeasure: {lane: quality}\n"),
              "DIR/t.yaml:4:14: 'scene_seeds' is 5, and no case has a generated scene");
    EXPECT_EQ(errorOf("scene: grass\nscene_seeds: 5\nmeasure: {lane: quality}\n"), "no error");
    EXPECT_EQ(errorOf("params: {static: true}\noutput: {frames: 10}\n"),
              "DIR/t.yaml:5:18: 10 frames: the technique draws the same in each; allowed: 1");
    EXPECT_EQ(errorOf("output: {frames: 10}\n"), "no error");
    EXPECT_EQ(errorOf("scene: grass\nparams: {static: true}\n"),
              "DIR/t.yaml:4:8: scene 'grass': technique 'still' reads none as it is set here");
    EXPECT_EQ(errorOf("sweep: {static: [true, false], scene: [grass]}\n"), "no error")
        << "some case reads it";
}

TEST(ResolveCases, RefusesACaseGivenTwice) {
    const Ledger ledger;
    EXPECT_EQ(errorText(
                  [&] {
                      ledger.cases(ledger.load(
                          "sweep: {zip: [{bias: [0.5, 0.5], static: [true, true]}]}\n"));
                  },
                  ledger.folder.path()),
              "DIR/t.yaml: the sweep gives the case 'sweep/t bias=0.5 static=true' twice");
    EXPECT_EQ(ledger.cases(ledger.load("sweep: {zip: [{bias: [0.5, 0.25]}]}\n")).size(), 2U);
}

/// A plan of more could not be read any more.
TEST(ResolveCases, RefusesMoreThanAPlanMayHave) {
    const Ledger ledger;
    EXPECT_EQ(
        errorText([&] { ledger.cases(ledger.load("sweep: {bias: {range: [0, 1, 0.000005]}}\n")); },
                  ledger.folder.path()),
        "DIR/t.yaml: the plan has 200001 cases; at most 200000 are allowed");
}

TEST(Ledger, TakesValueAndUnitFromTheCases) {
    const config::Experiment experiment = Ledger().bound(
        "sweep: {scene: [grass, scan], bias: [0.1, 0.2]}\noutput: {width: 64, height: 32}\n"
        "assumptions:\n  bias: {range: [0, 1], why: open}\n  static: {why: open}\n"
        "  scene: {range: {grass: [tree]}, why: open}\n  scene_seed: {range: [1, 5], why: open}\n"
        "  output: {why: open}\n  place: {value: 3, unit: m, why: open}\n");
    std::vector<std::pair<std::string, std::string>> values;
    for (const config::Assumption& each : experiment.assumptions) {
        values.emplace_back(each.value.text(), each.unit);
    }
    EXPECT_THAT(values,
                ElementsAre(Pair("0.1, 0.2", "texels"), Pair("false", ""), Pair("grass, scan", ""),
                            Pair("3", ""), Pair("64 × 32", "pixels"), Pair("3", "m")));
    EXPECT_TRUE(experiment.assumptions.front().isBound);
    EXPECT_FALSE(experiment.assumptions.back().isBound);
}

TEST(Ledger, TakesFramesFromWhatIsMeasured) {
    const Ledger ledger;
    const config::Experiment experiment = ledger.bound(
        "output: {frames: 7}\nassumptions:\n  output.frames: {range: [5, 9], why: open}\n");
    const config::Assumption& frames = experiment.assumptions.front();
    EXPECT_TRUE(frames.isBound);
    EXPECT_EQ(frames.value.text(), "7");
    EXPECT_EQ(frames.unit, "frames");
    const auto errorOf = [&](const std::string& entry) {
        return ledger.errorOf("output: {frames: 7}\nassumptions:\n  " + entry);
    };
    EXPECT_EQ(errorOf("output.frames: {range: [5, 9], why: open}\n"), "no error");
    EXPECT_EQ(errorOf("output.frames: {value: 7, why: open}\n"),
              "DIR/t.yaml:6:26: assumption 'output.frames': 'value' is filled in from the cases; "
              "allowed: range, why");
    EXPECT_EQ(errorOf("output.frames: {range: [8, 9], why: open}\n"),
              "DIR/t.yaml:6:26: assumption 'output.frames': range is [8, 9]; allowed: one that "
              "holds what is measured, 7");
    EXPECT_EQ(errorOf("output.frames: {range: [0, 9], why: open}\n"),
              "DIR/t.yaml:6:27: assumption 'output.frames': range is 0; allowed: 1 … 1000000");
    EXPECT_EQ(errorOf("output.frame: {why: open}\n"),
              "DIR/t.yaml:6:3: assumption 'output.frame' needs 'value': it is no parameter of "
              "technique 'still'; did you mean 'output.frames'?");
}

TEST(Ledger, RefusesWhatIsNotTheParameters) {
    const Ledger ledger;
    EXPECT_EQ(ledger.errorOf("assumptions:\n  bias: {value: 0.5, why: open}\n"),
              "DIR/t.yaml:5:17: assumption 'bias': 'value' is filled in from the cases; allowed: "
              "range, why");
    EXPECT_EQ(ledger.errorOf("assumptions:\n  bias: {unit: m, why: open}\n"),
              "DIR/t.yaml:5:3: assumption 'bias': 'unit' is filled in from the cases; allowed: "
              "range, why");
    EXPECT_EQ(ledger.errorOf("assumptions:\n  biass: {range: [0, 1], why: open}\n"),
              "DIR/t.yaml:5:3: assumption 'biass' needs 'value': it is no parameter of technique "
              "'still'; did you mean 'bias'?");
    EXPECT_EQ(ledger.errorOf("assumptions:\n  biass: {value: 0.5, range: [0, 1], why: open}\n"),
              "DIR/t.yaml:5:30: assumption 'biass' has a range of numbers: it is no parameter of "
              "technique 'still'; did you mean 'bias'?");
    EXPECT_EQ(ledger.errorOf("assumptions:\n  speed: {value: slow, range: [1, 2], why: open}\n"),
              "DIR/t.yaml:5:31: assumption 'speed' has a range of numbers: it is no parameter of "
              "technique 'still'");
    EXPECT_EQ(ledger.errorOf("assumptions:\n  biass: {value: 0.5, why: open}\n"),
              "DIR/t.yaml:5:18: assumption 'biass' is a number: it is no parameter of technique "
              "'still'; did you mean 'bias'?");
    EXPECT_EQ(ledger.errorOf("assumptions:\n  biass: {value: the middle, why: open}\n"), "no error")
        << "of words the name is anybody's";
}

TEST(Ledger, RefusesRangesWithoutWhatIsMeasured) {
    const Ledger ledger;
    const std::string range = "assumptions:\n  bias: {range: [0.5, 1], why: open}\n";
    EXPECT_EQ(ledger.errorOf("params: {bias: 0.25}\n" + range),
              "DIR/t.yaml:6:17: assumption 'bias': range is [0.5, 1]; allowed: one that holds what "
              "is measured, 0.25");
    EXPECT_EQ(ledger.errorOf("params: {bias: 0.75}\n" + range), "no error");
    EXPECT_EQ(
        ledger.errorOf("params: {bias: 1}\nassumptions:\n  bias: {range: [1, 1], why: open}\n"),
        "DIR/t.yaml:6:17: assumption 'bias': range is [1, 1]; allowed: one of more than one value");
    EXPECT_EQ(ledger.errorOf("sweep: {bias: [0.25, 1]}\n" + range), "no error");
}

TEST(Ledger, RefusesRangesThatACaseCannotTake) {
    const Ledger ledger;
    EXPECT_EQ(ledger.errorOf("assumptions:\n  bias: {range: [0.5, 5], why: open}\n"),
              "DIR/t.yaml:5:23: technique 'still': bias is 5; allowed: 0 … 1 texels");
    EXPECT_EQ(ledger.errorOf("sweep: {static: [false, true]}\n"
                             "assumptions:\n  bias: {range: [0.5, 0], why: open}\n"),
              "DIR/t.yaml:6:23: bias is 0, but static needs one");
    EXPECT_EQ(ledger.errorOf("assumptions:\n  static: {range: either, why: open}\n"),
              "DIR/t.yaml:5:19: assumption 'static': range is either; allowed: a list of values, "
              "or [first, last]");
    EXPECT_EQ(ledger.errorOf("assumptions:\n  output: {range: [0, 512], why: open}\n"),
              "DIR/t.yaml:5:20: assumption 'output': range is 0; allowed: 1 … 16384");
    EXPECT_EQ(ledger.errorOf("scene: grass\nassumptions:\n  scene: {range: [tee], why: open}\n"),
              "DIR/t.yaml:6:19: assumption 'scene': range is tee; allowed: catalogued scenes; did "
              "you mean 'tree'?");
    EXPECT_EQ(ledger.errorOf("sweep: {scene: [grass, scan]}\n"
                             "assumptions:\n  scene: {range: [tree], why: open}\n"),
              "DIR/t.yaml:6:18: assumption 'scene': range is [tree]; allowed: {NAME: [names]}, as "
              "sweep/t has 2 scenes: grass, scan");
    EXPECT_EQ(ledger.errorOf("scene: grass\nassumptions:\n"
                             "  bias: {range: [0, 1], why: open}\n"
                             "  scene: {range: [tree, tree@2], why: open}\n"),
              "no error");
}

TEST(Ledger, RefusesViewsThatTheSceneHasNot) {
    const Ledger ledger;
    const auto errorOf = [&](const std::string& range) {
        return ledger.errorOf("scene: tree\nassumptions:\n  view: {range: [" + range +
                              "], why: open}\n");
    };
    EXPECT_EQ(errorOf("whole, nowhere"),
              "DIR/t.yaml:6:25: assumption 'view': range is nowhere; allowed: paths and cameras of "
              "tree, whole");
    EXPECT_EQ(errorOf("whole"), "no error");
}

TEST(Ledger, RefusesScenesThatTakeNobodysPlace) {
    const Ledger ledger;
    ledger.folder.write("configs/scenes/hills.yaml",
                        "scene: hills\ndoc: d\nsources:\n  - {height_map: h.png, spacing_m: 1}\n");
    const auto errorOf = [&](const std::string& range) {
        return ledger.errorOf("sweep: {scene: [grass, scan]}\nassumptions:\n  scene: {range: {" +
                              range + "}, why: open}\n");
    };
    const std::string head = "DIR/t.yaml:6:";
    for (const std::string name : {"tree", "scene"}) {
        EXPECT_EQ(errorOf(name + ": [grass]"), head + "19: assumption 'scene': range: '" + name +
                                                   "' is no scene of sweep/t; it has grass, scan");
    }
    EXPECT_EQ(errorOf("grass: [tree, tree]"),
              head + "33: assumption 'scene': range is tree; allowed: each scene once");
    EXPECT_EQ(errorOf("grass: [grass]"),
              head + "26: assumption 'scene': range is [grass]; allowed: another scene than grass");
    EXPECT_EQ(
        errorOf("grass: [hills]"),
        head + "27: assumption 'scene': range is hills; allowed: models in the place of grass");
    EXPECT_EQ(errorOf("grass: []"),
              head + "26: assumption 'scene': range is []; allowed: a list of scenes");
    EXPECT_EQ(errorOf("grass: [tree@many]"),
              head + "27: the seed of scene 'tree' is 'many'; allowed: a whole number, at least 0");
    EXPECT_EQ(errorOf("grass: [tree, tree@2]"), "no error");
}

TEST(Ledger, RefusesAListOfWhatNobodyTries) {
    const Ledger ledger;
    EXPECT_EQ(
        ledger.errorOf("assumptions:\n  camera: {value: low, range: [low, high], why: open}\n"),
        "DIR/t.yaml:5:31: assumption 'camera' has a range that is no line of text: it is no "
        "parameter of technique 'still'");
    EXPECT_EQ(ledger.errorOf("assumptions:\n  camera: {value: low, range: any, why: open}\n"),
              "no error");
}

TEST(PaperCases, RefuseWhatTheTechniqueDoesNotTake) {
    const Ledger ledger;
    const auto errorOf = [&](const std::string& at) {
        ledger.folder.write("configs/at.yaml", "printed: {at: " + at + "}\n");
        return errorText(
            [&] {
                config::Experiment experiment = ledger.load("extends: at.yaml\n");
                experiment.paperDocument = experiment.document;
                resolvePaperCases(experiment, ledger.catalog(), kTechniques);
            },
            ledger.folder.path());
    };
    EXPECT_EQ(errorOf("{bias: 5}"),
              "DIR/configs/at.yaml:1:22: printed.at: bias is 5; allowed: 0 … 1 texels");
    EXPECT_EQ(
        errorOf("{bias: much}"),
        "DIR/configs/at.yaml:1:22: printed.at: bias is much; allowed: a number, 0 … 1 texels");
    EXPECT_EQ(
        errorOf("{biass: 1}"),
        "DIR/configs/at.yaml:1:23: printed.at: 'biass' is no parameter; did you mean 'bias'?");
    EXPECT_EQ(errorOf("{scene: gras}"),
              "DIR/configs/at.yaml:1:23: printed.at: scene is gras; allowed: a catalogued scene");
    EXPECT_EQ(errorOf("{bias: 0.25, scene: grass}"), "no error");
}

TEST(Cases, TakeParametersInsteadOfValuesAndDefaults) {
    const Ledger ledger;
    const auto bias = [&](const std::string& lines) {
        return ledger.cases(ledger.load(lines)).front().params.find("bias")->text();
    };
    EXPECT_EQ(bias("params: {bias: 0.1}\nparams_instead: {bias: 0.2}\n"), "0.2");
    EXPECT_EQ(bias("params_instead: {bias: 0.2}\n"), "0.2");
    // What nothing reads is refused where it is given, not where it takes a default's place.
    EXPECT_EQ(errorText([&] { bias("params: {last: 1}\n"); }, ledger.folder.path()),
              "DIR/t.yaml:4:16: 'last' needs 'static: true'");
    EXPECT_EQ(bias("params_instead: {last: 1}\n"), "0.5");
    EXPECT_EQ(
        errorText([&] { bias("params_instead: {biass: 1}\n"); }, ledger.folder.path()),
        "DIR/t.yaml:4:18: technique 'still': unknown parameter 'biass'; did you mean 'bias'?");
    EXPECT_EQ(errorText([&] { bias("sweep: {bias: [0.1]}\nparams_instead: {bias: 1}\n"); },
                        ledger.folder.path()),
              "DIR/t.yaml:5:18: 'params_instead': 'bias' is swept here");
}

TEST(Cases, TakeSeedsAndOtherScenes) {
    const Ledger ledger;
    const auto scenes = [&](const std::string& lines) {
        std::vector<std::pair<std::string, std::string>> result;
        for (const Case& item : ledger.cases(ledger.load(lines))) {
            result.emplace_back(item.scene.text(),
                                item.standsFor.isNull() ? "" : item.standsFor.text());
        }
        return result;
    };
    const std::string swept = "sweep: {scene: [grass, scan]}\n";
    EXPECT_THAT(scenes(swept + "scene_instead: {grass: grass@8}\n"),
                ElementsAre(Pair("grass@8", "grass"), Pair("scan", "")));
    EXPECT_THAT(scenes(swept + "scene_instead: {grass: tree}\n"),
                ElementsAre(Pair("tree", "grass"), Pair("scan", "")));
    EXPECT_THAT(scenes(swept + "scene_seeds: 3\nmeasure: {lane: quality}\n"),
                ElementsAre(Pair("grass", ""), Pair("grass@4", "grass"), Pair("grass@5", "grass"),
                            Pair("scan", "")));
    const auto errorOf = [&](const std::string& lines) {
        return errorText([&] { scenes(lines); }, ledger.folder.path());
    };
    EXPECT_EQ(errorOf("scene: scan\nscene_instead: {grass: tree}\n"),
              "DIR/t.yaml:5:17: 'scene_instead': no case of sweep/t has the scene 'grass'");
    const std::string refused = "'scene_seeds' takes no times; allowed: 1, or with lane: quality";
    EXPECT_EQ(errorOf("scene: grass\nscene_seeds: 5\nmeasure: {lane: timing}\n"),
              "DIR/t.yaml:5:14: " + refused);
    EXPECT_EQ(errorOf("scene: grass\nscene_seeds: 5\n"), "DIR/t.yaml:5:14: " + refused)
        << "what nobody laid out shows times, which no other key turns off";
}

TEST(Cases, TakeTheParametersOfTheirScene) {
    const Ledger ledger;
    const auto biases = [&](const std::string& lines) {
        std::vector<std::string> result;
        for (const Case& item : ledger.cases(ledger.load(lines))) {
            result.push_back(item.params.find("bias")->text());
        }
        return result;
    };
    const std::string swept = "sweep: {scene: [grass, scan]}\n";
    const std::string grass = "params_by_scene: {grass: {bias: 0.2}}\n";
    EXPECT_THAT(biases(swept + grass), ElementsAre("0.2", "0.5"));
    EXPECT_THAT(biases(swept + "params: {bias: 0.1}\n" + grass), ElementsAre("0.2", "0.1"));
    EXPECT_THAT(biases("sweep: {scene: [grass@7, scan]}\n" + grass), ElementsAre("0.2", "0.5"));
    EXPECT_THAT(biases("scene: grass\nscene_instead: {grass: tree}\n" + grass), ElementsAre("0.2"));
    EXPECT_THAT(biases(swept + grass + "params_instead: {bias: 0.6}\n"), ElementsAre("0.6", "0.6"));
    ledger.folder.write("configs/grass.yaml", grass);
    EXPECT_THAT(biases("extends: grass.yaml\nscene: grass\nsweep: {bias: [0.3, 0.4]}\n"),
                ElementsAre("0.3", "0.4"));
    EXPECT_THAT(biases("extends: grass.yaml\nscene: scan\n"), ElementsAre("0.5"))
        << "what is extended serves others, too";
    const config::Experiment bound =
        ledger.bound(swept + grass + "assumptions:\n  bias: {range: [0, 1], why: open}\n");
    EXPECT_EQ(bound.assumptions.front().value.text(), "0.2, 0.5");
}

TEST(Cases, RefuseParametersOfNoScene) {
    const Ledger ledger;
    const auto errorOf = [&](const std::string& lines) {
        return errorText([&] { ledger.cases(ledger.load("scene: grass\n" + lines)); },
                         ledger.folder.path());
    };
    EXPECT_EQ(
        errorOf("params_by_scene:\n  gras: {bias: 0.2}\n"),
        "DIR/t.yaml:6:3: 'gras': no case has the scene of params_by_scene; did you mean 'grass'?");
    EXPECT_EQ(
        errorOf("params_by_scene:\n  grass: {biass: 0.2}\n"),
        "DIR/t.yaml:6:11: technique 'still': unknown parameter 'biass'; did you mean 'bias'?");
    ledger.folder.write("configs/gras.yaml", "params_by_scene:\n  gras: {bias: 0.2}\n");
    EXPECT_EQ(
        errorOf("extends: gras.yaml\n"),
        "DIR/configs/gras.yaml:2:3: params_by_scene: unknown scene 'gras'; did you mean 'grass'?");
    ledger.folder.write("configs/tree.yaml", "params_by_scene:\n  tree: {biass: 0.2}\n");
    EXPECT_EQ(errorOf("extends: tree.yaml\n"),
              "DIR/configs/tree.yaml:2:10: params_by_scene: unknown parameter 'biass'; did you "
              "mean 'bias'?");
    EXPECT_EQ(errorOf("params_by_scene:\n  grass: {bias: 2}\n"),
              "DIR/t.yaml:6:17: technique 'still': bias is 2; allowed: 0 … 1 texels");
    EXPECT_EQ(errorOf("params_by_scene:\n  grass: 2\n"),
              "DIR/t.yaml:6:10: params_by_scene: 'grass' is 2; allowed: a map {name: value}");
    EXPECT_EQ(errorOf("params_by_scene:\n  grass@3: {bias: 0.2}\n"),
              "DIR/t.yaml:6:3: params_by_scene: 'grass@3'; allowed: a scene without seed and "
              "parameters, whose cases it is of");
}

TEST(Cases, TakeParametersOfTheGeneratedScene) {
    const Ledger ledger;
    const auto scenes = [&](const std::string& lines) {
        std::vector<std::pair<std::string, std::string>> result;
        for (const Case& item : ledger.cases(ledger.load(lines))) {
            const Node* count = item.params.find("scene.triangles");
            result.emplace_back(item.scene.text() + " for " + item.standsFor.text(),
                                count ? count->text() : "");
        }
        return result;
    };
    EXPECT_THAT(scenes("scene: grass\nscene_params: {triangles: 40000}\n"),
                ElementsAre(Pair("grass?triangles=40000 for grass", "40000")));
    EXPECT_THAT(scenes("sweep: {scene: [grass, tree], scene.triangles: [40000]}\n"
                       "scene_instead: {grass: grass@8, tree: tree@8}\n"),
                ElementsAre(Pair("grass?triangles=40000@8 for grass", "40000"),
                            Pair("tree?triangles=40000@8 for tree", "40000")));
    const std::vector<Case> cases =
        ledger.cases(ledger.load("scene: grass\nsweep: {scene.triangles: [40000, 50000]}\n"));
    EXPECT_EQ(cases[1].title(), "sweep/t scene.triangles=50000 (grass?triangles=50000)");
    EXPECT_NE(ledger.catalog().contentKey(cases[0].scene),
              ledger.catalog().contentKey(cases[1].scene));
    EXPECT_EQ(cases[1].recordedParams().find("scene.triangles")->asInteger(), 50000);

    const auto errorOf = [&](const std::string& lines) {
        return errorText([&] { scenes(lines); }, ledger.folder.path());
    };
    EXPECT_EQ(errorOf("scene: scan\nscene_params: {triangles: 40000}\n"),
              "DIR/t.yaml:5:16: scene 'scan' is not generated, so it has no parameter 'triangles': "
              "it is the file s.obj");
    EXPECT_EQ(errorOf("scene: grass\nscene_params: {triangle: 40000}\n"),
              "DIR/t.yaml:5:16: generator 'grass': unknown parameter 'triangle'; did you mean "
              "'triangles'?");
    EXPECT_EQ(errorOf("scene: grass\nscene_params: {triangles: 1}\n"),
              "DIR/t.yaml:5:27: generator 'grass': triangles is 1; allowed: 10000 … 4000000");
    EXPECT_EQ(errorOf("scene: grass\nscene_params: {triangles: [1, 2]}\n"),
              "DIR/t.yaml:5:27: generator 'grass': triangles is [1, 2]; allowed: a whole number, "
              "10000 … 4000000");
}

TEST(Cases, SayWhichSceneTheyTake) {
    const Ledger ledger;
    const std::vector<Case> cases =
        ledger.cases(ledger.load("scene: grass\nscene_seeds: 2\nmeasure: {lane: quality}\n"));
    const nlohmann::ordered_json params = cases[1].recordedParams().toJson();
    EXPECT_EQ(params.at(config::kStandsFor), "grass");
    EXPECT_EQ(params.at(config::kSceneSample), 1);
    EXPECT_EQ(cases[1].title(), "sweep/t (grass@4)");
    EXPECT_EQ(cases[0].recordedParams().find(config::kStandsFor), nullptr);
}

TEST(Plan, KeepsWhatIsAssumed) {
    const Ledger ledger;
    const Plan plan = makePlan({ledger.load("params: {bias: 0.25}\n"
                                            "assumptions:\n  bias: {range: [0, 1], why: open}\n")},
                               ledger.catalog(), kTechniques, "full", "software", 1);
    const auto file = ledger.folder.path() / "plan.json";
    plan.writeFile(file);
    const config::Assumption kept =
        Plan::fromJsonFile(file).experiments.front().assumptions.front();
    EXPECT_EQ(kept.value.text(), "0.25");
    EXPECT_EQ(kept.unit, "texels");
    EXPECT_TRUE(kept.isBound);
}

/// Digits alone are a number to who reads a table of cases: 46e288818872 is one beyond all.
TEST(Plan, IdsBeginWithALetterAndThoseOfBeforeAreRead) {
    const Ledger ledger;
    Plan plan = makePlan({ledger.load("sweep: {bias: [0.25, 0.5]}\n")}, ledger.catalog(),
                         kTechniques, "full", "software", 1);
    const auto file = ledger.folder.path() / "plan.json";
    for (Case& item : plan.cases) {
        EXPECT_EQ(item.id.size(), 13U);
        EXPECT_EQ(item.id.front(), 'c');
        item.id.erase(0, 1);
    }
    plan.writeFile(file);
    const Plan read = Plan::fromJsonFile(file);
    ASSERT_EQ(read.cases.size(), 2U);
    EXPECT_EQ(read.cases[1].id, plan.cases[1].id);
    std::swap(plan.cases[0].id, plan.cases[1].id);
    plan.writeFile(file);
    EXPECT_THROW(Plan::fromJsonFile(file), Error);
}

/// Before anything is measured: a larger one would be written and never read.
TEST(Plan, IsNoLargerThanIsRead) {
    const Ledger ledger;
    Plan plan = makePlan({ledger.load("")}, ledger.catalog(), kTechniques, "full", "software", 1);
    const auto file = ledger.folder.path() / "plan.json";
    const std::uintmax_t bytes = planBytes(plan);
    plan.writeFile(file, bytes);
    EXPECT_EQ(fs::file_size(file), bytes);
    fs::remove(file);
    const std::string config = plan.experiments.front().file.string();
    const std::string why = ": plan.json would have " + std::to_string(bytes) + " bytes; at most " +
                            std::to_string(bytes - 1) + " are read. Measure it in parts (--only)";
    EXPECT_EQ(errorText([&] { plan.writeFile(file, bytes - 1); }), config + why);
    EXPECT_FALSE(fs::exists(file));
    requirePlanBytes(plan, kMostPlanBytes);
    plan.experiments.push_back(plan.experiments.front());
    EXPECT_EQ(errorText([&] { requirePlanBytes(plan, kMostPlanBytes + 1); }),
              config +
                  " and 1 more: plan.json would have 1073741825 bytes; at most 1073741824 are "
                  "read. Measure it in parts (--only)");
}

}  // namespace
}  // namespace gfxrepro::run
