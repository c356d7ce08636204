// Errors and pictures of hand-made pictures.
#include "techniques/shared/reflections/displayed_errors.h"

#include <gtest/gtest.h>

#include "runner/image/srgb.h"

namespace gfxrepro::reflections {
namespace {

TEST(DisplayedErrorsTest, AreMeansOfShownDifferences) {
    image::ImageF a(2, 1, 3, 0.0F);
    image::ImageF b(2, 1, 3, 0.0F);
    b.at(0, 0, 0) = 1.0F;       // 255
    b.at(0, 0, 1) = 0.214041F;  // 127.5 … shown as 128 or 127
    b.at(1, 0, 2) = 2.0F;       // as bright as shown
    const std::vector<std::uint8_t> first{1, 0};
    EXPECT_EQ(channelErrors(a, b, &first).x, 255.0);
    EXPECT_NEAR(channelErrors(a, b, &first).y, 127.5, 0.5);
    EXPECT_EQ(channelErrors(a, b, &first).z, 0.0);
    EXPECT_EQ(channelErrors(a, b, nullptr).x, 127.5);
    EXPECT_EQ(channelErrors(a, b, nullptr).z, 127.5);
    const std::vector<std::uint8_t> none{0, 0};
    EXPECT_EQ(channelErrors(a, b, &none), glm::dvec3(0.0));
    EXPECT_EQ(shownPsnrDb(a, a), kEqualPsnrDb);
    EXPECT_NEAR(shownPsnrDb(a, image::ImageF(2, 1, 3, 1.0F)), 0.0, 1e-9);
}

TEST(DisplayedErrorsTest, PicturesAverageSamplesAndTurnRows) {
    HostGBuffer gbuffer;
    gbuffer.view.sizePx = {4, 4};
    gbuffer.surface.assign(16, 0);
    gbuffer.diffuse.assign(16, glm::vec3(0.0F));
    gbuffer.surface[0] = 1;  // the lowest sample on the left
    EXPECT_EQ(reflectivePixels(gbuffer, 2), (std::vector<std::uint8_t>{0, 0, 1, 0}));
    std::vector<std::uint8_t> marks(16, 0);
    marks[0] = marks[1] = 1;
    const image::ImageF marked = markedPicture(image::ImageF(2, 2, 3, 0.5F), marks, gbuffer, 2);
    EXPECT_FLOAT_EQ(marked.at(0, 1, 0), 0.5F * 0.3F + 0.5F);  // half of its samples
    EXPECT_FLOAT_EQ(marked.at(0, 1, 1), 0.5F * 0.3F);
    EXPECT_FLOAT_EQ(marked.at(1, 1, 0), 0.3F);
    const image::ImageF error = errorPicture(image::ImageF(1, 1, 3, 0.0F),
                                             image::ImageF(1, 1, 3, 1.0F / 12.92F / 255.0F), 50);
    // One level, fifty times: what is shown as 50.
    EXPECT_EQ(image::toSrgb8(error).at(0, 0), 50);
}

}  // namespace
}  // namespace gfxrepro::reflections
