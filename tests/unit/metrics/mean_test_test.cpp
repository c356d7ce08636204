// How often pictures of one expectation are said to differ, and a bias is found: by simulation.
#include "engine/metrics/mean_test.h"

#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <numbers>

#include "engine/core/random.h"
#include "tests/support/grid.h"
#include "tests/support/support.h"

namespace gfxrepro::metrics {
namespace {

using image::ImageF;

constexpr int kWidthPx = 32, kHeightPx = 24;
constexpr std::size_t kSeeds = 6;

/// One sample of a pixel whose expectation is 1.
using Noise = std::function<double(Random&)>;

double uniform(Random& random) {
    return (static_cast<double>(random.next()) + 0.5) * 0x1p-32;
}

double normal(Random& random) {
    const double radius = std::sqrt(-2.0 * std::log(uniform(random)));
    return radius * std::cos(2.0 * std::numbers::pi * uniform(random));
}

double gaussian(Random& random) {
    return 1.0 + 0.5 * normal(random);
}

/// A light that is seen or not.
double coin(Random& random) {
    return random.index(4) == 0 ? 4.0 : 0.0;
}

double exponential(Random& random) {
    return -std::log(uniform(random));
}

/// A path tracer's: now and then a path of a hundred times the usual light.
double fireflies(Random& random) {
    return random.index(1000) == 0 ? 0.5 + 500.0 : 0.5;
}

/// Of infinite variance: P(> x) = x^−1.5, less where its mean of 3 is above 1.
double heavyTail(Random& random) {
    return std::pow(uniform(random), -1.0 / 1.5) / 3.0;
}

/// A picture of so many samples a pixel; in it a square of 8 × 8 pixels is `bias` too bright.
ImageF picture(const Noise& noise, int samples, Random& random, double bias = 0.0) {
    ImageF image(kWidthPx, kHeightPx, 1);
    for (const auto [y, x] : test::grid(kHeightPx, kWidthPx)) {
        double sum = 0.0;
        for (int i = 0; i < samples; ++i) sum += noise(random);
        const bool isBiased = x < kMeanTilePx && y < kMeanTilePx;
        image.at(x, y) = static_cast<float>(sum / samples * (isBiased ? 1.0 + bias : 1.0));
    }
    return image;
}

std::vector<std::vector<double>> pictures(std::size_t count, const Noise& noise, int samples,
                                          Random& random, double bias = 0.0) {
    std::vector<std::vector<double>> all;
    for (std::size_t i = 0; i < count; ++i) {
        all.push_back(tileMeans(picture(noise, samples, random, bias)));
    }
    return all;
}

struct Count {
    int alarms = 0;  // p was at most the level
    int unlike = 0;  // the noise of the two sides was found to be unlike, and p left alone
};

/// Of so many comparisons; printed for people.
Count countOf(const char* name, int trials, double level, const Noise& noise, int samplesA,
              int samplesB, double bias = 0.0, std::size_t seedsA = kSeeds) {
    Count count;
    for (int trial = 0; trial < trials; ++trial) {
        Random random(static_cast<std::uint64_t>(trial) + 1);
        const auto a = pictures(seedsA, noise, samplesA, random, bias);
        const auto b = pictures(kSeeds, noise, samplesB, random);
        const MeanTest test = testMeans(a, b);
        count.unlike += test.isUnlike ? 1 : 0;
        count.alarms += !test.isUnlike && test.p <= level ? 1 : 0;
    }
    std::printf(
        "  %s, %zu × %d against %zu × %d samples, bias %.3g %%: %.2f %% alarms at %g %%, %.2f %% "
        "unlike\n",
        name, seedsA, samplesA, kSeeds, samplesB, 100.0 * bias, 100.0 * count.alarms / trials,
        100.0 * level, 100.0 * count.unlike / trials);
    return count;
}

/// Sanitized, a few: of them nothing is asked.
constexpr int trialsOf(int count) {
    return test::kIsSanitized ? 4 : count;
}
int atLeast(double share, int trials) {
    return test::kIsSanitized ? 0 : static_cast<int>(std::ceil(share * trials));
}
/// The most alarms of a test that gives them in the share `level`, but for one try in 10,000.
int mostAlarms(int trials, double level) {
    if (test::kIsSanitized) return trials;
    const double mean = trials * level;
    return static_cast<int>(std::ceil(mean + 3.72 * std::sqrt(mean * (1.0 - level))));
}

struct Shape {
    const char* name;
    Noise noise;
    bool hasHeavyTail;
};
const std::vector<Shape>& noiseShapes() {
    static const std::vector<Shape> kShapes = {{"gaussian", gaussian, false},
                                               {"coin", coin, false},
                                               {"exponential", exponential, false},
                                               {"fireflies", fireflies, true},
                                               {"infinite variance", heavyTail, true}};
    return kShapes;
}

constexpr double kLevel = 0.05;

TEST(MeanTest, GivesNoMoreFalseAlarmsThanDeclaredWhateverTheNoise) {
    constexpr int kTrials = trialsOf(400);
    for (const auto& [name, noise, hasHeavyTail] : noiseShapes()) {
        const Count count = countOf(name, kTrials, kLevel, noise, 2, 2);
        EXPECT_LE(count.alarms, mostAlarms(kTrials, kLevel)) << name;
        EXPECT_LE(count.unlike, mostAlarms(kTrials, 0.01)) << name;
    }
}

/// Four times the pictures of a quarter of the samples have the same noise.
TEST(MeanTest, HoldsManyOfFewSamplesAgainstFewOfMany) {
    constexpr int kTrials = trialsOf(200);
    for (const auto& [name, noise, hasHeavyTail] : noiseShapes()) {
        const Count count = countOf(name, kTrials, kLevel, noise, 1, 4, 0.0, 4 * kSeeds);
        EXPECT_LE(count.alarms, mostAlarms(kTrials, kLevel)) << name;
        EXPECT_LE(count.unlike, mostAlarms(kTrials, 0.01)) << name;
    }
}

/// Unlike noise does no harm without heavy tails, and much of it is found to be unlike.
TEST(MeanTest, KnowsUnlikeNoise) {
    constexpr int kTrials = trialsOf(200);
    for (const auto& [name, noise, hasHeavyTail] : noiseShapes()) {
        if (hasHeavyTail) continue;
        EXPECT_LE(countOf(name, kTrials, kLevel, noise, 2, 4).alarms, mostAlarms(kTrials, kLevel))
            << name;
        EXPECT_LE(countOf(name, kTrials, kLevel, noise, 1, 4).alarms, mostAlarms(kTrials, kLevel))
            << name;
        EXPECT_GE(countOf(name, kTrials, kLevel, noise, 1, 16).unlike, atLeast(0.9, kTrials))
            << name;
    }
    countOf("fireflies", kTrials, kLevel, fireflies, 2, 3);
    countOf("fireflies", kTrials, kLevel, fireflies, 2, 4);
    countOf("fireflies", kTrials, kLevel, fireflies, 1, 16);
    countOf("infinite variance", kTrials, kLevel, heavyTail, 2, 3);
    countOf("infinite variance", kTrials, kLevel, heavyTail, 2, 4);
}

/// Gaussian noise of 50 % at 4 samples: a tile's mean is known to 50 % ÷ √(4 · 64) = 3.1 %, a
/// difference of two sides' means to 1.8 %.
TEST(MeanTest, FindsABiasOfATile) {
    constexpr int kTrials = trialsOf(100);
    const int most = atLeast(0.95, kTrials);
    EXPECT_GE(countOf("gaussian", kTrials, 0.01, gaussian, 4, 4, 0.25).alarms, most);
    EXPECT_LE(countOf("gaussian", kTrials, 0.01, gaussian, 4, 4, 0.02).alarms, 30);
    EXPECT_GE(countOf("exponential", kTrials, 0.01, exponential, 4, 4, 0.5).alarms, most);
}

TEST(MeanTest, SaysWhichBiasItSees) {
    constexpr int kTrials = trialsOf(100);
    Random random(7);
    const auto first = pictures(kSeeds, gaussian, 4, random);
    const double seen = testMeans(first, pictures(kSeeds, gaussian, 4, random)).seen;
    EXPECT_GE(countOf("gaussian", kTrials, 0.01, gaussian, 4, 4, seen).alarms,
              atLeast(0.5, kTrials));
    const int few = countOf("gaussian", kTrials, 0.01, gaussian, 4, 4, 0.4 * seen).alarms;
    if (!test::kIsSanitized) EXPECT_LE(few, kTrials / 2);
}

/// Two-sided 5 %, 1 % and 0.1 % of tables of Student's distribution.
TEST(MeanTest, KnowsStudentsDistribution) {
    EXPECT_NEAR(studentP(12.706, 1), 0.05, 1e-5);
    EXPECT_NEAR(studentP(4.303, 2), 0.05, 1e-5);
    EXPECT_NEAR(studentP(5.841, 3), 0.01, 1e-5);
    EXPECT_NEAR(studentP(2.228, 10), 0.05, 1e-4);
    EXPECT_NEAR(studentP(5.041, 9), 0.0007, 1e-4);
    EXPECT_NEAR(studentP(4.587, 10), 0.001, 1e-5);
    EXPECT_NEAR(studentP(1.984, 100), 0.05, 1e-4);
    EXPECT_EQ(studentP(0.0, 7), 1.0);
    EXPECT_EQ(studentP(std::numeric_limits<double>::infinity(), 7), 0.0);
}

TEST(MeanTest, ComparesWhatHasNoNoise) {
    const std::vector<std::vector<double>> zero(4, {0.0, 1.0}), one(4, {0.0, 1.5});
    EXPECT_EQ(testMeans(zero, zero).p, 1.0);
    EXPECT_EQ(testMeans(zero, one).p, 2.0 / 70.0);
    EXPECT_EQ(testMeans(zero, zero).seen, std::numeric_limits<double>::infinity());
}

TEST(MeanTest, KnowsHowSureItCanBe) {
    EXPECT_EQ(leastP(2, 2), 2.0 / 6.0);
    EXPECT_EQ(leastP(6, 6), 2.0 / 924.0);
    EXPECT_EQ(leastP(4, 8), 2.0 / 70.0);
    EXPECT_EQ(leastP(30, 30), 1.0 / kMostDeals);
    // Beyond all deals, some: a difference that is one comes to the least p.
    std::vector<std::vector<double>> a, b;
    Random random(3);
    for (int i = 0; i < 12; ++i) {
        a.push_back({normal(random)});
        b.push_back({10.0 + normal(random)});
    }
    EXPECT_LT(testMeans(a, b).p, 3.0 / static_cast<double>(kMostDeals));
}

TEST(MeanTest, TakesTilesOfEverySize) {
    ImageF image(20, 8, 1, 1.0F);
    image.at(19, 7) = 33.0F;
    // 8 × 8, 8 × 8, 4 × 8; 16 × 8, 4 × 8; all.
    EXPECT_THAT(tileMeans(image), ElementsAre(1.0, 1.0, 2.0, 1.0, 2.0, 1.2));
    const ImageF colours(4, 4, 3, 0.5F);
    EXPECT_THAT(tileMeans(colours), ElementsAre(0.5, 0.5, 0.5));
}

TEST(TileDifferences, AreSignedStandardErrorsOfTheColours) {
    // Of two tiles the left is alike; on the right b lies 3 lower, in means of variance 1 a side.
    const auto sampleOf = [](float left, float right) {
        ImageF picture(12, 8, 4, left);
        for (int y = 0; y < 8; ++y) {
            for (int x = 8; x < 12; ++x) {
                for (int c = 0; c < 4; ++c) picture.at(x, y, c) = c < 3 ? right : 9.0F * left;
            }
        }
        return tileMeans(picture);
    };
    const std::vector<std::vector<double>> a = {sampleOf(1, 6), sampleOf(3, 8)};
    const std::vector<std::vector<double>> b = {sampleOf(3, 3), sampleOf(1, 5)};
    const ImageF errors = tileDifferences(a, b, 12, 8, 4);
    EXPECT_EQ(errors.at(0, 0), 0.0F);
    EXPECT_EQ(errors.at(7, 7), 0.0F);
    EXPECT_NEAR(errors.at(8, 0), 3.0 / std::sqrt(2.0), 1e-5);
    EXPECT_EQ(errors.at(11, 7), errors.at(8, 0));
    EXPECT_EQ(tileDifferences(b, a, 12, 8, 4).at(8, 0), -errors.at(8, 0));
    const std::vector<std::vector<double>> still(2, sampleOf(1, 1)), other(2, sampleOf(1, 2));
    EXPECT_EQ(tileDifferences(other, still, 12, 8, 4).at(9, 0), std::numeric_limits<float>::max());
}

}  // namespace
}  // namespace gfxrepro::metrics
