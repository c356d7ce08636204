#include "techniques/point_splatting/point_model.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <set>

#include "tests/support/support.h"
#include "tests/techniques/point_splatting/point_clouds.h"

namespace gfxrepro::point_splatting {
namespace {

scene::PointCloud plane(int side) {
    scene::PointCloud points;
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) points.positions.emplace_back(x, 0, y);
    }
    points.normals.assign(points.positions.size(), {0, 1, 0});
    points.radii.assign(points.positions.size(), 0.75F);
    return points;
}

auto key(const glm::vec3& p) {
    return std::tuple(p.x, p.y, p.z);
}

TEST(LinearTree, HoldsEveryPointOnce) {
    const scene::PointCloud points = sphere(20000);
    const PointModel model = buildModel(points, {});
    std::multiset<std::tuple<float, float, float>> in, out;
    for (const glm::vec3& p : points.positions) in.insert(key(p));
    for (const glm::vec3& p : model.positions) out.insert(key(p));
    EXPECT_EQ(in, out);
    EXPECT_EQ(model.normals, model.positions);  // attributes move with their points
    std::uint32_t next = 0;
    for (const Patch& patch : model.patches) {
        EXPECT_EQ(patch.firstPoint, next);
        next += patch.pointCount;
        EXPECT_LE(patch.pointCount, TreeSettings{}.maxPatchPoints);
        const Level& last = model.levels[patch.firstLevel + patch.levelCount - 1];
        EXPECT_EQ(last.count, patch.pointCount);
        EXPECT_EQ(last.radiusScale, 1.0F);
    }
    EXPECT_EQ(next, 20000U);
}

TEST(LinearTree, BoxesAndConesHoldTheirPoints) {
    const PointModel model = buildModel(sphere(20000), {});
    for (const Patch& patch : model.patches) {
        for (std::uint32_t i = patch.firstPoint; i < patch.firstPoint + patch.pointCount; ++i) {
            const glm::vec3& p = model.positions[i];
            EXPECT_TRUE(glm::all(glm::lessThanEqual(patch.bounds.min, p)) &&
                        glm::all(glm::lessThanEqual(p, patch.bounds.max)));
            // acos of a rounded cosine near 1 is off by 5e-4 at most.
            EXPECT_LE(std::acos(std::min(glm::dot(patch.meanNormal, model.normals[i]), 1.0F)),
                      patch.coneRad + 1e-3F);
        }
    }
}

TEST(LinearTree, LevelsDoubleAndCover) {
    const PointModel model = buildModel(plane(60), {4000, 256, 0.35F});
    ASSERT_EQ(model.patches.size(), 1U);  // flat: the cone is no reason to cut
    const Patch& patch = model.patches[0];
    EXPECT_LT(patch.curvature, 1e-6F);
    EXPECT_LT(patch.coneRad, 1e-3F);
    for (std::uint32_t l = 0; l < patch.levelCount; ++l) {
        const Level& level = model.levels[patch.firstLevel + l];
        if (l + 2 < patch.levelCount) EXPECT_EQ(level.count, (2U << l) - 1) << l;
        // At most one place in twenty is out of reach of the level's discs.
        int uncovered = 0;
        for (const glm::vec3& place : model.positions) {
            float nearest = 1e9F;
            for (std::uint32_t k = 0; k < level.count; ++k) {
                nearest = std::min(nearest, glm::distance(place, model.positions[k]));
            }
            uncovered += nearest > level.maxRadius;
        }
        EXPECT_LE(uncovered, 3600 / 20) << l;
    }
}

TEST(LinearTree, CutsCurvedPartsIntoMorePatches) {
    scene::PointCloud flat = plane(100);
    const std::size_t flatPatches = buildModel(flat, {}).patches.size();
    const std::size_t curvedPatches = buildModel(sphere(10000), {}).patches.size();
    EXPECT_GE(curvedPatches, 3 * flatPatches);
}

TEST(LinearTree, TheSamePointsGiveTheSameModel) {
    const scene::PointCloud points = sphere(60000);
    const PointModel a = buildModel(points, {}), b = buildModel(points, {});
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.levels.size(), b.levels.size());
}

TEST(LinearTree, TakesOnePointEqualPointsAndRefusesNone) {
    scene::PointCloud one;
    one.positions = {{1, 2, 3}};
    one.normals = {{0, 1, 0}};
    one.radii = {0.5F};
    const PointModel model = buildModel(one, {});
    ASSERT_EQ(model.patches.size(), 1U);
    EXPECT_EQ(model.levels.at(0).maxRadius, 0.5F);

    scene::PointCloud equal;
    equal.positions.assign(1000, {1, 2, 3});
    equal.normals.assign(1000, {0, 1, 0});
    equal.radii.assign(1000, 0.5F);
    EXPECT_EQ(buildModel(equal, {}).positions.size(), 1000U);
    EXPECT_EQ(errorText([] { buildModel({}, {}); }), "a point model of no points");
}

TEST(LinearTree, OppositeNormalsGiveAConeOfAnyDirection) {
    scene::PointCloud points = plane(10);
    for (std::size_t i = 0; i < 100; i += 2) points.normals[i] = {0, -1, 0};
    const PointModel model = buildModel(points, {});
    EXPECT_FLOAT_EQ(model.patches.at(0).coneRad, glm::pi<float>());
}

}  // namespace
}  // namespace gfxrepro::point_splatting
