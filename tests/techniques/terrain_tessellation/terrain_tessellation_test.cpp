// The technique as a whole: parameters, metrics, cracks and their control, terrain that is wrong.
#include "techniques/terrain_tessellation/terrain_tessellation.h"

#include <fmt/format.h>

#include <cmath>

#include "tests/support/grid.h"
#include "tests/techniques/technique_fixture.h"

namespace gfxrepro::terrain_tessellation {
namespace {

/// Waves of several lengths: levels differ.
scene::Scene terrain(glm::ivec2 size, float amplitudeM = 300.0F) {
    scene::Scene scene;
    scene::HeightMap map{.sizeSamples = size, .spacingM = glm::vec2(10.0F)};
    for (const auto [row, column] : test::grid(size.y, size.x)) {
        const double x = column, z = row;
        const double wave = std::sin(0.05 * x) * std::cos(0.04 * z) +
                            0.3 * std::sin(0.31 * x + 0.2 * z) +
                            0.1 * std::sin(1.3 * x) * std::sin(1.1 * z);
        map.heightsM.push_back(amplitudeM * static_cast<float>(1.5 + wave));
    }
    scene.heights = std::move(map);
    return scene;
}

struct TerrainTessellationTest : test::TechniqueTest {
    TerrainTessellationTest() : TechniqueTest(kTerrainTessellation, {96, 64}) {}

