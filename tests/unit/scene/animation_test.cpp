#include "engine/scene/animation.h"

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/support/support.h"

namespace gfxrepro::scene {
namespace {

Camera keyAt(const glm::vec3& position, const glm::vec3& target, float fovRad = 1.0F) {
    Camera camera;
    camera.position = position;
    camera.target = target;
    camera.verticalFovRad = fovRad;
    return camera;
}

CameraPath bentPath() {
    CameraPath path{"bent",
                    {keyAt({0, 0, 0}, {0, 0, -1}, 0.8F), keyAt({1, 2, 0}, {3, 0, -1}, 1.2F),
                     keyAt({4, 1, 5}, {0, 7, 2}, 0.9F), keyAt({2, 2, 2}, {9, 1, 1}, 1.0F)}};
    path.keys[1].up = {1, 0, 0};
    path.keys[1].nearM = 0.1F;
    path.keys[2].nearM = 0.3F;
    path.keys[1].farM = 10.0F;
    path.keys[2].farM = 20.0F;
    return path;
}

void expectNear(const glm::vec3& actual, const glm::vec3& expected, float tolerance = 1e-5F) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(actual[i], expected[i], tolerance) << "axis " << i;
}

TEST(CameraAt, PassesThroughItsKeysAtEqualSteps) {
    const CameraPath path = bentPath();
    for (std::size_t i = 0; i < path.keys.size(); ++i) {
        SCOPED_TRACE(i);
        const Camera camera = cameraAt(path, static_cast<double>(i) / 3.0);
        expectNear(camera.position, path.keys[i].position);
        expectNear(camera.target, path.keys[i].target);
        expectNear(camera.up, path.keys[i].up);
        EXPECT_NEAR(camera.verticalFovRad, path.keys[i].verticalFovRad, 1e-5F);
        EXPECT_NEAR(camera.nearM, path.keys[i].nearM, 1e-5F);
        EXPECT_EQ(camera.name, "bent");
    }
}

TEST(CameraAt, IsCatmullRomBetweenKeys) {
    // Halfway, the spline is (−p0 + 9 p1 + 9 p2 − p3) / 16.
    const CameraPath path = bentPath();
    const Camera camera = cameraAt(path, 0.5);
    const auto halfway = [](auto a, auto b, auto c, auto d) {
        return (-a + 9.0F * b + 9.0F * c - d) / 16.0F;
    };
    const auto& k = path.keys;
    expectNear(camera.position,
               halfway(k[0].position, k[1].position, k[2].position, k[3].position));
    expectNear(camera.target, halfway(k[0].target, k[1].target, k[2].target, k[3].target));
    EXPECT_NEAR(camera.verticalFovRad, (-0.8F + 9.0F * 1.2F + 9.0F * 0.9F - 1.0F) / 16.0F, 1e-5F);
    EXPECT_NEAR(glm::length(camera.up), 1.0F, 1e-6F);
    // The planes are linear.
    EXPECT_NEAR(camera.nearM, 0.2F, 1e-6F);
    EXPECT_NEAR(camera.farM, 15.0F, 1e-5F);
}

TEST(CameraAt, EqualStepsOnALineAreEvenAwayFromItsEnds) {
    CameraPath path;
    for (int i = 0; i < 5; ++i) {
        const auto x = static_cast<float>(i);
        path.keys.push_back(keyAt({x, 0, 0}, {x, 0, -1}));
    }
    for (double time = 0.25; time <= 0.75; time += 0.05) {
        EXPECT_NEAR(cameraAt(path, time).position.x, 4.0 * time, 1e-5);
    }
}

TEST(CameraAt, HasNoKinksAtItsKeys) {
    const CameraPath path = bentPath();
    constexpr double kStep = 1e-3;
    for (const double key : {1.0 / 3.0, 2.0 / 3.0}) {
        const glm::vec3 here = cameraAt(path, key).position;
        const glm::vec3 before = here - cameraAt(path, key - kStep).position;
        const glm::vec3 after = cameraAt(path, key + kStep).position - here;
        // The bend within a step; a kink would be of the size of the steps themselves.
        EXPECT_LT(glm::length(after - before), 0.1F * glm::length(before));
    }
}

TEST(CameraAt, TimesOutsideAreClamped) {
    const CameraPath path = bentPath();
    expectNear(cameraAt(path, -2.0).position, path.keys.front().position);
    expectNear(cameraAt(path, 1.5).position, path.keys.back().position);
}

TEST(CameraAt, OneKeyStandsStill) {
    const CameraPath path{"still", {keyAt({1, 2, 3}, {4, 5, 6}, 0.7F)}};
    for (const double time : {-1.0, 0.0, 0.4, 1.0, 3.0}) {
        const Camera camera = cameraAt(path, time);
        expectNear(camera.position, {1, 2, 3});
        expectNear(camera.target, {4, 5, 6});
        EXPECT_NEAR(camera.verticalFovRad, 0.7F, 1e-6F);
    }
}

TEST(CameraAt, APathWithoutKeysIsAnError) {
    EXPECT_EQ(errorText([] {
                  cameraAt(CameraPath{"empty", {}}, 0.5);
              }),
              "the camera path 'empty' has no keys");
}

/// Three instances, of which the second moves.
Scene movingScene(const Motion& motion) {
    Scene scene;
    scene.instances.resize(3);
    for (int i = 0; i < 3; ++i) {
        scene.instances[static_cast<std::size_t>(i)].worldFromMesh = glm::scale(
            glm::translate(glm::mat4(1.0F), glm::vec3(static_cast<float>(i), 0.0F, 0.0F)),
            glm::vec3(2.0F));
    }
    scene.motions = {motion};
    scene.motions[0].instance = 1;
    return scene;
}

glm::vec3 movedAt(const Scene& scene, double time, const glm::vec3& pointMesh) {
    return glm::vec3(posesAt(scene, time).at(1) * glm::vec4(pointMesh, 1.0F));
}

TEST(PosesAt, LeavesWhatDoesNotMove) {
    Motion motion;
    motion.turnRad = 2.0F;
    motion.swing = {1, 0, 0};
    const Scene scene = movingScene(motion);
    for (const double time : {0.0, 0.3, 1.0}) {
        const auto poses = posesAt(scene, time);
        ASSERT_EQ(poses.size(), 3U);
        EXPECT_EQ(poses[0], scene.instances[0].worldFromMesh);
        EXPECT_EQ(poses[2], scene.instances[2].worldFromMesh);
    }
}

TEST(PosesAt, TurnsAboutItsPivot) {
    Motion motion;
    motion.pivot = {5, 3, 1};
    motion.turnRad = glm::pi<float>();
    const Scene scene = movingScene(motion);
    // The mesh's (2, 1.5, 0.5) lies on the pivot in the world: it stays.
    for (const double time : {0.0, 0.2, 0.5, 1.0}) {
        expectNear(movedAt(scene, time, {2, 1.5F, 0.5F}), {5, 3, 1});
    }
    // (7, 3, 1) goes a quarter about +y, to −z of the pivot, then opposite.
    expectNear(movedAt(scene, 0.0, {3, 1.5F, 0.5F}), {7, 3, 1});
    expectNear(movedAt(scene, 0.5, {3, 1.5F, 0.5F}), {5, 3, -1});
    expectNear(movedAt(scene, 1.0, {3, 1.5F, 0.5F}), {3, 3, 1});
}

TEST(PosesAt, SwingsAFullPeriodAsOftenAsItSays) {
    Motion motion;
    motion.swing = {0, 0.5F, 1};
    motion.swingCount = 2.0F;
    const Scene scene = movingScene(motion);
    const glm::vec3 rest(1, 0, 0);
    for (const double time : {0.0, 0.25, 0.5, 0.75, 1.0}) {
        expectNear(movedAt(scene, time, glm::vec3(0)), rest);
    }
    expectNear(movedAt(scene, 0.125, glm::vec3(0)), rest + glm::vec3(0, 0.5F, 1));
    expectNear(movedAt(scene, 0.375, glm::vec3(0)), rest - glm::vec3(0, 0.5F, 1));
    expectNear(movedAt(scene, 0.625, glm::vec3(0)), rest + glm::vec3(0, 0.5F, 1));
}

TEST(PosesAt, TimesOutsideAreClamped) {
    Motion motion;
    motion.turnRad = 1.0F;
    const Scene scene = movingScene(motion);
    EXPECT_EQ(posesAt(scene, -1.0), posesAt(scene, 0.0));
    EXPECT_EQ(posesAt(scene, 7.0), posesAt(scene, 1.0));
    EXPECT_NE(posesAt(scene, 0.0), posesAt(scene, 1.0));
}

}  // namespace
}  // namespace gfxrepro::scene
