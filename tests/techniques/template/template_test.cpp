// Both methods against what is known of their pictures, and what is refused.
#include "techniques/template/template.h"

#include <fmt/format.h>

#include <array>

#include "scenes/shared/mesh_builder.h"
#include "techniques/kit/view.h"
#include "tests/techniques/technique_fixture.h"

namespace gfxrepro::template_ {
namespace {

constexpr glm::ivec2 kSizePx{96, 64};

class TemplateTest : public test::TechniqueTest {
  protected:
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

TEST_F(TemplateTest, ASilhouetteNeedsTriangles) {
    EXPECT_EQ(test::errorText([&] { recorded("{method: silhouette}", nullptr); }),
              "the technique needs a scene, and the case has none");
}

}  // namespace
}  // namespace gfxrepro::template_
