#include "runner/run/measure.h"

#include <gtest/gtest.h>

namespace gfxrepro::test {
namespace {

using run::Pacing;

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

}  // namespace
}  // namespace gfxrepro::test
