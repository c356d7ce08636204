#include "techniques/point_splatting/point_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/gtc/constants.hpp>
#include <initializer_list>
#include <set>

#include "engine/core/error.h"
#include "engine/core/random.h"
#include "techniques/point_splatting/point_splatting.h"
#include "tests/support/grid.h"
#include "tests/support/support.h"
#include "tests/techniques/point_splatting/point_clouds.h"

namespace gfxrepro::point_splatting {
namespace {

scene::PointCloud plane(int side) {
    scene::PointCloud points;
    for (const auto [y, x] : test::grid(side, side)) points.positions.emplace_back(x, 0, y);
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
    const scene::PointCloud one{.positions = {{1, 2, 3}}, .normals = {{0, 1, 0}}, .radii = {0.5F}};
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

scene::PointCloud cloud() {
    Random random(8);
    scene::PointCloud points;
    for (int i = 0; i < 3000; ++i) {
        points.positions.push_back({random.uniform(), random.uniform(), random.uniform()});
        points.normals.emplace_back(0, 1, 0);
        points.radii.push_back(random.uniform(0.01F, 0.02F));
        points.colors.emplace_back(1.0F, 0.5F, 0.0F);
    }
    return points;
}

TEST(ModelFile, IsFoundAgainWithTheSameContent) {
    const TemporaryFolder folder;
    const ModelFile built = ModelFile::openOrBuild(folder.path(), cloud(), {});
    EXPECT_TRUE(built.wasBuilt());
    const ModelFile found = ModelFile::openOrBuild(folder.path(), cloud(), {});
    EXPECT_FALSE(found.wasBuilt());
    ASSERT_EQ(found.positions().size(), 3000U);
    EXPECT_TRUE(std::ranges::equal(found.positions(), built.positions()));
    EXPECT_TRUE(std::ranges::equal(found.compressed(), built.compressed()));
    EXPECT_EQ(found.colors()[0], glm::u8vec4(255, 188, 0, 255));
    EXPECT_EQ(found.radiusTable().size(), 256U);
    for (const Patch& patch : found.patches()) {
        for (std::size_t i = patch.firstPoint; i < patch.firstPoint + patch.pointCount; ++i) {
            const glm::vec3 decodedAt =
                decoded(found.compressed()[i], patch.bounds, found.radiusTable()).position;
            EXPECT_LE(glm::distance(decodedAt, found.positions()[i]),
                      glm::length(positionErrorBound(patch.bounds)) * 1.01F);
        }
    }
}

TEST(ModelFile, OtherPointsOrSettingsAreOtherFiles) {
    scene::PointCloud moved = cloud();
    moved.positions[7].x += 1e-6F;
    const TreeSettings settings{.minPatchPoints = 100};
    EXPECT_NE(ModelFile::keyOf(cloud(), {}), ModelFile::keyOf(moved, {}));
    EXPECT_NE(ModelFile::keyOf(cloud(), {}), ModelFile::keyOf(cloud(), settings));
}

TEST(ModelFile, IsBuiltAgainWhereCutOffOrOfAnotherVersion) {
    const TemporaryFolder folder;
    (void)ModelFile::openOrBuild(folder.path(), cloud(), {});
    const auto path = folder.path() / (ModelFile::keyOf(cloud(), {}) + ".points");
    const auto size = fs::file_size(path);
    for (const std::uintmax_t kept : {size - 64, std::uintmax_t{100}, std::uintmax_t{0}}) {
        fs::resize_file(path, kept);
        const ModelFile again = ModelFile::openOrBuild(folder.path(), cloud(), {});
        EXPECT_TRUE(again.wasBuilt()) << kept;
        EXPECT_EQ(fs::file_size(path), size);
    }
    {
        std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(8);  // the version
        file.put('\x7F');
    }
    EXPECT_TRUE(ModelFile::openOrBuild(folder.path(), cloud(), {}).wasBuilt());
    EXPECT_FALSE(ModelFile::openOrBuild(folder.path(), cloud(), {}).wasBuilt());
}

TEST(ModelFile, IsBuiltAgainWhereItsCountsLie) {
    const TemporaryFolder folder;
    const ModelFile first = ModelFile::openOrBuild(folder.path(), cloud(), {});
    const auto path = folder.path() / (ModelFile::keyOf(cloud(), {}) + ".points");
    const std::vector<CompressedPoint> points(first.compressed().begin(), first.compressed().end());
    // Words of the file: what the header says of its sections (offset and size each), and of the
    // first section, the patches, what they say of points and levels.
    constexpr std::streamoff kSections = 88, kFirstPatch = 256;
    struct Lie {
        std::streamoff at;
        std::uint32_t value;
    };
    std::vector<Lie> lies{{kFirstPatch, 7},      {kFirstPatch + 4, 0xFFFFFFFFU},
                          {kFirstPatch + 4, 1},  {kFirstPatch + 8, 0xFFFFFFFFU},
                          {kFirstPatch + 12, 0}, {kFirstPatch + 12, 0xFFFFFFFFU}};
    for (std::streamoff section = 0; section < 8; ++section) {
        lies.push_back({kSections + 16 * section, 0xFFFFFFF8U});  // offset
        lies.push_back({kSections + 16 * section + 8, 0x7FFFFFF8U});
        lies.push_back({kSections + 16 * section + 8, 4});
    }
    for (const Lie& lie : lies) {
        SCOPED_TRACE(testing::Message() << lie.value << " at " << lie.at);
        {
            std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
            file.seekp(lie.at);
            file.write(reinterpret_cast<const char*>(&lie.value), sizeof lie.value);
        }
        const ModelFile again = ModelFile::openOrBuild(folder.path(), cloud(), {});
        EXPECT_TRUE(again.wasBuilt());
        EXPECT_TRUE(std::ranges::equal(again.compressed(), points));
    }
}

TEST(ModelFile, StaysInMemoryWhereItCannotBeWritten) {
    const TemporaryFolder folder;
    const auto file = folder.path() / "a file";
    std::ofstream(file) << "x";
    const ModelFile model = ModelFile::openOrBuild(file / "below", cloud(), {});
    EXPECT_TRUE(model.wasBuilt());
    EXPECT_EQ(model.positions().size(), 3000U);
}

/// Pixels (x, y) with their green.
ModelPicture pictureWith(std::initializer_list<std::array<int, 2>> covered, float green) {
    image::ImageF rgba(8, 4, 4);
    for (const auto& [x, y] : covered) {
        rgba.at(x, y, 1) = green;
        rgba.at(x, y, 3) = 1.0F;
    }
    return ModelPicture(rgba);
}

TEST(ModelPicture, PixelsAreThoseThatEitherCovers) {
    const ModelPicture a = pictureWith({{1, 0}, {2, 3}}, 0.5F), b = pictureWith({{7, 3}}, 0.25F);
    const ModelPixels model(a, b);
    const image::ImageF inA = model.of(a.color), inB = model.of(b.color);
    ASSERT_EQ(inA.width(), 3);
    ASSERT_EQ(inA.channels(), 3);
    EXPECT_EQ(inA.at(0, 0, 1), 0.5F);
    EXPECT_EQ(inA.at(1, 0, 1), 0.5F);
    EXPECT_EQ(inA.at(2, 0, 1), 0.0F);
    EXPECT_EQ(inB.at(2, 0, 1), 0.25F);
    // Black that is covered is the model's.
    EXPECT_EQ(ModelPixels(pictureWith({{3, 3}}, 0.0F), a).of(a.color).width(), 3);
    const ModelPicture nothing = pictureWith({}, 0.0F);
    EXPECT_EQ(ModelPixels(nothing, nothing).of(nothing.color).width(), 1);
}

TEST(ModelPicture, SmallModelsAreEnlarged) {
    const auto part = pictureWith({{3, 1}, {4, 2}}, 0.5F).enlarged();
    ASSERT_TRUE(part);
    ASSERT_EQ(part->width(), 8);  // the middle 4 × 2 pixels, twice as large
    ASSERT_EQ(part->height(), 4);
    EXPECT_EQ(part->at(2, 0, 1), 0.5F);
    EXPECT_EQ(part->at(3, 1, 1), 0.5F);
    EXPECT_EQ(part->at(4, 1, 1), 0.0F);
    EXPECT_EQ(part->at(4, 2, 1), 0.5F);
    // One of a pair need not show as much: both show the same part.
    EXPECT_EQ(pictureWith({{3, 1}}, 0.5F).enlarged()->width(), 8);
    EXPECT_FALSE(pictureWith({{6, 1}}, 0.5F).enlarged());
    EXPECT_FALSE(pictureWith({{0, 0}, {0, 2}}, 1.0F).enlarged());
    EXPECT_FALSE(pictureWith({}, 1.0F).enlarged());
}

}  // namespace
}  // namespace gfxrepro::point_splatting
