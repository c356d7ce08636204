#include "techniques/terrain_tessellation/tile_selection.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numeric>

#include "engine/scene/height_map.h"
#include "scenes/terrain/terrain.h"
#include "techniques/terrain_tessellation/patches.h"
#include "tests/support/grid.h"
#include "tests/techniques/terrain_tessellation/terrain_fixture.h"

namespace gfxrepro::terrain_tessellation {
namespace {

constexpr TileSettings kTiles{2, 2};
constexpr float kMaxErrorPx = 8.0F;

scene::HeightMap hills(int width, int height) {
    const scene::FractalTerrain shape{
        .sizeSamples = std::max(width, height), .reliefM = 400.0F, .featureM = 800.0F};
    scene::HeightMap square = scene::fractalTerrain(shape, 3);
    scene::HeightMap map{.sizeSamples = {width, height},
                         .spacingM = square.spacingM * glm::vec2(1.0F, 1.5F)};
    for (const auto [row, column] : test::grid(height, width)) {
        map.heightsM.push_back(square.heightM(column, row));
    }
    return map;
}

TileView viewFrom(const glm::vec3& eye, const glm::vec3& target) {
    const glm::vec3 up =
        eye.x == target.x && eye.z == target.z ? glm::vec3(0, 0, -1) : glm::vec3(0, 1, 0);
    const glm::mat4 projection = glm::perspective(0.7F, 1.6F, 1.0F, 20000.0F);
    const float horizontal = 2.0F * std::atan(1.6F * std::tan(0.35F));
    return {eye, projection * glm::lookAt(eye, target, up), pixelsPerTangent(1280, horizontal)};
}

std::vector<TileView> views() {
    return {viewFrom({-500, 900, -500}, {1500, 0, 1500}),
            viewFrom({1200, 420, 1200}, {1800, 300, 600}),
            viewFrom({1200, -300, 1200}, {1900, -200, 1200}),  // under the ground
            viewFrom({90000, 30000, 0}, {0, 0, 0}),            // beyond the far plane
            viewFrom({1000, 3000, 1000}, {1000, 0, 1000}),     // straight down
            viewFrom({1200, 200, 1200}, {3000, 200, 1200})};
}

/// How many tiles hold each cell between four samples.
std::vector<int> coverage(const TileSelection& selection, glm::ivec2 cells) {
    std::vector<int> counts(static_cast<std::size_t>(cells.x * cells.y), 0);
    for (const Tile& tile : selection.tiles) {
        const glm::ivec2 to = glm::min(tile.originSample + tile.sizeSamples, cells);
        for (int y = tile.originSample.y; y < to.y; ++y) {
            for (int x = tile.originSample.x; x < to.x; ++x) ++counts[y * cells.x + x];
        }
    }
    return counts;
}

TEST(TileSelection, CoversTheMapOnceWithTilesFineEnough) {
    const scene::HeightMap map = hills(257, 200);
    const TerrainMetadata metadata = TerrainMetadata::build(map, {8, 4});
    const TileTree tree(metadata, kTiles);
    bool isSeveralLevels = false;
    for (const TileView& view : views()) {
        const TileSelection selection = tree.select(view, kMaxErrorPx, false);
        EXPECT_EQ(selection.culledCount, 0);
        for (const int count : coverage(selection, map.sizeSamples - 1)) ASSERT_EQ(count, 1);
        for (const Tile& tile : selection.tiles) {
            isSeveralLevels = isSeveralLevels || tile.level != selection.tiles[0].level;
            EXPECT_EQ(tile.sizeSamples, 32 << tile.level);
            EXPECT_EQ(tile.firstBlock * (8 << tile.level), tile.originSample);
            // ε, the box and d again, from the blocks and the heights.
            float errorM = 0.0F;
            for (int i = 0; i < 16; ++i) {
                const glm::ivec2 at = tile.firstBlock + glm::ivec2(i % 4, i / 4);
                errorM = std::max(errorM, metadata.block(tile.level, at.x, at.y).whole.errorM);
            }
            const glm::ivec2 last =
                glm::min(tile.originSample + tile.sizeSamples, map.sizeSamples - 1);
            scene::Box box;
            for (int row = tile.originSample.y; row <= last.y; ++row) {
                for (int column = tile.originSample.x; column <= last.x; ++column) {
                    box.add(map.position(column, row));
                }
            }
            EXPECT_EQ(box.min, tile.box.min);
            EXPECT_EQ(box.max, tile.box.max);
            EXPECT_EQ(errorM, tile.errorM);
            const glm::vec3 gap =
                glm::max(glm::max(box.min - view.eye, view.eye - box.max), glm::vec3(0));
            const float rho = errorM * view.pixelsPerTangent / glm::length(gap);
            EXPECT_TRUE(tile.level == 0 || rho < kMaxErrorPx) << tile.level << ' ' << rho;
        }
    }
    EXPECT_TRUE(isSeveralLevels);
}

TEST(TileSelection, DropsNothingThatIsSeen) {
    const scene::HeightMap map = hills(257, 257);
    const TerrainMetadata metadata = TerrainMetadata::build(map, {8, 4});
    const TileTree tree(metadata, kTiles);
    int culled = 0;
    for (const TileView& view : views()) {
        const TileSelection selection = tree.select(view, kMaxErrorPx);
        culled += selection.culledCount;
        const std::vector<int> counts = coverage(selection, map.sizeSamples - 1);
        for (const auto [row, column] : test::grid(256, 256)) {
            const glm::vec4 clip = view.clipFromWorld * glm::vec4(map.position(column, row), 1.0F);
            const bool isSeen =
                std::abs(clip.x) < clip.w && std::abs(clip.y) < clip.w && std::abs(clip.z) < clip.w;
            ASSERT_LE(counts[row * 256 + column], 1);
            if (isSeen) ASSERT_EQ(counts[row * 256 + column], 1) << column << ' ' << row;
        }
        // What is left is what the whole selection has, less the tiles outside.
        const TileSelection all = tree.select(view, kMaxErrorPx, false);
        std::size_t visible = 0;
        for (const Tile& tile : all.tiles) visible += mayBeVisible(tile.box, view.clipFromWorld);
        EXPECT_EQ(selection.tiles.size(), visible);
    }
    EXPECT_GT(culled, 0);
    EXPECT_TRUE(tree.select(views()[3], kMaxErrorPx).tiles.empty());
}

TEST(TileSelection, ByDistanceCoversOnceAndDividesTheNear) {
    const scene::HeightMap map = hills(257, 257);
    const TerrainMetadata metadata = TerrainMetadata::build(map, {8, 4});
    const TileTree tree(metadata, kTiles);
    for (const TileView& view : views()) {
        const TileSelection selection = tree.selectByDistance(view, 500.0F, false);
        for (const int count : coverage(selection, map.sizeSamples - 1)) ASSERT_EQ(count, 1);
        for (const Tile& tile : selection.tiles) {
            if (tile.level > 0) {
                EXPECT_GE(tile.distanceM, 250.0F * static_cast<float>(1 << tile.level));
            }
        }
    }
}

TEST(TileSelection, ServesFlatAndTinyMaps) {
    scene::HeightMap flat{.sizeSamples = glm::ivec2(257)};
    flat.heightsM.assign(257 * 257, 5.0F);
    const TerrainMetadata flatData = TerrainMetadata::build(flat, {8, 4});
    const TileSelection one =
        TileTree(flatData, kTiles).select(viewFrom({100, 5, 100}, {200, 5, 200}), kMaxErrorPx);
    ASSERT_EQ(one.tiles.size(), 1U);
    EXPECT_EQ(one.tiles[0].level, 3);
    EXPECT_EQ(one.tiles[0].screenErrorPx, 0.0F);

    for (const int side : {1, 2}) {
        scene::HeightMap tiny{.sizeSamples = glm::ivec2(side)};
        tiny.heightsM.assign(static_cast<std::size_t>(side * side), 1.0F);
        const TerrainMetadata tinyData = TerrainMetadata::build(tiny, {8, 4});
        EXPECT_EQ(TileTree(tinyData, kTiles)
                      .select(viewFrom({0, 9, 9}, {0, 0, 0}), kMaxErrorPx)
                      .tiles.size(),
                  1U);
    }
}

// Draw calls for a software rasterizer: nothing is left out, and only small calls are clipped.

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
