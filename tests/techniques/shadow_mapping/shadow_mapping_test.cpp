// The technique as a whole: passes, metrics, errors of an analytic scene, what it refuses.
#include "techniques/shadow_mapping/shadow_mapping.h"

#include <fmt/format.h>

#include "scenes/shared/mesh_builder.h"
#include "techniques/shadow_mapping/lights.h"
#include "tests/techniques/technique_fixture.h"

namespace gfxrepro::shadow_mapping {
namespace {

/// A plate that floats over a floor.
scene::Scene plateOverFloor() {
    scene::MeshBuilder builder;
    builder.addBox({0, -0.05F, 0}, {1.5F, 0.05F, 1.5F});
    builder.addBox({0, 0.7F, 0}, {0.5F, 0.05F, 0.5F});
    scene::Scene scene = scene::sceneOf(builder.take("test", -1));
    const scene::Camera camera{
        .position = {1.0F, 4.0F, 5.0F}, .target = {0, 0, 0}, .verticalFovRad = 0.8F};
    scene.cameras = {camera};
    return scene;
}

struct ShadowMappingTest : test::TechniqueTest {
    ShadowMappingTest() : TechniqueTest(kShadowMapping, {96, 96}) {}
    scene::Scene scene_ = plateOverFloor();
};

TEST_F(ShadowMappingTest, BothMethodsAndAllLightsAreWrongAtEdgesOnly) {
    for (const char* method : {"standard", "hardware"}) {
        for (const char* kind : {"spot", "directional", "point"}) {
            for (const char* filter : {"nearest", "bilinear", "pcf"}) {
                SCOPED_TRACE(fmt::format("{} {} {}", method, kind, filter));
                auto m = recorded(fmt::format("{{method: {}, light_kind: {}, filter: {}, errors: "
                                              "true, slope_bias: 2}}",
                                              method, kind, filter),
                                  &scene_)
                             .metrics;
                EXPECT_GT(m["compared_points"], 1000.0);
                EXPECT_LT(m["acne_pct"], 0.1);
                EXPECT_LT(m["leak_pct"], 0.1);
                EXPECT_LT(m["edge_pct"], 3.0);
                EXPECT_NEAR(m["wrong_pct"], m["acne_pct"] + m["leak_pct"] + m["edge_pct"], 1e-9);
            }
        }
    }
}

TEST_F(ShadowMappingTest, NoBiasGivesAcneAndTooMuchLeaks) {
    auto none =
        recorded("{bias: 0, slope_bias: 0, errors: true, shadow_map_size: 128}", &scene_).metrics;
    auto much =
        recorded("{bias: 0.9, slope_bias: 0, errors: true, shadow_map_size: 128}", &scene_).metrics;
    EXPECT_GT(none["acne_pct"], 1.0);
    EXPECT_EQ(much["acne_pct"], 0.0);
    EXPECT_GT(much["leak_pct"], 1.0);
}

TEST_F(ShadowMappingTest, MethodsAgree) {
    auto m = recorded("{compare_methods: true, depth_format: float32}", &scene_).metrics;
    EXPECT_LT(m["methods_differ_pct"], 0.1);
}

TEST_F(ShadowMappingTest, AKeptMapIsNotDrawnAgain) {
    recorded("{}", &scene_);
    EXPECT_EQ(passes_, (std::vector<std::string>{"depth_pass", "shading_pass"}));
    recorded("{static: true}", &scene_);
    EXPECT_EQ(passes_, std::vector<std::string>{"shading_pass"});
}

TEST_F(ShadowMappingTest, TheYardstickIsOnePassMore) {
    recorded("{yardstick: true}", &scene_);
    EXPECT_EQ(passes_, (std::vector<std::string>{"depth_pass", "yardstick_pass", "shading_pass"}));
}

TEST_F(ShadowMappingTest, VarianceIsWrongAtEdgesOnly) {
    auto m =
        recorded(
            "{method: standard, filter: variance, shadow_map_size: 128, bias: 0.01, errors: true}",
            &scene_)
            .metrics;
    EXPECT_EQ(m["acne_pct"], 0.0);
    EXPECT_LT(m["leak_pct"], 0.1);
    EXPECT_GT(m["edge_pct"], 0.0);
    EXPECT_LT(m["edge_pct"], 5.0);
}

TEST_F(ShadowMappingTest, DeclaresTheStepsOfTable43) {
    auto standard = recorded("{method: standard, filter: bilinear}", &scene_).metrics;
    EXPECT_EQ(standard["colour_writes/depth_pass"], 1.0);
    EXPECT_EQ(standard["comparisons/shading_pass"], 4.0);
    auto hardware = recorded("{method: hardware, filter: bilinear}", &scene_).metrics;
    EXPECT_EQ(hardware["colour_writes/depth_pass"], 0.0);
    EXPECT_EQ(hardware["fetches/shading_pass"], 1.0);
    EXPECT_EQ(hardware["comparisons/shading_pass"], 0.0);
}

TEST_F(ShadowMappingTest, TakesTheViewThatIsNamed) {
    scene_.cameras.push_back(scene_.cameras[0]);
    scene_.cameras[1].name = "away";
    scene_.cameras[1].position = {3.0F, 12.0F, 15.0F};
    const auto points = [&](const char* yaml) {
        return recorded(yaml, &scene_).metrics.at("compared_points");
    };
    EXPECT_LT(points("{errors: true, view: away}"), 0.5 * points("{errors: true}"));
    EXPECT_EQ(errorText([&] { recorded("{view: back}", &scene_); }).substr(0, 39),
              "the scene has no path or camera 'back';");
}

TEST_F(ShadowMappingTest, BadInput) {
    const auto message = [&](const std::string& yaml) {
        return errorText([&] { recorded(yaml, &scene_); });
    };
    EXPECT_EQ(message("{shadow_map_size: 32768}"),
              "case.yaml:1:19: technique 'shadow_mapping': shadow_map_size is 32768; allowed: 16 … "
              "16384 pixels");
    EXPECT_EQ(errorText([&] { recorded("{}", nullptr); }),
              "the technique needs a scene, and the case has none");
    const scene::Scene empty;
    EXPECT_EQ(errorText([&] { recorded("{}", &empty); }),
              "technique 'shadow_mapping' needs a scene with triangles");
    EXPECT_EQ(message("{light_place: scene}"),
              "'light_place: scene' with 1 lights: the scene has 0");
    EXPECT_EQ(message("{light_distance: 0}"),
              "a spot light's target is its position: it looks nowhere");
    EXPECT_EQ(message("{filter: variance}"),
              "case.yaml:1:10: 'filter: variance' needs 'method: standard': moments are colours");
    EXPECT_EQ(message("{static: true, yardstick: true}"),
              "case.yaml:1:27: 'yardstick' needs 'static: false'");
    scene_.lights = {{.position = {0.0F, 0.7F, 0.0F}}};
    EXPECT_EQ(message("{light_place: scene}"),
              "light 0 at (0.000, 0.700, 0.000) lies inside of geometry: every ray from it meets a "
              "surface from behind");
}

TEST_F(ShadowMappingTest, LightsThatSeeNothingAreCounted) {
    EXPECT_EQ(recorded("{}", &scene_).metrics["lights_without_caster"], 0.0);
    // The whole scene lies behind its far plane.
    std::vector<Light> lights(2);
    lights[0].positionWorld = {0, 5, 0};
    lights[0].nearM = 0.1F;
    lights[0].farM = 0.2F;
    lights[1].positionWorld = {0, 5, 0};
    EXPECT_EQ(lightsWithoutCaster(lights, scene_, 64), 1);
}

}  // namespace
}  // namespace gfxrepro::shadow_mapping
