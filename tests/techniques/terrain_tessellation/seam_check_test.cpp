// Captured triangles fit together, to the last bit, unless factors differ.
#include "techniques/terrain_tessellation/patch_checks.h"

#include <algorithm>

#include "techniques/terrain_tessellation/terrain_measures.h"
#include "tests/techniques/terrain_tessellation/terrain_fixture.h"

namespace gfxrepro::terrain_tessellation {
namespace {

struct SeamCheckTest : TerrainTest {
    SeamCheckTest() { makeTerrain(roughMap(257, 60.0F)); }

    RenderSettings capturing(EdgeRule edges = EdgeRule::Shared) const {
        RenderSettings set = settings();
        set.capturesVertices = true;
        set.cullsPatches = false;
        set.factors.edges = edges;
        set.factors.segmentPx = 2.0F;
        return set;
    }
    std::vector<PatchFactors> factorsOf(const RenderSettings& set, const std::vector<Tile>& tiles,
                                        const kit::View& view) {
        return FactorReplay(shaders, *terrain, set).run(tiles, view);
    }
    Seams seamsOf(const RenderSettings& set, const std::vector<Tile>& tiles,
                  const kit::View& view) {
        TerrainRenderer renderer(shaders, *terrain, set);
        return checkSeams(tiles, tile, factorsOf(set, tiles, view), renderer.capture(tiles, view));
    }
};

TEST_F(SeamCheckTest, NoEdgeIsOpenWithinAndBetweenTilesOfOneLevel) {
    for (const kit::View& view : terrainViews()) {
        for (int level = 0; level < 2; ++level) {
            for (const Spacing spacing : {Spacing::FractionalEven, Spacing::Equal}) {
                RenderSettings set = capturing();
                set.spacing = spacing;
                set.cullsPatches = true;
                EXPECT_EQ(seamsOf(set, tilesOf(level), view).openEdges, 0U) << level;
                set.cullsPatches = false;
                const Seams seams = seamsOf(set, tilesOf(level), view);
                EXPECT_GT(seams.edges, 1000U);
                EXPECT_GT(seams.patchEdges, 100U);
                EXPECT_GT(seams.tileEdges, 10U);
                EXPECT_EQ(seams.openEdges, 0U) << level;
            }
        }
    }
}

TEST_F(SeamCheckTest, NorWhereTilesOfSeveralLevelsMeetWhichIsSkirtsWork) {
    const TileTree tree(*metadata, tile);
    int mixed = 0;
    for (const kit::View& view : terrainViews()) {
        const std::vector<Tile> tiles =
            tree.select({view.eyeWorld, view.clipFromWorld(), 62.0F}, 2.0F).tiles;
        mixed += std::any_of(tiles.begin(), tiles.end(),
                             [&](const Tile& t) { return t.level != tiles[0].level; });
        EXPECT_EQ(seamsOf(capturing(), tiles, view).openEdges, 0U);
    }
    EXPECT_GT(mixed, 0);
}

// Patches that reach beyond the map are folded onto its rim.
TEST_F(SeamCheckTest, NorWhereTheMapEndsWithinTiles) {
    for (const int side : {250, 201, 130}) {
        makeTerrain(roughMap(side, 60.0F));
        for (const kit::View& view : terrainViews()) {
            for (int level = 0; level < 2; ++level) {
                const Seams seams = seamsOf(capturing(), tilesOf(level), view);
                EXPECT_GT(seams.edges, 1000U);
                EXPECT_EQ(seams.openEdges, 0U) << side << ' ' << level;
            }
        }
    }
}

TEST_F(SeamCheckTest, NorWhereSamplesStandFurtherApartOneWay) {
    scene::HeightMap uneven = roughMap(257, 60.0F);
    for (const glm::vec2 spacingM : {glm::vec2(2, 1), glm::vec2(1, 2)}) {
        uneven.spacingM = spacingM;
        makeTerrain(uneven);
        for (const kit::View& view : terrainViews()) {
            const Seams seams = seamsOf(capturing(), tilesOf(0), view);
            EXPECT_GT(seams.edges, 1000U);
            EXPECT_EQ(seams.openEdges, 0U) << spacingM.x;
        }
    }
}

TEST_F(SeamCheckTest, UnequalFactorsLeaveEdgesOpen) {
    const kit::View view = terrainViews()[0];
    EXPECT_GT(seamsOf(capturing(EdgeRule::OwnPatch), tilesOf(0), view).openEdges, 100U);
}

TEST_F(SeamCheckTest, OneBitOfOneVertexIsFound) {
    const std::vector<Tile> tiles = tilesOf(0);
    TerrainRenderer renderer(shaders, *terrain, capturing());
    std::vector<CapturedVertex> vertices = renderer.capture(tiles, terrainViews()[0]);
    const std::vector<PatchFactors> factors = factorsOf(capturing(), tiles, terrainViews()[0]);
    ASSERT_EQ(checkSeams(tiles, tile, factors, vertices).openEdges, 0U);
    for (CapturedVertex& vertex : vertices) {
        if (vertex.at != glm::vec2(64.0F, 40.0F)) continue;  // between two tiles
        vertex.positionClip.x = std::nextafter(vertex.positionClip.x, 1e9F);
        break;
    }
    const std::size_t open = checkSeams(tiles, tile, factors, vertices).openEdges;
    EXPECT_GE(open, 2U);
    EXPECT_LE(open, 8U);
}

TEST_F(SeamCheckTest, CapturesTheTrianglesThatAreDrawn) {
    const std::vector<Tile> tiles = tilesOf(0);
    const kit::View view = terrainViews()[1];
    RenderSettings set = capturing();
    TerrainRenderer renderer(shaders, *terrain, set);
    const std::vector<CapturedVertex> vertices = renderer.capture(tiles, view);
    DrawCounts counts;
    set.hasSkirts = false;
    TerrainRenderer drawing(shaders, *terrain, set);
    picture({32, 20}, [&](const gl::Framebuffer& target) {
        drawing.drawTessellated(tiles, view, target);
        counts = drawing.counts();
    });
    EXPECT_EQ(vertices.size(), 3 * counts.triangles);
    // More tiles than there are pages: the same, in turns.
    constexpr std::size_t kPageBytes = 68 * 68 * sizeof(float);
    DeviceTerrain few(map, *metadata, 3 * kPageBytes);
    TerrainRenderer inTurns(shaders, few, set);
    const std::vector<PatchFactors> factors = factorsOf(set, tiles, view);
    const Seams a = checkSeams(tiles, tile, factors, vertices),
                b = checkSeams(tiles, tile, factors, inTurns.capture(tiles, view));
    EXPECT_EQ(a.edges, b.edges);
    EXPECT_EQ(b.openEdges, 0U);
}

TEST_F(SeamCheckTest, PatchesHaveTheVerticesOfTheirFactors) {
    const std::vector<Tile> tiles = tilesOf(0);
    for (const InnerFactors inner : {InnerFactors::Mean, InnerFactors::Minimum}) {
        RenderSettings set = capturing();
        set.factors.inner = inner;
        std::size_t fan = 0;
        for (const kit::View& view : terrainViews()) {
            const Seams seams = seamsOf(set, tiles, view);
            int most = 0;
            FactorReplay replay(shaders, *terrain, set);
            for (const PatchFactors& patch : replay.run(tiles, view)) {
                const glm::dvec4 outer(patch.outer);
                most = std::max(most, patchVertices({outer.x, outer.y, outer.z, outer.w}, inner));
            }
            EXPECT_EQ(seams.mostVertices, static_cast<std::size_t>(most));
            EXPECT_LE(most, 65 * 65);
            fan = std::max(fan, seams.largestFan);
        }
        EXPECT_GE(fan, 6U);
    }
    EXPECT_EQ(patchVertices({64, 64, 64, 64}, InnerFactors::Mean), 65 * 65);
    EXPECT_EQ(patchVertices({2, 2, 2, 2}, InnerFactors::Mean), 9);
    EXPECT_EQ(patchVertices({2, 3, 4, 4.5}, InnerFactors::Mean), 2 + 4 + 4 + 6 + 3 * 3);
}

TEST_F(SeamCheckTest, SkirtsAreCountedApart) {
    const std::vector<Tile> tiles = tilesOf(0);
    const kit::View view = terrainViews()[1];
    for (const bool hasBatches : {true, false}) {
        std::vector<std::uint64_t> counts;
        for (const bool hasSkirts : {true, false}) {
            RenderSettings set = settings();
            set.hasSkirts = hasSkirts;
            if (!hasBatches) set.batches.reset();
            TerrainRenderer renderer(shaders, *terrain, set);
            picture({32, 20}, [&](const gl::Framebuffer& target) {
                renderer.drawTessellated(tiles, view, target);
                counts.push_back(renderer.counts().triangles);
            });
            if (hasSkirts) counts.push_back(renderer.countSkirtTriangles(tiles, view));
        }
        EXPECT_GT(counts[1], 0U);
        EXPECT_EQ(counts[0], counts[1] + counts[2]);
    }
}

// No background shows through terrain from anywhere.

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
