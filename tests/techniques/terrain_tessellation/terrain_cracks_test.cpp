// No background shows through terrain from anywhere.
#include <algorithm>

#include "techniques/terrain_tessellation/terrain_measures.h"
#include "tests/techniques/terrain_tessellation/terrain_fixture.h"

namespace gfxrepro::terrain_tessellation {
namespace {

constexpr glm::ivec2 kSize{96, 60};
constexpr int kViewCount = 200;

struct TerrainCracksTest : TerrainTest {
    TerrainCracksTest() { makeTerrain(roughMap(257, 60.0F)); }

    /// From 8 to 80 m above the ground or beside the map, in any direction but upwards.
    kit::View randomView(std::mt19937& random) const {
        glm::vec3 eye(0.0F);
        eye.z = anywhere(random, -60, 316) * map.spacingM.y;
        eye.x = anywhere(random, -60, 316) * map.spacingM.x;
        const glm::ivec2 place(glm::vec2(eye.x, eye.z) / map.spacingM);
        float ground = 0.0F;
        for (int i = -8; i <= 8; ++i) {
            for (int j = -8; j <= 8; ++j) {
                ground = std::max(ground, map.clampedHeightM(place.x + i, place.y + j));
            }
        }
        eye.y = ground + anywhere(random, 8, 80);
        const float turn = anywhere(random, 0.0F, 6.2832F);
        const glm::vec3 ahead(std::cos(turn), anywhere(random, -2.0F, 0.1F), std::sin(turn));
        return viewAt(eye, eye + ahead, kSize);
    }
    template <class Draw>
    DepthMap coverage(const kit::View& view, const Draw& draw) {
        DepthMap result{view, {}};
        for (const glm::vec4& pixel : picture(kSize, draw)) result.depthM.push_back(pixel.a);
        return result;
    }
    struct Found {
        std::size_t crackPixels = 0;
        int viewsOfSeveralLevels = 0;
        std::size_t covered = 0;
    };
    Found cracksOver(int views, bool hasSkirts, EdgeRule edges, unsigned seed = 21) {
        const TileTree tree(*metadata, tile);
        RenderSettings set = settings();
        set.hasSkirts = hasSkirts;
        set.factors.edges = edges;
        set.factors.segmentPx = 4.0F;
        TerrainRenderer renderer(shaders, *terrain, set);
        std::mt19937 random(seed);
        Found found;
        for (int i = 0; i < views; ++i) {
            const kit::View view = randomView(random);
            const TileView tileView{view.eyeWorld, view.clipFromWorld(), 62.0F};
            const std::vector<Tile> tiles = tree.select(tileView, 2.0F).tiles;
            const std::vector<Tile> finest = tree.select(tileView, 0.0F).tiles;
            found.viewsOfSeveralLevels +=
                std::any_of(tiles.begin(), tiles.end(),
                            [&](const Tile& t) { return t.level != tiles[0].level; });
            const DepthMap drawn = coverage(view, [&](const gl::Framebuffer& target) {
                renderer.drawTessellated(tiles, view, target);
            });
            const DepthMap truth = coverage(view, [&](const gl::Framebuffer& target) {
                renderer.drawGrid(finest, view, target);
            });
            found.crackPixels += markedCount(crackMarks(drawn, truth));
            for (const float alpha : truth.depthM) found.covered += alpha > 0.0F;
        }
        return found;
    }
};

TEST_F(TerrainCracksTest, NoBackgroundShowsFrom800Places) {
    for (const unsigned seed : {21U, 22U, 23U, 24U}) {
        const Found found = cracksOver(kViewCount, true, EdgeRule::Shared, seed);
        EXPECT_EQ(found.crackPixels, 0U) << seed;
        EXPECT_GT(found.viewsOfSeveralLevels, kViewCount / 4) << seed;
        EXPECT_GT(found.covered, 200U * 96U * 60U / 4U) << seed;
    }
}

TEST_F(TerrainCracksTest, NorWhereSamplesStandFurtherApartOneWay) {
    scene::HeightMap uneven = roughMap(257, 60.0F);
    uneven.spacingM = {1.0F, 2.0F};
    makeTerrain(uneven);
    const Found found = cracksOver(kViewCount / 2, true, EdgeRule::Shared);
    EXPECT_EQ(found.crackPixels, 0U);
    EXPECT_GT(found.viewsOfSeveralLevels, kViewCount / 8);
    EXPECT_GT(found.covered, 100U * 96U * 60U / 4U);
}

TEST_F(TerrainCracksTest, TheyAreSeenWithoutSkirtsAndWithFactorsOfThePatch) {
    EXPECT_GT(cracksOver(kViewCount / 4, false, EdgeRule::Shared).crackPixels, 0U);
    EXPECT_GT(cracksOver(kViewCount / 4, false, EdgeRule::OwnPatch).crackPixels, 0U);
}

}  // namespace
}  // namespace gfxrepro::terrain_tessellation