    std::map<std::string, double> measured(const std::string& yaml, const scene::Scene& scene) {
        return recorded("{cache: false, " + yaml + "}", &scene).metrics;
    }
};

TEST(TerrainTessellationParamsTest, RefusesWhatMeansNothing) {
    const std::string chequer =
        ": 'shading: patches' needs 'method: adaptive' or 'patches', without 'errors: true': the "
        "truth has none";
    test::expectRefused(
        kTerrainTessellation,
        {
            {"{}", ""},
            {"{tile_patches: 3}", "16: tile_patches 3 is no power of two"},
            {"{block: 32, patch_blocks: 4}",
             "27: a patch of 4 blocks of 32 segments is 128 wide; allowed: 64, the largest factor"},
            {"{method: uniform_grid, tau: 3}", "29: 'tau' needs another method"},
            {"{method: cdlod, skirts: false}", "25: 'skirts' needs 'method: adaptive'"},
            {"{method: cdlod, culling: tile_and_patch}",
             "26: 'culling: tile_and_patch' needs 'method: adaptive'"},
            {"{method: cdlod, seams: true}", "24: 'seams' needs 'method: adaptive'"},
            {"{method: patches, yardstick: true}", "30: 'yardstick' needs 'method: adaptive'"},
            {"{method: cdlod, shading: patches}", "26" + chequer},
            {"{errors: true, shading: patches}", "25" + chequer},
            {"{supersampling: 2}", "17: 'supersampling' needs 'errors: true' or 'pictures: true'"},
        });
}

TEST_F(TerrainTessellationTest, TheUniformGridHasNoErrorsButThoseOfDepths) {
    // Tiles of 32 cells, so that none reaches beyond the map.
    const auto m = measured(
        "method: uniform_grid, errors: true, culling: none, tile_patches: 1, patch_blocks: 1",
        terrain({129, 129}));
    EXPECT_EQ(m.at("drawn_triangles"), 2.0 * 128 * 128);
    EXPECT_EQ(m.at("crack_pixels/background"), 0.0);
    EXPECT_EQ(m.at("display_flip"), 0.0);
    EXPECT_EQ(m.at("channel_error"), 0.0);
    EXPECT_EQ(passes_, (std::vector<std::string>{"tile_walk", "load_tiles", "draw"}));
}

TEST_F(TerrainTessellationTest, TheTruthOfAViewIsMadeOnce) {
    const scene::Scene scene = terrain({257, 257});
    const std::string common = "cache: false, errors: true, pictures: true, tile_patches: 2, ";
    const std::size_t bytesOfOne = expectSharedAsAlone(common, {"delta_s: 4"}, scene);
    EXPECT_GT(bytesOfOne, 0U);
    // Each of what it is made regardless of.
    const std::vector<std::string> regardless = {"delta_s: 4",
                                                 "delta_s: 12",
                                                 "delta_s: 4, tau: 9",
                                                 "delta_s: 4, edges: own_patch",
                                                 "delta_s: 4, inner: maximum",
                                                 "delta_s: 4, partitioning: integer",
                                                 "delta_s: 4, skirts: false"};
    EXPECT_EQ(expectSharedAsAlone(common, regardless, scene), bytesOfOne);
    // What decides it.
    const std::vector<std::string> deciding = {
        "delta_s: 4",    "supersampling: 2", "wireframe: true",
        "culling: none", "view: overview",   "shading: generated_map",
        "block: 16",     "patch_blocks: 1",  "method: cdlod"};
    EXPECT_GT(expectSharedAsAlone(common, deciding, scene), 8 * bytesOfOne);
}

TEST_F(TerrainTessellationTest, AColourMapLiesOverTheMapNorthOnTop) {
    scene::Scene scene = terrain({129, 129}, 0.0F);  // flat: one light for all
    EXPECT_EQ(errorText([&] { measured("shading: colour_map", scene); }),
              "'shading: colour_map' needs a scene with a colour map; sources of height maps take "
              "one as 'colour_map'");
    // Red in the north-west, green in the north-east, blue in the south.
    image::Image8 map(2, 2, 3);
    map.at(0, 0, 0) = map.at(1, 0, 1) = map.at(0, 1, 2) = map.at(1, 1, 2) = 255;
    scene.textures.push_back(map);
    scene.materials.emplace_back().baseColorTexture = 0;
    const scene::Camera above{.name = "above",
                              .position = {640.0F, 2000.0F, 641.0F},
                              .target = {640.0F, 0.0F, 640.0F},
                              .verticalFovRad = 0.6F,
                              .nearM = 1.0F,
                              .farM = 5000.0F};
    scene.cameras = {above};
    for (const char* method : {"adaptive", "uniform_grid", "cdlod"}) {
        const auto recordedImages =
            recorded(fmt::format("{{cache: false, method: {}, shading: colour_map, view: above, "
                                 "pictures: true}}",
                                 method),
                     &scene)
                .images;
        const image::ImageF& picture = recordedImages.at("image");
        const auto strongest = [&](int x, int y) {
            int best = 0;
            for (int c = 1; c < 3; ++c) {
                if (picture.at(x, y, c) > picture.at(x, y, best)) best = c;
            }
            return best;
        };
        EXPECT_EQ(strongest(34, 16), 0) << method;
        EXPECT_EQ(strongest(62, 16), 1) << method;
        EXPECT_EQ(strongest(34, 48), 2) << method;
        EXPECT_EQ(strongest(62, 48), 2) << method;
    }
}

TEST_F(TerrainTessellationTest, TrianglesFallAndErrorsGrowWithDeltaS) {
    const scene::Scene scene = terrain({257, 257});
    double triangles = 1e12, error = -1.0;
    for (const char* deltaS : {"1", "4", "16"}) {
        const auto m = measured(fmt::format("delta_s: {}, errors: true", deltaS), scene);
        EXPECT_LT(m.at("drawn_triangles"), triangles) << deltaS;
        EXPECT_GT(m.at("height_error_m/mean"), error) << deltaS;
        EXPECT_EQ(m.at("factor_mismatches"), 0.0) << deltaS;
        EXPECT_EQ(m.at("crack_pixels/background"), 0.0) << deltaS;
        EXPECT_LT(m.at("tile_error_px"), 4.0);
        triangles = m.at("drawn_triangles");
        error = m.at("height_error_m/mean");
    }
}

TEST_F(TerrainTessellationTest, OnlyTheMapsCellsAreDrawnOfATileBeyondItsRim) {
    const auto m = measured("method: uniform_grid, culling: none", terrain({200, 90}));
    // Two triangles a cell, of 199 × 89 cells an even count a side.
    EXPECT_EQ(m.at("drawn_triangles"), 2.0 * 200 * 90);
}

TEST_F(TerrainTessellationTest, TheTruthHasNoHeightError) {
    const scene::Scene scene = terrain({257, 257});
    const auto truth = measured("method: uniform_grid, errors: true", scene);
    const auto coarse = measured("delta_s: 4, errors: true", scene);
    EXPECT_LT(truth.at("height_error_px/mean"), 0.01 * coarse.at("height_error_px/mean"));
    EXPECT_LT(truth.at("height_error_px/max"), 0.05);
}

TEST_F(TerrainTessellationTest, SpacingsMayDiffer) {
    scene::Scene scene = terrain({257, 257});
    const std::string adaptive = "delta_s: 1, seams: true, errors: true, pictures: true";
    const auto even = measured(adaptive, scene);
    scene.heights->spacingM = {10.0F, 20.0F};
    EXPECT_LT(measured("method: uniform_grid, errors: true", scene).at("height_error_px/max"),
              0.05);
    const auto uneven = recorded("{cache: false, " + adaptive + "}", &scene);
    EXPECT_LT(uneven.metrics.at("height_error_px/mean"), 1.5 * even.at("height_error_px/mean"));
    for (const char* none : {"open_edges", "factor_mismatches", "crack_pixels/background"}) {
        EXPECT_EQ(uneven.metrics.at(none), 0.0) << none;
    }
    EXPECT_EQ(uneven.images.at("culling").width(), 32) << "to scale";
    EXPECT_EQ(uneven.images.at("culling").height(), 64);
}

TEST_F(TerrainTessellationTest, UnequalFactorsCrack) {
    const scene::Scene scene = terrain({257, 257});
    const std::string yaml =
        "delta_s: 8, tau: 0, skirts: false, errors: true, supersampling: 4, edges: ";
    const auto shared = measured(yaml + "shared", scene),
               unequal = measured(yaml + "own_patch", scene);
    EXPECT_EQ(shared.at("crack_pixels/background"), 0.0);
    // Seen edge-on, a triangle may turn over when the device rounds its corners.
    EXPECT_LE(shared.at("crack_pixels/underside"), 2.0);
    EXPECT_GT(unequal.at("crack_pixels/underside"), 2.0);
}

TEST_F(TerrainTessellationTest, SeamsFactorsAndRatesAreRecorded) {
    const scene::Scene scene = terrain({257, 257});
    const auto m = measured(
        "seams: true, yardstick: true, delta_s: 2, tile_patches: 2, tau: 0, culling: none", scene);
    EXPECT_EQ(m.at("open_edges"), 0.0);
    EXPECT_GT(m.at("seam_edges/tiles"), 0.0);
    EXPECT_GT(m.at("seam_edges"), m.at("seam_edges/patches"));
    EXPECT_GT(m.at("unclamped_edges"), 0.0);
    EXPECT_EQ(m.at("unhalved_edges"), 0.0);
    EXPECT_LE(m.at("most_patch_vertices"), 65.0 * 65.0);
    EXPECT_GT(m.at("yardstick_ms"), 0.0);
    EXPECT_LT(m.at("surface_triangles"), m.at("drawn_triangles"));
    EXPECT_EQ(measured("delta_s: 2, tile_patches: 2, tau: 0, culling: none, skirts: false", scene)
                  .at("drawn_triangles"),
              m.at("surface_triangles"));
    EXPECT_GT(measured("seams: true, edges: own_patch, delta_s: 2", scene).at("open_edges"), 0.0);
}

TEST_F(TerrainTessellationTest, AGeneratedMapLiesOverAnyTerrain) {
    const scene::Scene scene = terrain({129, 129});
    const auto picture = [&](const std::string& shading) {
        return recorded("{cache: false, pictures: true, shading: " + shading + "}", &scene)
            .images.at("image");
    };
    EXPECT_FALSE(picture("generated_map") == picture("slope_altitude"));
}

TEST_F(TerrainTessellationTest, CullingLeavesThePictureAsItIs) {
    const scene::Scene scene = terrain({257, 257});
    const auto run = [&](const char* culling) {
        return recorded(fmt::format("{{cache: false, pictures: true, culling: {}}}", culling),
                        &scene);
    };
    const auto none = run("none"), tile = run("tile"), patch = run("tile_and_patch");
    EXPECT_LT(patch.metrics.at("drawn_triangles"), tile.metrics.at("drawn_triangles"));
    EXPECT_LE(tile.metrics.at("drawn_triangles"), none.metrics.at("drawn_triangles"));
    EXPECT_GT(patch.metrics.at("culled_patches"), 0.0);
    EXPECT_EQ(tile.metrics.at("culled_patches"), 0.0);
    EXPECT_TRUE(none.images.at("image") == tile.images.at("image"));
    EXPECT_TRUE(none.images.at("image") == patch.images.at("image"));
}

// Skirts of tiles that reach beyond the map hang from its rim.
TEST_F(TerrainTessellationTest, CullingLeavesSkirtsAtARimWithinATile) {
    const scene::Scene scene = terrain({200, 90});
    for (const char* view : {"overview", "30 20", "120 30", "210 20", "300 30"}) {
        const auto run = [&](const char* culling) {
            return recorded(fmt::format("{{cache: false, pictures: true, tau: 0, tile_patches: 2, "
                                        "view: {}, culling: {}}}",
                                        view, culling),
                            &scene);
        };
        const auto none = run("none"), patch = run("tile_and_patch");
        EXPECT_TRUE(none.images.at("image") == patch.images.at("image")) << view;
        // All is in view: what reaches the picture from beyond the map has no triangles.
        EXPECT_EQ(none.metrics.at("drawn_triangles"), patch.metrics.at("drawn_triangles")) << view;
    }
}

TEST_F(TerrainTessellationTest, TheMapOfCulledPatchesCountsThem) {
    // 256 cells and 256 pixels: each patch of 16 cells has pixels inside of its borders.
    outputSizePx_ = {256, 256};
    const scene::Scene scene = terrain({257, 257});
    const auto areas = [&](const std::string& culling) {
        const auto recorder = recorded(
            "{cache: false, pictures: true, tau: 0, block: 8, culling: " + culling + "}", &scene);
        const image::ImageF& map = recorder.images.at("culling");
        EXPECT_EQ(map.width(), 256);
        EXPECT_EQ(map.height(), 256);
        // By hue at each patch's centre: green is drawn, orange a culled patch, grey a culled tile.
        glm::ivec3 found(0);
        for (int y = 8; y < 256; y += 16) {
            for (int x = 8; x < 256; x += 16) {
                const float red = map.at(x, y, 0), green = map.at(x, y, 1), blue = map.at(x, y, 2);
                ++found[blue > red ? 2 : red > green ? 1 : 0];
            }
        }
        EXPECT_EQ(found.x + found.y, recorder.metrics.at("patches"));
        EXPECT_EQ(found.y, recorder.metrics.at("culled_patches"));
        return found;
    };
    EXPECT_EQ(areas("none"), glm::ivec3(256, 0, 0));
    const glm::ivec3 tile = areas("tile"), patch = areas("tile_and_patch");
    EXPECT_EQ(tile.y, 0);
    EXPECT_GT(tile.z, 0);
    EXPECT_EQ(patch.z, tile.z);
    EXPECT_GT(patch.y, 0);
}

TEST_F(TerrainTessellationTest, ASmallBudgetLoadsTilesAgain) {
    const scene::Scene scene = terrain({257, 257});
    const std::string yaml = "tau: 0, tile_patches: 2, patch_blocks: 1, height_memory_mib: ";
    const auto all = measured(yaml + "16", scene), few = measured(yaml + "0.05", scene);
    EXPECT_EQ(all.at("loaded_tiles"), 0.0);  // the first of the two frames loaded them
    EXPECT_EQ(few.at("loaded_tiles"), few.at("tiles"));
    EXPECT_EQ(few.at("drawn_triangles"), all.at("drawn_triangles"));
    EXPECT_EQ(few.at("culled_patches"), all.at("culled_patches"));
    EXPECT_EQ(errorText([&] { measured(yaml + "0.01", scene); }),
              "0.01 MiB for heights hold no tile of 68 × 68; allowed: 0.02 MiB or more");
}

TEST_F(TerrainTessellationTest, UntessellatedPatchesAreTwoTriangles) {
    const auto m = measured("method: patches, culling: none", terrain({257, 257}));
    EXPECT_EQ(m.at("drawn_triangles"), 2.0 * m.at("patches"));
}

TEST_F(TerrainTessellationTest, EveryViewAndMethodDraws) {
    const scene::Scene scene = terrain({200, 90});
    for (const char* method : {"adaptive", "patches", "uniform_grid", "cdlod"}) {
        for (const char* view : {"overview", "valley", "steep", "round_flight"}) {
            const auto m = measured(fmt::format("method: {}, view: {}", method, view), scene);
            EXPECT_GT(m.at("drawn_triangles"), 0.0) << method << " " << view;
        }
    }
}

TEST_F(TerrainTessellationTest, PatchesAreAChequerWhereThereAreAny) {
    const scene::Scene scene = terrain({257, 257});
    const std::string chequer = "shading: patches, pictures: true, view: steep, method: ";
    EXPECT_GT(measured(chequer + "adaptive", scene).at("patches"), 1.0);
    EXPECT_GT(measured(chequer + "patches", scene).at("patches"), 1.0);
}

TEST_F(TerrainTessellationTest, DrawsTinyAndFlatTerrain) {
    for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(2, 2), glm::ivec2(5, 1)}) {
        measured("errors: true", terrain(size));
    }
    const auto m = measured("errors: true", terrain({65, 65}, 0.0F));
    EXPECT_LT(m.at("height_error_m/max"), 0.01);
    EXPECT_EQ(m.at("crack_pixels/background"), 0.0);
}

