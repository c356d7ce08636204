// What the living room's reflection experiments rely on: how much of the pictures along its paths
// reflects, and that the paths are free.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/raycast/ray_tracer.h"
#include "engine/scene/animation.h"
#include "scenes/registry.h"

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
        for (int y = 0; y < kSizePx; ++y) {
            for (int x = 0; x < kSizePx; ++x) {
                const float sx = slope * (static_cast<float>(2 * x + 1) / kSizePx - 1.0F);
                const float sy = slope * (static_cast<float>(2 * y + 1) / kSizePx - 1.0F);
                const auto hit =
                    tracer_->closestHit(camera.position, forward + sx * right + sy * up);
                EXPECT_TRUE(hit.has_value()) << "the room has a hole";
                if (!hit || !reflects(meshOf(hit->instance))) continue;
                ++reflective;
                planar += isPlanar(meshOf(hit->instance));
            }
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

}  // namespace
}  // namespace gfxrepro::raycast
