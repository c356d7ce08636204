// Where reference images and output frames are taken from.
#include "techniques/depth_sampling/reference_views.h"

#include <cmath>

#include <glm/gtc/constants.hpp>

#include "techniques/kit/view.h"
#include "tests/support/support.h"

namespace gfxrepro::depth_sampling {
namespace {

/// One triangle with this box, seen from (2, 3, 9).
scene::Scene boxScene(const glm::vec3& low, const glm::vec3& high) {
    const scene::Mesh mesh{.positions = {low, high, {low.x, high.y, low.z}},
                           .triangles = {{0, 1, 2}}};
    scene::Scene scene = scene::sceneOf(mesh);
    const scene::Camera camera{.position = {2, 3, 9}, .target = {0, 1, 0}};
    scene.cameras = {camera};
    return scene;
}

const scene::Scene kScene = boxScene({-1, 0, -2}, {1, 2, 2});  // diagonal √24

TEST(ReferenceViewsTest, TriangleIsEquilateralAndAcrossTheView) {
    const ViewTriangle triangle = makeViewTriangle(kScene, {.spread = 0.25F});
    const float side = 0.25F * std::sqrt(24.0F);
    const glm::vec3* v = triangle.corners;
    EXPECT_NEAR(glm::distance(v[0], v[1]), side, 1e-5F);
    EXPECT_NEAR(glm::distance(v[1], v[2]), side, 1e-5F);
    EXPECT_NEAR(glm::distance(v[2], v[0]), side, 1e-5F);
    EXPECT_NEAR(glm::distance((v[0] + v[1] + v[2]) / 3.0F, glm::vec3(2, 3, 9)), 0.0F, 1e-5F);
    EXPECT_EQ(triangle.centre.position, glm::vec3(2, 3, 9));
    const glm::vec3 forward = glm::normalize(triangle.centre.target - triangle.centre.position);
    EXPECT_NEAR(glm::dot(glm::cross(v[1] - v[0], v[2] - v[0]), -forward),
                std::sqrt(3.0F) / 2.0F * side * side, 1e-4F);  // seen from in front: V₀ V₁ V₂
    EXPECT_GT(v[2].y, v[0].y);
    EXPECT_NEAR(v[0].y, v[1].y, 1e-5F);
}

TEST(ReferenceViewsTest, TurnsAboutTheTarget) {
    const float quarter = glm::half_pi<float>();
    const auto centre = [](const ViewTriangleSettings& settings) {
        return makeViewTriangle(kScene, settings).centre.position;
    };
    // From (2, 2, 9) off the target: a quarter about y takes z to x, and x to −z.
    EXPECT_NEAR(glm::distance(centre({.yawRad = quarter}), glm::vec3(9, 3, -2)), 0.0F, 1e-4F);
    EXPECT_NEAR(glm::distance(centre({.distance = 2.0F}), glm::vec3(4, 5, 18)), 0.0F, 1e-4F);
    const glm::vec3 raised = centre({.pitchRad = 0.5F}) - glm::vec3(0, 1, 0);
    const float before = std::atan2(2.0F, std::sqrt(85.0F));
    EXPECT_NEAR(std::asin(raised.y / glm::length(raised)), before + 0.5F, 1e-4F);
}

TEST(ReferenceViewsTest, PlanesHoldTheBoxFromEverywhereInTheTriangle) {
    for (const glm::vec3& high : {glm::vec3(1, 2, 2), glm::vec3(1, 2, 6), glm::vec3(30, 2, 2)}) {
        const scene::Scene scene = boxScene({-1, 0, -2}, high);
        for (const float spread : {0.0F, 0.5F, 2.0F}) {
            const ViewTriangle triangle = makeViewTriangle(scene, {.spread = spread});
            const float diagonal = glm::length(scene.bounds().size());
            for (const scene::Camera& camera : outputCameras(triangle, 3, 300)) {
                const glm::mat4 view = kit::viewOf(camera, {8, 8}).viewFromWorld;
                for (int corner = 0; corner < 8; ++corner) {
                    const glm::vec3 at((corner & 1) != 0 ? high.x : -1.0F,
                                       (corner & 2) != 0 ? high.y : 0.0F,
                                       (corner & 4) != 0 ? high.z : -2.0F);
                    const float depthM = -(view * glm::vec4(at, 1.0F)).z;
                    EXPECT_LE(depthM, camera.farM);
                    // Eyes inside of the box, or next to it, have the least near plane.
                    if (camera.nearM > 0.0021F * diagonal) EXPECT_GE(depthM, camera.nearM);
                }
            }
        }
    }
}

TEST(ReferenceViewsTest, ReferencesAreTheCentreTheCornersAndMoreInside) {
    const ViewTriangle triangle = makeViewTriangle(kScene, {});
    ASSERT_EQ(referenceCameras(triangle, 1).size(), 1U);
    EXPECT_EQ(referenceCameras(triangle, 1)[0].position, triangle.centre.position);
    const auto two = referenceCameras(triangle, 2);
    ASSERT_EQ(two.size(), 2U);
    EXPECT_EQ(two[1].position, triangle.corners[1]);
    const auto many = referenceCameras(triangle, 16);
    ASSERT_EQ(many.size(), 16U);
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(glm::distance(many[static_cast<std::size_t>(i)].position, triangle.corners[i]),
                    0.0F, 1e-5F);
    }
}

/// Barycentric coordinates of corners 1 and 2.
glm::vec2 barycentricOf(const ViewTriangle& triangle, const glm::vec3& point) {
    const glm::vec3 a = triangle.corners[1] - triangle.corners[0];
    const glm::vec3 b = triangle.corners[2] - triangle.corners[0];
    const glm::vec3 p = point - triangle.corners[0];
    const glm::mat2 gram(glm::dot(a, a), glm::dot(a, b), glm::dot(a, b), glm::dot(b, b));
    return glm::inverse(gram) * glm::vec2(glm::dot(p, a), glm::dot(p, b));
}

TEST(ReferenceViewsTest, OutputFramesFillTheHullEvenly) {
    const ViewTriangle triangle = makeViewTriangle(kScene, {});
    int quarters[4] = {};  // the triangle's three corner quarters and its middle one
    for (const scene::Camera& camera : outputCameras(triangle, 3, 1000)) {
        const glm::vec2 b = barycentricOf(triangle, camera.position);
        ASSERT_GE(b.x, -1e-5F);
        ASSERT_GE(b.y, -1e-5F);
        ASSERT_LE(b.x + b.y, 1.0F + 1e-5F);
        ++quarters[b.x > 0.5F ? 0 : b.y > 0.5F ? 1 : b.x + b.y < 0.5F ? 2 : 3];
    }
    for (int count : quarters) EXPECT_NEAR(count, 250, 10);

    int halves[2] = {};
    for (const scene::Camera& camera : outputCameras(triangle, 2, 1000)) {
        const glm::vec2 b = barycentricOf(triangle, camera.position);
        EXPECT_NEAR(b.y, 0.0F, 1e-5F);
        ++halves[b.x > 0.5F ? 0 : 1];
    }
    EXPECT_NEAR(halves[0], 500, 10);
    for (const scene::Camera& camera : outputCameras(triangle, 1, 5)) {
        EXPECT_EQ(camera.position, triangle.centre.position);
    }
}

TEST(ReferenceViewsTest, CandidatesBeginWithTheFixedViewsAndAreNoOutputFrames) {
    const ViewTriangle triangle = makeViewTriangle(kScene, {});
    const auto candidates = candidateCameras(triangle, 3, kMaxCandidates);
    ASSERT_EQ(candidates.size(), 64U);
    EXPECT_EQ(candidates[2].position, referenceCameras(triangle, 3)[2].position);
    for (const scene::Camera& output : outputCameras(triangle, 3, 1000)) {
        for (const scene::Camera& candidate : candidates) {
            EXPECT_NE(output.position, candidate.position);
        }
    }
    EXPECT_NEAR(barycentricOf(triangle, candidateCameras(triangle, 2, 9)[8].position).y, 0.0F,
                1e-5F);
}

TEST(ReferenceViewsTest, RefusesToLookAlongUp) {
    scene::Scene scene = boxScene({-1, 0, -2}, {1, 2, 2});
    scene.cameras[0].position = {0, 9, 0};
    EXPECT_EQ(
        errorText([&] { makeViewTriangle(scene, {}); }),
        "the camera at (0, 9, 0) looks along its up direction; change 'view' or 'view_pitch_deg'");
}

}  // namespace
}  // namespace gfxrepro::depth_sampling
