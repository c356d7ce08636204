// What the living room's reflection experiments rely on: how much of the pictures along its paths
// reflects, and that the paths are free.
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "engine/raycast/ray_tracer.h"
#include "engine/scene/animation.h"
#include "engine/scene/generators.h"
#include "scenes/outdoor/outdoor.h"
#include "scenes/registry.h"
#include "tests/support/grid.h"

namespace gfxrepro::raycast {
namespace {

/// Made once: the tests only look.
struct LivingRoom : testing::Test {
    static void SetUpTestSuite() {
        Params params(parseYaml("{}", "t.yaml"), "generator 'living_room'");
        scene_ =
            new scene::Scene(scene::findGenerator(scene::registeredGenerators(), "living_room", {})
                                 .generate(params, 1));
        tracer_ = new RayTracer(*scene_);
    }
    static void TearDownTestSuite() {
        delete tracer_;
        delete scene_;
    }

    static const scene::Mesh& meshOf(unsigned instance) {
        return scene_->meshes.at(static_cast<std::size_t>(scene_->instances.at(instance).mesh));
    }
    static bool reflects(const scene::Mesh& mesh) {
        return scene_->materials.at(static_cast<std::size_t>(mesh.material)).metallic > 0.0F;
    }
    static bool isPlanar(const scene::Mesh& mesh) {
        return std::all_of(mesh.normals.begin(), mesh.normals.end(), [&](const glm::vec3& n) {
            return glm::length(n - mesh.normals[0]) < 1e-3F;
        });
    }

    struct Shares {
        double reflective = 0.0;  // of the pixels
        double planar = 0.0;      // of the reflective ones
    };
    static Shares sharesOf(const scene::Camera& camera) {
        constexpr int kSizePx = 40;
        const glm::vec3 forward = glm::normalize(camera.target - camera.position);
        const glm::vec3 right = glm::normalize(glm::cross(forward, camera.up));
        const glm::vec3 up = glm::cross(right, forward);
        const float slope = std::tan(0.5F * camera.verticalFovRad);
        int reflective = 0;
        int planar = 0;
        for (const auto [y, x] : test::grid(kSizePx, kSizePx)) {
            const float sx = slope * (static_cast<float>(2 * x + 1) / kSizePx - 1.0F);
            const float sy = slope * (static_cast<float>(2 * y + 1) / kSizePx - 1.0F);
            const auto hit = tracer_->closestHit(camera.position, forward + sx * right + sy * up);
            EXPECT_TRUE(hit.has_value()) << "the room has a hole";
            if (!hit || !reflects(meshOf(hit->instance))) continue;
            ++reflective;
            planar += isPlanar(meshOf(hit->instance));
        }
        return {static_cast<double>(reflective) / (kSizePx * kSizePx),
                reflective > 0 ? static_cast<double>(planar) / reflective : 0.0};
    }