TEST_F(TerrainTessellationTest, APlainHasOneColourAtAnyHeight) {
    const auto picture = [&](float heightM) {
        scene::Scene plain = terrain({65, 65});
        std::ranges::fill(plain.heights->heightsM, heightM);
        return recorded("{cache: false, view: steep, pictures: true}", &plain).images.at("image");
    };
    const image::ImageF atZero = picture(0.0F);
    for (const float heightM : {0.5F, 500.0F, 8000.0F, -400.0F}) {
        const image::ImageF high = picture(heightM);
        int others = 0;  // at the plain's border rounding moves an edge
        for (std::size_t i = 0; i < high.values().size(); ++i) {
            others += std::abs(high.values()[i] - atZero.values()[i]) > 0.02F ? 1 : 0;
        }
        EXPECT_LE(others, static_cast<int>(high.values().size()) / 100) << heightM;
    }
}

// From straight above a map of 1280 m, at 0 m: as much of the picture as a square of its width has.
TEST_F(TerrainTessellationTest, DrawsWhatAUsersViewHolds) {
    const scene::Scene plain = terrain({129, 129}, 0.0F);
    for (const float eyeM : {3000.0F, 6000.0F}) {
        for (const char* method : {"adaptive", "uniform_grid", "cdlod"}) {
            const image::ImageF picture =
                recorded(fmt::format("{{cache: false, pictures: true, method: {}, view: 640 {} 640 "
                                     "> 640 0 640}}",
                                     method, eyeM),
                         &plain)
                    .images.at("image");
            int ground = 0;  // the sky is blue
            for (int i = 0; i < picture.width() * picture.height(); ++i) {
                const int x = i % picture.width(), y = i / picture.width();
                ground += picture.at(x, y, 2) > picture.at(x, y, 1) + 0.2F ? 0 : 1;
            }
            const float sidePx = 1280.0F * 0.5F * static_cast<float>(picture.height()) /
                                 (eyeM * std::tan(0.5F * scene::Camera().verticalFovRad));
            EXPECT_NEAR(std::sqrt(static_cast<float>(ground)), sidePx, 1.0F) << method << eyeM;
        }
    }
}

