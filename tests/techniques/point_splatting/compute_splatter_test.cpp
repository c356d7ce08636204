// The compute splatter against the same two traversals on the host.
#include <algorithm>

#include "techniques/point_splatting/yardsticks.h"

#include "tests/techniques/point_splatting/splat_fixture.h"

namespace gfxrepro::point_splatting {
namespace {

constexpr glm::ivec2 kTargetSize(48, 40);
constexpr float kDistance = 4.0F;

/// Points that fall safely into a pixel, several of them into most, at depths that are clearly
/// within the tolerance of each other or clearly not.
scene::PointCloud pointsInPixels(const PatchView& view) {
    Random random(17);
    scene::PointCloud points;
    for (int i = 0; i < 6000; ++i) {
        const glm::vec2 pixel{random.index(static_cast<std::uint32_t>(kTargetSize.x)) + 0.5F,
                              random.index(static_cast<std::uint32_t>(kTargetSize.y)) + 0.5F};
        const glm::vec2 at = pixel + glm::vec2(random.uniform(-0.4F, 0.4F));
        const float layer = 3.0F + 0.5F * static_cast<float>(random.index(4));
        const float depth = layer + random.uniform(0.0F, 0.02F);
        const glm::vec2 slope = (at - 0.5F * glm::vec2(kTargetSize)) / view.focalPx;
        points.positions.emplace_back(slope * depth, kDistance - depth);
        points.normals.push_back(
            glm::normalize(glm::vec3{random.uniform(-1, 1), random.uniform(-1, 1), 2.0F}));
        points.radii.push_back(0.01F);
        const std::uint32_t step = random.index(3);
        points.colors.emplace_back(step == 0 ? 1.0F : 0.0F, step == 1 ? 1.0F : 0.0F, 0.5F);
    }
    return points;
}

TEST_F(SplatTest, ComputeSplatterAveragesWhatIsNearest) {
    const PatchView view = viewFrom(kDistance, kTargetSize);
    const ModelFile model = modelOf(pointsInPixels(view));
    ComputeSplatter splatter(shaders, model, PointStorage::Uncompressed, kTargetSize);
    gl::Profiler profiler(true);
    // Twice: nothing of the first frame may be left.
    for (int frame = 0; frame < 2; ++frame) {
        splatter.render(everything(model, SplatMode::FullEwa), view, profiler);
    }
    const Picture picture = pictureOf(splatter.output());

    const auto count = static_cast<std::size_t>(kTargetSize.x * kTargetSize.y);
    const auto depthOf = [&](std::size_t i) {
        return static_cast<double>(kDistance - model.positions()[i].z);
    };
    const auto pixelOf = [&](std::size_t i) {
        const glm::dvec2 slope = glm::dvec2(model.positions()[i]) / depthOf(i);
        const glm::ivec2 at(slope * static_cast<double>(view.focalPx) +
                            0.5 * glm::dvec2(kTargetSize));
        return static_cast<std::size_t>(at.y * kTargetSize.x + at.x);
    };
    std::vector<double> nearest(count, 1e9);
    std::vector<glm::dvec3> normals(count, glm::dvec3(0.0)), colors(count, glm::dvec3(0.0));
    std::vector<int> counts(count, 0);
    for (std::size_t i = 0; i < model.positions().size(); ++i) {
        nearest[pixelOf(i)] = std::min(nearest[pixelOf(i)], depthOf(i));
    }
    int averaged = 0, behind = 0;
    for (std::size_t i = 0; i < model.positions().size(); ++i) {
        const std::size_t pixel = pixelOf(i);
        if (depthOf(i) > 1.01 * nearest[pixel]) {
            ++behind;
            continue;
        }
        normals[pixel] += glm::dvec3(model.normals()[i]);
        const glm::dvec3 srgb = glm::dvec3(model.colors()[i]) / 255.0;
        for (int c = 0; c < 3; ++c) {
            colors[pixel][c] +=
                srgb[c] <= 0.04045 ? srgb[c] / 12.92 : std::pow((srgb[c] + 0.055) / 1.055, 2.4);
        }
        averaged += ++counts[pixel] > 1 ? 1 : 0;
    }
    EXPECT_GT(averaged, 300);
    EXPECT_GT(behind, 1000);
    const glm::dvec3 light = glm::normalize(glm::dvec3(kLightDirectionView));
    for (std::size_t p = 0; p < count; ++p) {
        const glm::ivec4 found(picture.pixels[p]);
        ASSERT_EQ(found.a, counts[p] > 0 ? 255 : 0);
        if (counts[p] == 0) continue;
        const int x = static_cast<int>(p) % kTargetSize.x, y = static_cast<int>(p) / kTargetSize.x;
        const glm::dvec2 slope = (glm::dvec2(x + 0.5, y + 0.5) - 0.5 * glm::dvec2(kTargetSize)) /
                                 static_cast<double>(view.focalPx);
        const glm::dvec3 expected = glm::min(
            shadedReference(colors[p] / static_cast<double>(counts[p]), glm::normalize(normals[p]),
                            glm::normalize(glm::dvec3(-slope, 1.0)), light),
            glm::dvec3(255.0));
        // A step of 255, half a step of rounding: sums err by half of 1/512 a point.
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(found[c], expected[c], 1.5) << x << ", " << y;
    }
}

TEST_F(SplatTest, ComputeSplatterLeavesOutWhatIsNotSeen) {
    scene::PointCloud points = sphere(300);
    for (glm::vec3& p : points.positions) p = 0.05F * p + glm::vec3(0.0F, 0.0F, 5.0F);
    const PatchView view = viewFrom(kDistance, kTargetSize);  // looks away from them
    const ModelFile model = modelOf(points);
    ComputeSplatter splatter(shaders, model, PointStorage::Compressed, kTargetSize);
    gl::Profiler profiler(true);
    splatter.render(everything(model, SplatMode::FullEwa), view, profiler);
    for (const glm::u8vec4& pixel : pictureOf(splatter.output()).pixels) ASSERT_EQ(pixel.a, 0);
    splatter.render({}, view, profiler);
    EXPECT_EQ(splatter.pointBytes(), 8U * 300 + 4 * model.radiusTable().size());
}

}  // namespace
}  // namespace gfxrepro::point_splatting