    static scene::Scene* scene_;
    static RayTracer* tracer_;
};

scene::Scene* LivingRoom::scene_ = nullptr;
RayTracer* LivingRoom::tracer_ = nullptr;

/// [xie2017] Table 13 and Table 21, percent: average and maximum.
struct Printed {
    const char* path;
    double reflective, mostReflective, planar, mostPlanar;
};

TEST_F(LivingRoom, PathsShowAsMuchReflectionAsTheThesis) {
    constexpr int kFrames = 40;
    for (const Printed& printed :
         {Printed{"path_1", 50, 62, 41, 52}, Printed{"path_2", 58, 69, 33, 51}}) {
        SCOPED_TRACE(printed.path);
        const auto path = std::find_if(scene_->paths.begin(), scene_->paths.end(),
                                       [&](const auto& p) { return p.name == printed.path; });
        ASSERT_NE(path, scene_->paths.end());
        Shares mean, most;
        for (int frame = 0; frame < kFrames; ++frame) {
            const Shares shares =
                sharesOf(scene::cameraAt(*path, static_cast<double>(frame) / (kFrames - 1)));
            mean.reflective += shares.reflective / kFrames;
            mean.planar += shares.planar / kFrames;
            most.reflective = std::max(most.reflective, shares.reflective);
            most.planar = std::max(most.planar, shares.planar);
        }
        EXPECT_NEAR(100.0 * mean.reflective, printed.reflective, 5.0);
        EXPECT_NEAR(100.0 * mean.planar, printed.planar, 5.0);
        EXPECT_LE(100.0 * most.reflective, printed.mostReflective + 2.0);
        EXPECT_LE(100.0 * most.planar, printed.mostPlanar + 2.0);
    }
}

TEST_F(LivingRoom, PathsAreClearOfGeometry) {
    constexpr int kFrames = 180;
    constexpr int kDirections = 200;
    for (const scene::CameraPath& path : scene_->paths) {
        float nearestM = 1e9F;
        for (int frame = 0; frame < kFrames; ++frame) {
            const scene::Camera camera =
                scene::cameraAt(path, static_cast<double>(frame) / (kFrames - 1));
            EXPECT_NEAR(camera.nearM, 0.05F, 1e-6F);
            EXPECT_GT(camera.position.y, 1.1F);
            EXPECT_LT(camera.position.y, 1.8F);
            for (int k = 0; k < kDirections; ++k) {
                const float y = 1.0F - 2.0F * (static_cast<float>(k) + 0.5F) / kDirections;
                const float angleRad = 2.3999632F * static_cast<float>(k);
                const float across = std::sqrt(1.0F - y * y);
                const auto hit = tracer_->closestHit(
                    camera.position, {across * std::cos(angleRad), y, across * std::sin(angleRad)});
                if (hit) nearestM = std::min(nearestM, hit->distance);
            }
        }
        // Objects that swing come up to 0.16 m nearer.
        EXPECT_GT(nearestM, 0.2F) << path.name;
    }
}

TEST_F(LivingRoom, CamerasSeeTheirSubjects) {
    const auto seenFrom = [&](const scene::Camera& camera, const char* name) {
        for (std::size_t i = 0; i < scene_->instances.size(); ++i) {
            const scene::Mesh& mesh = meshOf(static_cast<unsigned>(i));
            if (mesh.name != name) continue;
            for (std::size_t v = 0; v < mesh.positions.size(); v += 7) {
                const glm::vec3 toVertex = mesh.positions[v] - camera.position;
                const glm::vec3 forward = glm::normalize(camera.target - camera.position);
                const float cosine = glm::dot(glm::normalize(toVertex), forward);
                if (cosine < std::cos(0.5F * camera.verticalFovRad)) continue;
                const auto hit = tracer_->closestHit(camera.position, toVertex);
                if (hit && hit->instance == i) return true;
            }
        }
        return false;
    };
    ASSERT_EQ(scene_->cameras.size(), 2U);
    EXPECT_EQ(scene_->cameras[0].name, "overview");
    for (const char* name : {"floor", "coffee_table_top", "vase", "teapot", "arc_lamp_dish"}) {
        EXPECT_TRUE(seenFrom(scene_->cameras[0], name)) << name;
    }
    EXPECT_EQ(scene_->cameras[1].name, "vase");
    EXPECT_TRUE(seenFrom(scene_->cameras[1], "vase"));
}

// The claims of [xie2017] Fig. 11–12 about who hides whom, by rays.

struct FourObjects : testing::Test {
    FourObjects() {
        Params params({}, "generator 'four_objects'");
        scene_ = scene::fourObjects(params, 1);
        tracer_.emplace(scene_);
        // The lower corners of an upright equilateral triangle around the camera.
        const scene::Camera& camera = scene_.cameras.at(0);
        const glm::vec3 forward = glm::normalize(camera.target - camera.position);
        const glm::vec3 right = glm::normalize(glm::cross(forward, camera.up));
        const glm::vec3 up = glm::cross(right, forward);
        const float sideM = 0.5F * glm::length(scene_.bounds().size());  // the baseline
        middle_ = camera.position - up * (sideM * std::sqrt(3.0F) / 6.0F);
        left_ = middle_ - right * (0.5F * sideM);
        right_ = middle_ + right * (0.5F * sideM);
    }

