// Errors of hand-made pictures.
#include "techniques/kit/displayed_errors.h"

#include <gtest/gtest.h>

#include "engine/image/srgb.h"

namespace gfxrepro::kit {
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

TEST(DisplayedErrorsTest, PicturesAreDifferencesAsShown) {
    const image::ImageF error = errorPicture(image::ImageF(1, 1, 3, 0.0F),
                                             image::ImageF(1, 1, 3, 1.0F / 12.92F / 255.0F), 50);
    // One level, fifty times: what is shown as 50.
    EXPECT_EQ(image::toSrgb8(error).at(0, 0), 50);
}

}  // namespace
}  // namespace gfxrepro::kit
