// Levels of textures, and what is read of them over a footprint.
#include "techniques/reflections/surfaces.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/techniques/reflections/reflections_fixture.h"

namespace gfxrepro::reflections {
namespace {

scene::Scene texturedSquare(const image::Image8& texture) {
    scene::Scene scene;
    addPart(scene, squareMesh(), {.baseColorTexture = 0});
    scene.textures = {texture};
    return scene;
}

TEST(TextureFilterTest, KeepsLevelsWhereTexturesAreFiltered) {
    const scene::Scene scene = texturedSquare({8, 8, 3});
    const ReflectiveScene filtered(scene);
    ASSERT_EQ(filtered.textureLevels().size(), 10U);
    EXPECT_EQ(filtered.textureLevels()[1].at(0).width(), 256);
    EXPECT_EQ(filtered.textureLevels().back().at(0).width(), 1);
    EXPECT_EQ(filtered.valueLevels(), TextureLevels{{}});
    const ReflectiveScene finest(scene, {}, TextureFilter::FinestLevel);
    EXPECT_EQ(finest.textureLevels().size(), 1U);
}

TEST(TextureFilterTest, FootprintsAreAsWideAsWhatABeamCoversIsLong) {
    // The texture's side is 2 m, 6 m of the stretched instance.
    const ReflectiveScene scene(texturedSquare({8, 8, 3}));
    const glm::mat4 rest(1.0F);
    const glm::vec3 straight(0, 0, -1), slanted = glm::normalize(glm::vec3(0.6F, 0, -0.8F));
    EXPECT_NEAR(scene.footprintAt(0, rest, straight, 0.01F), 0.05F, 1e-6F);
    EXPECT_NEAR(scene.footprintAt(0, rest, -straight, 0.04F), 0.1F, 1e-6F);
    EXPECT_NEAR(scene.footprintAt(1, rest, slanted, 0.01F), 0.05F / 0.8F, 1e-6F);
    EXPECT_NEAR(scene.footprintAt(0, glm::scale(rest, glm::vec3(3)), straight, 0.01F), 0.05F / 3.0F,
                1e-6F);
    EXPECT_GT(scene.footprintAt(0, rest, {1, 0, 0}, 0.01F), 1e10F);  // edge-on: all of it
    const ReflectiveScene finest(texturedSquare({8, 8, 3}), {}, TextureFilter::FinestLevel);
    EXPECT_EQ(finest.footprintAt(0, rest, straight, 0.01F), 0.0F);
}

TEST(TextureFilterTest, AveragesTexturesOverTheFootprint) {
    // Black and white columns, a texel wide.
    const image::Image8 columns =
        imageOf([](int x, int) { return glm::u8vec3(x % 2 == 1 ? 255 : 0); });
    scene::Scene scene = texturedSquare(columns);
    scene.materials[0].baseColor = glm::vec4(1.0F);
    const ReflectiveScene prepared(scene);
    const auto white = [&](float texels) {  // in the middle of a white one
        return prepared.albedoAt(0, {301.5F / 512.0F, 0.25F}, texels / 512.0F).x;
    };
    EXPECT_NEAR(white(0.0F), 1.0F, 1e-3F);
    EXPECT_NEAR(white(0.5F), 1.0F, 1e-3F);
    EXPECT_NEAR(white(1.0F), 1.0F, 1e-3F);
    EXPECT_NEAR(white(std::sqrt(2.0F)), 0.75F, 5e-3F);  // half way to the next level, all grey
    EXPECT_NEAR(white(2.0F), 0.5F, 5e-3F);
    EXPECT_NEAR(white(100.0F), 0.5F, 5e-3F);
    EXPECT_NEAR(white(1e30F), 0.5F, 5e-3F);
    EXPECT_NEAR(ReflectiveScene(scene, {}, TextureFilter::FinestLevel)
                    .albedoAt(0, {301.5F / 512.0F, 0.25F}, 1.0F)
                    .x,
                1.0F, 1e-3F);
}

}  // namespace
}  // namespace gfxrepro::reflections