    /// The names of what is drawn along the ray, nearest first, back faces culled.
    std::string objectsAlong(const glm::vec3& eye, const glm::vec3& direction) const {
        std::string names;
        float after = 0.0F;
        while (const auto hit = tracer_->closestHit(eye, direction, after)) {
            if (glm::dot(hit->geometricNormal, direction) < 0.0F) names += "ABCD"[hit->instance];
            // Boxes are centimetres apart and thick, so that nothing is stepped over; and neither
            // triangle at a diagonal is met twice.
            after = hit->distance + 1e-3F;
        }
        return names;
    }

    /// Points inside of C's faces: all six, or the front alone.
    std::vector<glm::vec3> samplesOfC(bool isFrontOnly) const {
        constexpr int kSamples = 25;
        const scene::Box box = scene_.meshes.at(2).bounds();
        std::vector<glm::vec3> samples;
        for (int axis = isFrontOnly ? 2 : 0; axis < 3; ++axis) {
            for (const float side : {1.0F, 0.0F}) {
                if (isFrontOnly && side == 0.0F) continue;
                for (const auto [i, j] : test::grid(kSamples, kSamples)) {
                    glm::vec3 share(side);
                    share[(axis + 1) % 3] = (static_cast<float>(i) + 0.37F) / kSamples;
                    share[(axis + 2) % 3] = (static_cast<float>(j) + 0.41F) / kSamples;
                    samples.push_back(box.min + box.size() * share);
                }
            }
        }
        return samples;
    }

    bool isVisible(const glm::vec3& point, const glm::vec3& eye) const {
        const float distance = glm::length(point - eye);
        // Short of the point by 1 mm: it lies on its own surface.
        return !tracer_->isOccluded(eye, point - eye, 0.0F, distance - 1e-3F);
    }

