// The search on the host, and the distance that it descends ([xie2017] Sec. 5.4.1).
#include <gtest/gtest.h>

#include "tests/techniques/reflection_reuse/key_frame.h"

namespace gfxrepro::reflection_reuse {
namespace {

constexpr glm::ivec2 kSizePx(64, 48);
constexpr float kTie = 1e-5F;  // metres, of distances that differ by their rounding alone

using reflections::forEachReflective;

TEST(MatchingDistanceTest, IsZeroWhereTheLawOfReflectionHolds) {
    // A floor at y = 1; what is 2 above it is seen from 1 above it, a third of the way.
    const glm::vec3 normal(0, 3, 0), reflected(0, 3, 0), eye(3, 2, 0);
    EXPECT_NEAR(matchingDistance({2, 1, 0}, normal, reflected, eye), 0.0F, 1e-6F);
    // From the next candidate the ray passes elsewhere: through (0, −1, 0) and (1, 1, 0).
    EXPECT_NEAR(matchingDistance({1, 1, 0}, normal, reflected, eye), 3.0F / std::sqrt(5.0F), 1e-5F);
    // The plane alone decides, not which way its normal points or how long it is.
    EXPECT_EQ(matchingDistance({1, 1, 0}, -0.5F * normal, reflected, eye),
              matchingDistance({1, 1, 0}, normal, reflected, eye));
}

TEST(MatchingDistanceTest, AnEyeBehindTheMirrorIsAsFarAsTheCandidate) {
    // M = (0, −2, 0); the ray goes up from the candidate.
    EXPECT_FLOAT_EQ(matchingDistance({0, 0, 0}, {0, 1, 0}, {0, 2, 0}, {0, -1, 0}), 1.0F);
    EXPECT_FLOAT_EQ(matchingDistance({0, 0, 0}, {0, 1, 0}, {0, 2, 0}, {4, -3, 0}), 5.0F);
    EXPECT_FLOAT_EQ(matchingDistance({0, 0, 0}, {0, 1, 0}, {0, 2, 0}, {4, 5, 0}), 4.0F);
    // A candidate that turns its back to R sends nothing to the eye before it.
    EXPECT_FLOAT_EQ(matchingDistance({0, 0, 0}, {0, 1, 0}, {0, -2, 0}, {0, 1, 0}), 1.0F);
}

TEST(MatchingDistanceTest, OfAPointInTheCandidateItselfIsItsOwn) {
    EXPECT_FLOAT_EQ(matchingDistance({1, 1, 1}, {0, 1, 0}, {1, 1, 1}, {1, 1, 3}), 2.0F);
}

class MatchingSearchTest : public KeyFrameTest {
  protected:
    struct Outcome {
        int count = 0, valid = 0;
        int missed = 0;       // ended elsewhere than the exhaustive search, and farther away
        int missedValid = 0;  // of those, held to be matches
        int steps = 0;
    };
    /// Searches from every sample; each comes nearer with each step.
    static Outcome search(const KeyFrame& key, const glm::vec3& eye,
                          const MatchingSettings& settings) {
        Outcome outcome;
        forEachReflective(key.host.gbuffer, [&](glm::ivec2 pixel, std::size_t) {
            const HostMatch match = matchOnHost(key.host, pixel, eye, {}, settings);
            const HostMatch best = matchExhaustively(key.host, pixel, eye);
            EXPECT_EQ(match.passed.size(), static_cast<std::size_t>(match.steps) + 1);
            for (std::size_t i = 1; i < match.passed.size(); ++i) {
                EXPECT_LT(match.passed[i], match.passed[i - 1]);
            }
            // Unit normals in one and not in the other: the last bits differ.
            EXPECT_GE(match.distance, best.distance - kTie);
            const bool isMissed = match.distance > best.distance + kTie;
            ++outcome.count;
            outcome.valid += match.offset ? 1 : 0;
            outcome.missed += isMissed ? 1 : 0;
            outcome.missedValid += isMissed && match.offset ? 1 : 0;
            outcome.steps += match.steps;
        });
        return outcome;
    }
    static void expectMinimaFound(const Outcome& outcome, int fewestSteps) {
        RecordProperty("count", outcome.count);
        RecordProperty("missed", outcome.missed);
        EXPECT_GT(outcome.count, 400);
        EXPECT_GT(outcome.steps, fewestSteps);
        EXPECT_GE(outcome.valid, outcome.count / 2);
        EXPECT_LE(outcome.missed, 0.05 * outcome.count);
        EXPECT_LE(outcome.missedValid, 0.05 * outcome.count);
    }
    const glm::vec3 move_{0.15F, 0.1F, -0.1F};
};

TEST_F(MatchingSearchTest, EndsAtTheMinimumOnAConvexReflector) {
    const KeyFrame key = keyFrame(roomWithBall(), beforeBall(), kSizePx);
    expectMinimaFound(search(key, key.eyeWorld() + move_, {}), 500);
}

TEST_F(MatchingSearchTest, EndsAtTheMinimumOnAConcaveReflector) {
    const KeyFrame key = keyFrame(roomWithBowl(), aboveBowl(), kSizePx);
    expectMinimaFound(search(key, key.eyeWorld() + move_, {}), 500);
}

TEST_F(MatchingSearchTest, EndsAtTheMinimumOnAPlane) {
    const KeyFrame key = keyFrame(roomWithMirrorFloor(), aboveFloor(), kSizePx);
    expectMinimaFound(search(key, key.eyeWorld() + move_, {}), 500);
}

}  // namespace
}  // namespace gfxrepro::reflection_reuse
