// The published picture of the Cornell box, by rays.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "engine/raycast/ray_tracer.h"
#include "tests/scenes/generated_scene.h"

namespace gfxrepro::raycast {
namespace {

class CornellBox : public testing::Test {
  protected:
    const scene::Scene scene_ = scene::generated("cornell_box", "{}");
    const RayTracer tracer_{scene_};
    const scene::Camera camera_ = scene_.cameras.at(0);

    /// What is seen at a place of the square picture: from −1 to 1, to the right and upwards.
    std::string seenAt(float right, float up) const {
        const float slope = std::tan(0.5F * camera_.verticalFovRad);
        // The camera looks along +z with +y up: right is −x.
        const glm::vec3 direction(-slope * right, slope * up, 1.0F);
        const auto hit = tracer_.closestHit(camera_.position, direction);
        if (!hit) return "nothing";
        if (glm::dot(hit->geometricNormal, direction) >= 0.0F) return "a back";
        const auto instance = static_cast<std::size_t>(hit->instance);
        return scene_.meshes[static_cast<std::size_t>(scene_.instances[instance].mesh)].name;
    }
};

TEST_F(CornellBox, ShowsWhatThePublishedPictureShows) {
    EXPECT_EQ(scene_.triangleCount(), 32U);
    EXPECT_EQ(seenAt(-0.9F, 0.0F), "left_wall");
    EXPECT_EQ(seenAt(0.9F, 0.0F), "right_wall");
    EXPECT_EQ(seenAt(0.0F, 0.9F), "ceiling");
    EXPECT_EQ(seenAt(0.0F, 0.72F), "light");
    EXPECT_EQ(seenAt(0.0F, -0.9F), "floor");
    EXPECT_EQ(seenAt(0.4F, -0.5F), "short_block");
    EXPECT_EQ(seenAt(-0.3F, -0.2F), "tall_block");
    EXPECT_EQ(seenAt(0.1F, 0.3F), "back_wall");
    const auto colorOf = [&](std::size_t mesh) {
        return scene::materialOf(scene_, scene_.meshes.at(mesh)).baseColor;
    };
    EXPECT_GT(colorOf(4).r, 5.0F * colorOf(4).g);  // red is on the left
    EXPECT_GT(colorOf(3).g, 3.0F * colorOf(3).r);
}

TEST_F(CornellBox, FillsThePictureAndFacesTheEye) {
    for (const scene::Mesh& mesh : scene_.meshes) {
        SCOPED_TRACE(mesh.name);
        scene::expectSoundMesh(mesh);
    }
    constexpr int kAcross = 64;
    for (int y = 0; y < kAcross; ++y) {
        for (int x = 0; x < kAcross; ++x) {
            const float right = 1.9F * (static_cast<float>(x) + 0.5F) / kAcross - 0.95F;
            const float up = 1.9F * (static_cast<float>(y) + 0.5F) / kAcross - 0.95F;
            const std::string seen = seenAt(right, up);
            ASSERT_TRUE(seen != "nothing" && seen != "a back") << right << ' ' << up << ' ' << seen;
        }
    }
}

}  // namespace
}  // namespace gfxrepro::raycast
