// Occlusion errors by hand-made cameras.
#include "techniques/clustered_reflections/reflection_errors.h"

#include <glm/gtc/matrix_transform.hpp>

#include "tests/techniques/clustered_reflections/room.h"

namespace gfxrepro::clustered_reflections {
namespace {

/// A mirror in the plane z = 0, a screen before a wall; the camera stands at z = −1 behind the
/// mirror and looks through it, 45° to each side.
struct OcclusionTest : testing::Test {
    OcclusionTest() : scene_(makeScene()), rays_(scene_.scene()) {
        const glm::mat4 view = glm::lookAt(glm::vec3(0, 0, -1), glm::vec3(0), glm::vec3(0, 1, 0));
        camera_.clipFromWorld = glm::frustum(-1.0F, 1.0F, -1.0F, 1.0F, 1.0F, 11.0F) * view;
        camera_.eyeWorld = glm::vec4(0, 0, -1, 1);
        camera_.planeNormal = glm::vec4(0, 0, 1, 11);
        camera_.reflector = 1;
        camera_.flags = kPlanarCluster;
    }
    static reflections::ReflectiveScene makeScene() {
        scene::Scene scene;
        scene::MeshBuilder builder;
        // A mirror with a flap that stands out from it, before everything at x < −0.5; below y = 0
        // it turns its back to the camera.
        builder.addQuad({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0});
        builder.addQuad({-3, -3, 0.5F}, {-1, -3, 0.5F}, {-1, 0, 0.5F}, {-3, 0, 0.5F});
        builder.addQuad({-3, 0, 0.5F}, {-3, 3, 0.5F}, {-1, 3, 0.5F}, {-1, 0, 0.5F});
        addPart(scene, builder, kMirror);
        builder.addQuad({-5, -5, 5}, {-5, 5, 5}, {5, 5, 5}, {5, -5, 5});  // wall
        builder.addQuad({1, -5, 2}, {1, 5, 2}, {5, 5, 2}, {5, -5, 2});    // screen at x > 1
        addPart(scene, builder, {});
        return reflections::ReflectiveScene(scene);
    }
    Sight sight(const glm::vec3& point, std::uint32_t reflector = 0) const {
        return sightOf(camera_, point, reflector, {gbuffer_, {}, {}, {}, scene_, rays_, {}});
    }
    bool isSeen(const glm::vec3& point) const { return sight(point) == Sight::Seen; }

