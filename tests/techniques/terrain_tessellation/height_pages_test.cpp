// Heights in pages: what a page holds, which pages go, and that pictures do not depend on it.
#include <algorithm>

#include "techniques/terrain_tessellation/terrain_views.h"
#include "tests/techniques/terrain_tessellation/terrain_fixture.h"

namespace gfxrepro::terrain_tessellation {
namespace {

/// Of the fixture's tiles: 64 segments and a border.
constexpr std::size_t kPageBytes = 68 * 68 * sizeof(float);

TEST_F(TerrainTest, PagesHoldTheSamplesOfTheirTilesAndABorder) {
    scene::HeightMap rough = roughMap(257, 40.0F);
    rough.sizeSamples = {257, 200};  // the last tiles reach beyond the map
    rough.heightsM.resize(257 * 200);
    makeTerrain(std::move(rough));
    terrain.emplace(map, *metadata);
    for (int level = 0; level < 3; ++level) {
        const std::vector<Tile> tiles = tilesOf(level);
        const std::vector<int> layers = terrain->pages().load(tiles);
        const auto texels = terrain->pages().texture().read<float>(GL_RED, GL_FLOAT, 1);
        for (std::size_t t = 0; t < tiles.size(); ++t) {
            const auto page = texels.begin() + std::ptrdiff_t{68 * 68} * layers[t];
            float greatest = 0.0F;
            for (int i = 0; i < 68 * 68; ++i) {
                const int column = tiles[t].originSample.x + (i % 68 - 1) * (1 << level);
                const int row = tiles[t].originSample.y + (i / 68 - 1) * (1 << level);
                const float expected =
                    map.heightM(std::clamp(column, 0, 256), std::clamp(row, 0, 199));
                greatest = std::max(greatest, std::abs(page[i] - expected));
            }
            EXPECT_EQ(greatest, 0.0F) << level << ' ' << t;
        }
    }
}

TEST_F(TerrainTest, PagesOfAFileAreThoseOfTheSameHeightsInMemory) {
    const TemporaryFolder folder;
    scene::HeightMap coarse = roughMap(65, 40.0F);
    coarse.sizeSamples = {65, 50};  // tiles reach beyond the map
    coarse.heightsM.resize(65 * 50);
    makeTerrain(scene::resampled(coarse, 257, 5.0F, 1));
    const scene::HeightMap inFile =
        scene::resampledInFile(coarse, 257, 5.0F, 1, folder.path(), "key");
    ASSERT_NE(inFile.file, nullptr);
    DeviceTerrain other(inFile, *metadata);
    for (int level = 0; level < 3; ++level) {
        const std::vector<Tile> tiles = tilesOf(level);
        const auto texelsOf = [&](HeightPages& pages) {
            const std::vector<int> layers = pages.load(tiles);
            const auto all = pages.texture().read<float>(GL_RED, GL_FLOAT, 1);
            std::vector<float> texels;  // of these tiles: what other layers hold is the device's
            for (const int layer : layers) {
                const auto page = all.begin() + std::ptrdiff_t{68 * 68} * layer;
                texels.insert(texels.end(), page, page + 68 * 68);
            }
            return texels;
        };
        EXPECT_EQ(texelsOf(terrain->pages()), texelsOf(other.pages())) << level;
    }
}

TEST_F(TerrainTest, ThePageOutOfUseForLongestGoes) {
    makeTerrain(roughMap(257, 40.0F));
    terrain.emplace(map, *metadata, 3 * kPageBytes + 99);
    HeightPages& pages = terrain->pages();
    ASSERT_EQ(pages.capacity(), 3);
    const std::vector<Tile> tiles = tilesOf(0);
    const std::vector<int> first = pages.load(std::span(tiles).subspan(0, 3));
    EXPECT_EQ(pages.loadedCount(), 3U);
    const auto loaded = [&](std::size_t from, std::size_t count) {
        return pages.load(std::span(tiles).subspan(from, count));
    };
    EXPECT_EQ(loaded(0, 1), std::vector<int>{first[0]});
    EXPECT_EQ(loaded(2, 1), std::vector<int>{first[2]});
    EXPECT_EQ(pages.loadedCount(), 3U);
    // Tile 1 was out of use for longest, then tile 0. A tile that is asked for keeps its page.
    EXPECT_EQ(loaded(3, 1), std::vector<int>{first[1]});
    EXPECT_EQ(loaded(0, 2), (std::vector<int>{first[0], first[2]}));
    EXPECT_EQ(pages.loadedCount(), 5U);
}

TEST_F(TerrainTest, FewPagesDrawThePictureOfMany) {
    makeTerrain(roughMap(257, 40.0F));
    const TileTree tree(*metadata, tile);
    scene::Scene scene;
    scene.heights = map;
    const TerrainView flight(scene, "round_flight");
    constexpr std::size_t kBudget = 4 * kPageBytes;
    DeviceTerrain few(map, *metadata, kBudget);
    TerrainRenderer whole(shaders, *terrain, settings()), paged(shaders, few, settings());
    MorphRanges ranges;
    for (int level = 0; level < tree.levelCount(); ++level) {
        ranges.rangesM.push_back(std::ldexp(60.0F, level));
    }
    std::size_t mostTiles = 0;
    for (int frame = 0; frame < 12; ++frame) {
        const kit::View view = kit::viewOf(flight.camera(frame, 12, 1.6F), {80, 50});
        const TileView tileView{view.eyeWorld, view.clipFromWorld(), 50.0F};
        const std::vector<Tile> tiles = tree.select(tileView, 1.0F).tiles;
        mostTiles = std::max(mostTiles, tiles.size());
        const auto pictureOf = [&](TerrainRenderer& renderer, int method) {
            return picture({80, 50}, [&](const gl::Framebuffer& target) {
                if (method == 0) renderer.drawTessellated(tiles, view, target);
                if (method == 1) renderer.drawGrid(tiles, view, target);
                if (method == 2) renderer.drawGrid(tiles, view, target, &ranges);
            });
        };
        for (int method = 0; method < 3; ++method) {
            const auto expected = pictureOf(whole, method);
            EXPECT_GT(expected[40].a, 0.5F);  // ground in the lowest row
            EXPECT_EQ(expected, pictureOf(paged, method)) << frame << ' ' << method;
        }
        EXPECT_LE(few.pages().texture().sizeBytes(), kBudget);
    }
    EXPECT_GT(mostTiles, 4U);
    EXPECT_GT(few.pages().loadedCount(), terrain->pages().loadedCount());
}

TEST_F(TerrainTest, RefusesABudgetThatHoldsNoTile) {
    makeTerrain(roughMap(257, 1.0F));
    EXPECT_EQ(errorText([&] { DeviceTerrain(map, *metadata, kPageBytes / 2); }),
              "0.01 MiB for heights hold no tile of 68 × 68; allowed: 0.02 MiB or more");
}

}  // namespace
}  // namespace gfxrepro::terrain_tessellation
