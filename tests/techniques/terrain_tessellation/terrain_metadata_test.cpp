#include "techniques/terrain_tessellation/terrain_metadata.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/files.h"
#include "engine/core/random.h"
#include "tests/support/grid.h"
#include "tests/support/support.h"

namespace gfxrepro::terrain_tessellation {
namespace {

scene::HeightMap randomMap(int width, int height) {
    scene::HeightMap map{.sizeSamples = {width, height}, .spacingM = glm::vec2(2.0F)};
    Random random(7);
    for (int i = 0; i < width * height; ++i) map.heightsM.push_back(random.uniform(-50.0F, 90.0F));
    return map;
}

/// The definition at its word: a rectangle's samples against the bilinear grid, in double.
HeightRange bruteForce(const scene::HeightMap& map, glm::ivec2 from, glm::ivec2 to, int level) {
    const int step = 1 << level;
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    double error = 0.0;
    for (int y = from.y; y <= to.y; ++y) {
        for (int x = from.x; x <= to.x; ++x) {
            const int x0 = x / step * step;
            const int y0 = y / step * step;
            const double u = static_cast<double>(x - x0) / step;
            const double v = static_cast<double>(y - y0) / step;
            const double grid = (1 - u) * (1 - v) * map.clampedHeightM(x0, y0) +
                                u * (1 - v) * map.clampedHeightM(x0 + step, y0) +
                                (1 - u) * v * map.clampedHeightM(x0, y0 + step) +
                                u * v * map.clampedHeightM(x0 + step, y0 + step);
            const double height = map.clampedHeightM(x, y);
            low = std::min(low, height);
            high = std::max(high, height);
            error = std::max(error, std::abs(height - grid));
        }
    }
    return {static_cast<float>(low), static_cast<float>(high), static_cast<float>(error)};
}

void expectNear(const HeightRange& found, const HeightRange& expected) {
    EXPECT_EQ(found.minM, expected.minM);
    EXPECT_EQ(found.maxM, expected.maxM);
    // Single against double precision at heights of 100 m.
    EXPECT_NEAR(found.errorM, expected.errorM, 1e-4F);
}

TEST(TerrainMetadata, EqualsBruteForce) {
    // Neither square nor a power of two: parts of the tree lie beyond the map.
    const scene::HeightMap map = randomMap(61, 40);
    const TerrainMetadata metadata = TerrainMetadata::build(map, {8, 4});
    ASSERT_EQ(metadata.levelCount(), 4);
    ASSERT_EQ(metadata.treeSizeSamples(), 64);
    for (int level = 0; level < metadata.levelCount(); ++level) {
        const int size = metadata.blockSizeSamples(level);
        for (const auto [row, column] :
             test::grid(metadata.blocksPerSide(level), metadata.blocksPerSide(level))) {
            SCOPED_TRACE(testing::Message() << level << ' ' << column << ' ' << row);
            const glm::ivec2 a(column * size, row * size);
            const glm::ivec2 b = a + size;
            const Block& block = metadata.block(level, column, row);
            expectNear(block.whole, bruteForce(map, a, b, level));
            expectNear(block.edges[kWest], bruteForce(map, a, {a.x, b.y}, level));
            expectNear(block.edges[kNorth], bruteForce(map, a, {b.x, a.y}, level));
            expectNear(block.edges[kEast], bruteForce(map, {b.x, a.y}, b, level));
            expectNear(block.edges[kSouth], bruteForce(map, {a.x, b.y}, b, level));
            const std::array corners{map.clampedHeightM(a.x, a.y), map.clampedHeightM(b.x, a.y),
                                     map.clampedHeightM(a.x, b.y), map.clampedHeightM(b.x, b.y)};
            EXPECT_EQ(block.cornersM, corners);
        }
    }
}

TEST(TerrainMetadata, NeighboursShareTheirEdgesAndParentsHoldTheirChildren) {
    const TerrainMetadata metadata = TerrainMetadata::build(randomMap(129, 129), {8, 4});
    for (int level = 0; level < metadata.levelCount(); ++level) {
        const int side = metadata.blocksPerSide(level);
        for (const auto [row, column] : test::grid(side, side)) {
            const Block& block = metadata.block(level, column, row);
            if (column + 1 < side) {
                EXPECT_EQ(block.edges[kEast], metadata.block(level, column + 1, row).edges[kWest]);
            }
            if (row + 1 < side) {
                EXPECT_EQ(block.edges[kSouth],
                          metadata.block(level, column, row + 1).edges[kNorth]);
            }
            if (level == 0) EXPECT_EQ(block.whole.errorM, 0.0F);
            if (level + 1 == metadata.levelCount()) continue;
            const Block& parent = metadata.block(level + 1, column / 2, row / 2);
            EXPECT_LE(parent.whole.minM, block.whole.minM);
            EXPECT_GE(parent.whole.maxM, block.whole.maxM);
        }
    }
}

TEST(TerrainMetadata, APlaneHasNoErrorAndOneSampleHasATree) {
    scene::HeightMap plane{.sizeSamples = glm::ivec2(65)};
    for (int i = 0; i < 65 * 65; ++i) plane.heightsM.push_back(static_cast<float>(i % 65));
    const TerrainMetadata metadata = TerrainMetadata::build(plane, {8, 4});
    for (const Block& block : metadata.blocks()) EXPECT_EQ(block.whole.errorM, 0.0F);

    const TerrainMetadata tiny = TerrainMetadata::build(randomMap(1, 1), {8, 4});
    EXPECT_EQ(tiny.levelCount(), 3);
    EXPECT_EQ(tiny.block(0, 3, 3).whole.minM, tiny.block(2, 0, 0).whole.maxM);
}

TEST(TerrainMetadata, RefusesEmptyMapsAndOddBlocks) {
    const auto messageOf = [](const scene::HeightMap& map, const MetadataSettings& settings) {
        return errorText([&] { TerrainMetadata::build(map, settings); });
    };
    EXPECT_EQ(messageOf({}, {}), "terrain: the height map has no samples; allowed: at least one");
    EXPECT_EQ(messageOf(randomMap(2, 2), {12, 4}),
              "terrain: blocks of 12 segments; allowed: powers of two to 1024");
    EXPECT_EQ(messageOf(randomMap(2, 2), {8, 0}),
              "terrain: tiles of 0 blocks; allowed: powers of two to 256");
}

TEST(TerrainMetadata, ComesBackFromTheCacheUnlessDamaged) {
    const TemporaryFolder folder;
    const scene::HeightMap map = randomMap(65, 65);
    const MetadataSettings settings{8, 4};
    const TerrainMetadata built = TerrainMetadata::openOrBuild(folder.path(), map, settings);
    EXPECT_TRUE(built.wasBuilt());
    const auto expectSame = [&](const TerrainMetadata& other) {
        EXPECT_TRUE(std::equal(built.blocks().begin(), built.blocks().end(), other.blocks().begin(),
                               other.blocks().end()));
    };
    const TerrainMetadata found = TerrainMetadata::openOrBuild(folder.path(), map, settings);
    EXPECT_FALSE(found.wasBuilt());
    expectSame(found);

    const auto file = folder.path() / (TerrainMetadata::keyOf(map, settings) + ".terrain");
    const std::string whole = readFile(file);
    std::string damaged = whole;
    damaged[damaged.size() - 3] = static_cast<char>(damaged[damaged.size() - 3] ^ 1);
    for (const std::string& content : {damaged, whole.substr(0, whole.size() - 4), std::string()}) {
        writeFileAtomic(file, content);
        const TerrainMetadata rebuilt = TerrainMetadata::openOrBuild(folder.path(), map, settings);
        EXPECT_TRUE(rebuilt.wasBuilt());
        expectSame(rebuilt);
        EXPECT_EQ(readFile(file), whole);
    }
    EXPECT_NE(TerrainMetadata::keyOf(map, {16, 4}), TerrainMetadata::keyOf(map, settings));
}

TEST(TerrainMetadata, OfAFileIsThatOfTheSameHeightsInMemory) {
    const TemporaryFolder folder;
    const MetadataSettings settings{8, 4};
    scene::HeightMap coarse = randomMap(33, 21);
    const scene::HeightMap inMemory = scene::resampled(coarse, 129, 5.0F, 1);
    const scene::HeightMap inFile =
        scene::resampledInFile(coarse, 129, 5.0F, 1, folder.path(), "key");
    ASSERT_NE(inFile.file, nullptr);
    const TerrainMetadata a = TerrainMetadata::build(inMemory, settings);
    const TerrainMetadata b = TerrainMetadata::build(inFile, settings);
    EXPECT_TRUE(
        std::equal(a.blocks().begin(), a.blocks().end(), b.blocks().begin(), b.blocks().end()));
    EXPECT_NE(TerrainMetadata::keyOf(inFile, settings), TerrainMetadata::keyOf(inMemory, settings));
}

}  // namespace
}  // namespace gfxrepro::terrain_tessellation
