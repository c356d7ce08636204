// Captured triangles fit together, to the last bit, unless factors differ.
#include "techniques/terrain_tessellation/patch_checks.h"

#include <algorithm>

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

}  // namespace
}  // namespace gfxrepro::terrain_tessellation
