// Draw calls for a software rasterizer: nothing is left out, and only small calls are clipped.
#include "techniques/terrain_tessellation/patches.h"

#include <algorithm>
#include <numeric>

#include "tests/techniques/terrain_tessellation/terrain_fixture.h"

namespace gfxrepro::terrain_tessellation {
namespace {

constexpr float kFootM = -5.0F;

struct PatchBatchesTest : testing::Test {
    PatchBatchesTest()
        : map(roughMap(257, 40.0F)),
          metadata(TerrainMetadata::build(map, {8, 8})),
          tree(metadata, {4, 2}) {
        settings.tile = {4, 2};
    }
    std::vector<Tile> tilesFrom(const kit::View& view) const {
        return tree.select({view.eyeWorld, view.clipFromWorld(), 50.0F}, 4.0F, false).tiles;
    }
    /// Whether all samples of a patch or a skirt's part, as patches.glsl numbers them, are inside.
    bool isInside(const std::vector<Tile>& tiles, std::uint32_t number,
                  const kit::View& view) const {
        const Tile& tile = tiles[number / 32];
        const int local = static_cast<int>(number % 32), span = 16 << tile.level;
        const bool isSkirt = local >= 16;
        const int rim = (local - 16) / 4, along = local % 4;
        glm::ivec2 low(local % 4, local / 4);
        if (isSkirt)
            low = rim % 2 == 0 ? glm::ivec2(rim / 2 * 3, along) : glm::ivec2(along, rim / 2 * 3);
        low = tile.originSample + low * span;
        glm::ivec2 high = low + span;
        if (isSkirt && rim == kWest) high.x = low.x;
        if (isSkirt && rim == kNorth) high.y = low.y;
        if (isSkirt && rim == kEast) low.x = high.x;
        if (isSkirt && rim == kSouth) low.y = high.y;
        for (int row = low.y; row <= high.y; ++row) {
            for (int column = low.x; column <= high.x; ++column) {
                glm::vec3 place(column, map.clampedHeightM(column, row), row);
                for (int end = 0; end < (isSkirt ? 2 : 1); ++end, place.y = kFootM) {
                    const glm::vec4 clip = view.clipFromWorld() * glm::vec4(place, 1.0F);
                    for (int axis = 0; axis < 3; ++axis) {
                        if (std::abs(clip[axis]) > clip.w) return false;
                    }
                }
            }
        }
        return true;
    }

    scene::HeightMap map;
    TerrainMetadata metadata;
    TileTree tree;
    FactorSettings settings;
};

TEST_F(PatchBatchesTest, HaveEveryPatchOnceAndOnlySmallOnesAreClipped) {
    int large = 0, small = 0;
    for (const kit::View& view : terrainViews()) {
        const std::vector<Tile> tiles = tilesFrom(view);
        const BatchLimits limits{4000, 500};
        const PatchBatches patches =
            batchPatches(metadata, settings, view, {tiles, true, kFootM, false}, limits);
        std::vector<std::uint32_t> sorted = patches.order, expected(32 * tiles.size());
        std::sort(sorted.begin(), sorted.end());
        std::iota(expected.begin(), expected.end(), 0U);
        EXPECT_EQ(sorted, expected);
        std::size_t first = 0;
        for (const PatchBatch& batch : patches.batches) {
            EXPECT_TRUE(batch.triangles <= limits.triangles || batch.count == 1);
            const bool isSmall = batch.triangles <= limits.clippedTriangles || batch.count == 1;
            for (std::size_t i = first; i < first + batch.count && !isSmall; ++i) {
                EXPECT_TRUE(isInside(tiles, patches.order[i], view)) << patches.order[i];
            }
            isSmall ? ++small : ++large;
            first += batch.count;
        }
        EXPECT_EQ(first, patches.order.size());
    }
    EXPECT_GT(small, 10);
    EXPECT_GT(large, 3);
}

TEST_F(PatchBatchesTest, CulledPatchesCostNothing) {
    const kit::View away = viewAt({128, 60, 128}, {140, 400, 128});
    const std::vector<Tile> tiles = tilesFrom(away);
    const PatchBatches patches =
        batchPatches(metadata, settings, away, {tiles, true, kFootM, true}, {});
    ASSERT_EQ(patches.batches.size(), 1U);
    EXPECT_EQ(patches.batches[0].count, 32 * tiles.size());
    EXPECT_EQ(patches.batches[0].triangles, 0.0);
}

TEST_F(PatchBatchesTest, NothingMakesNoCall) {
    EXPECT_TRUE(
        batchPatches(metadata, settings, viewAt({0, 9, 0}, {9, 0, 9}), {}, {}).batches.empty());
}

}  // namespace
}  // namespace gfxrepro::terrain_tessellation