    reflections::ReflectiveScene scene_;
    raycast::RayTracer rays_;
    reflections::HostGBuffer gbuffer_;
    ClusterCamera camera_;
};

TEST_F(OcclusionTest, WhatLiesOpenIsSeen) {
    EXPECT_TRUE(isSeen({0, 0, 5}));
    EXPECT_TRUE(isSeen({1.9F, 0, 5}));  // passes the screen's edge: 0.95 at z = 2
    EXPECT_TRUE(isSeen({1.5F, 0, 2}));  // on the screen
    EXPECT_TRUE(isSeen({-4, 0, 5}));    // through the own reflector's flap
}

TEST_F(OcclusionTest, WhatIsHiddenIsNotSeen) {
    EXPECT_EQ(sight({2.2F, 0, 5}), Sight::Hidden);  // behind the screen: 1.1 at z = 2
    EXPECT_EQ(sight({5.9F, 0, 5}), Sight::Hidden);  // there and nowhere
}

TEST_F(OcclusionTest, TheOwnReflectorIsSeenOnlyWhereTheImageShowsIt) {
    EXPECT_EQ(sight({-1.2F, 0, 0.5F}, 1), Sight::Self);  // on the flap
    EXPECT_EQ(sight({-1.2F, 0, 0.5F}, 2), Sight::Seen);  // the same place of another
    camera_.flags = kShowsOwn;
    EXPECT_EQ(sight({-1.2F, 0, 0.5F}, 1), Sight::Seen);
    EXPECT_EQ(sight({-4.8F, 1, 5}), Sight::Hidden);  // through the flap, which is drawn now
    EXPECT_EQ(sight({-4.8F, -1, 5}), Sight::Seen);   // but for its back
    camera_.flags = kShowsOwn | kShowsOwnBack;
    EXPECT_EQ(sight({-4.8F, -1, 5}), Sight::Hidden);
}

TEST_F(OcclusionTest, WhatLiesBackToBackIsLeftOut) {
    // Reflector 1 is convex, 2 the concave part of the same object, 3 that of another.
    const std::vector<std::uint32_t> families{0, 1U << 2 | 1, 1U << 2 | 2, 2U << 2 | 2};
    const auto seen = [&](std::uint32_t reflector) {
        return sightOf(camera_, {0, 0, 5}, reflector,
                       {gbuffer_, {}, {}, {}, scene_, rays_, {}, families});
    };
    EXPECT_EQ(seen(0), Sight::Seen);
    EXPECT_EQ(seen(2), Sight::Self);
    EXPECT_EQ(seen(3), Sight::Seen);
    EXPECT_FALSE(areBackToBack(families[1], 1U << 2));  // a planar part
    EXPECT_FALSE(areBackToBack(families[1], families[1]));
}

TEST_F(OcclusionTest, ToleratesEdgesThatAreMissedByLittle) {
    // Seen at x = 1 ± half of z = 2 … 5 there; the diagonal is √(100 + 100 + 25) = 15.
    const float toleranceM = kOcclusionTolerance * scene_.diagonalM();
    EXPECT_NEAR(scene_.diagonalM(), 15.0F, 1e-3F);
    EXPECT_TRUE(isSeen({2.0F + 0.5F * toleranceM, 0, 5}));
    EXPECT_FALSE(isSeen({2.0F + 3.0F * toleranceM, 0, 5}));
}

TEST_F(OcclusionTest, WhatLeavesTheFrustumIsNotSeen) {
    // The camera's right is −x.
    camera_.clipFromWorld = glm::frustum(-1.0F, 0.5F, -1.0F, 1.0F, 1.0F, 11.0F) *
                            glm::lookAt(glm::vec3(0, 0, -1), glm::vec3(0), glm::vec3(0, 1, 0));
    EXPECT_TRUE(isSeen({-2.9F, 0, 5}));
    EXPECT_EQ(sight({-3.1F, 0, 5}), Sight::Beside);
    EXPECT_EQ(sight({0, 0, -0.1F}), Sight::BeforeNear);
    EXPECT_EQ(sight({0, 0, -5}), Sight::BeforeNear);  // behind the camera
    camera_.planeNormal.w = 5.0F;
    EXPECT_EQ(sight({0, 0, 5}), Sight::Beside);  // behind the far plane
}

TEST_F(OcclusionTest, CountsSamplesByTheirClusters) {
    // Two samples in a view from (0, 0, 4) down to the mirror; its pixels see (∓1, 0, 0).
    scene::Camera eye{.position = {0, 0, 4}, .target = {0, 0, 0}};
    eye.verticalFovRad = 2.0F * std::atan(0.25F);
    gbuffer_.view = kit::viewOf(eye, {4, 2});
    gbuffer_.worldFromPixels = kit::worldFromPixels(gbuffer_.view);
    gbuffer_.depthM.assign(8, 4.0F);
    gbuffer_.normalWorld.assign(8, {0, 0, 1});
    gbuffer_.surface.assign(8, 1U | 255U << 16);
    gbuffer_.diffuse.assign(8, glm::vec3(0.5F));
    std::vector<reflections::TracedSample> truth(8);
    std::vector<std::uint16_t> clusters(8, 0);
    // The mirror ray of pixel (3, 1) runs from (1.5, 0.5, 0) to (3.375, 1.125, 5), which a camera
    // at (0, 0, −4) sees but for the screen: it is at x = 2.25 there. That of (2, 1) passes it.
    const float length = std::sqrt(1.875F * 1.875F + 0.625F * 0.625F + 25.0F);
    const float inner = std::sqrt(0.625F * 0.625F + 0.625F * 0.625F + 25.0F);
    clusters[7] = clusters[6] = clusters[5] = 1;
    truth[7].distanceM = length;
    truth[6].distanceM = inner;
    truth[5].distanceM = 0.0F;  // left the scene
    camera_.clipFromWorld = glm::frustum(-4.0F, 4.0F, -4.0F, 4.0F, 4.0F, 14.0F) *
                            glm::lookAt(glm::vec3(0, 0, -4), glm::vec3(0), glm::vec3(0, 1, 0));
    camera_.eyeWorld = glm::vec4(0, 0, -4, 4);
    camera_.planeNormal.w = 14.0F;
    const std::vector<ClusterCamera> cameras{camera_};
    OcclusionErrors errors =
        occlusionErrors({gbuffer_, truth, clusters, cameras, scene_, rays_, {}});
    EXPECT_EQ(errors.reflective, 3U);
    EXPECT_EQ(errors.missing(), 1U);
    EXPECT_EQ(errors.of(Sight::Hidden), 1U);
    EXPECT_EQ(errors.planar, 3U);
    EXPECT_EQ(errors.planarMissing, 1U);
    EXPECT_EQ(errors.isMissing[7], 1);
    EXPECT_EQ(errors.isMissing[6], 0);
    // The same two hits on the mirror itself, the first object, and one that leaves the scene.
    truth[7].object = truth[6].object = 1;
    errors = occlusionErrors({gbuffer_, truth, clusters, cameras, scene_, rays_, {}});
    EXPECT_EQ(errors.of(Sight::Self), 2U);
    EXPECT_EQ(errors.of(Sight::Hidden), 0U);
    EXPECT_EQ(errors.missing(), 2U);
    // Glossy samples' rays end before it: 15 · (1 − 0.5)⁴ is less than a metre.
    gbuffer_.surface.assign(8, 1U | 255U << 16 | 128U << 24);
    errors = occlusionErrors({gbuffer_, truth, clusters, cameras, scene_, rays_, {}});
    EXPECT_EQ(errors.missing(), 0U);
}

}  // namespace
}  // namespace gfxrepro::clustered_reflections
