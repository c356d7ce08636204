// Pictures of tessellated terrain: heights, culling, cracks.
#include <fmt/format.h>
#include <algorithm>

#include "techniques/terrain_tessellation/terrain_views.h"
#include "tests/support/grid.h"
#include "tests/techniques/terrain_tessellation/terrain_fixture.h"

namespace gfxrepro::terrain_tessellation {
namespace {

constexpr glm::ivec2 kPictureSize{160, 100};

/// Pixels that show the background with terrain above them in the same column.
int holesBelowSilhouette(const std::vector<glm::vec4>& pixels, glm::ivec2 size) {
    int holes = 0;
    for (int x = 0; x < size.x; ++x) {
        bool isBelow = false;
        for (int y = size.y - 1; y >= 0; --y) {
            const bool isDrawn = pixels[static_cast<std::size_t>(y * size.x + x)].a > 0.5F;
            isBelow = isBelow || isDrawn;
            if (isBelow && !isDrawn) ++holes;
        }
    }
    return holes;
}

TEST_F(TerrainTest, HeightsAtSamplesAreTheMaps) {
    makeTerrain(roughMap(257, 40.0F));
    RenderSettings set = settings();
    set.shading = Shading::Height;
    // Every sample is a vertex: 16 segments on the 16 of a patch. Eq. (4) itself gives the smallest
    // factor here, as the vertical AB shrinks to a point from above.
    set.factors.smallest = 16.0F;
    set.factors.greatest = 16.0F;
    set.hasSkirts = false;
    TerrainRenderer renderer(shaders, *terrain, set);
    // From straight above, half a metre a pixel at an even height would need an orthographic view:
    // scale the clip space of one directly, sample (i, j) in the middle of pixel (i, 63 − j).
    kit::View view = viewAt({0, 0, 0}, {0, -1, -0.001F}, {64, 64});
    view.eyeWorld = {32, 500, 32};
    view.viewFromWorld = glm::mat4(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1);
    view.clipFromView = glm::mat4(2.0F / 64, 0, 0, 0, 0, 2.0F / 64, 0, 0, 0, 0, 1.0F / 200, 0,
                                  0.5F * 2 / 64 - 1, 1 - 0.5F * 2 / 64, 0, 1);
    view.nearM = 0.01F;
    const auto pixels = picture({64, 64}, [&](const gl::Framebuffer& target) {
        renderer.drawTessellated(tilesOf(0), view, target);
    });
    for (int j = 1; j < 64; ++j) {
        for (int i = 1; i < 63; ++i) {
            const auto at = static_cast<std::size_t>((63 - j) * 64 + i);
            // The rasterizer's sub-pixel grid: a vertex lands within 1/256 pixel of the centre,
            // where neighbouring heights differ by a few metres.
            EXPECT_NEAR(pixels[at].r, map.heightM(i, j), 0.05F) << i << ' ' << j;
        }
    }
}

/// Flat ground of `side`² samples a metre apart, drawn, against the rectangle that it is.
struct FlatTerrainTest : TerrainTest {
    template <class Draw>
    void expectThePlane(int side, const Draw& draw) {
        const float last = static_cast<float>(side - 1);
        const kit::View view =
            viewAt({0.5F * last, 30, last + 44.0F}, {0.5F * last, 0, 100}, kPictureSize);
        const auto pixels = picture(
            kPictureSize, [&](const gl::Framebuffer& target) { draw(tilesOf(0), view, target); });
        int ground = 0, background = 0;
        std::optional<glm::vec4> first;
        for (const auto [y, x] : test::grid(kPictureSize.y, kPictureSize.x)) {
            const glm::vec2 px(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
            const glm::vec3 ray = kit::rayThrough(view, px);
            const float away = ray.y < 0.0F ? -view.eyeWorld.y / ray.y : -1.0F;
            const glm::vec3 hit = view.eyeWorld + away * ray;
            const float inside =
                std::min(std::min(hit.x, last - hit.x), std::min(hit.z, last - hit.z));
            if (away > 0.0F && std::abs(inside) < 3.0F) continue;  // on the rim
            const bool isTerrain = away > 0.0F && inside > 0.0F;
            const glm::vec4 pixel = pixels[static_cast<std::size_t>(y * kPictureSize.x + x)];
            ASSERT_EQ(pixel.a, isTerrain ? 1.0F : 0.0F) << x << ' ' << y;
            if (isTerrain && !first) first = pixel;
            if (isTerrain) EXPECT_LT(glm::distance(pixel, *first), 1e-5F);
            ++(isTerrain ? ground : background);
        }
        EXPECT_GT(ground, 4000);
        EXPECT_GT(background, 2000);
    }
};

// Tiles of 64 end with the map, beyond it by less than a patch, by patches, and all but a sample.
TEST_F(FlatTerrainTest, IsDrawnAsThePlaneAndEndsAtItsMapByEveryMethod) {
    for (const int side : {257, 250, 201, 130}) {
        makeTerrain(roughMap(side, 0.0F));
        for (const bool isCulling : {true, false}) {
            SCOPED_TRACE(fmt::format("{} {}", side, isCulling));
            RenderSettings set = settings();
            set.hasSkirts = false;
            set.cullsPatches = isCulling;
            TerrainRenderer renderer(shaders, *terrain, set);
            MorphRanges ranges;
            for (int level = 0; level < metadata->levelCount(); ++level) {
                ranges.rangesM.push_back(std::ldexp(60.0F, level));
            }
            expectThePlane(side, [&](const auto& tiles, const auto& view, const auto& target) {
                renderer.drawTessellated(tiles, view, target);
            });
            expectThePlane(side, [&](const auto& tiles, const auto& view, const auto& target) {
                renderer.drawGrid(tiles, view, target);
            });
            expectThePlane(side, [&](const auto& tiles, const auto& view, const auto& target) {
                renderer.drawGrid(tiles, view, target, &ranges);
            });
        }
    }
}

/// 256 by 256 m of a plane.
scene::HeightMap inclined(glm::vec2 spacingM) {
    scene::HeightMap map{.sizeSamples = glm::ivec2(256.0F / spacingM) + 1, .spacingM = spacingM};
    for (const auto [row, column] : test::grid(map.sizeSamples.y, map.sizeSamples.x)) {
        const glm::vec2 at = glm::vec2(column, row) * spacingM;
        map.heightsM.push_back(0.5F * at.x + 0.25F * at.y);
    }
    return map;
}

TEST_F(TerrainTest, SamplesThatStandFurtherApartOneWayShowTheSameGround) {
    const kit::View view = viewAt({128, 500, 500}, {128, 96, 128}, kPictureSize);
    std::vector<std::vector<glm::vec4>> pictures;
    for (const glm::vec2 spacingM : {glm::vec2(1, 1), glm::vec2(2, 1), glm::vec2(1, 2)}) {
        makeTerrain(inclined(spacingM));
        RenderSettings set = settings();
        set.factors.smallest = set.factors.greatest = 16.0F;  // every sample is a vertex
        set.hasSkirts = false;
        TerrainRenderer renderer(shaders, *terrain, set);
        pictures.push_back(picture(kPictureSize, [&](const gl::Framebuffer& target) {
            renderer.drawTessellated(tilesOf(0), view, target);
        }));
        pictures.push_back(picture(kPictureSize, [&](const gl::Framebuffer& target) {
            renderer.drawGrid(tilesOf(0), view, target);
        }));
    }
    int ground = 0, background = 0;
    for (const auto [y, x] : test::grid(kPictureSize.y, kPictureSize.x)) {
        const glm::vec3 slope(-0.5F, 1.0F, -0.25F), eye = view.eyeWorld;
        const glm::vec3 ray =
            kit::rayThrough(view, {static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F});
        const glm::vec3 hit = eye - glm::dot(eye, slope) / glm::dot(ray, slope) * ray;
        const float inside =
            std::min(std::min(hit.x, 256.0F - hit.x), std::min(hit.z, 256.0F - hit.z));
        if (std::abs(inside) < 6.0F) continue;  // on the rim, whose slope is halved
        ++(inside > 0.0F ? ground : background);
        const auto at = static_cast<std::size_t>(y * kPictureSize.x + x);
        for (const auto& pixels : pictures) {
            ASSERT_EQ(pixels[at].a, inside > 0.0F ? 1.0F : 0.0F) << x << ' ' << y;
            ASSERT_LT(glm::distance(pixels[at], pictures[0][at]), 1e-3F) << x << ' ' << y;
        }
    }
    EXPECT_GT(ground, 1000);
    EXPECT_GT(background, 1000);
}

TEST_F(TerrainTest, CullingChangesNoPixelAndDropsPatches) {
    makeTerrain(roughMap(257, 60.0F));
    RenderSettings set = settings();
    TerrainRenderer culling(shaders, *terrain, set);
    set.cullsPatches = false;
    TerrainRenderer whole(shaders, *terrain, set);
    std::mt19937 random(3);
    const auto anywhere = [&] { return static_cast<float>(random() % 256U); };
    int culled = 0;
    for (int i = 0; i < 6; ++i) {
        const glm::vec3 eye{anywhere(), 70.0F, anywhere()};
        const glm::vec3 target{anywhere(), 10.0F, anywhere()};
        const kit::View view = viewAt(eye, target, kPictureSize);
        DrawCounts fewer, all;
        const auto a = picture(kPictureSize, [&](const gl::Framebuffer& target) {
            culling.drawTessellated(tilesOf(0), view, target);
            fewer = culling.counts();
        });
        const auto b = picture(kPictureSize, [&](const gl::Framebuffer& target) {
            whole.drawTessellated(tilesOf(0), view, target);
            all = whole.counts();
        });
        EXPECT_EQ(a, b);
        EXPECT_EQ(all.culledPatches, 0);
        EXPECT_LT(fewer.triangles, all.triangles);
        culled += fewer.culledPatches;
    }
    EXPECT_GT(culled, 100);
}

TEST_F(TerrainTest, SkirtsHideTheCracksBetweenTilesOfDifferentLevels) {
    makeTerrain(roughMap(257, 60.0F));
    std::vector<Tile> mixed;  // the western half coarse, the eastern half fine
    for (const Tile& t : tilesOf(1)) {
        if (t.originSample.x < 128) mixed.push_back(t);
    }
    for (const Tile& t : tilesOf(0)) {
        if (t.originSample.x >= 128) mixed.push_back(t);
    }
    const auto holesOf = [&](bool hasSkirts, EdgeRule rule, const std::vector<Tile>& tiles) {
        RenderSettings set = settings();
        set.hasSkirts = hasSkirts;
        set.factors.edges = rule;
        set.factors.segmentPx = 6.0F;
        TerrainRenderer renderer(shaders, *terrain, set);
        std::mt19937 random(11);
        int holes = 0;
        for (int i = 0; i < 12; ++i) {
            const auto about = [&](float low, float high) {
                return low + (high - low) * static_cast<float>(random() % 1000U) / 1000.0F;
            };
            const glm::vec3 eye{about(40, 216), about(70, 110), about(40, 216)};
            const kit::View view =
                viewAt(eye, eye + glm::vec3{about(-30, 30), -about(60, 90), 20.0F}, kPictureSize);
            holes += holesBelowSilhouette(picture(kPictureSize,
                                                  [&](const gl::Framebuffer& target) {
                                                      renderer.drawTessellated(tiles, view, target);
                                                  }),
                                          kPictureSize);
        }
        return holes;
    };
    EXPECT_EQ(holesOf(true, EdgeRule::Shared, mixed), 0);
    EXPECT_GT(holesOf(false, EdgeRule::Shared, mixed), 0);         // negative control
    EXPECT_EQ(holesOf(false, EdgeRule::Shared, tilesOf(0)), 0);    // one level needs none
    EXPECT_GT(holesOf(false, EdgeRule::OwnPatch, tilesOf(0)), 0);  // negative control, figure 9
}

TEST_F(TerrainTest, SplittingChangesNoPixel) {
    makeTerrain(roughMap(257, 40.0F));
    RenderSettings set = settings();
    const kit::View view = viewAt({128, 70, 300}, {128, 0, 100}, kPictureSize);
    std::vector<std::vector<glm::vec4>> pictures;
    std::vector<DrawCounts> counts;
    for (const int limit : {0, 1500}) {
        set.batches.reset();
        if (limit > 0) set.batches = BatchLimits{limit, limit / 2};
        TerrainRenderer renderer(shaders, *terrain, set);
        pictures.push_back(picture(kPictureSize, [&](const gl::Framebuffer& target) {
            renderer.drawTessellated(tilesOf(0), view, target);
            counts.push_back(renderer.counts());
        }));
    }
    EXPECT_EQ(pictures[0], pictures[1]);
    EXPECT_EQ(counts[0].triangles, counts[1].triangles);
    EXPECT_EQ(counts[0].drawCalls, 1);
    EXPECT_GT(counts[1].drawCalls, 10);
    // What batches expect is no less than what is drawn.
    const std::vector<Tile> tiles = tilesOf(0);
    double bound = 0.0;
    for (const PatchBatch& batch :
         batchPatches(*metadata, set.factors, view, {tiles, true, -1.0F, true}, {1500, 750})
             .batches) {
        bound += batch.triangles;
    }
    EXPECT_GE(bound, static_cast<double>(counts[1].triangles));
    EXPECT_LT(bound, 3.0 * static_cast<double>(counts[1].triangles));
}

TEST_F(TerrainTest, RefusesAMapThatTheMetadataIsNotOf) {
    makeTerrain(roughMap(257, 1.0F));
    EXPECT_EQ(errorText([&] { DeviceTerrain(roughMap(65, 1.0F), *metadata); }),
              "height map of 65 × 65 samples with metadata of 257 × 257");
}

// Heights in pages: what a page holds, which pages go, and that pictures do not depend on it.

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
    const scene::Scene scene{.heights = map};
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