    scene::Scene scene_;
    std::optional<RayTracer> tracer_;
    glm::vec3 left_{0.0F}, right_{0.0F}, middle_{0.0F};  // V₀, V₁ and between them
};

TEST_F(FourObjects, HasFourClosedBoxes) {
    ASSERT_EQ(scene_.meshes.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(scene_.meshes[i].name, std::string(1, "ABCD"[i]));
        EXPECT_EQ(scene_.meshes[i].triangles.size(), 12U);
    }
}

TEST_F(FourObjects, NeitherReferenceViewSeesCButTheMiddleDoes) {
    for (const glm::vec3& point : samplesOfC(false)) {
        EXPECT_FALSE(isVisible(point, left_));
        EXPECT_FALSE(isVisible(point, right_));
    }
    int visible = 0;
    const auto front = samplesOfC(true);
    for (const glm::vec3& point : front) visible += isVisible(point, middle_);
    EXPECT_EQ(visible, static_cast<int>(front.size()));
}

TEST_F(FourObjects, CIsThirdFromTheLeftAndSecondFromTheRight) {
    for (const glm::vec3& point : samplesOfC(true)) {
        EXPECT_EQ(objectsAlong(left_, point - left_), "ABC");
        EXPECT_EQ(objectsAlong(right_, point - right_), "DC");
    }
}

TEST_F(FourObjects, WhatHidesCFromTheRightIsSeenFromTheLeft) {
    // So that a non-redundant image at V₁ looks through it.
    for (const glm::vec3& point : samplesOfC(false)) {
        const auto hit = tracer_->closestHit(right_, point - right_);
        ASSERT_TRUE(hit);
        EXPECT_TRUE(isVisible(hit->position, left_));
        EXPECT_EQ(hit->geometricNormal, glm::vec3(0, 0, 1));
    }
}

TEST_F(FourObjects, LayersFromTheLeft) {
    std::set<char> layers[3];
    std::set<char> firstFromTheRight;
    constexpr int kAcross = 600;
    for (const auto [j, i] : test::grid(kAcross / 4, kAcross)) {
        // Points of a plane behind the objects that covers them from both eyes.
        const glm::vec3 point(40.0F * (static_cast<float>(i) + 0.5F) / kAcross - 20.0F,
                              16.0F * (static_cast<float>(j) + 0.5F) / (kAcross / 4) - 3.0F,
                              -25.0F);
        const std::string names = objectsAlong(left_, point - left_);
        ASSERT_LE(names.size(), 3U);
        for (std::size_t k = 0; k < names.size(); ++k) layers[k].insert(names[k]);
        const std::string fromRight = objectsAlong(right_, point - right_);
        if (!fromRight.empty()) firstFromTheRight.insert(fromRight[0]);
    }
    EXPECT_EQ(layers[0], (std::set<char>{'A', 'D'}));
    EXPECT_EQ(layers[1], (std::set<char>{'B'}));
    EXPECT_EQ(layers[2], (std::set<char>{'C'}));
    EXPECT_EQ(firstFromTheRight, (std::set<char>{'A', 'B', 'D'}));
}

// Generated scenes are seen from outside: back-face culling must not open them.

class OutdoorWinding : public testing::TestWithParam<const char*> {};

TEST_P(OutdoorWinding, AlmostNoRayMeetsABackFaceFirst) {
    Params params({}, "generator");
    const scene::Scene scene =
        scene::findGenerator(scene::registeredGenerators(), GetParam(), {}).generate(params, 1);
    const RayTracer tracer(scene);
    const glm::vec3 target = scene.cameras.at(0).target;
    int hits = 0;
    int backFaces = 0;
    bool isAnyDoubleSided = false;
    constexpr int kAcross = 250;
    // From the camera and from around the scene at its height.
    for (int turn = 0; turn < 4; ++turn) {
        const glm::vec3 offset = scene.cameras[0].position - target;
        const glm::vec3 turned = turn == 0   ? offset
                                 : turn == 1 ? glm::vec3(offset.z, offset.y, -offset.x)
                                 : turn == 2 ? glm::vec3(-offset.x, offset.y, -offset.z)
                                             : glm::vec3(-offset.z, offset.y, offset.x);
        const glm::vec3 forward = -glm::normalize(turned);
        const glm::vec3 right = glm::normalize(glm::cross(forward, glm::vec3(0, 1, 0)));
        const glm::vec3 up = glm::cross(right, forward);
        const float slope = 2.0F * std::tan(0.5F * scene.cameras[0].verticalFovRad) / kAcross;
        for (const auto [j, i] : test::grid(kAcross, kAcross)) {
            const glm::vec3 direction =
                forward + slope * (static_cast<float>(i - kAcross / 2) * right +
                                   static_cast<float>(j - kAcross / 2) * up);
            const auto hit = tracer.closestHit(target + turned, direction);
            if (!hit) continue;
            ++hits;
            // Of a sheet with two sides either may be reported: what counts is what is drawn.
            const auto drawn = tracer.closestHit(target + turned, direction, 0.0F,
                                                 hit->distance * (1.0F + 1e-5F), Faces::Drawn);
            backFaces += !drawn.has_value();
            isAnyDoubleSided |= tracer.triangle(hit->flattenedTriangle).isDoubleSided;
        }
    }
    EXPECT_GT(hits, kAcross * kAcross / 10);
    // Open ends of poles and twigs.
    EXPECT_LE(backFaces, hits / 1000);
    EXPECT_FALSE(isAnyDoubleSided);
    RecordProperty("back_faces", backFaces);
}

INSTANTIATE_TEST_SUITE_P(All, OutdoorWinding,
                         testing::Values("bird_nest", "city", "grass", "tree", "four_objects"));

}  // namespace
}  // namespace gfxrepro::raycast
