#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/core/random.h"
#include "techniques/depth_sampling/visibility.h"
#include "tests/support/crossings.h"
#include "tests/support/meshes.h"
#include "tests/techniques/depth_sampling/brute_visibility.h"
#include "tests/techniques/voxelization/shapes.h"

namespace gfxrepro::depth_sampling {
namespace {

using kit::View;
using raycast::Faces;
using raycast::RayTracer;

/// One-sided and double-sided triangles at random, a box and its mirror image turned and moved, all
/// within about [−1, 1]³.
scene::Scene scattered(std::uint64_t seed) {
    Random random(seed);
    scene::Scene scene;
    scene.materials.resize(2);
    scene.materials[1].isDoubleSided = true;
    const glm::vec3 half(0.3F, 0.15F, 0.2F);
    scene.meshes = {test::randomTriangles(60, 0.35F, seed),
                    test::randomTriangles(30, 0.35F, seed + 10),
                    voxelization::shapes::cube(-half, half)};
    scene.meshes[0].material = 0;
    scene.meshes[1].material = 1;
    const glm::mat4 one(1.0F);
    const glm::mat4 turned = glm::rotate(glm::translate(one, test::randomIn(random, -0.5F, 0.5F)),
                                         0.7F, glm::vec3(0.6F, 0.8F, 0));
    const glm::mat4 mirrored = glm::scale(glm::translate(one, test::randomIn(random, -0.5F, 0.5F)),
                                          glm::vec3(-1.3F, 0.8F, 1.0F));
    scene.instances = {{2, turned}, {0, one}, {2, mirrored}, {1, one}};
    return scene;
}

/// Three views of scattered() from the corners of a triangle before it; their frustums cut it at
/// the sides, in front and behind.
std::vector<View> threeViews(int sizePx) {
    std::vector<View> views;
    for (const glm::vec3 eye :
         {glm::vec3(-1.3F, -0.4F, 4), glm::vec3(1.2F, -0.3F, 3.9F), glm::vec3(0.1F, 1.1F, 3.8F)}) {
        const scene::Camera camera{.position = eye,
                                   .target = {0.07F, -0.03F, 0},
                                   .verticalFovRad = 0.42F,
                                   .nearM = 3.4F,
                                   .farM = 4.9F};
        views.push_back(kit::viewOf(camera, glm::ivec2(sizePx)));
    }
    return views;
}

/// A square of half size `half` facing +z.
scene::Mesh squareAt(const glm::vec3& centre, float half) {
    return test::rectangle(centre, {half, 0, 0}, {0, half, 0});
}

/// After [xie2017] Fig. 11: a wide square A at z = 2, behind it small ones B (z = 0) and C (z = −2)
/// on the axis, and a wall D behind all. A hides C from everywhere; B hides it from the centre too.
struct FourObjects {
    scene::Scene scene;

