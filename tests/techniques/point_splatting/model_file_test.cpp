#include "techniques/point_splatting/point_model.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "engine/core/error.h"
#include "engine/core/random.h"
#include "tests/support/support.h"

namespace gfxrepro::point_splatting {
namespace {

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
    TreeSettings settings;
    settings.minPatchPoints = 100;
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

}  // namespace
}  // namespace gfxrepro::point_splatting
