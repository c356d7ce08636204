#include "engine/scene/scene_reference.h"

#include "tests/support/support.h"

namespace gfxrepro::scene {
namespace {

Node reference(const std::string& text) {
    return Node::scalar(text, SourceLocation{"t.yaml", 5, 8});
}

TEST(SceneReference, HasParametersAndSeed) {
    const SceneReference city =
        SceneReference::from(reference("outdoor/city?towers=4&width_m=0.5@3"));
    EXPECT_EQ(city.name, "outdoor/city");
    EXPECT_EQ(city.params.toFlowText(), "{towers: 4, width_m: 0.5}");
    EXPECT_EQ(city.seed, "3");
    EXPECT_EQ(city.text(), "outdoor/city?towers=4&width_m=0.5@3");
    for (const char* text : {"outdoor/city", "outdoor/city@3", "outdoor/city?density=0.5"}) {
        EXPECT_EQ(SceneReference::from(reference(text)).text(), text);
        EXPECT_EQ(sceneName(text), "outdoor/city") << text;
        EXPECT_FALSE(isSceneFile(text)) << text;
    }
}

TEST(SceneReference, IsAFileWhereTheNameHasAnExtension) {
    for (const char* text : {"scan.glb", "dir.x/a@3.glb"}) {
        EXPECT_TRUE(isSceneFile(text)) << text;
        EXPECT_EQ(sceneName(text), text);
        EXPECT_EQ(SceneReference::from(reference(text)).name, text);
    }
    EXPECT_TRUE(isSceneFile("scan.glb?x=1"));
}

TEST(SceneReference, TakesSeedAndParameters) {
    EXPECT_EQ(withSeed(reference("a@5"), 7).text(), "a@7");
    EXPECT_EQ(withSeed(reference("a?n=1"), 7).text(), "a?n=1@7");
    const Node params = parseYaml("{n: 2, kind: tall, lit: true}", "p.yaml");
    EXPECT_EQ(withSceneParams(reference("a@5"), params).text(), "a?n=2&kind=tall&lit=true@5");
    EXPECT_EQ(withSceneParams(reference("a?m=1&n=1"), params).text(),
              "a?m=1&n=2&kind=tall&lit=true");
    EXPECT_EQ(withSeed(reference("a@5"), 7).location().line, 5);
}

TEST(SceneReference, RefusesWhatIsNoParameter) {
    const auto errorOf = [](const std::string& text) {
        return errorText([&] { SceneReference::from(reference(text)); });
    };
    EXPECT_EQ(errorOf("a?blades"),
              "t.yaml:5:8: scene 'a?blades': 'blades' is no parameter; allowed: "
              "SCENE?NAME=VALUE&NAME=VALUE@SEED");
    EXPECT_EQ(errorOf("a?n=1&=2"),
              "t.yaml:5:8: scene 'a?n=1&=2': '=2' is no parameter; allowed: "
              "SCENE?NAME=VALUE&NAME=VALUE@SEED");
    EXPECT_EQ(errorOf("a?n=[1, 2]"),
              "t.yaml:5:8: scene 'a?n=[1, 2]': 'n=[1, 2]' is no parameter; allowed: "
              "SCENE?NAME=VALUE&NAME=VALUE@SEED");
    EXPECT_EQ(
        errorText([] { withSceneParams(reference("a"), parseYaml("n: [1, 2]", "p.yaml")); }),
        "p.yaml:1:4: scene parameter 'n' is [1, 2]; allowed: a number, true, false or a name");
}

}  // namespace
}  // namespace gfxrepro::scene
