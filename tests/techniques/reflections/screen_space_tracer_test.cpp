#include "techniques/reflections/reflection_tracer.h"

#include <cmath>
#include <optional>

#include "tests/techniques/reflections/environment_on_host.h"
#include "tests/techniques/reflections/traced_scenes.h"

namespace gfxrepro::reflections {
namespace {

constexpr glm::ivec2 kScreenSizePx(96, 72);
constexpr float kThicknessM = 0.3F;

/// Two pillars, a wide one and a thin one, on a mirror; nothing around.
scene::Scene pillarsOnMirror(float glossiness = 0.0F) {
    scene::Scene scene{.name = "pillars"};
    addPart(scene, rectangle({0, 0, 0}, {0, 0, 2}, {2, 0, 0}), mirror(glossiness));
    addPart(scene, block({glm::vec3(-0.8F, 0.0F, -1.2F), glm::vec3(-0.1F, 1.2F, -0.6F)}),
            matt({0.9F, 0.2F, 0.1F}));
    addPart(scene, block({glm::vec3(0.5F, 0.0F, -0.4F), glm::vec3(0.7F, 0.8F, -0.2F)}),
            matt({0.1F, 0.3F, 0.9F}));
    return scene;
}

scene::Camera beforePillars() {
    return camera({0.1F, 1.1F, 2.4F}, {0.0F, 0.4F, 0.0F});
}

struct Traced {
    std::vector<glm::vec3> radiance;
    std::vector<float> distanceM;
};

struct ScreenSpaceTracerTest : TracerTest {
    Traced traced(const Prepared& prepared, const LobeSettings& lobe) {
        ScreenSpaceTracer tracer(shaders, prepared.map, lobe, prepared.scene.diagonalM(),
                                 kThicknessM);
        tracer.update(prepared.objects, profiler);
        ReflectionTarget target(prepared.gbuffer.view.sizePx);
        tracer.trace(prepared.gbuffer, nullptr, target, profiler);
        return {target.radiance.read<glm::vec3>(GL_RGB, GL_FLOAT, 1),
                target.distance.read<float>(GL_RED, GL_FLOAT, 1)};
    }
};

/// Whether the eye sees a point, and the side that a ray comes from.
bool isSeen(const HostGBuffer& gbuffer, const glm::vec3& point, const glm::vec3& direction) {
    const std::optional<glm::ivec2> pixel = kit::pixelOf(gbuffer.view, point);
    if (!pixel) return false;
    const std::size_t index = gbuffer.indexOf(*pixel);
    if (gbuffer.depthM[index] == 0.0F) return false;
    const float depth = -(gbuffer.view.viewFromWorld * glm::vec4(point, 1.0F)).z;
    return std::abs(gbuffer.depthM[index] - depth) < 0.02F &&
           glm::dot(gbuffer.normalWorld[index], direction) < 0.0F;
}

TEST_F(ScreenSpaceTracerTest, AgreesWithRaysWhereTheEyeSeesWhatIsReflected) {
    const EmbreeTrace rays = trace(pillarsOnMirror(), beforePillars(), kScreenSizePx);
    const Traced traced = this->traced(rays.prepared, {});
    const HostEnvironment environment(rays.prepared.map);

    int seenCount = 0, agreeing = 0, missCount = 0, misses = 0;
    forEachReflective(rays.gbuffer, [&](glm::ivec2 pixel, std::size_t index) {
        const glm::vec3 direction = rays.gbuffer.mirrorDirection(pixel);
        const TracedSample& sample = rays.samples[index];
        const bool isEnvironment =
            traced.distanceM[index] == 0.0F &&
            largestDifference(traced.radiance[index], environment.radianceFrom(direction)) < 2e-3F;
        if (sample.object == 0) {
            ++missCount;
            misses += isEnvironment ? 1 : 0;
        } else if (isSeen(rays.gbuffer,
                          rays.gbuffer.positionWorld(pixel) + sample.distanceM * direction,
                          direction)) {
            ++seenCount;
            const bool agrees = std::abs(traced.distanceM[index] - sample.distanceM) < 0.05F &&
                                largestDifference(traced.radiance[index], sample.radiance) < 0.03F;
            agreeing += agrees ? 1 : 0;
        }
    });
    EXPECT_GT(seenCount, 200);
    // The rest, and the rest of the misses, lies at the pillars' edges, where a texel shows one
    // side of them and the ray meets the other, or passes by.
    EXPECT_GE(agreeing, 0.95 * seenCount);
    EXPECT_GT(missCount, 1000);
    EXPECT_GE(misses, 0.99 * missCount);
}

/// In the image, a sign near the eye is in front of the wall that the floor shows; the rays pass
/// far behind it.
TEST_F(ScreenSpaceTracerTest, RaysPassBehindWhatIsInFrontOfThem) {
    scene::Scene source{.name = "sign"};
    addPart(source, rectangle({0, 0, 0}, {0, 0, 2}, {2, 0, 0}), mirror());
    addPart(source, rectangle({0, 2, -1.9F}, {2, 0, 0}, {0, 2, 0}), glowing({0.2F, 0.6F, 0.3F}));
    addPart(source, rectangle({0, 0.75F, 1.2F}, {0.6F, 0, 0}, {0, 0.1F, 0}), glowing({1, 0, 0}));
    const EmbreeTrace rays = trace(source, camera({0, 0.9F, 2.2F}, {0, 0.5F, 0}), kScreenSizePx);
    const Traced traced = this->traced(rays.prepared, {});
    int count = 0, behindCount = 0, agreeing = 0;
    forEachReflective(rays.gbuffer, [&](glm::ivec2 pixel, std::size_t index) {
        const glm::vec3 direction = rays.gbuffer.mirrorDirection(pixel);
        const glm::vec3 point =
            rays.gbuffer.positionWorld(pixel) + rays.samples[index].distanceM * direction;
        if (rays.samples[index].object != 2 || !isSeen(rays.gbuffer, point, direction)) return;
        // In this symmetric image rays go straight up.
        bool isBehind = false;
        const int wallY = kit::pixelOf(rays.gbuffer.view, point)->y;
        for (int y = pixel.y; y < wallY; ++y) {
            const float depth = rays.gbuffer.depthM[rays.gbuffer.indexOf({pixel.x, y})];
            isBehind = isBehind || (depth > 0.0F && depth < 1.2F);
        }
        ++count;
        behindCount += isBehind ? 1 : 0;
        agreeing +=
            largestDifference(traced.radiance[index], rays.samples[index].radiance) < 2e-3F ? 1 : 0;
    });
    EXPECT_GT(behindCount, 100);
    EXPECT_GE(agreeing, 0.99 * count);
}

/// The eye looks at the mirror alone: all that is reflected is above the image.
TEST_F(ScreenSpaceTracerTest, TakesTheEnvironmentForWhatIsOutsideOfTheImage) {
    const EmbreeTrace rays =
        trace(pillarsOnMirror(), camera({0.0F, 0.8F, 1.6F}, {0.0F, 0.0F, 1.0F}), kScreenSizePx);
    const Traced traced = this->traced(rays.prepared, {});
    const HostEnvironment environment(rays.prepared.map);
    int count = 0, outside = 0;
    forEachReflective(rays.gbuffer, [&](glm::ivec2 pixel, std::size_t index) {
        const glm::vec3 direction = rays.gbuffer.mirrorDirection(pixel);
        const glm::vec3 point =
            rays.gbuffer.positionWorld(pixel) + rays.samples[index].distanceM * direction;
        const bool isOnPillar = rays.samples[index].object > 1;
        if (isOnPillar && kit::pixelOf(rays.gbuffer.view, point)) return;
        EXPECT_EQ(traced.distanceM[index], 0.0F);
        EXPECT_LT(largestDifference(traced.radiance[index], environment.radianceFrom(direction)),
                  2e-3F);
        ++count;
        outside += isOnPillar ? 1 : 0;
    });
    EXPECT_GT(count, 1000);
    EXPECT_GT(outside, 300);
}

/// All that the eye sees glows alike, so that neither hits nor what stands in for misses differ.
TEST_F(ScreenSpaceTracerTest, GlossyMeanOfOneColourIsThatColour) {
    const glm::vec3 colour(0.3F, 0.4F, 0.5F);
    scene::Scene source = pillarsOnMirror(0.3F);
    for (scene::Material& material : source.materials) {
        material.baseColor = glm::vec4(0.0F, 0.0F, 0.0F, 1.0F);
        material.emissive = colour;
    }
    const Prepared prepared(shaders, source, beforePillars(), kScreenSizePx);
    const Traced traced = this->traced(prepared, {});
    const HostGBuffer gbuffer = readGBuffer(prepared.gbuffer);
    int hits = 0;
    forEachReflective(gbuffer, [&](glm::ivec2, std::size_t index) {
        EXPECT_LT(largestDifference(traced.radiance[index], colour), 1e-3F);
        hits += traced.distanceM[index] > 0.0F ? 1 : 0;
    });
    EXPECT_GT(hits, 200);
}

/// Where whole lobes meet what the eye sees, their means agree with Embree's.
TEST_F(ScreenSpaceTracerTest, GlossyMeansAgreeWithRays) {
    // Reflections end at 0.8 m.
    const LobeSettings lobe{16, 0.6F, 12.0F};
    const EmbreeTrace rays = trace(pillarsOnMirror(0.15F), beforePillars(), kScreenSizePx, lobe);
    const Traced traced = this->traced(rays.prepared, lobe);
    int count = 0, agreeing = 0;
    forEachReflective(rays.gbuffer, [&](glm::ivec2 pixel, std::size_t index) {
        // The wide pillar's front fills the lobe.
        const glm::vec3 point = rays.gbuffer.positionWorld(pixel) +
                                rays.samples[index].distanceM * rays.gbuffer.mirrorDirection(pixel);
        if (rays.samples[index].object != 2 || point.x < -0.65F || point.x > -0.25F) return;
        if (rays.samples[index].distanceM > 0.8F ||
            !isSeen(rays.gbuffer, point, glm::vec3(0, 0, -1)))
            return;
        ++count;
        agreeing +=
            largestDifference(traced.radiance[index], rays.samples[index].radiance) < 0.02F ? 1 : 0;
    });
    EXPECT_GT(count, 50);
    EXPECT_GE(agreeing, 0.95 * count);
}

}  // namespace
}  // namespace gfxrepro::reflections
