// Factors of the shaders against Eq. (2) to (4) in double precision, and against each other.

#include "tests/techniques/terrain_tessellation/terrain_fixture.h"

namespace gfxrepro::terrain_tessellation {
namespace {

const std::array kViews{std::array{glm::vec3(-20, 60, 300), glm::vec3(128, 10, 100)},
                        std::array{glm::vec3(100, 45, 120), glm::vec3(200, 10, 60)},
                        std::array{glm::vec3(128, 300, 128), glm::vec3(129, 0, 127)}};

TEST_F(TerrainTest, ReplayedFactorsAreThoseOfTheDoublePrecisionReference) {
    scene::HeightMap rough = roughMap(257, 40.0F);
    for (const auto& [spacingM, segment] : {std::pair(glm::vec2(1, 1), Segment::Vertical),
                                            {{1, 1}, Segment::ViewFacing},
                                            {{1, 1}, Segment::Sphere},
                                            {{2, 1}, Segment::Vertical},
                                            {{1, 2}, Segment::Sphere}}) {
        rough.spacingM = spacingM;
        makeTerrain(rough);
        RenderSettings set = settings();
        set.factors.segment = segment;
        set.cullsPatches = false;
        set.factors.segmentPx = 3.0F;
        FactorReplay replay(shaders, *terrain, set);
        for (const auto& [eye, target] : kViews) {
            const kit::View view = viewAt(eye, target);
            const std::vector<Tile> tiles = tilesOf(0);
            const auto factors = replay.run(tiles, view);
            ASSERT_EQ(factors.size(), tiles.size() * 16);
            for (std::size_t i = 0; i < factors.size(); ++i) {
                const Patch patch = patchOf(tiles[i / 16], tile, static_cast<int>(i % 16));
                for (const Edge edge : {kWest, kNorth, kEast, kSouth}) {
                    const double expected = edgeFactor(*metadata, set.factors, view, patch, edge);
                    // Single precision: the projection cancels where an end is near the eye.
                    EXPECT_NEAR(factors[i].outer[edge], expected, 2e-3 * expected);
                }
            }
        }
    }
}

TEST_F(TerrainTest, AKnownEdgeHasItsFactorByHand) {
    scene::HeightMap flat = roughMap(257, 0.0F);
    makeTerrain(flat);
    RenderSettings set = settings();
    set.factors.segmentPx = 1.0F;
    // Level 0, D = 16. The eye is 40 in front of the midpoint (8, 0, 0) of the first north edge:
    // F = 16 · (height / 2) / tan(0.45) / 40 pixels.
    const kit::View view = viewAt({8, 0, -40}, {8, 0, 0});
    const double expected = 16.0 * 50.0 / std::tan(0.45) / 40.0;
    EXPECT_NEAR(edgeFactor(*metadata, set.factors, view, {0, {0, 0}}, kNorth), expected, 1e-3);
}

TEST_F(TerrainTest, AnEdgeIsAsLongAsTheSpacingOfItsAxisSays) {
    scene::HeightMap flat = roughMap(257, 0.0F);
    flat.spacingM = {1.0F, 2.0F};
    makeTerrain(flat);
    RenderSettings set = settings();
    set.factors.segmentPx = 2.0F;
    set.cullsPatches = false;
    FactorReplay replay(shaders, *terrain, set);
    const double perMetre = 50.0 / std::tan(0.45) / 40.0 / 2.0;
    // 16 along x and 32 along z, each seen from 40 in front of its middle.
    for (const auto& [edge, eye, middle, lengthM] :
         {std::tuple(kNorth, glm::vec3(8, 0, -40), glm::vec3(8, 0, 0), 16.0),
          std::tuple(kWest, glm::vec3(-40, 0, 16), glm::vec3(0, 0, 16), 32.0)}) {
        const kit::View view = viewAt(eye, middle);
        const double expected = lengthM * perMetre;
        EXPECT_NEAR(edgeFactor(*metadata, set.factors, view, {0, {0, 0}}, edge), expected, 1e-3);
        EXPECT_NEAR(replay.run(tilesOf(0), view)[0].outer[edge], expected, 1e-3 * expected);
    }
}

TEST_F(TerrainTest, ASlopingEdgeIsAsLongAsInSpace) {
    scene::HeightMap slope = roughMap(257, 0.0F);
    for (int i = 0; i < 257 * 257; ++i) {
        slope.heightsM[static_cast<std::size_t>(i)] = 0.75F * static_cast<float>(i % 257);
    }
    makeTerrain(slope);
    RenderSettings set = settings();
    set.factors.segmentPx = 1.0F;
    set.cullsPatches = false;
    // From (0, 0, 0) to (16, 12, 0): D = 20, more than the 12 between the heights. Seen from 40 in
    // front of its middle.
    const kit::View view = viewAt({8, 6, -40}, {8, 6, 0});
    const double expected = 20.0 * 50.0 / std::tan(0.45) / 40.0;
    EXPECT_NEAR(edgeFactor(*metadata, set.factors, view, {0, {0, 0}}, kNorth), expected, 1e-3);
    const std::vector<Tile> tiles = tilesOf(0);
    FactorReplay replay(shaders, *terrain, set);
    EXPECT_NEAR(replay.run(tiles, view)[0].outer[kNorth], expected, 1e-3 * expected);
    EXPECT_EQ(edgeEndsM(*metadata, tile, {0, {2, 0}}, kSouth), glm::vec2(12.0F, 24.0F));
    EXPECT_EQ(edgeEndsM(*metadata, tile, {0, {2, 0}}, kEast), glm::vec2(24.0F, 24.0F));
    EXPECT_EQ(edgeEndsM(*metadata, tile, {1, {2, 2}}, kNorth), glm::vec2(24.0F, 48.0F));
}

TEST_F(TerrainTest, TwiceTheDeltaSHalvesFactorsThatMeetNoLimit) {
    makeTerrain(roughMap(257, 40.0F));
    RenderSettings set = settings();
    FactorReplay replay(shaders, *terrain, set);
    const std::vector<Tile> tiles = tilesOf(0);
    const kit::View view = viewAt(kViews[0][0], kViews[0][1]);
    const auto factorsAt = [&](float segmentPx) {
        replay.setSegmentPx(segmentPx);
        return replay.run(tiles, view);
    };
    const auto fine = factorsAt(1.5F);
    const FactorHalving halving = compareHalving(set.factors, fine, factorsAt(3.0F));
    EXPECT_GT(halving.unclampedEdges, 100);
    EXPECT_LT(halving.unclampedEdges, halving.edges);
    EXPECT_EQ(halving.unhalvedEdges, 0);
    // Negative control: another ratio.
    const FactorHalving other = compareHalving(set.factors, fine, factorsAt(3.001F));
    EXPECT_GT(other.unhalvedEdges, 100);
    const FactorHalving near = compareHalving(set.factors, factorsAt(0.1F), factorsAt(0.2F));
    EXPECT_GT(near.greatestEdges, 0);
}

TEST(EdgeJumpsTest, AreThoseOfEdgesOverTheirInside) {
    // West 4, north 10, east 12, south 10; a culled patch does not count.
    const std::array patches{PatchFactors{{4, 10, 12, 10}}, PatchFactors{{-1, -1, -1, -1}}};
    EXPECT_DOUBLE_EQ(edgeJumps(patches, InnerFactors::Mean).mean, 1.5);
    EXPECT_DOUBLE_EQ(edgeJumps(patches, InnerFactors::Minimum).greatest, 3.0);
    EXPECT_DOUBLE_EQ(edgeJumps(patches, InnerFactors::Maximum).mean, 1.0);
}

TEST_F(TerrainTest, BothPatchesOfAnEdgeGetTheSameBits) {
    makeTerrain(roughMap(257, 40.0F));
    RenderSettings set = settings();
    FactorReplay replay(shaders, *terrain, set);
    for (const auto& [eye, target] : kViews) {
        for (int level = 0; level < 2; ++level) {
            const std::vector<Tile> tiles = tilesOf(level);
            auto factors = replay.run(tiles, viewAt(eye, target));
            const EdgeAgreement agreement = compareEdges(tiles, tile, factors);
            EXPECT_GT(agreement.sharedEdges, 10);
            EXPECT_EQ(agreement.unequalEdges, 0);
        }
    }
    // Negative control: one factor moved by its last bit is found.
    set.cullsPatches = false;
    FactorReplay all(shaders, *terrain, set);
    const std::vector<Tile> tiles = tilesOf(0);
    auto factors = all.run(tiles, viewAt(kViews[0][0], kViews[0][1]));
    factors[0].outer[kEast] = std::nextafter(factors[0].outer[kEast], 100.0F);
    EXPECT_EQ(compareEdges(tiles, tile, factors).unequalEdges, 1);
}

}  // namespace
}  // namespace gfxrepro::terrain_tessellation
