// Measures of terrain pictures on depth maps whose errors and cracks are known, and the views.
#include "techniques/terrain_tessellation/terrain_measures.h"

#include <cmath>

#include "engine/image/resample.h"
#include "techniques/kit/path_view.h"
#include "techniques/terrain_tessellation/terrain_views.h"
#include "tests/support/grid.h"
#include "tests/support/support.h"

namespace gfxrepro::terrain_tessellation {
namespace {

/// From 100 m above the origin down onto the plane at `planeM`.
DepthMap fromAbove(float planeM, glm::ivec2 sizePx = {16, 12}) {
    const scene::Camera camera{.position = {0.0F, 100.0F, 0.0F},
                               .target = {0.0F, 0.0F, 0.0F},
                               .up = {0.0F, 0.0F, -1.0F},
                               .nearM = 1.0F,
                               .farM = 1000.0F};
    DepthMap map{kit::viewOf(camera, sizePx), {}};
    map.depthM.assign(static_cast<std::size_t>(sizePx.x * sizePx.y), 100.0F - planeM);
    return map;
}

TEST(TerrainMeasuresTest, HeightErrorsAreThoseOfThePlane) {
    const DepthMap drawn = fromAbove(10.0F);
    const HeightErrors errors = heightErrors(drawn, drawn, [](float, float) { return 7.0F; });
    EXPECT_EQ(errors.pixels, 16u * 12u);
    EXPECT_NEAR(errors.meanM, 3.0, 1e-4);
    EXPECT_NEAR(errors.maxM, 3.0, 1e-4);
    const double k = 6.0 / std::tan(0.5 * 0.7F);  // pixels a tangent of 12 rows and 0.7 rad
    EXPECT_NEAR(errors.meanPx, 3.0 * k / 90.0, 1e-4);
}

TEST(TerrainMeasuresTest, HeightErrorsLookWhereThePixelLies) {
    const DepthMap drawn = fromAbove(0.0F);
    // Seen from above with −z upwards: x grows to the right. Half of the pixels are off by 2 m.
    const HeightErrors errors =
        heightErrors(drawn, drawn, [](float x, float) { return x > 0 ? 2.0F : 0.0F; });
    EXPECT_NEAR(errors.meanM, 1.0, 1e-4);
    EXPECT_NEAR(errors.maxM, 2.0, 1e-4);
}

TEST(TerrainMeasuresTest, NothingDrawnHasNoErrors) {
    DepthMap drawn = fromAbove(0.0F);
    drawn.depthM.assign(drawn.depthM.size(), 0.0F);
    const HeightErrors errors = heightErrors(drawn, drawn, [](float, float) { return 0.0F; });
    EXPECT_EQ(errors.pixels, 0u);
    EXPECT_EQ(errors.meanM, 0.0);
}

TEST(TerrainMeasuresTest, WhereTheTruthShowsNoGroundSkirtsHaveNoError) {
    const DepthMap drawn = fromAbove(10.0F);
    DepthMap truth = drawn;
    truth.depthM[truth.indexOf({3, 4})] = 0.0F;
    EXPECT_EQ(heightErrors(drawn, truth, [](float, float) { return 7.0F; }).pixels, 16u * 12u - 1u);
}

TEST(TerrainMeasuresTest, CracksAreHolesBelowTerrainInsideOfTheTruth) {
    const DepthMap truth = fromAbove(0.0F);
    DepthMap drawn = truth;
    drawn.depthM[drawn.indexOf({5, 4})] = 0.0F;
    drawn.depthM[drawn.indexOf({6, 4})] = 0.0F;
    const std::vector<std::uint8_t> marks = crackMarks(drawn, truth);
    EXPECT_EQ(markedCount(marks), 2u);
    EXPECT_EQ(marks[drawn.indexOf({5, 4})], 1);
    EXPECT_EQ(marks[drawn.indexOf({6, 4})], 1);
}

TEST(TerrainMeasuresTest, ALowerHorizonIsNoCrack) {
    const DepthMap truth = fromAbove(0.0F);
    DepthMap drawn = truth;
    for (int x = 0; x < 16; ++x) {
        for (int y = 9; y < 12; ++y) drawn.depthM[drawn.indexOf({x, y})] = 0.0F;
    }
    EXPECT_EQ(markedCount(crackMarks(drawn, truth)), 0u);
}

/// `truth` with background in the rectangle.
DepthMap withoutTerrain(DepthMap map, glm::ivec2 low, glm::ivec2 high) {
    for (int y = low.y; y <= high.y; ++y) {
        for (int x = low.x; x <= high.x; ++x) map.depthM[map.indexOf({x, y})] = 0.0F;
    }
    return map;
}

TEST(TerrainMeasuresTest, AnOutlineDrawnTooNarrowIsNoCrackButWhatGoesOnFromItIs) {
    // Background right of column 11, below terrain.
    const DepthMap truth = withoutTerrain(fromAbove(0.0F), {12, 0}, {15, 9});
    EXPECT_EQ(markedCount(crackMarks(withoutTerrain(truth, {9, 4}, {11, 5}), truth)), 0u);
    EXPECT_EQ(markedCount(crackMarks(withoutTerrain(truth, {5, 4}, {11, 5}), truth)), 4u * 2u);
    // Behind a spike, a pixel wide.
    EXPECT_EQ(markedCount(crackMarks(withoutTerrain(truth, {10, 4}, {10, 5}), truth)), 0u);
    EXPECT_EQ(markedCount(crackMarks(withoutTerrain(truth, {9, 4}, {9, 5}), truth)), 2u);
}

TEST(TerrainMeasuresTest, AnOutlineBesideTheImageIsNoCrackButAHoleThatReachesInIs) {
    const DepthMap truth = fromAbove(0.0F);
    EXPECT_EQ(markedCount(crackMarks(withoutTerrain(truth, {0, 4}, {0, 5}), truth)), 0u);
    EXPECT_EQ(markedCount(crackMarks(withoutTerrain(truth, {13, 0}, {15, 5}), truth)), 0u);
    EXPECT_EQ(markedCount(crackMarks(withoutTerrain(truth, {6, 3}, {15, 5}), truth)), 7u * 3u);
    EXPECT_EQ(markedCount(crackMarks(withoutTerrain(truth, {3, 0}, {12, 7}), truth)), 10u * 5u);
}

TEST(TerrainMeasuresTest, TheTruthsOwnBackgroundIsNoCrack) {
    DepthMap truth = fromAbove(0.0F);
    for (int x = 0; x < 16; ++x) truth.depthM[truth.indexOf({x, 3})] = 0.0F;
    DepthMap drawn = truth;
    for (int x = 0; x < 16; ++x) drawn.depthM[drawn.indexOf({x, 2})] = 0.0F;  // its neighbours
    EXPECT_EQ(markedCount(crackMarks(drawn, truth)), 0u);
}

TEST(TerrainMeasuresTest, MarksHaveRowsFromTheBottom) {
    const image::ImageF grey(4, 3, 3, 0.5F);
    std::vector<std::uint8_t> marks(12, 0);
    marks[0] = 1;  // the lower left pixel
    const image::ImageF marked = withMarks(grey, marks);
    EXPECT_EQ(marked.at(0, 2, 0), 1.0F);
    EXPECT_EQ(marked.at(0, 2, 1), 0.0F);
    EXPECT_FLOAT_EQ(marked.at(0, 0, 1), 0.3F);
}

TEST(TerrainMeasuresTest, AveragesBlocks) {
    image::ImageF image(4, 2, 1);
    image.at(0, 0) = 4.0F;
    image.at(3, 1) = 2.0F;
    const image::ImageF small = image::averaged(image, 2);
    EXPECT_EQ(small.width(), 2);
    EXPECT_EQ(small.at(0, 0), 1.0F);
    EXPECT_EQ(small.at(1, 0), 0.5F);
}

scene::Scene terrainScene() {
    scene::Scene scene;
    scene::HeightMap map{.sizeSamples = {33, 33}, .spacingM = glm::vec2(10.0F)};
    for (const auto [row, column] : test::grid(33, 33)) {
        map.heightsM.push_back(static_cast<float>(column + 2 * row));
    }
    scene.heights = map;
    return scene;
}

TEST(TerrainViewsTest, HeightsAreBilinearAndGoOnBeyondTheBorder) {
    const scene::HeightMap map = *terrainScene().heights;
    EXPECT_FLOAT_EQ(heightAt(map, 15.0F, 25.0F), 1.5F + 5.0F);
    EXPECT_FLOAT_EQ(heightAt(map, -100.0F, 20.0F), 4.0F);
    EXPECT_FLOAT_EQ(heightAt(map, 1e6F, 1e6F), 96.0F);
}

TEST(TerrainViewsTest, SpacingsMayDiffer) {
    scene::Scene scene = terrainScene();
    scene.heights->spacingM = {10.0F, 20.0F};
    EXPECT_FLOAT_EQ(heightAt(*scene.heights, 15.0F, 50.0F), 1.5F + 5.0F);
    EXPECT_FLOAT_EQ(drawnHeightAt(*scene.heights, 15.0F, 50.0F), 1.5F + 5.0F);
    const scene::Camera overview = TerrainView(scene, "overview").camera(0, 1, 1.6F);
    EXPECT_EQ(overview.target, glm::vec3(160.0F, 48.0F, 320.0F));
    EXPECT_EQ(samplesPerPixel(*scene.heights, 64), glm::vec2(1.0F, 0.5F));
}

// NW 0, NE 1, SW 1, SE 10: the middle lies on the edge from south-west to north-east.
TEST(TerrainViewsTest, HeightsOfTheTruthAreItsTriangles) {
    const scene::HeightMap map{
        .sizeSamples = {2, 2}, .spacingM = glm::vec2(10.0F), .heightsM = {0.0F, 1.0F, 1.0F, 10.0F}};
    EXPECT_FLOAT_EQ(drawnHeightAt(map, 0.0F, 10.0F), 1.0F);
    EXPECT_FLOAT_EQ(drawnHeightAt(map, 10.0F, 10.0F), 10.0F);
    EXPECT_FLOAT_EQ(drawnHeightAt(map, 2.5F, 2.5F), 0.5F);
    EXPECT_FLOAT_EQ(drawnHeightAt(map, 5.0F, 5.0F), 1.0F);
    EXPECT_FLOAT_EQ(drawnHeightAt(map, 7.5F, 7.5F), 5.5F);
    EXPECT_FLOAT_EQ(heightAt(map, 5.0F, 5.0F), 3.0F);
}

TEST(TerrainViewsTest, FliesAboveTheGround) {
    const scene::Scene scene = terrainScene();
    const TerrainView view(scene, "round_flight");
    for (int frame = 0; frame < 100; ++frame) {
        const scene::Camera camera = view.camera(frame, 100, 1.6F);
        EXPECT_GT(camera.position.y,
                  heightAt(*scene.heights, camera.position.x, camera.position.z) + camera.nearM);
    }
}

TEST(TerrainViewsTest, TheScenesOwnViewsComeFirst) {
    scene::Scene scene = terrainScene();
    const scene::Camera camera{.name = "valley", .position = {1.0F, 2.0F, 3.0F}};
    scene.cameras.push_back(camera);
    EXPECT_EQ(TerrainView(scene, "valley").camera(0, 1, 1.0F).position, camera.position);
    EXPECT_EQ(errorText([&] { TerrainView(scene, "moon"); }),
              "the scene has no path or camera 'moon'; paths: none; cameras: 'valley'; or 'AZIMUTH "
              "ELEVATION' in degrees, or 'X Y Z > X Y Z' from and to, with more such behind ';' a "
              "path; or overview, valley, steep, round_flight");
}

TEST(TerrainViewsTest, StandsWhereAUserSays) {
    const scene::Scene scene = terrainScene();  // 320 m wide, 0 to 96 m high
    const auto from = [&](const std::string& view, int frame = 0, int frames = 1) {
        return TerrainView(scene, view).camera(frame, frames, 1.5F);
    };
    const auto refused = [&](const std::string& view) { return errorText([&] { from(view); }); };
    EXPECT_EQ(from("10 70 300 > 160 0 100").position, glm::vec3(10, 70, 300));
    EXPECT_EQ(from("10 70 300 > 160 0 100").target, glm::vec3(160, 0, 100));
    EXPECT_EQ(from("30 60").position,
              scene::framingCamera(scene.bounds(), 1.5F, *kit::towardsEyeOf("30 60")).position);
    const std::string path = "10 60 100 > 160 0 100; 90 60 100 > 160 0 100";
    EXPECT_EQ(from(path).position.x, 50.0F);
    EXPECT_LT(from(path, 0, 2).position.x, 50.0F);
    EXPECT_GT(from(path, 1, 2).position.x, 50.0F);
    // Its near plane is a tenth of what lies between the eye and the ground.
    EXPECT_FLOAT_EQ(from("160 48.5 160 > 300 64 160").nearM, 0.05F);
    EXPECT_EQ(refused("160 48 160 > 300 64 160"),
              "view '160 48 160 > 300 64 160': the eye at 160 48 160 lies under the ground; "
              "allowed there: above 48");
    EXPECT_THAT(refused(path + "; 160 47 160 > 300 64 160"),
                HasSubstr("lies under the ground; allowed there: above 4"));
    EXPECT_EQ(from("-20 10 160 > 300 64 160").position.x, -20.0F);
    EXPECT_THAT(refused("-20 0 160 > 300 64 160"),
                HasSubstr("the eye at -20 0 160 lies under the ground; allowed there: above 0"));
    EXPECT_THAT(refused("30 -60"), HasSubstr("lies under the ground"));
}

}  // namespace
}  // namespace gfxrepro::terrain_tessellation
