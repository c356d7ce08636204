// Generated scenes are seen from outside: back-face culling must not open them.

#include <gtest/gtest.h>

#include <cmath>

#include "engine/raycast/ray_tracer.h"
#include "scenes/registry.h"

namespace gfxrepro::raycast {
namespace {

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
        for (int j = 0; j < kAcross; ++j) {
            for (int i = 0; i < kAcross; ++i) {
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
