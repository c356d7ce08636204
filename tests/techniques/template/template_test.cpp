// All methods against what is known of their pictures, and what is refused.
#include "techniques/template/template.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <set>
#include <string>

#include "scenes/shared/mesh_builder.h"
#include "techniques/kit/view.h"
#include "tests/techniques/technique_fixture.h"

namespace gfxrepro::template_ {
namespace {

constexpr glm::ivec2 kSizePx{96, 64};

struct TemplateTest : test::TechniqueTest {
    TemplateTest() : TechniqueTest(kTemplate, kSizePx) {}
};

TEST_F(TemplateTest, ARampHasHalfItsBrightness) {
    for (const double brightness : {0.0, 0.5, 1.0}) {
        auto m =
            recorded(fmt::format("{{method: gradient, brightness: {}, errors: true}}", brightness),
                     nullptr)
                .metrics;
        EXPECT_NEAR(m["mean_brightness"], brightness / 2, 1e-6);
        EXPECT_EQ(m["wrong_pct"], 0.0);
    }
    EXPECT_EQ(passes_, std::vector<std::string>{"draw"});
}

TEST_F(TemplateTest, ADitheredRampHasTheMeanOfTheRamp) {
    const test::MetricRecorder dithered =
        recorded("{method: dither, tile: 48, errors: true}", nullptr);
    auto m = dithered.metrics;
    const double pixels = kSizePx.x * kSizePx.y;
    EXPECT_EQ(m["mean_brightness"], m["white_pixels/draw"] / pixels);
    // 48² thresholds decide, and each of two pixels: a share p of them scatters by less than this.
    EXPECT_NEAR(m["mean_brightness"], 0.5, 4 * std::sqrt(0.25 / (48.0 * 48.0)));
    EXPECT_GT(m["white_pixels/draw"], 0.0);
    EXPECT_EQ(dithered.withTruth, std::set<std::string>{"result"});
    EXPECT_EQ(recorded("{method: dither, tile: 48}", nullptr).metrics,
              recorded("{method: dither, tile: 48}", nullptr).metrics);
}

TEST_F(TemplateTest, EachMethodHasItsParameters) {
    test::expectRefused(kTemplate,
                        {{"{method: dither, tile: 4}", ""},
                         {"{method: silhouette, view: \"30 20\"}", ""},
                         {"{method: gradient, tile: 4}", "26: 'tile' needs 'method: dither'"},
                         {"{method: dither, view: x}", "24: 'view' needs 'method: silhouette'"}});
}

TEST_F(TemplateTest, ASilhouetteCoversWhatItsCornersEnclose) {
    const std::array<glm::vec3, 4> corners = {{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}};
    scene::MeshBuilder builder;
    builder.addQuad(corners[0], corners[1], corners[2], corners[3]);
    const scene::Scene scene = scene::sceneOf(builder.take("plate", -1));
    auto m = recorded("{method: silhouette, errors: true}", &scene).metrics;

    // The area of the projected corners, by the shoelace formula.
    const float aspect = static_cast<float>(kSizePx.x) / static_cast<float>(kSizePx.y);
    const kit::View view = kit::viewOf(scene::framingCamera(scene.bounds(), aspect), kSizePx);
    double areaPx = 0.0, outlinePx = 0.0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const glm::vec2 a = kit::project(view, corners[i]).value();
        const glm::vec2 b = kit::project(view, corners[(i + 1) % corners.size()]).value();
        areaPx += 0.5 * static_cast<double>(a.x * b.y - a.y * b.x);
        outlinePx += static_cast<double>(glm::length(b - a));
    }
    const double pixels = kSizePx.x * kSizePx.y;
    ASSERT_GT(areaPx, 0.1 * pixels);
    // Pixels count by their centres: along an edge the error averages out to far less than this.
    EXPECT_NEAR(m["mean_brightness"] * pixels, areaPx, 0.1 * outlinePx);
    EXPECT_LE(m["wrong_pct"] / 100 * pixels, 1.01);  // an edge may touch a pixel's centre
}

TEST_F(TemplateTest, APathHasAViewAFrame) {
    scene::MeshBuilder builder;
    builder.addQuad({0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0});
    const scene::Scene scene = scene::sceneOf(builder.take("plate", -1));
    // From before the plate to beside it.
    const std::string path =
        "{method: silhouette, view: \"1 0.5 6 > 1 0.5 0; 7 0.5 0.5 > 1 0.5 0\"}";
    const double before = recorded(path, &scene, 0, 2).metrics["mean_brightness"];
    const double beside = recorded(path, &scene, 1, 2).metrics["mean_brightness"];
    EXPECT_GT(beside, 0.0);
    EXPECT_GT(before, 1.5 * beside);
    EXPECT_EQ(errorText([] {
                  Params params = test::paramsOf(kTemplate, "{method: gradient}");
                  kTemplate.create(params)->requireFrames(2);
              }),
              "2 frames: the technique draws the same in each; allowed: 1");
}

TEST_F(TemplateTest, ASilhouetteNeedsTriangles) {
    EXPECT_EQ(errorText([&] { recorded("{method: silhouette}", nullptr); }),
              "the technique needs a scene, and the case has none");
    Params params = test::paramsOf(kTemplate, "{method: silhouette, view: walk}");
    const auto technique = kTemplate.create(params);
    scene::MeshBuilder builder;
    builder.addQuad({0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0});
    const scene::Scene scene = scene::sceneOf(builder.take("plate", -1));
    EXPECT_THAT(errorText([&] { technique->requireScene(scene); }), HasSubstr("'walk'"));
}

}  // namespace
}  // namespace gfxrepro::template_