    FourObjects() {
        scene.meshes = {squareAt({0, 0, 2}, 1.2F), squareAt({0, 0, 0}, 0.3F),
                        squareAt({0, 0, -2}, 0.2F), squareAt({0, 0, -5}, 6.0F)};
        for (int mesh = 0; mesh < 4; ++mesh) scene.instances.push_back({mesh, glm::mat4(1.0F)});
    }
    /// From 10 m before the axis, 3 m · `side` beside it.
    View viewFrom(float side) const {
        const scene::Camera camera{
            .position = {3.0F * side, 0, 10}, .target = {0, 0, 0}, .nearM = 1.0F, .farM = 30.0F};
        return kit::viewOf(camera, {32, 32});
    }
    SurfacePoint middleOfA() const { return {{0.03F, 0.05F, 2.0F}, 2}; }
    SurfacePoint middleOfB() const { return {{0.03F, 0.05F, 0.0F}, 4}; }
    SurfacePoint middleOfC() const { return {{0.03F, 0.05F, -2.0F}, 6}; }
};

struct Agreement {
    int decided = 0;
    int held = 0;
    int unclear = 0;
};

/// Samples, and holds() of every image for every sample and for points of all triangles.
Agreement expectAgreement(const scene::Scene& scene, const std::vector<View>& views,
                          bool isNonRedundant) {
    const RayTracer tracer(scene);
    const VisibilitySequence sequence(tracer, views, isNonRedundant);
    BruteVisibility brute(scene, views, isNonRedundant);
    Agreement result;
    const auto expectHeldAlike = [&](const SurfacePoint& point) {
        for (std::size_t i = 0; i < views.size(); ++i) {
            brute.start();
            const bool isHeld = brute.holds(i, point);
            if (brute.isUnclear()) {
                ++result.unclear;
                continue;
            }
            ++result.decided;
            result.held += isHeld ? 1 : 0;
            EXPECT_EQ(sequence.holds(i, point), isHeld) << "image " << i;
        }
    };
    for (std::size_t j = 0; j < views.size(); ++j) {
        for (int pixel = 0; pixel < views[j].sizePx.x * views[j].sizePx.y; ++pixel) {
            const glm::ivec2 at(pixel % views[j].sizePx.x, pixel / views[j].sizePx.x);
            const auto sample = sequence.sample(j, at);
            brute.start();
            const auto expected = brute.sample(j, rayThrough(views[j], glm::vec2(at) + 0.5F));
            if (brute.isUnclear()) {
                ++result.unclear;
                continue;
            }
            ++result.decided;
            EXPECT_EQ(sample.has_value(), expected.has_value());
            if (!sample || !expected) continue;
            EXPECT_EQ(sample->triangleId, expected->triangleId);
            EXPECT_LT(glm::distance(sample->positionWorld, expected->positionWorld), 1e-5F);
            expectHeldAlike(*sample);
        }
    }
    Random random(5);
    const scene::Mesh mesh = flattened(scene);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        float b = random.uniform(0.0F, 1.0F);
        float c = random.uniform(0.0F, 1.0F);
        if (b + c > 1.0F) b = 1.0F - b, c = 1.0F - c;
        const glm::uvec3 v = mesh.triangles[t];
        expectHeldAlike({(1.0F - b - c) * mesh.positions[v.x] + b * mesh.positions[v.y] +
                             c * mesh.positions[v.z],
                         static_cast<std::uint32_t>(t + 1)});
    }
    return result;
}

void expectDecided(const Agreement& agreement) {
    EXPECT_GT(agreement.decided, 1500);
    EXPECT_GT(agreement.held, 300);
    EXPECT_LT(agreement.unclear, agreement.decided / 20);
}

TEST(Visibility, ConventionalImagesAgreeWithALoopOverTriangles) {
    expectDecided(expectAgreement(scattered(1), threeViews(24), false));
}

TEST(Visibility, NonRedundantImagesAgreeWithALoopOverTriangles) {
    expectDecided(expectAgreement(scattered(2), threeViews(24), true));
}

TEST(Visibility, PeeledLayersAgreeWithALoopOverTriangles) {
    const View view = threeViews(24)[0];
    expectDecided(expectAgreement(scattered(3), {view, view, view, view}, true));
}

TEST(Visibility, ViewsThatComeAgainAgreeWithALoopOverTriangles) {
    const std::vector<View> views = threeViews(20);
    expectDecided(expectAgreement(scattered(4), {views[0], views[1], views[0], views[1]}, true));
}

TEST(Visibility, ConventionalImagesHoldWhatNothingOccludes) {
    const scene::Scene scene = scattered(5);
    const RayTracer tracer(scene);
    const std::vector<View> views = threeViews(64);
    const VisibilitySequence sequence(tracer, views, false);
    int counts[2] = {0, 0};
    for (int pixel = 0; pixel < 64 * 64; ++pixel) {
        const auto point = sequence.sample(0, {pixel % 64, pixel / 64});
        if (!point || !pixelOf(views[1], point->positionWorld)) continue;
        if (!tracer.triangle(point->triangleId - 1).isDrawnFrom(views[1].eyeWorld)) continue;
        const glm::vec3 towards = point->positionWorld - views[1].eyeWorld;
        const float distance = glm::length(towards);
        const float depthM = -(views[1].viewFromWorld * glm::vec4(point->positionWorld, 1.0F)).z;
        if (depthM < views[1].nearM || depthM > views[1].farM) continue;
        const bool isHeld =
            !tracer.isOccluded(views[1].eyeWorld, towards, views[1].nearM * distance / depthM,
                               distance * (1.0F - 1e-5F), Faces::Drawn, point->triangleId - 1);
        EXPECT_EQ(sequence.holds(1, *point), isHeld);
        ++counts[isHeld ? 1 : 0];
    }
    EXPECT_GT(counts[0], 100);
    EXPECT_GT(counts[1], 100);
}

TEST(Visibility, PeeledLayersAreTheRanksAlongARay) {
    scene::Scene scene = scattered(6);
    for (scene::Mesh& mesh : scene.meshes) mesh.material = 1;  // double-sided
    const RayTracer tracer(scene);
    View view = threeViews(48)[0];
    view.nearM = 0.01F;
    view.farM = 100.0F;
    constexpr std::size_t kLayers = 6;
    const VisibilitySequence layers(tracer, std::vector<View>(kLayers, view), true);
    std::size_t deepest = 0;
    int disagreeing = 0;
    for (int pixel = 0; pixel < 48 * 48; ++pixel) {
        const glm::ivec2 at(pixel % 48, pixel / 48);
        const std::vector<float> ranks =
            test::crossings(tracer, view.eyeWorld, rayThrough(view, glm::vec2(at) + 0.5F));
        deepest = std::max(deepest, ranks.size());
        for (std::size_t j = 0; j < kLayers; ++j) {
            const auto point = layers.sample(j, at);
            const bool isThere = j < ranks.size();
            const bool agrees =
                point.has_value() == isThere &&
                (!point ||
                 std::abs(glm::distance(point->positionWorld, view.eyeWorld) - ranks[j]) < 1e-5F);
            if (!agrees) ++disagreeing;
            if (!point) continue;
            for (std::size_t k = 0; k < kLayers; ++k) {
                if (layers.holds(k, *point) != (j == k)) ++disagreeing;
            }
        }
    }
    EXPECT_GE(deepest, kLayers);
    // A ray to a point is not the ray that found it, to the last place: next to an edge it may pass
    // on the other side. crossings() tells the two sides of an edge apart.
    EXPECT_LE(disagreeing, 5) << "of 48 * 48 * 6";
}

TEST(Visibility, NonRedundantImagesHoldWhatConventionalOnesHoldAndMore) {
    const scene::Scene scene = scattered(7);
    const RayTracer tracer(scene);
    const std::vector<View> views = threeViews(64);
    const VisibilitySequence conventional(tracer, views, false);
    const VisibilitySequence nonRedundant(tracer, views, true);
    int samples = 0;
    int hidden = 0;
    int lost = 0;
    int again = 0;
    for (std::size_t j = 0; j < views.size(); ++j) {
        for (int pixel = 0; pixel < 64 * 64; ++pixel) {
            const glm::ivec2 at(pixel % 64, pixel / 64);
            if (const auto point = conventional.sample(j, at)) {
                EXPECT_TRUE(nonRedundant.anyHolds(views.size(), *point));
            }
            const auto point = nonRedundant.sample(j, at);
            if (!point) continue;
            ++samples;
            EXPECT_FALSE(nonRedundant.isRedundant(j, *point));
            EXPECT_FALSE(conventional.anyHolds(j, *point)) << "no earlier view sees it";
            again += nonRedundant.anyHolds(j, *point) ? 1 : 0;
            lost += nonRedundant.holds(j, *point) ? 0 : 1;
            hidden += conventional.anyHolds(views.size(), *point) ? 0 : 1;
        }
    }
    EXPECT_GT(samples, 2000);
    EXPECT_GT(hidden, 100);
    EXPECT_GT(again, 20) << "what image 1 uncovered, image 2 takes again";
    EXPECT_LE(lost, samples / 500);  // next to edges, as above
}

TEST(Visibility, PointsOfDepthImagesAreFoundAgain) {
    const scene::Scene scene = scattered(8);
    const RayTracer tracer(scene);
    const std::vector<View> views = threeViews(64);
    const VisibilitySequence sequence(tracer, views, true);
    int samples = 0;
    int lost = 0;
    for (std::size_t j = 0; j < views.size(); ++j) {
        for (int pixel = 0; pixel < 64 * 64; ++pixel) {
            const glm::ivec2 at(pixel % 64, pixel / 64);
            const auto point = sequence.sample(j, at);
            if (!point) continue;
            const float depthM =
                -(views[j].viewFromWorld * glm::vec4(point->positionWorld, 1.0F)).z;
            const glm::vec3 stored = unproject(views[j], glm::vec2(at) + 0.5F, depthM);
            ++samples;
            lost += sequence.holds(j, {stored, point->triangleId}) ? 0 : 1;
        }
    }
    EXPECT_GT(samples, 2000);
    EXPECT_LE(lost, samples / 500);
}

TEST(Visibility, SurfacesSeenAtASlantDoNotHideThemselves) {
    const scene::Scene scene{.meshes = {squareAt({0, 0, 0}, 1.0F)},
                             .instances = {{0, glm::mat4(1.0F)}}};
    const RayTracer tracer(scene);
    const scene::Camera camera{
        .position = {-1.5F, 0.1F, 0.01F}, .target = {0.3F, 0.2F, 0}, .up = {0, 0, 1}};
    const View view = kit::viewOf(camera, {16, 16});
    const VisibilitySequence images(tracer, {view, view}, true);
    // Rounded to 1 µm behind the surface, the ray meets it 0.2 mm before the point.
    const SurfacePoint point{{0.3F, 0.2F, -1e-6F}, 1};
    EXPECT_TRUE(images.holds(0, point));
    EXPECT_FALSE(images.holds(1, point));
}

// [xie2017] Fig. 11 and 12: A hides C from both views; as V₀ has A, V₁ looks through it, past B.
TEST(Visibility, OnlyNonRedundantImagesGetTheObjectHiddenFromAllViews) {
    const FourObjects objects;
    const RayTracer tracer(objects.scene);
    const View left = objects.viewFrom(-1.0F);
    const View right = objects.viewFrom(1.0F);
    const View centre = objects.viewFrom(0.0F);
    const VisibilitySequence conventional(tracer, {left, right}, false);
    const VisibilitySequence nonRedundant(tracer, {left, right}, true);
    const VisibilitySequence peeled(tracer, {centre, centre}, true);
    const SurfacePoint c = objects.middleOfC();
    EXPECT_FALSE(conventional.anyHolds(2, c));
    EXPECT_FALSE(peeled.anyHolds(2, c));
    EXPECT_FALSE(nonRedundant.holds(0, c));
    EXPECT_TRUE(nonRedundant.holds(1, c));
    const VisibilitySequence threeLayers(tracer, {centre, centre, centre}, true);
    EXPECT_TRUE(threeLayers.holds(2, c));
}

// [xie2017] Sec. 2.1: however many layers are peeled, a wall in the eye's plane is in none of them.
TEST(Visibility, AWallInThePlaneOfTheEyeIsNeverPeeled) {
    FourObjects objects;
    const scene::Mesh wall = test::rectangle({0, 0, 2}, {0, 0, -1}, {0, 1, 0});  // faces +x
    objects.scene.meshes = {wall, squareAt({0, 0, -5}, 6.0F)};
    objects.scene.instances = {{0}, {1}};
    const RayTracer tracer(objects.scene);
    const View centre = objects.viewFrom(0.0F);
    const VisibilitySequence peeled(tracer, std::vector<View>(8, centre), true);
    const VisibilitySequence nonRedundant(tracer, {objects.viewFrom(-1.0F), objects.viewFrom(1.0F)},
                                          true);
    for (const SurfacePoint& point :
         {SurfacePoint{{0, -0.3F, 1.4F}, 1}, SurfacePoint{{0, 0.4F, 2.1F}, 2}}) {
        EXPECT_FALSE(peeled.anyHolds(8, point));
        EXPECT_TRUE(nonRedundant.holds(1, point));
    }
}

TEST(Visibility, FrustumsEndWhatImagesHold) {
    const FourObjects objects;
    const RayTracer tracer(objects.scene);
    const SurfacePoint a = objects.middleOfA();
    const auto holds = [&](const View& view) {
        return VisibilitySequence(tracer, {view}, false).holds(0, a);
    };
    const View view = objects.viewFrom(0.0F);
    const float depthM = view.eyeWorld.z - a.positionWorld.z;
    EXPECT_TRUE(holds(view));
    View moved = view;
    moved.nearM = depthM + 0.01F;
    EXPECT_FALSE(holds(moved));
    moved = view;
    moved.farM = depthM - 0.01F;
    EXPECT_FALSE(holds(moved));
    moved = view;
    moved.clipFromView[2].x = 2.0F;  // an image further to the right
    EXPECT_FALSE(holds(moved));
    // What lies before the near plane hides nothing.
    moved = view;
    moved.nearM = depthM + 0.01F;
    const SurfacePoint b = objects.middleOfB();
    EXPECT_FALSE(VisibilitySequence(tracer, {view}, false).holds(0, b));
    EXPECT_TRUE(VisibilitySequence(tracer, {moved}, false).holds(0, b));
}

/// A square of half size 1 at z = 0 and one of half size 0.5 behind it at z = −1.
scene::Scene twoSquares() {
    return scene::Scene{.meshes = {squareAt({0, 0, 0}, 1.0F), squareAt({0, 0, -1}, 0.5F)},
                        .instances = {{0, glm::mat4(1.0F)}, {1, glm::mat4(1.0F)}}};
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

ImageCounts measured(const VisibilitySequence& sequence, std::size_t index,
                     const VisibilitySequence& conventional, std::size_t conventionalCount,
                     const VisibilitySequence& outputs) {
    return countsOf(markedSamples(sequence, samplesOf(sequence, index), conventional,
                                  conventionalCount, outputs));
}

TEST(VisibilityMeasures, CountTwoSquares) {
    const RayTracer tracer(twoSquares());
    const VisibilitySequence conventional(tracer, {viewFrom(0), viewFrom(0)}, false);
    const VisibilitySequence layers(tracer, {viewFrom(0), viewFrom(0), viewFrom(0)}, true);
    const VisibilitySequence aside(tracer, {viewFrom(0), viewFrom(20)}, false);
    const VisibilitySequence before(tracer, {viewFrom(0)}, false);

    // 32 pixels for 4 m: the front square fills 16². The back one, a metre further, is seen at
    // 0.5 · 4/5 = 0.4 m of half size: samples at 0.125 · (k + 0.5) m, so 2 · 3 = 6 a side.
    EXPECT_EQ(measured(conventional, 0, conventional, 2, before), (ImageCounts{.samples = 256}));
    EXPECT_EQ(measured(conventional, 1, conventional, 2, before),
              (ImageCounts{.samples = 256, .redundant = 256}));
    EXPECT_EQ(measured(layers, 1, conventional, 2, before),
              (ImageCounts{.samples = 36, .occluded = 36}));
    // From far aside the gap between the squares shows all of the back one.
    EXPECT_EQ(measured(layers, 1, conventional, 2, aside),
              (ImageCounts{.samples = 36, .occluded = 36, .useful = 36}));
    EXPECT_EQ(measured(layers, 2, conventional, 2, aside), ImageCounts{});
    // V₁ has what V₀ has not.
    EXPECT_EQ(measured(layers, 1, aside, 1, aside),
              (ImageCounts{.samples = 36, .occluded = 36, .useful = 36}));
    EXPECT_EQ(measured(layers, 1, aside, 2, aside), (ImageCounts{.samples = 36}));
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
    const scene::Scene scene = scattered(9);
    const RayTracer tracer(scene);
    const std::vector<View> views = threeViews(24);
    const std::vector<View> seers{viewFrom(-0.7F), viewFrom(-0.6F), viewFrom(0.5F), viewFrom(6)};
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
            if (isHeld(bruteConventional, j + 1, *point)) continue;
            ++expected.occluded;
            expected.useful += isHeld(bruteOutputs, seers.size(), *point);
        }
        const ImageCounts counts = measured(sequence, j, conventional, j + 1, outputs);
        EXPECT_EQ(counts.redundant, 0U);
        // A few samples lie so near to an edge that rounding decides.
        constexpr double kFew = 3.0;
        EXPECT_NEAR(counts.samples, expected.samples, kFew);
        EXPECT_NEAR(counts.occluded, expected.occluded, kFew);
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

    const auto front = rayCastImage(layers.views()[0], samplesOf(layers, 0), shading);
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

    const auto back = rayCastImage(layers.views()[1], samplesOf(layers, 1), shading);
    const std::size_t behind = back.indexOf({16, 18});
    EXPECT_NEAR(back.depthM[behind], 5.0F, 1e-6F);
    EXPECT_EQ(back.triangleId[behind], 4U);
    const float turned = 0.3F + 0.7F * (-0.6F * 0.397F + 0.8F * 0.461F);
    EXPECT_EQ(glm::ivec4(back.shading[behind]), glm::ivec4(glm::ivec3(byte(turned)), 255));
}

}  // namespace

}  // namespace gfxrepro::depth_sampling
