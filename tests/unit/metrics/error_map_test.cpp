#include "engine/metrics/error_map.h"

#include <array>
#include <limits>

#include "tests/support/support.h"

namespace gfxrepro::metrics {
namespace {

using image::Image8;
using image::ImageF;

std::array<int, 3> pixel(const Image8& picture, int x) {
    return {picture.at(x, 0, 0), picture.at(x, 0, 1), picture.at(x, 0, 2)};
}
constexpr std::array<int, 3> kEqual{221, 221, 221};
constexpr std::array<int, 3> kTooDark{180, 4, 38};
constexpr std::array<int, 3> kTooBright{59, 76, 192};

/// Equal, test black, test white, and one channel off.
struct PictureAndTruth {
    ImageF reference{4, 1, 3, 0.5F}, test{4, 1, 3, 0.5F};
    PictureAndTruth() {
        for (int c = 0; c < 3; ++c) {
            reference.at(1, 0, c) = 1.0F;
            test.at(1, 0, c) = 0.0F;
            reference.at(2, 0, c) = 0.0F;
            test.at(2, 0, c) = 1.0F;
        }
        test.at(3, 0, 1) = 0.25F;
    }
};

TEST(ErrorMap, SignedErrorsHaveTheirColours) {
    const PictureAndTruth p;
    const Image8 picture = signedErrorPicture(p.reference, p.test);
    EXPECT_EQ(pixel(picture, 0), kEqual);
    EXPECT_EQ(pixel(picture, 1), kTooDark);
    EXPECT_EQ(pixel(picture, 2), kTooBright);
    // The other way round: the signs change.
    const Image8 swapped = signedErrorPicture(p.test, p.reference);
    EXPECT_EQ(pixel(swapped, 1), kTooBright);
    EXPECT_EQ(pixel(swapped, 2), kTooDark);
}

/// A third of the channels is off: sRGB of 0.5 is 0.735357, of 0.25 0.537099, so that the mean is
/// 0.0660860, and 0.0833333 in linear light. A gain of one over it gives the end of the map.
TEST(ErrorMap, GainAndSpaceOfSignedErrors) {
    const PictureAndTruth p;
    EXPECT_EQ(pixel(signedErrorPicture(p.reference, p.test, 15.14F), 3), kTooDark);
    EXPECT_NE(pixel(signedErrorPicture(p.reference, p.test, 14.0F), 3), kTooDark);
    EXPECT_EQ(pixel(signedErrorPicture(p.reference, p.test, 12.0F, ErrorOf::Linear), 3), kTooDark);
    EXPECT_NE(pixel(signedErrorPicture(p.reference, p.test, 11.0F, ErrorOf::Linear), 3), kTooDark);
    // An eighth of the map is its second control colour of each side.
    EXPECT_EQ(pixel(signedErrorPicture(p.reference, p.test, 1.5F, ErrorOf::Linear), 3),
              (std::array<int, 3>{236, 211, 197}));
}

TEST(ErrorMap, WhatNoDisplayShowsIsEqualUnlessLinear) {
    const ImageF reference(1, 1, 3, 1.0F), test(1, 1, 3, 3.0F);
    EXPECT_EQ(pixel(signedErrorPicture(reference, test), 0), kEqual);
    EXPECT_EQ(pixel(signedErrorPicture(reference, test, 1.0F, ErrorOf::Linear), 0), kTooBright);
    EXPECT_EQ(pixel(absoluteErrorPicture(reference, test), 0), (std::array<int, 3>{0, 0, 0}));
}

TEST(ErrorMap, AbsoluteErrorsAreValues) {
    const PictureAndTruth p;
    const Image8 picture = absoluteErrorPicture(p.reference, p.test, 1.0F, ErrorOf::Linear);
    EXPECT_EQ(pixel(picture, 0), (std::array<int, 3>{0, 0, 0}));
    EXPECT_EQ(pixel(picture, 2), (std::array<int, 3>{255, 255, 255}));
    EXPECT_EQ(pixel(picture, 3), (std::array<int, 3>{0, 64, 0}));
    EXPECT_EQ(pixel(absoluteErrorPicture(p.reference, p.test, 2.0F), 3),
              (std::array<int, 3>{0, 101, 0}));  // 2 · 255 · 0.198258
}

TEST(ErrorMap, AlphaIsNoColour) {
    ImageF a(1, 1, 4, 0.5F), b = a;
    b.at(0, 0, 3) = 0.0F;
    EXPECT_EQ(pixel(signedErrorPicture(a, b, 100.0F), 0), kEqual);
    EXPECT_EQ(absoluteErrorPicture(a, b).channels(), 3);
    ImageF grey(1, 1, 2, 0.5F), other = grey;
    other.at(0, 0, 1) = 0.0F;
    EXPECT_EQ(pixel(signedErrorPicture(grey, other, 100.0F), 0), kEqual);
    EXPECT_EQ(absoluteErrorPicture(grey, other).channels(), 1);
}

TEST(ErrorMap, FlipIsShownAsItsAuthorsDo) {
    ImageF map(2, 1, 1);
    map.at(1, 0) = 1.0F;
    const Image8 picture = flipPicture(map);
    EXPECT_EQ(pixel(picture, 0), (std::array<int, 3>{0, 0, 4}));
    EXPECT_EQ(pixel(picture, 1), (std::array<int, 3>{252, 253, 191}));
}

TEST(ErrorMap, RefusesWhatCannotBeCompared) {
    EXPECT_EQ(errorText([] { signedErrorPicture(ImageF(2, 3, 3), ImageF(3, 3, 3)); }),
              "the images differ in shape: 2x3 with 3 channels and 3x3 with 3 channels");
    EXPECT_EQ(errorText([] { absoluteErrorPicture(ImageF(), ImageF()); }), "the images are empty");
    const ImageF a(1, 1, 1);
    EXPECT_EQ(errorText([&] { signedErrorPicture(a, a, 0.0F); }),
              "a gain is positive and finite, found 0");
    EXPECT_EQ(
        errorText([&] { absoluteErrorPicture(a, a, std::numeric_limits<float>::infinity()); }),
        "a gain is positive and finite, found inf");
}

}  // namespace
}  // namespace gfxrepro::metrics
