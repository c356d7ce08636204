// Algorithm 8 in a room with mirrors, against rays traced from every sample.
#include "techniques/reflection_reuse/reuse_renderer.h"

#include "tests/techniques/reflection_reuse/mirror_room.h"
#include "tests/techniques/reflections/gl_calls.h"

namespace gfxrepro::reflection_reuse {
namespace {

/// As the thesis has them; {} is the default.
const ReuseSettings kPrintedSettings{.matching = {.matching = Matching::FirstOrder},
                                     .reprojection = {.resampling = Resampling::Twice}};

TEST_F(ReuseTest, TheFirstFrameIsAKeyFrameAndTraced) {
    World world(shaders, mirrorRoom(), {});
    const Frame frame = world.render(front());
    EXPECT_TRUE(frame.counts.isKeyFrame);
    EXPECT_GT(frame.counts.reflectiveSamples, 5000U);
    EXPECT_EQ(frame.counts.recomputedSamples, frame.counts.reflectiveSamples);
    EXPECT_GT(psnrDb(world, frame), 60.0);  // halves
}

TEST_F(ReuseTest, ACameraThatStandsStillRecomputesNothing) {
    for (const ReuseSettings& settings : {ReuseSettings{}, kPrintedSettings, {.isDirect = true}}) {
        World world(shaders, mirrorRoom(), settings);
        const Frame key = world.render(front());
        for (int i = 0; i < 2; ++i) {
            const Frame frame = world.render(front());
            EXPECT_FALSE(frame.counts.isKeyFrame);
            EXPECT_EQ(frame.counts.recomputedSamples, 0U);
            EXPECT_EQ(frame.counts.reflectiveSamples, key.counts.reflectiveSamples);
            // One unit of the last place of a half in [½, 1], twice: interpolation at a corner
            // rounds, in the shift and in the warp.
            EXPECT_LE(largestError(frame, [&](std::size_t s) { return key.radiance[s]; }),
                      2.0F / 2048.0F);
        }
    }
}

TEST_F(ReuseTest, GatheredAMirrorKeepsItsImageToo) {
    World gathered(shaders, mirrorRoom(), {.keyFrameThreshold = 1.0F});
    gathered.render(front());
    for (const float x : {0.1F, 0.2F}) {
        const Frame frame = gathered.render(front(x));
        // Sharp edges that miss by half a pixel cost more of it than blurred ones (27 dB).
        EXPECT_GT(psnrDb(gathered, frame), 24.0) << x;
        EXPECT_LT(share(frame.counts), 0.35) << x;
    }
}

TEST_F(ReuseTest, EveryReflectiveSampleIsReusedOrRecomputed) {
    World world(shaders, mirrorRoom(), {.keyFrameThreshold = 1.0F});
    world.render(front());
    for (const float x : {0.02F, 0.1F, 0.3F}) {
        const Frame frame = world.render(front(x));
        const std::vector<reflections::TracedSample> truth = world.truth(frame);
        std::uint32_t reflective = 0, recomputed = 0;
        for (std::size_t i = 0; i < frame.radiance.size(); ++i) {
            if (frame.gbuffer.isReflective(i)) {
                ++reflective;
                EXPECT_TRUE(std::isfinite(frame.radiance[i].x + frame.radiance[i].y));
                EXPECT_GT(frame.radiance[i].x, 0.0F);  // nothing in the room is black
            }
            if (frame.recomputed[i] == 0) continue;
            ++recomputed;
            EXPECT_TRUE(frame.gbuffer.isReflective(i));
            // Just what the tracer says.
            EXPECT_LE(reflections::largestDifference(frame.radiance[i], truth[i].radiance), 1e-3F);
        }
        EXPECT_EQ(frame.counts.reflectiveSamples, reflective);
        EXPECT_EQ(frame.counts.recomputedSamples, recomputed);
        EXPECT_GT(recomputed, 0U);
        EXPECT_LT(recomputed, reflective / 2);
    }
}

TEST_F(ReuseTest, AMirrorKeepsItsImageWhenTheEyeMoves) {
    World world(shaders, mirrorRoom(), kPrintedSettings);
    World direct(shaders, mirrorRoom(), {.isDirect = true});
    world.render(front());
    direct.render(front());
    for (const float x : {0.1F, 0.2F}) {
        const Frame frame = world.render(front(x));
        ASSERT_FALSE(frame.counts.isKeyFrame);
        EXPECT_LT(share(frame.counts), 0.1);
        const double reusedDb = psnrDb(world, frame);
        // Offsets are whole pixels: edges of the room's corners and of the block miss by up to one.
        EXPECT_GT(reusedDb, 23.0) << x;
        EXPECT_GT(reusedDb, psnrDb(direct, direct.render(front(x))) + 3.0) << x;
    }
}

TEST_F(ReuseTest, OnlyWhatTheKeyFrameDidNotSeeIsRecomputed) {
    scene::Scene scene = mirrorRoom();
    scene.instances.resize(kBlock + 1);  // no ball: every reflection is in the plane z = −2
    World world(shaders, scene, kPrintedSettings);
    const Frame key = world.render(front());
    const std::vector<reflections::TracedSample> keyTruth = world.truth(key);
    const Frame frame = world.render(front(0.1F));
    ASSERT_FALSE(frame.counts.isKeyFrame);
    const std::vector<reflections::TracedSample> truth = world.truth(frame);
    const glm::vec3 keyEye = key.gbuffer.view.eyeWorld;

    std::uint32_t wronglyRecomputed = 0;
    reflections::forEachReflective(frame.gbuffer, [&](glm::ivec2 pixel, std::size_t i) {
        if (frame.recomputed[i] == 0) return;
        // The image behind the mirror, and where the key frame's eye sees it.
        const glm::vec3 reflected = frame.gbuffer.positionWorld(pixel) +
                                    truth[i].distanceM * frame.gbuffer.mirrorDirection(pixel);
        const glm::vec3 image(reflected.x, reflected.y, -4.0F - reflected.z);
        const auto seenAt = kit::pixelOf(key.gbuffer.view, image);
        if (!seenAt) return;
        // Two samples around, all mirroring the same object at the same distance: the image was
        // seen, and no edge is near.
        const float distanceM =
            glm::distance(image, keyEye) * (1.0F - (-2.0F - keyEye.z) / (image.z - keyEye.z));
        for (int y = -2; y <= 2; ++y) {
            for (int x = -2; x <= 2; ++x) {
                const glm::ivec2 at = *seenAt + glm::ivec2(x, y);
                if (key.gbuffer.reflectorAt(at) == 0) return;
                const float keyM = keyTruth[key.gbuffer.indexOf(at)].distanceM;
                if (std::abs(keyM - distanceM) > 0.2F) return;
                // The surface itself has to be seen from both views, too.
                if (!frame.gbuffer.isReflective(frame.gbuffer.indexOf(pixel))) return;
            }
        }
        ++wronglyRecomputed;
    });
    // Stray samples whose search ends early.
    EXPECT_LE(wronglyRecomputed, frame.counts.reflectiveSamples / 100);
    EXPECT_GT(frame.counts.recomputedSamples, 0U);
}

TEST_F(ReuseTest, AJumpIsTracedWholeAndTheNextFrameIsAKeyFrame) {
    scene::Scene scene = mirrorRoom();
    scene.materials[5] = reflections::mirror();  // the wall at +z, behind the camera
    World world(shaders, scene, {});
    world.render(front());
    const Frame jump = world.render(atMattWall());
    EXPECT_FALSE(jump.counts.isKeyFrame);
    EXPECT_GT(jump.counts.reflectiveSamples, 1000U);
    EXPECT_EQ(jump.counts.recomputedSamples, jump.counts.reflectiveSamples);
    EXPECT_GT(psnrDb(world, jump), 60.0);
    EXPECT_TRUE(world.render(atMattWall()).counts.isKeyFrame);
    const Frame after = world.render(atMattWall());
    EXPECT_FALSE(after.counts.isKeyFrame);
    EXPECT_EQ(after.counts.recomputedSamples, 0U);
}

TEST_F(ReuseTest, TheThresholdDecidesOnTheNextFrame) {
    const auto keyFrames = [&](float threshold, float step) {
        World world(shaders, mirrorRoom(), {.keyFrameThreshold = threshold});
        std::string pattern;
        double former = 0.0;
        for (int i = 0; i < 7; ++i) {
            const ReuseCounts counts = world.render(front(static_cast<float>(i) * step)).counts;
            if (i > 0 && threshold > 0.0F) {
                EXPECT_EQ(counts.isKeyFrame, former > double{threshold}) << i;
            }
            former = counts.isKeyFrame ? 0.0 : share(counts);
            pattern += counts.isKeyFrame ? 'k' : '.';
        }
        return pattern;
    };
    EXPECT_EQ(keyFrames(0.0F, 0.05F), "k.k.k.k");
    EXPECT_EQ(keyFrames(0.0F, 0.0F), "k......");  // nothing to recompute
    EXPECT_EQ(keyFrames(1.0F, 0.2F), "k......");
    const std::string middle = keyFrames(0.24F, 0.1F);
    EXPECT_GT(std::count(middle.begin(), middle.end(), 'k'), 1) << middle;
    EXPECT_LT(std::count(middle.begin(), middle.end(), 'k'), 4) << middle;
}

TEST_F(ReuseTest, ReflectorsMayLeaveTheViewAndComeBack) {
    World world(shaders, mirrorRoom(), {});
    const Frame key = world.render(front());
    for (int i = 0; i < 2; ++i) {
        const Frame away = world.render(atMattWall());
        EXPECT_FALSE(away.counts.isKeyFrame);
        EXPECT_EQ(away.counts.reflectiveSamples, 0U);
        EXPECT_EQ(away.counts.recomputedSamples, 0U);
    }
    const Frame back = world.render(front());
    EXPECT_FALSE(back.counts.isKeyFrame);
    EXPECT_LT(share(back.counts), 0.05);
    EXPECT_GT(psnrDb(world, back), 30.0);
}

TEST_F(ReuseTest, AKeyFrameWithoutReflectorsHasNothingToReuse) {
    World world(shaders, mirrorRoom(), {});
    EXPECT_EQ(world.render(atMattWall()).counts.reflectiveSamples, 0U);
    const Frame frame = world.render(front());
    EXPECT_FALSE(frame.counts.isKeyFrame);
    EXPECT_EQ(frame.counts.recomputedSamples, frame.counts.reflectiveSamples);
    EXPECT_TRUE(world.render(front()).counts.isKeyFrame);
}

TEST_F(ReuseTest, SearchesBeginWhereTheLastOnesEnded) {
    ReuseSettings settings{.keyFrameThreshold = 1.0F,
                           .matching = {.matching = Matching::SecondOrder},
                           .reprojection = {.resampling = Resampling::Twice}};
    World world(shaders, mirrorRoom(), settings);
    world.render(front());
    const double first = world.render(front(0.1F)).matchingSteps;
    EXPECT_GT(first, 0.5);
    EXPECT_LT(world.render(front(0.1F)).matchingSteps, 0.5 * first);
    // Offsets of another key frame would send the search astray.
    settings.keyFrameThreshold = 0.0F;
    World often(shaders, mirrorRoom(), settings);
    often.render(front());
    EXPECT_EQ(often.render(front(0.1F)).matchingSteps, first);
    EXPECT_TRUE(often.render(front(0.1F)).counts.isKeyFrame);
    EXPECT_LT(often.render(front(0.1F)).matchingSteps, 0.1);
}

TEST_F(ReuseTest, TheDeviceHasAFrameToDrawWhileTheLastOnesCountIsWaitedFor) {
    World world(shaders, mirrorRoom(), {});
    world.render(front());
    world.render(front(0.02F));
    gl::Profiler untimed(false);
    reflections::glCalls().clear();
    world.renderer.render(kit::viewOf(front(0.04F), kSize), untimed);
    const std::vector<reflections::GlCall>& calls = reflections::glCalls();
    const auto firstWait = std::ranges::find(calls, reflections::GlCall::Wait);
    EXPECT_EQ(std::count(calls.begin(), firstWait, reflections::GlCall::DrawObject),
              world.objects.objectCount());  // its G-buffer
}

TEST_F(ReuseTest, PassesAreThoseOfTheThesis) {
    World world(shaders, mirrorRoom(), kPrintedSettings);
    world.render(front());
    world.profiler.collect();
    world.render(front(0.05F));
    std::vector<std::string> passes;
    for (const gl::PassTime& time : world.profiler.collect()) passes.push_back(time.pass);
    EXPECT_EQ(passes, (std::vector<std::string>{"diffuse", "pixel_matching", "reflection_shift",
                                                "reflection_warp", "recompute", "transfer",
                                                "intersection"}));
}

}  // namespace
}  // namespace gfxrepro::reflection_reuse
