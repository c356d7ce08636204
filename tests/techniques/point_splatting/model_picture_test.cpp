#include "techniques/point_splatting/point_splatting.h"

#include <gtest/gtest.h>

#include <array>
#include <initializer_list>

namespace gfxrepro::point_splatting {
namespace {

/// Pixels (x, y) with their green.
ModelPicture pictureWith(std::initializer_list<std::array<int, 2>> covered, float green) {
    image::ImageF rgba(8, 4, 4);
    for (const auto& [x, y] : covered) {
        rgba.at(x, y, 1) = green;
        rgba.at(x, y, 3) = 1.0F;
    }
    return ModelPicture(rgba);
}

TEST(ModelPicture, PixelsAreThoseThatEitherCovers) {
    const ModelPicture a = pictureWith({{1, 0}, {2, 3}}, 0.5F), b = pictureWith({{7, 3}}, 0.25F);
    const ModelPixels model(a, b);
    const image::ImageF inA = model.of(a.color), inB = model.of(b.color);
    ASSERT_EQ(inA.width(), 3);
    ASSERT_EQ(inA.channels(), 3);
    EXPECT_EQ(inA.at(0, 0, 1), 0.5F);
    EXPECT_EQ(inA.at(1, 0, 1), 0.5F);
    EXPECT_EQ(inA.at(2, 0, 1), 0.0F);
    EXPECT_EQ(inB.at(2, 0, 1), 0.25F);
    // Black that is covered is the model's.
    EXPECT_EQ(ModelPixels(pictureWith({{3, 3}}, 0.0F), a).of(a.color).width(), 3);
    const ModelPicture nothing = pictureWith({}, 0.0F);
    EXPECT_EQ(ModelPixels(nothing, nothing).of(nothing.color).width(), 1);
}

TEST(ModelPicture, SmallModelsAreEnlarged) {
    const auto part = pictureWith({{3, 1}, {4, 2}}, 0.5F).enlarged();
    ASSERT_TRUE(part);
    ASSERT_EQ(part->width(), 8);  // the middle 4 × 2 pixels, twice as large
    ASSERT_EQ(part->height(), 4);
    EXPECT_EQ(part->at(2, 0, 1), 0.5F);
    EXPECT_EQ(part->at(3, 1, 1), 0.5F);
    EXPECT_EQ(part->at(4, 1, 1), 0.0F);
    EXPECT_EQ(part->at(4, 2, 1), 0.5F);
    // One of a pair need not show as much: both show the same part.
    EXPECT_EQ(pictureWith({{3, 1}}, 0.5F).enlarged()->width(), 8);
    EXPECT_FALSE(pictureWith({{6, 1}}, 0.5F).enlarged());
    EXPECT_FALSE(pictureWith({{0, 0}, {0, 2}}, 1.0F).enlarged());
    EXPECT_FALSE(pictureWith({}, 1.0F).enlarged());
}

}  // namespace
}  // namespace gfxrepro::point_splatting
