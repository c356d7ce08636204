#include "techniques/depth_sampling/visibility.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/techniques/depth_sampling/brute_visibility.h"
#include "tests/techniques/depth_sampling/visibility_scenes.h"

namespace gfxrepro::depth_sampling {
namespace {

using kit::View;
using raycast::RayTracer;

/// A square of half size 1 at z = 0 and one of half size 0.5 behind it at z = −1.
scene::Scene twoSquares() {
    scene::Scene scene;
    scene.meshes = {squareAt({0, 0, 0}, 1.0F), squareAt({0, 0, -1}, 0.5F)};
    scene.instances = {{0, glm::mat4(1.0F)}, {1, glm::mat4(1.0F)}};
    return scene;
}

/// From (x, 0, 4), looking at the origin, sees [−2, 2] there.
View viewFrom(float x, int sizePx = 32) {
    scene::Camera camera;
    camera.position = {x, 0, 4};
    camera.target = {0, 0, 0};
    camera.verticalFovRad = 2.0F * std::atan(2.0F / glm::length(camera.position));
    camera.nearM = 0.5F;
    camera.farM = 50.0F;
    return kit::viewOf(camera, {sizePx, sizePx});
}

TEST(VisibilityMeasures, CountTwoSquares) {
    const RayTracer tracer(twoSquares());
    const VisibilitySequence conventional(tracer, {viewFrom(0), viewFrom(0)}, false);
    const VisibilitySequence layers(tracer, {viewFrom(0), viewFrom(0), viewFrom(0)}, true);
    const VisibilitySequence aside(tracer, {viewFrom(0), viewFrom(20)}, false);
    const VisibilitySequence before(tracer, {viewFrom(0)}, false);

    // 32 pixels for 4 m: the front square fills 16². The back one, a metre further, is seen at
    // 0.5 · 4/5 = 0.4 m of half size: samples at 0.125 · (k + 0.5) m, so 2 · 3 = 6 a side.
    EXPECT_EQ(countSamples(conventional, 0, conventional, before),
              (ImageCounts{.samples = 256, .occludedLiterally = 256}));
    EXPECT_EQ(countSamples(conventional, 1, conventional, before),
              (ImageCounts{.samples = 256, .redundant = 256}));
    EXPECT_EQ(
        countSamples(layers, 1, conventional, before),
        (ImageCounts{.samples = 36, .redundant = 0, .occluded = 36, .occludedLiterally = 36}));
    // From far aside the gap between the squares shows all of the back one.
    EXPECT_EQ(countSamples(layers, 1, conventional, aside),
              (ImageCounts{.samples = 36, .occluded = 36, .occludedLiterally = 36, .useful = 36}));
    EXPECT_EQ(countSamples(layers, 2, conventional, aside), ImageCounts{});
    // V₁ has what V₀ has not: occluded in the literal reading alone.
    EXPECT_EQ(countSamples(layers, 1, aside, aside),
              (ImageCounts{.samples = 36, .occludedLiterally = 36}));
}

TEST(VisibilityMeasures, AvailabilityOfTwoSquares) {
    const RayTracer tracer(twoSquares());
    const VisibilitySequence outputs(tracer, {viewFrom(0, 64), viewFrom(20, 64)}, false);
    std::uint64_t front = 0;
    std::uint64_t back = 0;
    for (int pixel = 0; pixel < 64 * 64; ++pixel) {
        const auto point = outputs.sample(1, {pixel % 64, pixel / 64});
        if (point) ++(point->positionWorld.z > -0.5F ? front : back);
    }
    EXPECT_GT(front, 100U);
    EXPECT_GT(back, 10U);
    using Frames = std::vector<FrameCounts>;
    const auto available = [&](const std::vector<View>& views, bool isNonRedundant) {
        return countAvailable(VisibilitySequence(tracer, views, isNonRedundant), outputs);
    };
    const View centre = viewFrom(0);
    const Frames all{{1024, 1024}, {front + back, front + back}};
    EXPECT_EQ(available({centre, centre}, false), (Frames{{1024, 1024}, {front + back, front}}));
    EXPECT_EQ(available({centre, centre}, true), all);
    EXPECT_EQ(available({centre, viewFrom(20)}, true), all);
    EXPECT_EQ(available({}, false), (Frames{{1024, 0}, {front + back, 0}}));
}

TEST(VisibilityMeasures, CountsAgreeWithALoopOverTriangles) {
    const scene::Scene scene = clutter(9);
    const RayTracer tracer(scene);
    const std::vector<View> views = threeViews(24);
    const std::vector<View> seers{viewFrom(-0.7F), viewFrom(0.5F), viewFrom(6)};
    const VisibilitySequence sequence(tracer, views, true);
    const VisibilitySequence conventional(tracer, views, false);
    const VisibilitySequence outputs(tracer, seers, false);
    BruteVisibility bruteSequence(scene, views, true);
    BruteVisibility bruteConventional(scene, views, false);
    BruteVisibility bruteOutputs(scene, seers, false);
    const auto isHeld = [](BruteVisibility& images, std::size_t count, const SurfacePoint& point) {
        for (std::size_t i = 0; i < count; ++i) {
            if (images.holds(i, point)) return 1;
        }
        return 0;
    };
    std::uint64_t useful = 0;
    for (std::size_t j = 0; j < 3; ++j) {
        ImageCounts expected;
        for (int pixel = 0; pixel < 24 * 24; ++pixel) {
            const glm::vec2 at(pixel % 24, pixel / 24);
            const auto point = bruteSequence.sample(j, rayThrough(views[j], at + 0.5F));
            if (!point) continue;
            ++expected.samples;
            if (isHeld(bruteConventional, j, *point)) continue;
            ++expected.occludedLiterally;
            if (isHeld(bruteConventional, 3, *point)) continue;
            ++expected.occluded;
            expected.useful += isHeld(bruteOutputs, 3, *point);
        }
        const ImageCounts counts = countSamples(sequence, j, conventional, outputs);
        EXPECT_EQ(counts.redundant, 0U);
        // A few samples lie so near to an edge that rounding decides.
        constexpr double kFew = 3.0;
        EXPECT_NEAR(counts.samples, expected.samples, kFew);
        EXPECT_NEAR(counts.occluded, expected.occluded, kFew);
        EXPECT_NEAR(counts.occludedLiterally, expected.occludedLiterally, kFew);
        EXPECT_NEAR(counts.useful, expected.useful, kFew);
        useful += counts.useful;
        if (j > 0) EXPECT_GT(counts.occluded, counts.useful);
    }
    EXPECT_GT(useful, 10U);
}

TEST(RayCastImage, HasDepthTriangleAndLight) {
    scene::Scene scene = twoSquares();
    scene.materials.resize(2);
    scene.materials[0].baseColor = {0.5F, 0.25F, 1.0F, 1.0F};
    scene.materials[1].baseColor = {1, 1, 1, 1};
    scene.materials[1].isDoubleSided = true;
    scene.meshes[0].material = 0;
    scene.meshes[1].material = 1;
    scene.meshes[0].colors.assign(4, glm::vec3(1.0F, 0.5F, 0.5F));
    scene.meshes[1].normals.assign(4, glm::vec3(0.6F, 0, -0.8F));  // turned away: turned back
    const RayTracer tracer(scene);
    const VisibilitySequence layers(tracer, {viewFrom(0), viewFrom(0)}, true);
    const SurfaceShading shading(scene);
    const auto byte = [](float value) { return static_cast<int>(value * 255.0F + 0.5F); };

    const auto front = rayCastImage(layers, 0, shading);
    const std::size_t at = front.indexOf({17, 20});
    EXPECT_NEAR(front.depthM[at], 4.0F, 1e-6F);
    EXPECT_EQ(front.triangleId[at], 2U);  // above the diagonal
    const float light = 0.3F + 0.7F * 0.461F;
    EXPECT_EQ(glm::ivec4(front.shading[at]),
              glm::ivec4(byte(0.5F * light), byte(0.125F * light), byte(0.5F * light), 255));
    EXPECT_EQ(front.triangleId[front.indexOf({20, 17})], 1U);
    EXPECT_LT(glm::distance(front.pointWorld({17, 20}), glm::vec3(0.1875F, 0.5625F, 0)), 1e-6F);

    const std::size_t corner = front.indexOf({1, 1});
    EXPECT_EQ(front.depthM[corner], 0.0F);
    EXPECT_EQ(front.triangleId[corner], 0U);
    EXPECT_EQ(front.shading[corner], glm::u8vec4(0));

    const auto back = rayCastImage(layers, 1, shading);
    const std::size_t behind = back.indexOf({16, 18});
    EXPECT_NEAR(back.depthM[behind], 5.0F, 1e-6F);
    EXPECT_EQ(back.triangleId[behind], 4U);
    const float turned = 0.3F + 0.7F * (-0.6F * 0.397F + 0.8F * 0.461F);
    EXPECT_EQ(glm::ivec4(back.shading[behind]), glm::ivec4(glm::ivec3(byte(turned)), 255));
}

}  // namespace
}  // namespace gfxrepro::depth_sampling
