// Splats on the device against known pictures: planes, spheres, sheets, and what degenerates.
#include "techniques/point_splatting/splat_renderer.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "tests/support/grid.h"
#include "tests/techniques/point_splatting/splat_fixture.h"
#include "tests/techniques/point_splatting/splat_math.h"

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
    for (const auto [y, x] : test::grid(view.sizePx.y, view.sizePx.x)) {
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

TEST_F(SplatTest, OutlinesOfFullEwaAreCoveredByTheirShare) {
    constexpr float kDistance = 5.0F;
    const PatchView view = viewFrom(kDistance, kSize);
    const ModelFile model = modelOf(sphere(40000));
    const SplatSettings settings{.lowPassRadiusPx = 0.5F, .cutoff = 1.5F};
    const Picture picture = renderModel(model, SplatMode::FullEwa, view, settings);
    // The unit sphere's outline is a circle, of the angle whose sine is 1 / distance.
    const double radiusPx = static_cast<double>(view.focalPx) /
                            std::sqrt(static_cast<double>(kDistance * kDistance) - 1.0);
    double covered = 0.0;
    int partly = 0;
    for (const auto [y, x] : test::grid(kSize.y, kSize.x)) {
        const double alpha = picture.at(x, y).a / 255.0;
        covered += alpha;
        partly += alpha > 0.05 && alpha < 0.95 ? 1 : 0;
        const double beyond = glm::length(glm::dvec2(x + 0.5, y + 0.5) - 48.0) - radiusPx;
        if (beyond < -1.5) ASSERT_EQ(picture.at(x, y).a, 255) << x << ", " << y;
        if (beyond > 1.5) ASSERT_EQ(picture.at(x, y).a, 0) << x << ", " << y;
    }
    // A quarter pixel off all around at the most: where splats end it would be ¾ more.
    EXPECT_NEAR(covered, glm::pi<double>() * radiusPx * radiusPx,
                glm::two_pi<double>() * radiusPx * 0.25);
    EXPECT_GT(partly, 100);
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

/// Of points 1.9 pixels apart, squares of half the filter leave rows and columns open.
TEST_F(SplatTest, LowPassSplatsHideWhereTheyCloseTheSurface) {
    scene::PointCloud points = sheet(33, 0.6F, 0.0F, 0.0F, {1.0F, 0.0F, 0.0F});
    append(points, sheet(60, 0.6F, -0.3F, 0.0F, {0.0F, 1.0F, 0.0F}));
    const SplatSettings settings{.storage = PointStorage::Uncompressed,
                                 .lowPassRadiusPx = 1.0F,
                                 .cutoff = 1.5F,
                                 .lightDirectionView = {0.0F, 0.0F, -1.0F}};
    const Picture picture =
        renderModel(modelOf(points), SplatMode::LowPass, viewFrom(3.0F, kSize), settings);
    for (int y = 36; y < 60; ++y) {
        for (int x = 36; x < 60; ++x) {
            ASSERT_EQ(picture.at(x, y).a, 255) << x << ", " << y;
            ASSERT_EQ(picture.at(x, y).g, 0) << x << ", " << y;
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
    return scene::PointCloud{.positions = {position}, .normals = {normal}, .radii = {radius}};
}

int coveredPixelsOf(const Picture& picture) {
    return static_cast<int>(std::count_if(picture.pixels.begin(), picture.pixels.end(),
                                          [](const glm::u8vec4& p) { return p.a > 0; }));
}

TEST_F(SplatTest, OneSpriteIsASquareAndOneSplatAnEllipse) {
    const PatchView view = viewFrom(3.0F, kSize);
    const float radius = 10.0F * 3.0F / view.focalPx;  // 10 pixels
    const glm::vec3 slanted(std::sin(1.0F), 0.0F, std::cos(1.0F));
    const ModelFile model = modelOf(onePoint(glm::vec3(0.0F), slanted, radius));
    EXPECT_EQ(coveredPixelsOf(renderModel(model, SplatMode::Sprite, view)), 400);
    // Half axes of two standard deviations, one of them foreshortened.
    const double area = glm::pi<double>() * 20.0 * 20.0 * std::cos(1.0);
    EXPECT_NEAR(coveredPixelsOf(renderModel(model, SplatMode::Reconstruction, view)), area, 25.0);
    const double foreshortened = std::sqrt(100.0 * std::pow(std::cos(1.0), 2.0) + 0.49);
    EXPECT_NEAR(coveredPixelsOf(renderModel(model, SplatMode::FullEwa, view)),
                glm::pi<double>() * 4.0 * std::sqrt(100.49) * foreshortened, 25.0);
    EXPECT_NEAR(coveredPixelsOf(renderModel(model, SplatMode::LowPass, view)),
                glm::pi<double>() * 4.0 * 0.49, 4.0);
}

TEST_F(SplatTest, DiscsLieWhereViewRaysMeetThem) {
    const PatchView view = viewFrom(3.0F, kSize);
    constexpr double kCutoff = 2.0;
    struct Case {
        glm::vec3 position, normal;
        float radius;
    };
    const Case cases[] = {
        {{0.05F, -0.02F, 0.0F}, {0.0F, 0.0F, 1.0F}, 0.1F},
        {{-0.4F, 0.3F, 0.5F}, glm::normalize(glm::vec3(0.7F, 0.2F, 0.5F)), 0.12F},
        {{0.5F, 0.5F, -0.5F}, glm::normalize(glm::vec3(0.1F, -0.9F, 0.3F)), 0.09F},
        // Beyond the window's edge: GL would drop a point whose middle is outside.
        {{0.97F, 0.1F, 0.0F}, glm::normalize(glm::vec3(-0.4F, 0.0F, 1.0F)), 0.15F},
        {{1.0F, 1.0F, 0.0F}, {0.0F, 0.0F, 1.0F}, 0.12F},
        // So near that perspective bends the ellipse.
        {{0.0F, 0.1F, 2.2F}, glm::normalize(glm::vec3(0.0F, 1.0F, 0.8F)), 0.06F},
    };
    for (const Case& c : cases) {
        SCOPED_TRACE(testing::Message() << "at " << c.position.x << ", " << c.position.y);
        const ModelFile model = modelOf(onePoint(c.position, c.normal, c.radius));
        SplatRenderer renderer(
            shaders, model,
            {.storage = PointStorage::Uncompressed, .cutoff = static_cast<float>(kCutoff)}, kSize);
        render(renderer, everything(model, SplatMode::Reconstruction), view);
        const auto sums = renderer.accumulated().read<float>(GL_RGBA, GL_FLOAT, 4);
        const glm::dvec3 eye(0.0, 0.0, 3.0), normal(c.normal),
            toCentre = glm::dvec3(c.position) - eye;
        int hits = 0;
        for (const auto [y, x] : test::grid(kSize.y, kSize.x)) {
            const glm::dvec3 ray = rayOf(view, x, y);
            const double t = glm::dot(normal, toCentre) / glm::dot(normal, ray);
            const double away = glm::length(t * ray - toCentre) / static_cast<double>(c.radius);
            // A hundredth of a radius about the edge is left to rounding.
            if (std::abs(away - kCutoff) < 0.01) continue;
            const bool isHit = t > 0.0 && away < kCutoff;
            hits += isHit ? 1 : 0;
            const double expected = isHit ? std::exp(-0.5 * away * away) : 0.0;
            // Half floats have 2⁻¹¹ of a value up to 1.
            ASSERT_NEAR(
                static_cast<double>(sums[static_cast<std::size_t>(4 * (y * kSize.x + x) + 3)]),
                expected, 0.001)
                << x << ", " << y;
        }
        EXPECT_GT(hits, 15);
    }
}

TEST_F(SplatTest, DiscsAreTheEllipsesOfEquation8ToFirstOrder) {
    // Seen from far, the map to the screen is linear over a disc: H = J V^r Jᵀ.
    const PatchView view = viewFrom(40.0F, glm::ivec2(512), 20.0F);
    const glm::vec3 position(4.0F, -3.0F, 0.0F);
    const glm::vec3 normal = glm::normalize(glm::vec3(0.5F, 0.6F, 0.7F));
    const glm::vec3 tangent = tangentOf(normal, tangentChoice(normal));
    const float radius = 0.5F;
    const ModelFile model = modelOf(onePoint(position, normal, radius));
    SplatRenderer renderer(shaders, model, {.storage = PointStorage::Uncompressed}, view.sizePx);
    render(renderer, everything(model, SplatMode::Reconstruction), view);
    const auto sums = renderer.accumulated().read<float>(GL_RGBA, GL_FLOAT, 4);
    // Eye space has z the distance along the view axis.
    const auto toEye = [](const glm::vec3& v) { return glm::dvec3(v.x, v.y, -v.z); };
    const EyeSplat splat{toEye(position) + glm::dvec3(0.0, 0.0, 40.0), toEye(tangent),
                         toEye(glm::cross(normal, tangent)), static_cast<double>(radius)};
    const auto focal = static_cast<double>(view.focalPx);
    const glm::dmat2 h = ewaCovariance(splat, focal, 0.0);
    const glm::dvec2 centre =
        256.0 + focal * glm::dvec2(splat.centre.x, splat.centre.y) / splat.centre.z;
    int compared = 0;
    for (const auto [y, x] : test::grid(512, 512)) {
        const glm::dvec2 away = glm::dvec2(x + 0.5, y + 0.5) - centre;
        const double distance2 = glm::dot(away, glm::inverse(h) * away);
        if (distance2 > 3.8) continue;
        ++compared;
        // Over the disc depths differ by 2 % of the distance, which bends the exponent as much.
        ASSERT_NEAR(static_cast<double>(sums[static_cast<std::size_t>(4 * (y * 512 + x) + 3)]),
                    std::exp(-0.5 * distance2), 0.04);
    }
    EXPECT_GT(compared, 300);
}

TEST_F(SplatTest, DiscsWiderThanGlPointsAreStillWhole) {
    // A disc as wide as the window beside others: no device has GL points of every size.
    const PatchView view = viewFrom(3.0F, glm::ivec2(1024));
    const ModelFile model = modelOf(onePoint(glm::vec3(0.0F), {0.0F, 0.0F, 1.0F}, 0.4F));
    const Picture picture = renderModel(model, SplatMode::Reconstruction, view,
                                        {.storage = PointStorage::Uncompressed});
    const double radiusPx = 2.0 * 0.4 * static_cast<double>(view.focalPx) / 3.0;
    EXPECT_GT(radiusPx, 400.0);
    EXPECT_NEAR(coveredPixelsOf(picture), glm::pi<double>() * radiusPx * radiusPx, 4000.0);
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
            EXPECT_EQ(coveredPixelsOf(picture) > 0, isSeen);
            device.finish(c.name);
        }
    }
}

TEST_F(SplatTest, SplatsTurnedAwayAreNotDrawn) {
    const PatchView view = viewFrom(3.0F, kSize);
    for (const SplatMode mode :
         {SplatMode::FullEwa, SplatMode::Reconstruction, SplatMode::LowPass, SplatMode::Sprite}) {
        const auto coveredAt = [&](float turnRad) {
            return coveredPixelsOf(
                renderModel(modelOf(sheet(40, 0.5F, 0.0F, turnRad)), mode, view));
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
    EXPECT_GT(coveredPixelsOf(render(renderer, everything(model, SplatMode::Sprite), view)), 1000);
    EXPECT_EQ(coveredPixelsOf(render(renderer, {}, view)), 0);
}

/// The nearest of each pixel, against the same on the host; nothing of what lies beyond the view.
TEST_F(SplatTest, PlainPointsLeaveTheNearestOfEachPixel) {
    constexpr glm::ivec2 kWide(48, 40);
    constexpr float kDistance = 4.0F;
    const PatchView view = viewFrom(kDistance, kWide, 1.0F);
    Random random(17);
    scene::PointCloud points;
    std::vector<float> nearest(48 * 40, std::numeric_limits<float>::infinity());
    for (int i = 0; i < 6000; ++i) {
        // Clearly in a pixel, of the window or beside it, before, in and behind the view.
        const glm::ivec2 pixel{static_cast<int>(random.index(56)) - 4,
                               static_cast<int>(random.index(48)) - 4};
        const glm::vec2 within{random.uniform(0.1F, 0.9F), random.uniform(0.1F, 0.9F)};
        const float depth = random.uniform(-1.0F, 18.0F);
        const glm::vec2 slope =
            (glm::vec2(pixel) + within - 0.5F * glm::vec2(kWide)) / view.focalPx;
        points.positions.emplace_back(slope * depth, kDistance - depth);
        points.normals.emplace_back(0.0F, 0.0F, 1.0F);
        points.radii.push_back(0.01F);
        const bool isSeen = depth > view.nearM && depth < view.farM && pixel.x >= 0 &&
                            pixel.x < kWide.x && pixel.y >= 0 && pixel.y < kWide.y;
        if (!isSeen) continue;
        float& least = nearest[static_cast<std::size_t>(pixel.y * kWide.x + pixel.x)];
        least = std::min(least, depth);
    }
    const ModelFile model = modelOf(points);
    PlainPoints plain(shaders, model, kWide);
    gl::Profiler profiler(true);
    // Twice: nothing of the first frame may be left.
    plain.render(everything(model, SplatMode::Sprite), viewFrom(3.0F, kWide), profiler);
    plain.render(everything(model, SplatMode::Sprite), view, profiler);
    const Picture picture = pictureOf(plain.output());
    const std::vector<float> depths = plain.depths().read<float>(nearest.size());
    int seen = 0;
    for (std::size_t i = 0; i < nearest.size(); ++i) {
        const bool isSeen = std::isfinite(nearest[i]);
        seen += isSeen ? 1 : 0;
        ASSERT_EQ(picture.pixels[i], glm::u8vec4(isSeen ? 255 : 0)) << i;
        if (isSeen) ASSERT_NEAR(depths[i], nearest[i], 1e-5F * nearest[i]) << i;
    }
    EXPECT_GT(seen, 1000);
    EXPECT_LT(seen, 1900);
    plain.render({}, view, profiler);
    EXPECT_EQ(coveredPixelsOf(pictureOf(plain.output())), 0);
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