TEST_F(TerrainTessellationTest, SeesNothingFromUnderTheGroundAndFarOutside) {
    scene::Scene scene = terrain({129, 129});
    scene::Camera camera{
        .name = "far", .position = {1e6F, 500.0F, 1e6F}, .target = {2e6F, 500.0F, 2e6F}};
    scene.cameras.push_back(camera);
    camera.name = "under";
    camera.position = {640.0F, 1.0F, 640.0F};
    camera.target = {700.0F, 1.0F, 700.0F};
    scene.cameras.push_back(camera);
    const auto far = measured("view: far, errors: true", scene);
    EXPECT_EQ(far.at("tiles"), 0.0);
    EXPECT_EQ(far.at("drawn_triangles"), 0.0);
    EXPECT_EQ(far.at("height_error_px/max"), 0.0);
    measured("view: under, errors: true", scene);
}

TEST_F(TerrainTessellationTest, NeedsHeights) {
    EXPECT_EQ(errorText([&] { recorded("{}", nullptr); }),
              "the technique needs a scene, and the case has none");
    const scene::Scene nothing;
    EXPECT_EQ(errorText([&] { recorded("{}", &nothing); }),
              "technique 'terrain_tessellation' needs a scene with a height map");
}

}  // namespace
}  // namespace gfxrepro::terrain_tessellation
