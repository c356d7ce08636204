// Shadow rays and the classes of errors, under a square plate whose shadow is known.
#include "techniques/shadow_mapping/shadow_truth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scenes/shared/mesh_builder.h"

namespace gfxrepro::shadow_mapping {
namespace {

constexpr int kSizePx = 96;
constexpr float kLightHeight = 3.0F;
constexpr float kPlateHeight = 1.0F;
constexpr float kHalfPlate = 0.5F;
// Under a point light the shadow of the plate is larger by the ratio of the distances.
constexpr float kHalfShadow = kHalfPlate * kLightHeight / (kLightHeight - kPlateHeight);

/// A square plate, seen from both sides, over a floor that faces up.
scene::Scene tracedPlateOverFloor() {
    scene::MeshBuilder builder;
    builder.addQuad({-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {-4, 0, -4});
    builder.addQuad({-kHalfPlate, kPlateHeight, kHalfPlate}, {kHalfPlate, kPlateHeight, kHalfPlate},
                    {kHalfPlate, kPlateHeight, -kHalfPlate},
                    {-kHalfPlate, kPlateHeight, -kHalfPlate});
    return scene::sceneOf(builder.take("test", -1));
}

struct ShadowTruthTest : testing::Test {
    ShadowTruthTest() {
        scene::Camera camera;
        camera.position = {0.0F, 0.45F, 3.5F};  // below the plate: sees all of its shadow
        camera.target = {0.0F, 0.0F, 0.0F};
        camera.verticalFovRad = 0.9F;
        points_ = visiblePoints(tracer_, kit::viewOf(camera, glm::ivec2(kSizePx)));
    }

    /// Above the middle of the plate, 64 texels across a right angle.
    static TruthLight pointLight() {
        return TruthLight{.position = {0.0F, kLightHeight, 0.0F},
                          .texel = 2.0F / 64.0F,
                          .forward = {0.0F, -1.0F, 0.0F}};
    }

    static TruthLight sun() { return TruthLight{.isDirectional = true, .texel = 0.1F}; }

    static bool isFloor(const VisiblePoint& point) {
        return point.isSurface() && point.position.y < 0.5F;
    }

    /// Distance inwards from the border of a centred square shadow; negative outside.
    static float depthInShadow(const VisiblePoint& point, float half) {
        return half - std::max(std::abs(point.position.x), std::abs(point.position.z));
    }

    /// The reach is across the ray: a slanted ray spreads it over more of the floor.
    static float reachOnFloor(const VisiblePoint& point, float reach) {
        return reach / pointLight().directionFrom(point.position).y;
    }

    std::vector<float> terms(float value) const { return std::vector(points_.size(), value); }

    scene::Scene scene_ = tracedPlateOverFloor();
    raycast::RayTracer tracer_{scene_};
    ShadowTruth truth_{tracer_, glm::length(scene_.bounds().size())};
    std::vector<VisiblePoint> points_;
};

TEST_F(ShadowTruthTest, ShadowOfAPlateIsASquare) {
    int shadowed = 0;
    for (const VisiblePoint& point : points_) {
        if (!isFloor(point)) continue;
        const float depth = depthInShadow(point, kHalfShadow);
        if (std::abs(depth) < 1e-4F) continue;  // rounding decides
        ASSERT_EQ(truth_.isLit(point, pointLight()), depth < 0.0F) << point.position.x;
        shadowed += depth > 0.0F;
    }
    EXPECT_GT(shadowed, 100);  // enough to mean something
}

TEST_F(ShadowTruthTest, ShadowUnderADirectionalLightIsAsLargeAsThePlate) {
    for (const VisiblePoint& point : points_) {
        if (!isFloor(point)) continue;
        const float depth = depthInShadow(point, kHalfPlate);
        if (std::abs(depth) < 1e-4F) continue;
        ASSERT_EQ(truth_.isLit(point, sun()), depth < 0.0F);
    }
}

TEST_F(ShadowTruthTest, TrueAnswersAreNoErrors) {
    std::vector<float> answers;
    for (const VisiblePoint& point : points_) {
        answers.push_back(point.isSurface() && truth_.isLit(point, pointLight()) ? 1.0F : 0.0F);
    }
    const ShadowErrors errors = truth_.compare(points_, pointLight(), answers, 1.5F);
    EXPECT_EQ(errors.wrong(), 0U);
    EXPECT_GT(errors.compared, 1000U);
}

TEST_F(ShadowTruthTest, LeaksLieDeepInTheShadowAndEdgesAtItsBorder) {
    constexpr float kTexels = 2.0F;
    const float reach = kTexels * pointLight().texel * kLightHeight;  // on the floor
    const ShadowErrors errors = truth_.compare(points_, pointLight(), terms(1.0F), kTexels);
    EXPECT_EQ(errors.acne, 0U);
    EXPECT_GT(errors.leak, 50U);
    EXPECT_GT(errors.edge, 50U);
    for (std::size_t i = 0; i < points_.size(); ++i) {
        if (!isFloor(points_[i])) continue;
        const float depth = depthInShadow(points_[i], kHalfShadow);
        if (depth < -1e-4F) {
            EXPECT_EQ(errors.classes[i], PixelClass::Lit);
        }
        // 16 directions reach 98 % of the distance.
        if (depth > 1e-4F && depth < 0.97F * reach) {
            EXPECT_EQ(errors.classes[i], PixelClass::Edge) << depth;
        }
        if (depth > 1.001F * reachOnFloor(points_[i], reach)) {
            EXPECT_EQ(errors.classes[i], PixelClass::Leak) << depth;
        }
    }
}

TEST_F(ShadowTruthTest, AcneLiesOnLitSurfacesAwayFromEdges) {
    constexpr float kTexels = 2.0F;
    const float reach = kTexels * pointLight().texel * kLightHeight;
    const ShadowErrors errors = truth_.compare(points_, pointLight(), terms(0.0F), kTexels);
    EXPECT_EQ(errors.leak, 0U);
    for (std::size_t i = 0; i < points_.size(); ++i) {
        if (!isFloor(points_[i])) continue;
        const float depth = depthInShadow(points_[i], kHalfShadow);
        if (depth > 1e-4F) {
            EXPECT_EQ(errors.classes[i], PixelClass::Shadowed);
        }
        if (depth < -1.001F * reachOnFloor(points_[i], reach)) {
            EXPECT_EQ(errors.classes[i], PixelClass::Acne) << depth;
        }
    }
}

TEST_F(ShadowTruthTest, SurfacesTurnedAwayAreNotCompared) {
    TruthLight below = sun();
    below.toLight = {0.0F, -1.0F, 0.0F};
    const ShadowErrors errors = truth_.compare(points_, below, terms(0.0F), 1.0F);
    for (std::size_t i = 0; i < points_.size(); ++i) {
        if (isFloor(points_[i])) {
            EXPECT_EQ(errors.classes[i], PixelClass::NotCompared);
        }
    }
}

TEST_F(ShadowTruthTest, HalfATermIsLit) {
    const ShadowErrors errors = truth_.compare(points_, sun(), terms(0.5F), 1.0F);
    EXPECT_EQ(errors.acne, 0U);
    EXPECT_GT(errors.leak, 0U);
}

TEST(TruthLight, TexelsGrowWithTheDistanceAlongTheAxis) {
    TruthLight light{.texel = 0.01F, .forward = {0.0F, 0.0F, -1.0F}};
    EXPECT_FLOAT_EQ(light.texelWidthAt({3.0F, 0.0F, -5.0F}), 0.05F);
    light.forward = glm::vec3(0.0F);  // a cube: the side that the point lies on
    EXPECT_FLOAT_EQ(light.texelWidthAt({7.0F, 0.0F, -5.0F}), 0.07F);
    light.isDirectional = true;
    EXPECT_FLOAT_EQ(light.texelWidthAt({7.0F, 0.0F, -5.0F}), 0.01F);
}

TEST_F(ShadowTruthTest, PictureHasAColourForEachClass) {
    const ShadowErrors errors{.classes = {PixelClass::Acne, PixelClass::Leak}};
    const image::ImageF picture = classPicture(errors, {1, 2});  // rows from the bottom
    EXPECT_GT(picture.at(0, 1, 0), picture.at(0, 1, 1));
    EXPECT_GT(picture.at(0, 0, 1), picture.at(0, 0, 0));
}

}  // namespace
}  // namespace gfxrepro::shadow_mapping
