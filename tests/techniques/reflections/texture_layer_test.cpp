// Resampling of textures: a box filter in linear light.
#include "techniques/reflections/surfaces.h"

#include <gtest/gtest.h>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/image/srgb.h"
#include "tests/support/grid.h"
#include "tests/techniques/reflections/reflections_fixture.h"

namespace gfxrepro::reflections {
namespace {

/// Every value different from its neighbours'.
image::Image8 pattern(int width, int height, int channels) {
    image::Image8 image(width, height, channels);
    int next = 0;
    for (std::uint8_t& value : image.values()) {
        value = static_cast<std::uint8_t>(next);
        next = (next + 89) % 256;
    }
    return image;
}

TEST(TextureLayerTest, LeavesTheSameSizeAsItIs) {
    const image::Image8 image = pattern(16, 16, 4);
    EXPECT_EQ(textureLayer(image, 16), image);
}

TEST(TextureLayerTest, AddsAlpha) {
    const image::Image8 layer = textureLayer(pattern(4, 4, 3), 4);
    ASSERT_EQ(layer.channels(), 4);
    EXPECT_EQ(layer.at(2, 3, 3), 255);
    EXPECT_EQ(layer.at(2, 3, 1), pattern(4, 4, 3).at(2, 3, 1));
}

TEST(TextureLayerTest, AveragesInLinearLight) {
    // Black and white columns, three to two: texels cover 1½ of them each.
    image::Image8 image(3, 1, 3);
    for (int channel = 0; channel < 3; ++channel) image.at(1, 0, channel) = 255;
    const image::Image8 layer = textureLayer(image, 2);
    // Each is 1 part black, ½ part white: a linear third, 156 in sRGB (85 if encoded values were
    // averaged).
    for (const auto [y, x] : test::grid(2, 2)) EXPECT_EQ(layer.at(x, y, 0), 156) << x << " " << y;
}

TEST(TextureLayerTest, HalvesInLinearLight) {
    image::Image8 image(2, 4, 4);
    for (int channel = 0; channel < 4; ++channel) {
        image.at(1, 0, channel) = image.at(0, 1, channel) = 255;
        image.at(0, 2, channel) = 255;
    }
    const image::Image8 half = halvedLayer(image);
    ASSERT_EQ(half.width(), 1);
    ASSERT_EQ(half.height(), 2);
    EXPECT_EQ(half.at(0, 0, 0), 188);  // a linear half
    EXPECT_EQ(half.at(0, 0, 3), 128);
    EXPECT_EQ(half.at(0, 1, 1), 137);  // a quarter
    EXPECT_EQ(halvedLayer(image, TexelKind::Values).at(0, 1, 1), 64);
}

TEST(TextureLayerTest, KeepsTheMeanOfSizesThatDoNotDivide) {
    const std::array<float, 256> decoding = image::srgbDecoding();
    const auto meanOf = [&](const image::Image8& image) {
        double sum = 0.0;
        for (const auto [y, x] : test::grid(image.height(), image.width()))
            sum += decoding[image.at(x, y, 0)];
        return sum / (image.width() * image.height());
    };
    for (const int size : {3, 7, 33, 64}) {
        const image::Image8 image = pattern(size, size + 5, 3);
        // Rounding to 8 bits moves the mean by less than half a step of the brightest.
        EXPECT_NEAR(meanOf(textureLayer(image, 16)), meanOf(image), 0.002) << size;
    }
}

TEST(TextureLayerTest, AveragesValuesAsTheyAre) {
    image::Image8 image(3, 1, 3);
    for (int channel = 0; channel < 3; ++channel) image.at(1, 0, channel) = 255;
    const image::Image8 layer = textureLayer(image, 2, TexelKind::Values);
    for (int x = 0; x < 2; ++x) EXPECT_EQ(layer.at(x, 1, 0), 85) << x;
    const image::Image8 same = pattern(16, 16, 4);
    EXPECT_EQ(textureLayer(same, 16, TexelKind::Values), same);
}

TEST(TextureLayerTest, EnlargesToBlocks) {
    const image::Image8 image = pattern(2, 2, 3);
    const image::Image8 layer = textureLayer(image, 8);
    for (const auto [y, x] : test::grid(8, 8)) {
        ASSERT_EQ(layer.at(x, y, 2), image.at(x / 4, y / 4, 2)) << x << " " << y;
    }
}

// Levels of textures, and what is read of them over a footprint.

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
