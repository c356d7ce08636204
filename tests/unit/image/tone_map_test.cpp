#include "engine/image/srgb.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace gfxrepro::image {
namespace {

ImageF one(std::initializer_list<float> values) {
    ImageF image(1, 1, static_cast<int>(values.size()));
    std::copy(values.begin(), values.end(), image.values().begin());
    return image;
}

TEST(ToneMap, KnownAnswers) {
    // Two stops up: 0.25 is 1. ACES at 1: 0.9216 / 1.3688.
    EXPECT_NEAR(toneMapped(one({0.25F}), 2.0F, ToneMap::Aces).at(0, 0), 0.6732905, 1e-6);
    EXPECT_NEAR(toneMapped(one({0.25F}), 2.0F, ToneMap::Reinhard).at(0, 0), 0.5F, 1e-6);
    EXPECT_EQ(toneMapped(one({0.25F}), 1.0F, ToneMap::None).at(0, 0), 0.5F);
    EXPECT_EQ(toneMapped(one({0.25F}), 3.0F, ToneMap::None).at(0, 0), 1.0F);
    // Luminance of (1, 2, 3): 0.2126 + 1.4304 + 0.2166.
    const ImageF colour = toneMapped(one({1.0F, 2.0F, 3.0F}), 0.0F, ToneMap::Reinhard);
    EXPECT_NEAR(colour.at(0, 0, 0), 1.0 / 2.8596, 1e-6);
    EXPECT_EQ(colour.at(0, 0, 2), 1.0F);
}

TEST(ToneMap, ExtremesAndAlpha) {
    for (const ToneMap map : {ToneMap::None, ToneMap::Reinhard, ToneMap::Aces}) {
        EXPECT_EQ(toneMapped(one({-5.0F}), 0.0F, map).at(0, 0), 0.0F);
        EXPECT_EQ(toneMapped(one({0.0F}), 4.0F, map).at(0, 0), 0.0F);
    }
    for (const float most :
         {std::numeric_limits<float>::max(), std::numeric_limits<float>::infinity()}) {
        EXPECT_EQ(toneMapped(one({most}), 4.0F, ToneMap::Aces).at(0, 0), 1.0F);
        EXPECT_EQ(toneMapped(one({most}), 4.0F, ToneMap::Reinhard).at(0, 0), 1.0F);
    }
    EXPECT_EQ(toneMapped(one({std::nanf("")}), 0.0F, ToneMap::None).at(0, 0), 0.0F);
    EXPECT_EQ(toneMapped(one({1.0F, 1.0F, 1.0F, 7.0F}), 3.0F, ToneMap::Aces).at(0, 0, 3), 7.0F);
}

}  // namespace
}  // namespace gfxrepro::image
