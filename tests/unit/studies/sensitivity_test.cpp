#include "runner/studies/sensitivity.h"

#include "engine/core/node.h"
#include "scenes/registry.h"
#include "tests/support/support.h"

namespace gfxrepro::studies {
namespace {

using claims::ClaimResult;
using claims::Verdict;

Node node(const std::string& yaml) {
    return parseYaml(yaml, "t.yaml");
}

/// One that is bound to cases which take `value`; an empty one is free text.
config::Assumption assumption(const std::string& name, const std::string& value,
                              const std::string& range) {
    return config::Assumption{.name = name,
                              .value = Node::scalar(value),
                              .range = node(range),
                              .isBound = !value.empty()};
}

config::Case caseWith(const std::string& params, const std::string& axes = "{}") {
    config::Case item;
    item.params = node(params);
    item.axes = node(axes);
    item.outputWidthPx = 512;
    return item;
}

/// Two generated scenes and one of a file.
struct Scenes {
    TemporaryFolder folder;

    Scenes() {
        for (const char* name : {"city", "tree"}) {
            folder.write(
                std::string("scenes/") + name + ".yaml",
                std::string("scene: ") + name + "\ndoc: d\nsources: [{generator: tree}]\n");
        }
        folder.write("scenes/scan.yaml", "scene: scan\ndoc: d\nsources: [{file: s.obj}]\n");
        folder.write("assets/s.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    }
    scene::Catalog catalog() const {
        return {folder.path() / "scenes", folder.path() / "assets", scene::registeredGenerators()};
    }
};

std::vector<std::string> titles(const Variations& variations) {
    std::vector<std::string> all;
    for (const Variation& run : variations.runs) all.push_back(run.title());
    return all;
}

using Sensitivity = FolderTest;

TEST_F(Sensitivity, VariesWhatIsBoundByTurns) {
    config::Experiment experiment;
    experiment.assumptions = {assumption("bias", "0.02", "[0, 0.04]"),
                              assumption("size", "1024", "[16, 4096]"),
                              assumption("gain", "1", "[0.5, 1.7]"),
                              assumption("kind", "spot", "[spot, point]"),
                              assumption("output", "512", "[256, 512]"),
                              assumption("place", "", "[1, 2]"),
                              assumption("method", "a", "[a, b]"),
                              assumption("view", "top", ""),
                              assumption("box", "[1,2]", "[[1, 2], [3, 4]]"),
                              assumption("output.frames", "5", "[5, 20]")};
    const Variations variations = variationsOf(
        experiment,
        {caseWith(
             "{bias: 0.02, size: 1024, gain: 1, kind: spot, method: a, view: top, box: [1, 2]}"),
         caseWith("{method: a}", "{method: a}")},
        Scenes().catalog(), 3);
    EXPECT_THAT(titles(variations),
                ElementsAre("as configured", "bias = 0", "size = 16", "gain = 0.5", "kind = point",
                            "output = 256", "box = [3,4]", "output.frames = 13", "bias = 0.04",
                            "size = 256", "gain = 1.1", "output = 384", "output.frames = 20",
                            "size = 4096", "gain = 1.7"));
    EXPECT_THAT(variations.runs[5].sets, ElementsAre("output.width=256", "output.height=256"));
    EXPECT_THAT(variations.runs[1].sets, ElementsAre("params_instead.bias=0"));
    EXPECT_THAT(variations.runs[6].sets, ElementsAre("params_instead.box=[3,4]"));
    EXPECT_THAT(variations.runs[7].sets, ElementsAre("output.frames=13"));
    EXPECT_THAT(variations.fixed,
                ElementsAre(Pair("place", "no parameter of the technique"),
                            Pair("method", "an axis of the table: it is varied there"),
                            Pair("view", "it has no range")));
}

TEST_F(Sensitivity, VariesScenesBySeedAndByAlternatives) {
    config::Case city = caseWith("{}"), tree = city, scan = city;
    city.scene = node("city");
    tree.scene = node("tree@2");
    tree.standsFor = node("tree");
    scan.scene = node("scan");
    const Scenes scenes;
    const scene::Catalog catalog = scenes.catalog();
    config::Experiment experiment;
    experiment.assumptions = {assumption("scene", "city, tree@2", "{city: [deep], nest: [straw]}"),
                              assumption("scene_seed", "1, 2", "[4, 9]")};
    const Variations variations = variationsOf(experiment, {city, tree, scan}, catalog, 2);
    EXPECT_THAT(titles(variations), ElementsAre("as configured", "scene = deep for city",
                                                "scene_seed = 4", "scene_seed = 9"));
    EXPECT_THAT(variations.runs[1].sets, ElementsAre("scene_instead={city: deep}"));
    EXPECT_THAT(variations.runs[2].sets, ElementsAre("scene_instead={city: city@4, tree: tree@4}"));

    experiment.assumptions = {assumption("scene", "city", "{nest: [straw]}"),
                              assumption("scene_seed", "none", "[4, 9]")};
    EXPECT_THAT(variationsOf(experiment, {city}, catalog, 2).fixed,
                ElementsAre(Pair("scene", "no other scene for those of the table"),
                            Pair("scene_seed", "no scene of the table is generated")));
}

VariationResult outcome(const std::string& name, const std::string& value, Verdict verdict,
                        std::optional<double> margin = {}) {
    const ClaimResult claim{.id = "C", .text = "a < b", .verdict = verdict, .distance = margin};
    Variation variation{name, value, std::nullopt, {}};
    if (margin) variation.number = std::stod(value);
    return {variation, {claim}};
}

TEST_F(Sensitivity, SaysUnderWhatAClaimHolds) {
    const VariationResult base = outcome("", "", Verdict::Holds);
    EXPECT_EQ(dependence({base, outcome("bias", "0", Verdict::Holds, 1.0)}, 0),
              "holds under all 2");
    EXPECT_EQ(
        dependence({outcome("", "", Verdict::Fails), outcome("bias", "0", Verdict::Ambiguous)}, 0),
        "holds under none of 2");
    // Margins 3 at 1 and −1 at 5: 0 at 4.
    EXPECT_EQ(dependence({base, outcome("bias", "1", Verdict::Holds, 3.0),
                          outcome("bias", "5", Verdict::Fails, -1.0),
                          outcome("kind", "spot", Verdict::Holds)},
                         0),
              "holds unless bias is 5 (flips between 1 and 5, near 4)");
    EXPECT_EQ(dependence({outcome("", "", Verdict::Fails), outcome("kind", "a", Verdict::Fails),
                          outcome("kind", "b", Verdict::Holds)},
                         0),
              "holds only if kind is b");
}

VariationResult failed(const std::string& name, const std::string& value) {
    return {{name, value, std::nullopt, {}}, {}, "exit code 2: bias is 5"};
}

TEST_F(Sensitivity, LeavesOutWhatCouldNotBeMeasured) {
    const std::vector<VariationResult> outcomes{
        outcome("", "", Verdict::Holds), failed("bias", "5"), outcome("kind", "b", Verdict::Holds),
        outcome("kind", "c", Verdict::Unmeasured)};
    EXPECT_EQ(dependence(outcomes, 0), "holds under all 2");
    EXPECT_EQ(restsOn(outcomes, 0), "none (1 of 2 tried)");
    EXPECT_EQ(dependence({outcome("", "", Verdict::NotApplicable)}, 0), "not judged as configured");
}

TEST_F(Sensitivity, SaysWhatAVerdictRestsOn) {
    const VariationResult base = outcome("", "", Verdict::Fails);
    EXPECT_EQ(restsOn({base}, 0), "not tried");
    EXPECT_EQ(
        restsOn(
            {base, outcome("bias", "1", Verdict::Fails), outcome("kind", "b", Verdict::Holds),
             outcome("scene_seed", "2", Verdict::Ambiguous), outcome("kind", "c", Verdict::Holds)},
            0),
        "kind, scene_seed (of 3 tried)");
}

TEST_F(Sensitivity, SaysOfHowManyAssumptionsSomeWereTried) {
    Variations variations;
    for (const char* name : {"", "kind", "bias", "kind"})
        variations.runs.push_back({name, "", std::nullopt, {}});
    const std::vector<VariationResult> made{outcome("", "", Verdict::Fails),
                                            outcome("kind", "b", Verdict::Holds)};
    EXPECT_EQ(restsOn(made, 0), "kind (of 1 tried)");
    const std::vector<VariationResult> all = withLeft(made, variations, 2);
    ASSERT_EQ(all.size(), 4U);
    EXPECT_EQ(restsOn(all, 0), "kind (1 of 2 tried)");
    EXPECT_EQ(dependence(all, 0), dependence(made, 0));
    EXPECT_EQ(restsOn(withLeft({made[0], outcome("kind", "b", Verdict::Fails)}, variations, 2), 0),
              "none (1 of 2 tried)");
    EXPECT_EQ(restsOn(withLeft({made[0]}, variations, 3), 0), "not tried");
    const auto file = folder.write("p-1.csv", sensitivityCsv("p/1", all, "abc"));
    EXPECT_EQ(restsOn(readSensitivity(file, "p/1", "abc"), 0), "kind (1 of 2 tried)");
}

TEST_F(Sensitivity, WritesTablesAndReadsThemAgain) {
    config::Experiment experiment;
    experiment.id = "p/1";
    experiment.title = "T";
    std::vector<VariationResult> outcomes{
        outcome("", "", Verdict::Holds), outcome("kind", "b", Verdict::Fails), failed("bias", "5")};
    outcomes[1].claims[0].distance = -0.25;
    const std::string csv = sensitivityCsv("p/1", outcomes, "abc");
    EXPECT_EQ(csv,
              "table,basis,assumption,value,claim,verdict,measured,required,margin,error\n"
              "p/1,abc,,,C,holds,,,,\np/1,abc,kind,b,C,fails,,,-0.25,\n"
              "p/1,abc,bias,5,,,,,,exit code 2: bias is 5\n");
    const std::string text =
        sensitivityMarkdown(experiment, outcomes, {{}, {{"view", "it has no range"}}}, 2);
    for (const char* line :
         {"runs, 2 more were not made.",
          "| C | a \\< b | holds | kind (1 of 2 tried) | holds unless kind is b |\n",
          "| kind = b | fails:  |\n", "| bias = 5 | exit code 2: bias is 5 |\n",
          "- view: it has no range\n"}) {
        EXPECT_THAT(text, HasSubstr(line)) << line << '\n';
    }

    const auto file = folder.write("p-1.csv", csv);
    const std::vector<VariationResult> read = readSensitivity(file, "p/1", "abc");
    ASSERT_EQ(read.size(), 3U);
    EXPECT_EQ(sensitivityCsv("p/1", read, "abc"), csv);
    EXPECT_EQ(restsOn(read, 0), "kind (1 of 2 tried)");
    EXPECT_TRUE(readSensitivity(file, "p/1", "of another config").empty());
    folder.write("p-1.csv", csv + "p/1,abc,kind,c,C,perhaps,,,,\n");
    EXPECT_EQ(errorText([&] { readSensitivity(file, "p/1", "abc"); }, folder.path()),
              "DIR/p-1.csv:5: 'perhaps' is no verdict (holds, fails, ambiguous, not-applicable, "
              "unmeasured)");
}

TEST_F(Sensitivity, ATableTakesTheKeptPlaceOfItselfAlone) {
    const auto file = folder.path() / "software-quick.csv";
    const auto csv = [&](const char* table, const char* value) {
        return sensitivityCsv(table, {outcome("", "", Verdict::Holds), failed("bias", value)}, "a");
    };
    keepSensitivity(file, "p/2", csv("p/2", "1"));
    keepSensitivity(file, "p/1", csv("p/1", "2\n\"3\""));  // a row of several lines
    const std::string both = readFile(file);
    EXPECT_EQ(both,
              csv("p/1", "2\n\"3\"") + csv("p/2", "1").substr(csv("p/2", "1").find('\n') + 1));
    keepSensitivity(file, "p/2", csv("p/2", "4"));
    EXPECT_EQ(readSensitivity(file, "p/2").back().variation.value, "4");
    EXPECT_EQ(readSensitivity(file, "p/1").back().variation.value, "2\n\"3\"");
    keepSensitivity(file, "p/2", csv("p/2", "1"));
    EXPECT_EQ(readFile(file), both);
    EXPECT_TRUE(readSensitivity(file, "p/3").empty());
}

/// An experiment of one claim, and its plan of one case.
run::Plan planWith(const std::string& claim, int number) {
    run::Plan plan{.profile = "quick", .deviceClass = "software"};
    config::Experiment experiment;
    experiment.id = "p/1";
    experiment.document = node("{claims: {C: " + claim + "}}");
    plan.experiments.push_back(experiment);
    plan.cases.push_back(caseWith("{number: " + std::to_string(number) + "}"));
    plan.cases.back().experiment = "p/1";
    return plan;
}

TEST_F(Sensitivity, KeptResultsOfAnotherCaseOrClaimAreStale) {
    const run::Plan plan = planWith("{says: a, bound: n, at_least: 1}", 3);
    folder.write("software-quick.csv",
                 sensitivityCsv(
                     "p/1", {outcome("", "", Verdict::Holds), outcome("bias", "5", Verdict::Fails)},
                     basisOf(plan, plan.experiments.front())));
    const auto kept = [&](const run::Plan& of) {
        return keptSensitivity(of, of.experiments, folder.path());
    };
    const claims::KeptSensitivity own = kept(plan);
    ASSERT_EQ(own.size(), 1U);
    EXPECT_EQ(own.at({"p/1", "C"}).restsOn, "bias (of 1 tried)");
    EXPECT_EQ(own.at({"p/1", "C"}).verdict, Verdict::Holds);
    // What is said of a claim does not matter.
    const run::Plan reworded =
        planWith("{says: b, bound: n, at_least: 1, because: {verdict: fails}}", 3);
    EXPECT_EQ(kept(reworded).size(), 1U);
    EXPECT_TRUE(kept(planWith("{says: a, bound: n, at_least: 2}", 3)).empty());
    EXPECT_TRUE(kept(planWith("{says: a, bound: n, at_least: 1}", 4)).empty());
}

TEST_F(Sensitivity, TheContentOfEachSceneIsInTheBasis) {
    run::Plan plan = planWith("{says: a, bound: n, at_least: 1}", 3);
    const auto basis = [&] { return basisOf(plan, plan.experiments.front()); };
    const std::string none = basis();
    plan.cases.back().scene = node("a.ply");
    plan.cases.back().params.set("scene_b", node("b.ply"));
    plan.sceneKeys = {{"a.ply", "1"}, {"b.ply", "1"}};
    const std::string first = basis();
    EXPECT_NE(first, none);
    plan.sceneKeys["b.ply"] = "2";
    const std::string second = basis();
    EXPECT_NE(second, first);
    plan.sceneKeys = {{"a.ply", "2"}, {"b.ply", "1"}};
    EXPECT_NE(basis(), first);
    EXPECT_NE(basis(), second);
}

}  // namespace
}  // namespace gfxrepro::studies
