#include "runner/run/measure.h"

#include <gtest/gtest.h>

namespace gfxrepro::run {
namespace {

config::Measure timing(int repeats, int frames) {
    config::Measure measure;
    measure.lane = config::Measure::Lane::Timing;
    measure.repeats = repeats;
    measure.frames = frames;
    return measure;
}

TEST(Pacing, OnASoftwareDeviceAndInTheQualityLaneAsTheConfigSays) {
    config::Measure quality = timing(5, 1);
    quality.lane = config::Measure::Lane::Quality;
    for (const Pacing& pacing : {Pacing::of(timing(5, 1), false), Pacing::of(quality, true)}) {
        EXPECT_EQ(pacing.warmUpS, 0.0);
        EXPECT_EQ(pacing.warmUpAtMostS, 0.0);
        EXPECT_EQ(pacing.busyS, 0.0);
        EXPECT_EQ(pacing.repeatsS, 0.0);
        EXPECT_EQ(pacing.repeatsAtMost, 5);
        EXPECT_EQ(pacing.inFlight(1.0), 1);
    }
}

TEST(Pacing, OnHardwareByTimeWhichTheFramesShare) {
    EXPECT_EQ(Pacing::of(timing(1, 1), true).repeatsS, 0.2);
    EXPECT_EQ(Pacing::of(timing(1, 500), true).repeatsS, 0.0004);
    EXPECT_EQ(Pacing::of(timing(1, 1), true).repeatsAtMost, 10);
    EXPECT_EQ(Pacing::of(timing(200, 1), true).repeatsAtMost, 200);
    EXPECT_GE(Pacing::of(timing(1, 1), true).warmUpS, 0.2);
}

TEST(Pacing, SettledAreThreeTimesWithinTwoPercent) {
    EXPECT_FALSE(Pacing::areSettled({}));
    EXPECT_FALSE(Pacing::areSettled({1.0, 1.0}));
    EXPECT_TRUE(Pacing::areSettled({9.0, 1.0, 1.0, 1.019}));
    EXPECT_FALSE(Pacing::areSettled({1.0, 1.0, 1.0, 1.03}));
    EXPECT_FALSE(Pacing::areSettled({1.03, 1.0, 1.0}));
}

TEST(Pacing, FramesInFlightTakeFiftyMillisecondsTogether) {
    const Pacing pacing = Pacing::of(timing(1, 1), true);
    EXPECT_EQ(pacing.inFlight(0.0), 8);
    EXPECT_EQ(pacing.inFlight(1.0), 8);
    EXPECT_EQ(pacing.inFlight(20.0), 3);
    EXPECT_EQ(pacing.inFlight(50.0), 1);
    EXPECT_EQ(pacing.inFlight(900.0), 1);
}

image::ImageF ramp(float shift = 0.0F) {
    image::ImageF image(32, 16, 3);
    for (int y = 0; y < 16; ++y) {
        for (int x = 0; x < 32; ++x) {
            for (int c = 0; c < 3; ++c) image.at(x, y, c) = static_cast<float>(x) / 31.0F + shift;
        }
    }
    return image;
}

RepeatWork work(std::uint64_t primitives, std::uint64_t fragments, float shift = 0.0F) {
    return {gl::Work{primitives, fragments, 7}, ImageDigest::of(ramp(shift))};
}

TEST(ImageDigest, TellsBlankPicturesAndCellMeans) {
    EXPECT_TRUE(ImageDigest::of(image::ImageF(5, 3, 4, 0.25F)).isBlank);
    const ImageDigest digest = ImageDigest::of(ramp());
    EXPECT_FALSE(digest.isBlank);
    EXPECT_EQ(digest.range, 1.0F);
    EXPECT_NEAR(digest.means[0], 1.5F / 31.0F, 1e-6F);  // columns 0 to 3
    EXPECT_NEAR(digest.means[7], 29.5F / 31.0F, 1e-6F);
    EXPECT_EQ(digest.hash, ImageDigest::of(ramp()).hash);
    EXPECT_NE(digest.hash, ImageDigest::of(ramp(1e-6F)).hash);
}

TEST(ImageDigest, SmallPicturesHaveEmptyCells) {
    image::ImageF image(2, 1, 1);
    image.at(1, 0, 0) = 3.0F;
    const ImageDigest digest = ImageDigest::of(image);
    EXPECT_EQ(digest.means[0], 0.0F);
    EXPECT_EQ(digest.means[4], 3.0F);
    EXPECT_EQ(digest.means[63], 0.0F);
}

TEST(EqualWork, TheSameIsFine) {
    EXPECT_EQ(whyUnequal({}), "");
    EXPECT_EQ(whyUnequal({work(5, 1000)}), "");
    EXPECT_EQ(whyUnequal({work(5, 1000), work(5, 1000)}), "");
    // Orders of sums and of early depth tests.
    EXPECT_EQ(whyUnequal({work(5, 1000), work(5, 1009, 0.005F)}), "");
    // A device that does not count, a technique without a picture.
    EXPECT_EQ(whyUnequal({{}, {}}), "");
}

TEST(EqualWork, APointOfMillionsMayDependOnTheOrder) {
    EXPECT_EQ(whyUnequal({work(2'480'376, 100), work(2'480'377, 100)}), "");
    EXPECT_EQ(whyUnequal({work(2'480'376, 100), work(2'480'476, 100)}),
              "repeat 1 has 2480476 primitives, repeat 0 has 2480376");
}

TEST(EqualWork, AWorkGroupOfAMillionInvocationsMayDependOnTheOrder) {
    RepeatWork first = work(5, 1000), other = first;
    first.counts->invocations = 1'233'024;
    other.counts->invocations = 1'233'088;
    EXPECT_EQ(whyUnequal({first, other}), "");
    other.counts->invocations = 1'233'152;
    EXPECT_EQ(whyUnequal({first, other}),
              "repeat 1 has 1233152 compute invocations, repeat 0 has 1233024");
}

TEST(EqualWork, DifferencesAreNamedWithTheirNumbers) {
    EXPECT_EQ(whyUnequal({work(5, 1000), work(5, 1000), work(6, 1000)}),
              "repeat 2 has 6 primitives, repeat 0 has 5");
    EXPECT_EQ(whyUnequal({work(5, 1000), work(5, 1011)}),
              "repeat 1 has 1011 fragments, repeat 0 has 1000");
    EXPECT_EQ(whyUnequal({work(5, 1000), work(5, 1000, 0.02F)}),
              "repeat 1 drew a different picture than repeat 0");
    RepeatWork idle = work(5, 1000);
    idle.counts->invocations = 0;
    EXPECT_EQ(whyUnequal({work(5, 1000), idle}),
              "repeat 1 has 0 compute invocations, repeat 0 has 7");
    RepeatWork blank = work(5, 1000);
    blank.image = ImageDigest::of(image::ImageF(8, 8, 3));
    EXPECT_EQ(whyUnequal({blank}), "the picture of repeat 0 is blank: all its pixels are the same");
}

}  // namespace

}  // namespace gfxrepro::run
