// Factors of the shaders against Eq. (2) to (4) in double precision, and against each other.
#include <algorithm>

#include "tests/techniques/terrain_tessellation/terrain_fixture.h"

namespace gfxrepro::terrain_tessellation {
namespace {

const std::array kViews{std::array{glm::vec3(-20, 60, 300), glm::vec3(128, 10, 100)},
                        std::array{glm::vec3(100, 45, 120), glm::vec3(200, 10, 60)},
                        std::array{glm::vec3(128, 300, 128), glm::vec3(129, 0, 127)}};

TEST_F(TerrainTest, ReplayedFactorsAreThoseOfTheDoublePrecisionReference) {
    makeTerrain(roughMap(257, 40.0F));
    for (const Segment segment : {Segment::Vertical, Segment::ViewFacing, Segment::Sphere}) {
        RenderSettings set = settings();
        set.factors.segment = segment;
        set.cullsPatches = false;
        set.factors.segmentPx = 3.0F;
        FactorReplay replay(shaders, *terrain, set);
        for (const auto& [eye, target] : kViews) {
            const depth_images::View view = viewAt(eye, target);
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
    const depth_images::View view = viewAt({8, 0, -40}, {8, 0, 0});
    const double expected = 16.0 * 50.0 / std::tan(0.45) / 40.0;
    EXPECT_NEAR(edgeFactor(*metadata, set.factors, view, {0, {0, 0}}, kNorth), expected, 1e-3);
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
