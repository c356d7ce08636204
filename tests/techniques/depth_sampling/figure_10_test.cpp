// [xie2017] Fig. 10: where a sample s₁ of I₁ lands on I₀, and by which definition it is redundant.

#include "engine/core/files.h"
#include "engine/raycast/ray_tracer.h"
#include "techniques/depth_sampling/pixel_measures.h"
#include "techniques/depth_sampling/visibility.h"
#include "tests/gl/gl_fixture.h"
#include "tests/techniques/depth_sampling/host_images.h"
#include "tests/techniques/kit/write_depth_image.h"

namespace gfxrepro::depth_sampling {
namespace {

using kit::DepthImage;
using kit::HostDepthImage;
using kit::View;

constexpr float kEyeZ = 8.0F;
constexpr float kOccluderZ = 1.0F;
enum TriangleId : std::uint32_t { T0 = 1, T1 = 2, T2 = 3 };

struct Figure10Test : test::GlTest {
    /// The point of height z that lands on I₀ at these pixel coordinates.
    static glm::vec3 landingAt(glm::vec2 px, float z) {
        const float halfWidthPx = 4.0F;
        const float widthAtEyeDistance = std::tan(glm::radians(22.5F)) / halfWidthPx;
        return {(px - halfWidthPx) * widthAtEyeDistance * (kEyeZ - z), z};
    }

    /// T₀ left and T₁ right of x = 4.3 px, T₂ before T₁ from x = 6.7 px on.
    static std::vector<test::Triangle> triangles() {
        const auto blue = [](glm::vec2 px) { return landingAt(px, 0.0F); };
        const auto red = [](glm::vec2 px) { return landingAt(px, kOccluderZ); };
        return {{blue({4.3F, -20.0F}), blue({4.3F, 28.0F}), blue({-60.0F, 4.0F})},
                {blue({4.3F, 28.0F}), blue({4.3F, -20.0F}), blue({60.0F, 4.0F})},
                {red({6.7F, 8.0F}), red({6.7F, 0.0F}), red({9.0F, 4.0F})}};
    }
    static scene::Scene scene() {
        scene::Scene scene;
        scene.materials.resize(1);
        scene.meshes.resize(1);
        for (const test::Triangle& corners : triangles()) {
            scene::Mesh& mesh = scene.meshes[0];
            const auto first = static_cast<unsigned>(mesh.positions.size());
            mesh.positions.insert(mesh.positions.end(), corners.begin(), corners.end());
            mesh.triangles.emplace_back(first, first + 1, first + 2);
        }
        scene.instances = {{0}};
        return scene;
    }

    /// I₁ has one pixel, whose centre shows what lands on I₀ at `px`: a point of `triangle`, seen
    /// from the left, so that nothing hides it.
    static HostDepthImage imageOf(TriangleId triangle, glm::vec2 px) {
        const glm::vec3 point = landingAt(px, triangle == T2 ? kOccluderZ : 0.0F);
        HostDepthImage image =
            test::castImage(test::viewFrom({-6.0F, 0.0F, 4.0F}, {1, 1}, point), triangles());
        EXPECT_EQ(image.triangleId[0], triangle);
        EXPECT_LT(glm::distance(image.pointWorld({0, 0}), point), 1e-4F);
        return image;
    }

    bool isPixelRedundant(const HostDepthImage& s1) {
        DepthImage here(s1.view, kit::DepthFormat::Float32);
        DepthImage there(i0.view, kit::DepthFormat::Float32);
        kit::writeDepthImage(s1, here);
        kit::writeDepthImage(i0, there);
        gl::Texture marks = measures.makeMarks(here);
        const DepthImage* const earlier[] = {&there};
        measures.mark(here, marks, earlier, true, kSample, kRedundant);
        return measures.count(marks, kRedundant) == 1;
    }
    bool isVisibilityRedundant(const HostDepthImage& s1) const {
        return sequence.holds(0, {s1.pointWorld({0, 0}), s1.triangleId[0]});
    }

    gl::ShaderLibrary programShaders{dataFolder("shaders")};
    PixelMeasures measures{programShaders};
    HostDepthImage i0 = test::castImage(test::viewFrom({0.0F, 0.0F, kEyeZ}, {8, 8}), triangles());
    raycast::RayTracer tracer{scene()};
    VisibilitySequence sequence{tracer, {i0.view}, false};
};

TEST_F(Figure10Test, AOnThePixelsCentreIsTheSameSample) {
    const HostDepthImage s1 = imageOf(T0, {2.5F, 2.5F});
    EXPECT_LT(glm::distance(i0.pointWorld({2, 2}), s1.pointWorld({0, 0})), 1e-4F);
    EXPECT_TRUE(isVisibilityRedundant(s1));
    EXPECT_TRUE(isPixelRedundant(s1));
}

TEST_F(Figure10Test, BBesideTheCentreOnTheSameTriangleIsRedundantByBoth) {
    const HostDepthImage s1 = imageOf(T0, {2.8F, 2.3F});
    EXPECT_TRUE(isVisibilityRedundant(s1));
    EXPECT_TRUE(isPixelRedundant(s1));
}

TEST_F(Figure10Test, CInAPixelOfTheNextTriangleIsVisibleOnly) {
    const HostDepthImage s1 = imageOf(T0, {4.1F, 2.3F});
    EXPECT_EQ(i0.triangleId[i0.indexOf({4, 2})], T1);
    EXPECT_TRUE(isVisibilityRedundant(s1));
    EXPECT_FALSE(isPixelRedundant(s1));
}

TEST_F(Figure10Test, DBehindTheOccluderInAPixelOfItsOwnTriangleIsPixelRedundantOnly) {
    const HostDepthImage s1 = imageOf(T1, {6.85F, 4.5F});
    EXPECT_EQ(i0.triangleId[i0.indexOf({6, 4})], T1);
    EXPECT_FALSE(isVisibilityRedundant(s1));
    EXPECT_TRUE(isPixelRedundant(s1));
}

TEST_F(Figure10Test, EBehindTheOccluderInItsPixelIsRedundantByNeither) {
    const HostDepthImage s1 = imageOf(T1, {7.5F, 4.5F});
    EXPECT_EQ(i0.triangleId[i0.indexOf({7, 4})], T2);
    EXPECT_FALSE(isVisibilityRedundant(s1));
    EXPECT_FALSE(isPixelRedundant(s1));
}

TEST_F(Figure10Test, FOnTheOccluderInAPixelOfWhatItHidesIsVisibleOnly) {
    const HostDepthImage s1 = imageOf(T2, {6.8F, 4.5F});
    EXPECT_EQ(i0.triangleId[i0.indexOf({6, 4})], T1);
    EXPECT_TRUE(isVisibilityRedundant(s1));
    EXPECT_FALSE(isPixelRedundant(s1));
}

}  // namespace
}  // namespace gfxrepro::depth_sampling
