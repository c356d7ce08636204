#include "engine/metrics/flip.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/support.h"
#include "tests/unit/metrics/pairs.h"

namespace gfxrepro::metrics {
namespace {

using image::ImageF;
using test::errorText;

/// One luminance is compared at one exposure, that which shows it as 0.85.
TEST(HdrFlip, ConstantReferenceHasOneExposure) {
    const ImageF grey(4, 4, 3, 8.0F);
    const Exposures exposures = flipExposures(grey);
    EXPECT_EQ(exposures.count, 1);
    EXPECT_EQ(exposures.start, exposures.stop);
    const double x = 8.0 * std::exp2(exposures.start);
    EXPECT_NEAR((0.9036 * x * x + 0.018 * x) / (0.8748 * x * x + 0.354 * x + 0.14), 0.85, 1e-6);
}

/// Twice the light moves the exposures by one stop and no error.
TEST(HdrFlip, DoesNotDependOnTheScaleOfTheLight) {
    const ImageF a = ranged(shapes(60, 40, 0)), b = ranged(shapes(60, 40, 3));
    ImageF a2 = a, b2 = b;
    for (float& value : a2.values()) value *= 2.0F;
    for (float& value : b2.values()) value *= 2.0F;
    EXPECT_NEAR(flipExposures(a2).start, flipExposures(a).start - 1.0, 1e-6);
    EXPECT_NEAR(hdrFlip(a2, b2), hdrFlip(a, b), 1e-5);
}

/// A difference far above 1 is none for LDR-FLIP, and one in the dark is small.
TEST(HdrFlip, SeesWhatOneExposureHides) {
    ImageF a(40, 20, 3, 0.5F), b = a;
    for (int y = 5; y < 10; ++y) {
        for (int x = 5; x < 10; ++x) {
            for (int c = 0; c < 3; ++c) {
                a.at(x, y, c) = 100.0F;
                b.at(x, y, c) = 10.0F;
            }
        }
    }
    EXPECT_EQ(flip(a, b), 0.0);
    EXPECT_GT(hdrFlip(a, b), 0.02);
    EXPECT_EQ(hdrFlip(a, a), 0.0);
}

TEST(HdrFlip, BlackReferences) {
    const ImageF black(6, 6, 3);
    EXPECT_EQ(flipExposures(black).count, 1);
    EXPECT_EQ(hdrFlip(black, black), 0.0);
    // Most is black: the median of the rest.
    ImageF spot = black;
    for (int c = 0; c < 3; ++c) spot.at(0, 0, c) = 2.0F;
    for (int c = 0; c < 3; ++c) spot.at(1, 0, c) = -3.0F;  // counts as black
    const Exposures exposures = flipExposures(spot);
    EXPECT_EQ(exposures.count, 1);
    EXPECT_TRUE(std::isfinite(exposures.stop));
    EXPECT_GT(hdrFlip(spot, black), 0.0);
}

TEST(HdrFlip, RefusesWhatCannotBeCompared) {
    EXPECT_EQ(errorText([] { hdrFlip(ImageF(2, 3, 3), ImageF(3, 3, 3)); }),
              "the images differ in shape: 2x3 with 3 channels and 3x3 with 3 channels");
    EXPECT_EQ(errorText([] { hdrFlip(ImageF(2, 3, 1), ImageF(2, 3, 1)); }),
              "FLIP compares images of 3 channels, found 1");
}

}  // namespace
}  // namespace gfxrepro::metrics
