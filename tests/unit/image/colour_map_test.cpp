#include "engine/image/colour_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include "tests/support/support.h"

namespace gfxrepro::image {
namespace {

using Colour = std::array<std::uint8_t, 3>;
using test::errorText;

/// Entries of matplotlib 3.6.3 that are no control colours: magma's 8th, 101st, 200th and 247th,
/// coolwarm's second and 32nd of 33.
TEST(ColourMap, FollowsThePublishedTables) {
    const auto expectNear = [](const Colour& a, const Colour& b, int tolerance) {
        for (std::size_t c = 0; c < 3; ++c) EXPECT_LE(std::abs(a[c] - b[c]), tolerance);
    };
    expectNear(colourOf(ColourMap::Magma, 8.0F / 255.0F), {3, 3, 18}, 3);
    expectNear(colourOf(ColourMap::Magma, 101.0F / 255.0F), {139, 41, 129}, 3);
    expectNear(colourOf(ColourMap::Magma, 200.0F / 255.0F), {253, 152, 105}, 3);
    expectNear(colourOf(ColourMap::Magma, 247.0F / 255.0F), {252, 238, 176}, 3);
    expectNear(colourOf(ColourMap::CoolWarm, 1.0F / 32.0F), {68, 90, 204}, 2);
    expectNear(colourOf(ColourMap::CoolWarm, 31.0F / 32.0F), {192, 40, 47}, 8);
}

TEST(ColourMap, EndsMiddleAndBeyond) {
    EXPECT_EQ(colourOf(ColourMap::Magma, 0.0F), (Colour{0, 0, 4}));
    EXPECT_EQ(colourOf(ColourMap::Magma, 1.0F), (Colour{252, 253, 191}));
    EXPECT_EQ(colourOf(ColourMap::Magma, -7.0F), colourOf(ColourMap::Magma, 0.0F));
    const float infinity = std::numeric_limits<float>::infinity();
    EXPECT_EQ(colourOf(ColourMap::Magma, infinity), colourOf(ColourMap::Magma, 1.0F));
    EXPECT_EQ(colourOf(ColourMap::CoolWarm, 0.5F), (Colour{221, 221, 221}));
    EXPECT_EQ(colourOf(ColourMap::CoolWarm, std::nanf("")), (Colour{0, 255, 0}));
    EXPECT_EQ(colourOf(ColourMap::Grey, 0.2F), (Colour{51, 51, 51}));
}

/// The order of magnitudes survives in print: magma's lightness only grows.
TEST(ColourMap, MagmaGrowsLighter) {
    double last = -1.0;
    for (int i = 0; i <= 64; ++i) {
        const Colour c = colourOf(ColourMap::Magma, static_cast<float>(i) / 64.0F);
        const double luma = 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
        EXPECT_GT(luma, last) << i;
        last = luma;
    }
}

TEST(ColourMap, ShowsARange) {
    ImageF depths(3, 1, 1);
    depths.at(0, 0) = 2.0F;
    depths.at(1, 0) = 3.0F;
    depths.at(2, 0) = 4.0F;
    const Image8 picture = coloured(depths, ColourMap::CoolWarm, 2.0F, 4.0F);
    EXPECT_EQ(picture.at(0, 0, 2), 192);
    EXPECT_EQ(picture.at(1, 0, 0), 221);
    EXPECT_EQ(picture.at(2, 0, 0), 180);
    // From high to low: the other way round.
    EXPECT_EQ(coloured(depths, ColourMap::CoolWarm, 4.0F, 2.0F).at(0, 0, 0), 180);
}

TEST(ColourMap, RefusesWhatHasNoRange) {
    EXPECT_EQ(errorText([] { coloured(ImageF(2, 2, 3), ColourMap::Magma, 0, 1); }),
              "a colour map shows 1 channel, found 3");
    EXPECT_EQ(errorText([] { coloured(ImageF(2, 2, 1), ColourMap::Magma, 1, 1); }),
              "a colour map needs two finite ends that differ, found 1 and 1");
    EXPECT_EQ(errorText([] { coloured(ImageF(2, 2, 1), ColourMap::Magma, 0, std::nanf("")); }),
              "a colour map needs two finite ends that differ, found 0 and nan");
}

}  // namespace
}  // namespace gfxrepro::image
