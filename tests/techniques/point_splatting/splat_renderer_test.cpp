// Splats on the device against known pictures: planes, spheres, sheets, and what degenerates.
#include "techniques/point_splatting/splat_renderer.h"

#include <glm/gtc/constants.hpp>

#include "tests/techniques/point_splatting/splat_fixture.h"

namespace gfxrepro::point_splatting {
namespace {

constexpr glm::ivec2 kSize(96);
const glm::vec3 kLight = glm::normalize(SplatSettings{}.lightDirectionView);

/// The ray of a pixel's centre, at depth 1 before the eye.
glm::dvec3 rayOf(const PatchView& view, int x, int y) {
    const glm::dvec2 away =
        glm::dvec2(x + 0.5, y + 0.5) - 0.5 * glm::dvec2(view.sizePx.x, view.sizePx.y);
    return {away / static_cast<double>(view.focalPx), -1.0};
}

/// Every pixel whose ray meets the turned sheet well inside of it must have the sheet's colour,
/// lit.
void expectSheet(const Picture& picture, const PatchView& view, double distance, double half,
                 double turnRad, const glm::dvec3& color) {
    const glm::dvec3 normal(std::sin(turnRad), 0.0, std::cos(turnRad));
    const glm::dvec3 along(std::cos(turnRad), 0.0, -std::sin(turnRad));
    int inside = 0;
    for (int y = 0; y < view.sizePx.y; ++y) {
        for (int x = 0; x < view.sizePx.x; ++x) {
            const glm::dvec3 ray = rayOf(view, x, y), eye(0.0, 0.0, distance);
            const glm::dvec3 hit = eye - glm::dot(normal, eye) / glm::dot(normal, ray) * ray;
            if (std::abs(glm::dot(hit, along)) > 0.95 * half || std::abs(hit.y) > 0.95 * half) {
                continue;
            }
            ++inside;
            const glm::dvec3 expected =
                shadedReference(color, normal, -glm::normalize(ray), glm::dvec3(kLight));
            const glm::ivec4 found = picture.at(x, y);
            ASSERT_EQ(found.a, 255) << x << ", " << y;
            for (int c = 0; c < 3; ++c) {
                // One step, and half a step of rounding.
                ASSERT_NEAR(found[c], expected[c], 1.5) << x << ", " << y << " of " << c;
            }
        }
    }
    EXPECT_GT(inside, 1500);
}

TEST_F(SplatTest, PlanesAreOfOneColourInEveryMode) {
    const glm::vec3 color(0.2158605F, 0.5028865F, 0.0703601F);  // sRGB 128, 188, 75
    constexpr float kDistance = 3.0F, kHalf = 0.95F;
    const PatchView view = viewFrom(kDistance, kSize);
    for (const float turnRad : {0.0F, 0.6F, 1.1F}) {
        const ModelFile model = modelOf(sheet(200, kHalf, 0.0F, turnRad, color));
        for (const PointStorage storage : {PointStorage::Compressed, PointStorage::Uncompressed}) {
            SplatRenderer renderer(shaders, model, {.storage = storage}, kSize);
            for (const SplatMode mode : {SplatMode::FullEwa, SplatMode::Reconstruction,
                                         SplatMode::LowPass, SplatMode::Sprite}) {
                SCOPED_TRACE(testing::Message()
                             << "turned by " << turnRad << ", mode " << static_cast<int>(mode)
                             << ", storage " << static_cast<int>(storage));
                const Picture picture = render(renderer, everything(model, mode), view);
                if (storage == PointStorage::Uncompressed) {
                    expectSheet(picture, view, kDistance, kHalf, static_cast<double>(turnRad),
                                glm::dvec3(color));
                } else {
                    // Half a step of theta and phi turns the light by less than 2 steps of 255.
                    const Picture full =
                        renderModel(model, mode, view, {.storage = PointStorage::Uncompressed});
                    EXPECT_LT(meanDifference(picture, full), 2.0);
                }
            }
        }
    }
}

TEST_F(SplatTest, SumsOfWeightsLeaveTheirMean) {
    const ModelFile model = modelOf(sheet(150, 0.95F, 0.0F, 0.9F));
    SplatRenderer renderer(shaders, model, {.storage = PointStorage::Uncompressed}, kSize);
    const glm::vec3 normal = model.normals()[0];
    for (const SplatMode mode : kEwaModes) {
        render(renderer, everything(model, mode), viewFrom(3.0F, kSize));
        const auto sums = renderer.accumulated().read<float>(GL_RGBA, GL_FLOAT, 4);
        int covered = 0;
        for (std::size_t i = 0; i < sums.size(); i += 4) {
            if (sums[i + 3] < 0.1F) continue;
            ++covered;
            for (std::size_t c = 0; c < 3; ++c) {
                // Dozens of sums in half floats, which llvmpipe cuts off: up to 2⁻¹¹ each.
                ASSERT_NEAR(sums[i + c] / sums[i + 3], normal[static_cast<int>(c)], 0.006F);
            }
        }
        EXPECT_GT(covered, 1500);
    }
}

TEST_F(SplatTest, FullEwaIsTheReconstructionFilterForLargeSplats) {
    const ModelFile model = modelOf(sphere(1500));
    const PatchView view = viewFrom(4.0F, glm::ivec2(256));
    const Picture full = renderModel(model, SplatMode::FullEwa, view);
    // Discs of 16 pixels; what differs lies along the silhouette.
    EXPECT_LT(meanDifference(full, renderModel(model, SplatMode::Reconstruction, view)), 0.6);
    EXPECT_GT(meanDifference(full, renderModel(model, SplatMode::LowPass, view)), 20.0);
}

TEST_F(SplatTest, FullEwaIsTheLowPassFilterForSmallSplats) {
    const ModelFile model = modelOf(sphere(60000));
    const PatchView view = viewFrom(14.0F, glm::ivec2(64));
    const Picture full = renderModel(model, SplatMode::FullEwa, view);
    // Discs of a tenth of a pixel.
    EXPECT_LT(meanDifference(full, renderModel(model, SplatMode::LowPass, view)), 0.6);
}

TEST_F(SplatTest, FarSheetsDoNotShineThroughAndNearOnesBlend) {
    constexpr float kRadius = 0.85F * 2.0F * 0.6F / 60.0F;
    const PatchView view = viewFrom(3.0F, kSize);
    const auto behind = [&](float gap) {
        scene::PointCloud points = sheet(60, 0.6F, 0.0F, 0.0F, {1.0F, 0.0F, 0.0F});
        append(points, sheet(60, 0.6F, -gap, 0.0F, {0.0F, 1.0F, 0.0F}));
        return modelOf(points);
    };
    const SplatSettings settings{.storage = PointStorage::Uncompressed};
    // Without light but the ambient one, and no highlight.
    SplatSettings dark = settings;
    dark.lightDirectionView = {0.0F, 0.0F, -1.0F};
    for (const SplatMode mode : {SplatMode::FullEwa, SplatMode::Reconstruction}) {
        const Picture apart = renderModel(behind(1.5F * kRadius), mode, view, dark);
        const Picture close = renderModel(behind(0.5F * kRadius), mode, view, dark);
        for (int y = 36; y < 60; ++y) {
            for (int x = 36; x < 60; ++x) {
                ASSERT_EQ(apart.at(x, y).g, 0);
                ASSERT_NEAR(apart.at(x, y).r, 25.5, 1.0);
                ASSERT_NEAR(close.at(x, y).g, 12.75, 3.0);
            }
        }
    }
}

double psnr(const Picture& a, const Picture& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const glm::dvec3 away(glm::ivec3(a.pixels[i]) - glm::ivec3(b.pixels[i]));
        sum += glm::dot(away, away) / 3.0;
    }
    const double mean = sum / static_cast<double>(a.pixels.size());
    return 10.0 * std::log10(255.0 * 255.0 / mean);
}

TEST_F(SplatTest, CompressedPointsLookLikeUncompressedOnes) {
    const ModelFile model = modelOf(sphere(40000));
    const PatchView view = viewFrom(4.0F, glm::ivec2(256));
    const SplatSettings full{.storage = PointStorage::Uncompressed};
    for (const SplatMode mode : {SplatMode::FullEwa, SplatMode::Reconstruction}) {
        EXPECT_GT(psnr(renderModel(model, mode, view), renderModel(model, mode, view, full)), 45.0);
    }
    EXPECT_GT(psnr(renderModel(model, SplatMode::Sprite, view),
                   renderModel(model, SplatMode::Sprite, view, full)),
              38.0);
}

TEST_F(SplatTest, PointsTakeEightBytesOrSixty) {
    const ModelFile model = modelOf(sphere(5000));
    const SplatRenderer compressed(shaders, model, {}, kSize);
    EXPECT_EQ(compressed.pointBytes(), 8U * 5000 + 4 * model.radiusTable().size());
    const SplatRenderer full(shaders, model, {.storage = PointStorage::Uncompressed}, kSize);
    EXPECT_EQ(full.pointBytes(), 60U * 5000);
    EXPECT_EQ(full.targetBytes(), 96U * 96 * (4 + 8 + 4));
}

scene::PointCloud onePoint(const glm::vec3& position, const glm::vec3& normal, float radius) {
    scene::PointCloud points;
    points.positions = {position};
    points.normals = {normal};
    points.radii = {radius};
    return points;
}

int coveredPixels(const Picture& picture) {
    return static_cast<int>(std::count_if(picture.pixels.begin(), picture.pixels.end(),
                                          [](const glm::u8vec4& p) { return p.a > 0; }));
}

TEST_F(SplatTest, OneSpriteIsASquareAndOneSplatAnEllipse) {
    const PatchView view = viewFrom(3.0F, kSize);
    const float radius = 10.0F * 3.0F / view.focalPx;  // 10 pixels
    const glm::vec3 slanted(std::sin(1.0F), 0.0F, std::cos(1.0F));
    const ModelFile model = modelOf(onePoint(glm::vec3(0.0F), slanted, radius));
    EXPECT_EQ(coveredPixels(renderModel(model, SplatMode::Sprite, view)), 400);
    // Half axes of two standard deviations, one of them foreshortened.
    const double area = glm::pi<double>() * 20.0 * 20.0 * std::cos(1.0);
    EXPECT_NEAR(coveredPixels(renderModel(model, SplatMode::Reconstruction, view)), area, 25.0);
    const double foreshortened = std::sqrt(100.0 * std::pow(std::cos(1.0), 2.0) + 0.49);
    EXPECT_NEAR(coveredPixels(renderModel(model, SplatMode::FullEwa, view)),
                glm::pi<double>() * 4.0 * std::sqrt(100.49) * foreshortened, 25.0);
    EXPECT_NEAR(coveredPixels(renderModel(model, SplatMode::LowPass, view)),
                glm::pi<double>() * 4.0 * 0.49, 4.0);
}

TEST_F(SplatTest, EdgeOnSplatsStayAPixelWide) {
    const PatchView view = viewFrom(3.0F, kSize);
    const float radius = 10.0F * 3.0F / view.focalPx;
    const ModelFile model =
        modelOf(onePoint({0.8F * 3.0F / view.focalPx, 0.0F, 0.0F}, {1, 0, 0}, radius));
    const Picture picture = renderModel(model, SplatMode::Reconstruction, view,
                                        {.storage = PointStorage::Uncompressed});
    int rows = 0;
    for (int y = 0; y < kSize.y; ++y) {
        bool isCovered = false;
        for (int x = 0; x < kSize.x; ++x) isCovered = isCovered || picture.at(x, y).a > 0;
        rows += isCovered ? 1 : 0;
    }
    // 0.3 pixels from their centres: reached by 32 of the ellipse's 40 rows.
    EXPECT_NEAR(rows, 32, 2);
}

TEST_F(SplatTest, NothingDegenerateBreaksASum) {
    const PatchView view = viewFrom(3.0F, kSize);
    const glm::vec3 towards(0.0F, 0.0F, 1.0F), sideways(1.0F, 0.0F, 0.0F);
    struct Case {
        const char* name;
        scene::PointCloud points;
        std::array<bool, 4> isSeen;  // by mode
    };
    const std::vector<Case> cases{
        {"all but edge-on",
         onePoint({0.01F, 0.0F, 0.0F}, sideways, 0.1F),
         {true, true, true, true}},
        // Without area it has no weight where filters keep areas.
        {"edge-on", onePoint(glm::vec3(0.0F), sideways, 0.1F), {false, false, false, true}},
        {"behind the eye", onePoint({0.0F, 0.0F, 5.0F}, towards, 0.1F), {}},
        {"in the eye", onePoint({0.0F, 0.0F, 3.0F}, towards, 0.1F), {}},
        {"on the near plane", onePoint({0.0F, 0.0F, 2.9F}, towards, 0.1F), {}},
        // Its disc reaches into the window, its centre does not.
        {"beside the window",
         onePoint({2.0F, 0.0F, 2.8F}, towards, 1.0F),
         {true, true, false, false}},
        {"of a huge radius", onePoint(glm::vec3(0.0F), towards, 1e30F), {true, true, true, true}},
        {"huge and edge-on",
         onePoint(glm::vec3(0.0F), sideways, 1e30F),
         {false, false, false, true}},
        {"of no radius to speak of",
         onePoint(glm::vec3(0.0F), towards, 1e-30F),
         {false, false, false, true}}};
    for (const Case& c : cases) {
        const ModelFile model = modelOf(c.points);
        SplatRenderer renderer(shaders, model, {.storage = PointStorage::Uncompressed}, kSize);
        for (const SplatMode mode : {SplatMode::FullEwa, SplatMode::Reconstruction,
                                     SplatMode::LowPass, SplatMode::Sprite}) {
            SCOPED_TRACE(testing::Message() << c.name << ", mode " << static_cast<int>(mode));
            const Picture picture = render(renderer, everything(model, mode), view);
            for (const float sum : renderer.accumulated().read<float>(GL_RGBA, GL_FLOAT, 4)) {
                ASSERT_TRUE(std::isfinite(sum));
            }
            const bool isSeen = c.isSeen[static_cast<std::size_t>(mode)];
            EXPECT_EQ(coveredPixels(picture) > 0, isSeen);
            device.finish(c.name);
        }
    }
}

TEST_F(SplatTest, SplatsTurnedAwayAreNotDrawn) {
    const PatchView view = viewFrom(3.0F, kSize);
    for (const SplatMode mode :
         {SplatMode::FullEwa, SplatMode::Reconstruction, SplatMode::LowPass, SplatMode::Sprite}) {
        const auto coveredAt = [&](float turnRad) {
            return coveredPixels(renderModel(modelOf(sheet(40, 0.5F, 0.0F, turnRad)), mode, view));
        };
        EXPECT_GT(coveredAt(1.4F), 0);
        EXPECT_EQ(coveredAt(2.0F), 0);
        EXPECT_EQ(coveredAt(3.1F), 0);
    }
}

TEST_F(SplatTest, NothingDrawnIsAnEmptyPicture) {
    const ModelFile model = modelOf(sphere(500));
    const PatchView view = viewFrom(4.0F, kSize);
    SplatRenderer renderer(shaders, model, {}, kSize);
    EXPECT_GT(coveredPixels(render(renderer, everything(model, SplatMode::Sprite), view)), 1000);
    EXPECT_EQ(coveredPixels(render(renderer, {}, view)), 0);
}

TEST_F(SplatTest, ALevelIsAPrefixWithItsOwnRadii) {
    const ModelFile model = modelOf(sphere(4000));
    const DevicePoints points(model, PointStorage::Compressed);
    std::vector<DrawnPatch> drawn = everything(model, SplatMode::Reconstruction);
    drawn.front().level = 2;
    drawn.back().mode = SplatMode::FullEwa;
    DrawList list;
    list.assign(points, drawn, 100, 300);
    std::uint32_t expected = 0, found = 0;
    for (const DrawnPatch& d : drawn) {
        expected += model.levels()[model.patches()[d.patch].firstLevel + d.level].count;
    }
    for (const Batch& batch : list.batches) {
        std::uint32_t inBatch = 0;
        for (std::uint32_t i = 0; i < batch.rangeCount; ++i) {
            EXPECT_LE(list.ranges[batch.firstRange + i].count, 100U);
            inBatch += list.ranges[batch.firstRange + i].count;
        }
        EXPECT_EQ(inBatch, batch.pointCount);
        EXPECT_LT(inBatch, 400U);
        found += inBatch;
    }
    EXPECT_EQ(found, expected);
    EXPECT_EQ(list.batches.front().mode, SplatMode::FullEwa);
    const Patch& first = model.patches()[0];
    const Level& level = model.levels()[first.firstLevel + 2];
    const PointRange& range = list.ranges[list.batches[1].firstRange];
    EXPECT_EQ(range.first, first.firstPoint);
    EXPECT_EQ(range.count, level.count);
    EXPECT_EQ(list.records[range.record].boxMinScale,
              glm::vec4(first.bounds.min, level.radiusScale));
}

}  // namespace
}  // namespace gfxrepro::point_splatting
