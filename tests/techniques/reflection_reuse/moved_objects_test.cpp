// Objects that move between key frames: their ghosts, and what is recomputed of them.
#include "techniques/reflection_reuse/reuse_renderer.h"

#include <gtest/gtest.h>

#include "tests/techniques/reflection_reuse/mirror_room.h"

namespace gfxrepro::reflection_reuse {
namespace {

constexpr glm::vec3 kStep(0.5F, 0.2F, 0.1F);

using MovedObjectsTest = ReuseTest;

TEST_F(MovedObjectsTest, WithoutRecomputingTheyLeaveGhosts) {
    World world(shaders, mirrorRoom(), {});
    world.render(front());
    world.move(kBlock, kStep);
    const Frame frame = world.render(front());
    EXPECT_GT(largestError(world, frame), 0.3F);
    EXPECT_LT(psnrDb(world, frame), 40.0);
}

TEST_F(MovedObjectsTest, RecomputedTheyLeaveNone) {
    World world(shaders, mirrorRoom(), {.recomputesMoved = true});
    world.render(front());
    world.move(kBlock, kStep);
    for (int i = 0; i < 2; ++i) {
        const Frame frame = world.render(front());
        if (frame.counts.isKeyFrame) break;
        // The camera stands still, so that all else is as in the key frame, to halves.
        EXPECT_LT(largestError(world, frame), 2e-3F);
        EXPECT_LT(share(frame.counts), 0.4);
        EXPECT_GT(share(frame.counts), 0.02);
    }
}

TEST_F(MovedObjectsTest, ObjectsThatStandStillCostNothing) {
    World world(shaders, mirrorRoom(), {.recomputesMoved = true});
    world.render(front());
    EXPECT_EQ(world.render(front()).counts.recomputedSamples, 0U);
    world.move(kBlock, kStep);
    EXPECT_GT(world.render(front()).counts.recomputedSamples, 0U);
    world.move(kBlock, -kStep);
    // Back where it was, as far as floats go: poses that are equal have not moved.
    const Frame frame = world.render(front());
    if (!frame.counts.isKeyFrame) EXPECT_LT(largestError(world, frame), 2e-3F);
}

TEST_F(MovedObjectsTest, ReflectorsThatMovedAreRecomputedWhole) {
    World world(shaders, mirrorRoom(), {.keyFrameThreshold = 1.0F, .recomputesMoved = true});
    world.render(front());
    world.move(kBall, {0.1F, 0.1F, 0});
    const Frame frame = world.render(front());
    constexpr int kBallReflector = 2;  // the wall is the first
    int ballSamples = 0;
    reflections::forEachReflective(frame.gbuffer, [&](glm::ivec2, std::size_t i) {
        if (frame.gbuffer.reflector(i) != kBallReflector) return;
        ++ballSamples;
        EXPECT_EQ(frame.recomputed[i], 1);
    });
    EXPECT_GT(ballSamples, 200);
    EXPECT_LT(largestError(world, frame), 2e-3F);
}

TEST_F(MovedObjectsTest, DoubtsAreThoseOfSegmentsThroughTheBox) {
    World world(shaders, mirrorRoom(), {});
    world.render(front());
    MovedObjects moved(shaders, kSize);
    moved.setKeyFrame(world.objects);
    EXPECT_FALSE(moved.find(world.objects));
    const scene::Box box = world.objects.boundsWorld()[kBlock];
    world.move(kBlock, kStep);
    ASSERT_TRUE(moved.find(world.objects));
    const std::vector<std::uint8_t> doubts =
        reflections::readMask(moved.doubtful(world.renderer.keyFrame()));

    const HostGBuffer gbuffer = readGBuffer(world.renderer.keyFrame().gbuffer);
    const std::vector<float> distanceM =
        world.renderer.keyFrame().reflection.distance.read<float>(GL_RED, GL_FLOAT, 1);
    // Along the segment in small steps; undecided near the box's surface.
    constexpr float kStepM = 0.004F, kUndecidedM = 0.02F;
    int doubted = 0;
    reflections::forEachReflective(gbuffer, [&](glm::ivec2 pixel, std::size_t i) {
        const glm::vec3 origin = gbuffer.positionWorld(pixel);
        const glm::vec3 direction = gbuffer.mirrorDirection(pixel);
        bool isInside = false, isNear = false;
        for (float t = 0.0F; t <= distanceM[i]; t += kStepM) {
            const glm::vec3 out =
                glm::abs(origin + t * direction - box.centre()) - 0.5F * box.size();
            const float outside = std::max({out.x, out.y, out.z});
            isInside = isInside || outside < -kUndecidedM;
            isNear = isNear || outside < kUndecidedM;
        }
        doubted += doubts[i];
        if (isInside) EXPECT_EQ(doubts[i], 1) << pixel.x << " " << pixel.y;
        if (!isNear) EXPECT_EQ(doubts[i], 0) << pixel.x << " " << pixel.y;
    });
    EXPECT_GT(doubted, 100);
}

}  // namespace
}  // namespace gfxrepro::reflection_reuse
