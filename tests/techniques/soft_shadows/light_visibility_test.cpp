// The samples of a light that points see: shadow maps and shadow rays against a scene whose shadows
// are known.

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "engine/core/files.h"
#include "engine/gl/device.h"
#include "scenes/shared/mesh_builder.h"
#include "techniques/soft_shadows/shadow_casters.h"
#include "techniques/soft_shadows/shadow_errors.h"
#include "tests/support/support.h"
#include "tests/support/test_device.h"

namespace gfxrepro::soft_shadows {
namespace {

constexpr int kGrid = 6;  // 36 samples: a whole word of bits and a part of one
constexpr glm::ivec2 kSize{64, 48};

/// A floor of ±2 and a square plate of ±0.5 at height 1, both double-sided.
scene::Scene litPlateOverFloor() {
    scene::MeshBuilder builder;
    const auto addSquare = [&](float half, float y) {
        builder.addQuad({-half, y, half}, {half, y, half}, {half, y, -half}, {-half, y, -half});
    };
    addSquare(2.0F, 0.0F);
    addSquare(0.5F, 1.0F);
    scene::Scene scene = scene::sceneOf(builder.take("plate", 0));
    scene.materials.push_back({.isDoubleSided = true});
    scene.meshes.front().material = 0;
    return scene;
}

AreaLight lightOver(const scene::Scene& scene, float sizeRatio) {
    return makeAreaLight(scene.bounds(), {.sizeRatio = sizeRatio, .elevationRad = 1.2F});
}

/// How far inside the plate (positive) the segment from a floor point to the light passes it.
float insidePlate(const glm::vec3& point, const glm::vec3& light) {
    const float t = (1.0F - point.y) / (light.y - point.y);
    const glm::vec3 at = glm::mix(point, light, t);
    return 0.5F - std::max(std::abs(at.x), std::abs(at.z));
}

struct LightVisibilityTest : testing::Test {
    LightVisibilityTest()
        : scene(litPlateOverFloor()),
          drawable(scene),
          receivers(render()),
          host(readReceivers(receivers)) {}

    Receivers render() const {
        scene::Camera camera = scene::framingCamera(scene.bounds(), 4.0F / 3.0F);
        return renderReceivers(shaders, drawable, kit::viewOf(camera, kSize));
    }
    HostVisibilityMask byShadowMaps(const AreaLight& light, int sizePx) const {
        const LightVisibility visibility(shaders, {.sizePx = sizePx});
        VisibilityMask mask = LightVisibility::makeMask(kSize, kGrid);
        const SceneCaster caster(shaders, drawable);
        const ShadowCaster* casters[] = {&caster};
        visibility.accumulate(mask, receivers, light, kGrid, casters);
        return readMask(mask);
    }
    /// Compares every bit of floor pixels with the plate's true shadow; bits whose ray passes the
    /// plate's edge nearer than `tolerance` may be anything.
    void expectPlateShadow(const HostVisibilityMask& mask, const AreaLight& light,
                           float tolerance) const {
        std::size_t decided = 0, wrong = 0, shadowed = 0;
        for (std::size_t pixel = 0; pixel < mask.pixelCount(); ++pixel) {
            if (host.positions[pixel].w == 0.0F || host.positions[pixel].y > 0.5F) continue;
            for (int s = 0; s < kGrid * kGrid; ++s) {
                const float inside =
                    insidePlate(host.positions[pixel], light.sample(s % kGrid, s / kGrid, kGrid));
                if (std::abs(inside) < tolerance) continue;
                const bool isLit =
                    (mask.bits[static_cast<std::size_t>(s / 32) * mask.pixelCount() + pixel] >>
                         (s % 32) &
                     1U) != 0;
                ++decided;
                shadowed += isLit ? 0 : 1;
                wrong += isLit == (inside > 0.0F) ? 1 : 0;
            }
        }
        EXPECT_GT(decided, 20000U);
        EXPECT_GT(shadowed, 500U);
        EXPECT_EQ(wrong, 0U);
    }

    gl::Device device = gl::Device::open({test::testDevice(), gl::DebugOutput::Fatal});
    gl::ShaderLibrary shaders{dataFolder("shaders")};
    scene::Scene scene;
    kit::DrawableScene drawable;
    Receivers receivers;
    HostReceivers host;
};

TEST_F(LightVisibilityTest, ShadowRaysSeeThePlatesTrueShadow) {
    const AreaLight light = lightOver(scene, 1.0F);
    const raycast::RayTracer tracer(scene);
    // The offset of rays and the 16-bit normals move a point by less than 10⁻³.
    expectPlateShadow(traceVisibility(tracer, host, light, kGrid), light, 1e-3F);
}

TEST_F(LightVisibilityTest, ShadowMapsSeeItUpToTheirTexels) {
    const AreaLight light = lightOver(scene, 1.0F);
    const int sizePx = 512;
    // A point is moved by one texel and falls into a texel whose centre is half a diagonal away; a
    // texel is about the box's diagonal over the size.
    const float texel = glm::length(scene.bounds().size()) / static_cast<float>(sizePx);
    expectPlateShadow(byShadowMaps(light, sizePx), light, 3.0F * texel);
}

TEST_F(LightVisibilityTest, ReceiversBeyondTheFarPlaneAreShadowedByCastersOnly) {
    AreaLight light = lightOver(scene, 1.0F);
    // The plate alone: no view of the light reaches down to the floor.
    light.casters = {{-0.5F, 0.9F, -0.5F}, {0.5F, 1.1F, 0.5F}};
    const int sizePx = 512;
    const float texel = glm::length(light.casters.size()) / static_cast<float>(sizePx);
    expectPlateShadow(byShadowMaps(light, sizePx), light, 6.0F * texel);
}

TEST_F(LightVisibilityTest, LightOfNoSizeCastsHardShadows) {
    const AreaLight light = lightOver(scene, 0.0F);
    const HostVisibilityMask mask = byShadowMaps(light, 256);
    for (std::size_t pixel = 0; pixel < mask.pixelCount(); ++pixel) {
        const int lit = mask.litSamples(pixel);
        ASSERT_TRUE(lit == 0 || lit == kGrid * kGrid) << "pixel " << pixel << ": " << lit;
    }
    expectPlateShadow(mask, light, 3.0F * glm::length(scene.bounds().size()) / 256.0F);
}

TEST_F(LightVisibilityTest, PixelsWithoutSurfaceSeeTheWholeLight) {
    const AreaLight light = lightOver(scene, 1.0F);
    const HostVisibilityMask maps = byShadowMaps(light, 64);
    const HostVisibilityMask rays = traceVisibility(raycast::RayTracer(scene), host, light, kGrid);
    std::size_t background = 0;
    for (std::size_t pixel = 0; pixel < maps.pixelCount(); ++pixel) {
        if (host.positions[pixel].w != 0.0F) continue;
        ++background;
        EXPECT_EQ(maps.litSamples(pixel), kGrid * kGrid);
        EXPECT_EQ(rays.litSamples(pixel), kGrid * kGrid);
    }
    EXPECT_GT(background, 100U);
}

TEST(LightTruth, AStepOfAFewThousandthsOfAPercentCastsItsShadow) {
    scene::MeshBuilder builder;
    const float height = 5e-5F * std::sqrt(32.0F);  // as a share of the diagonal
    builder.addQuad({-2, 0, 2}, {2, 0, 2}, {2, 0, -2}, {-2, 0, -2});
    builder.addQuad({0, 0, -2}, {0, 0, 2}, {0, height, 2}, {0, height, -2});
    scene::Scene scene = scene::sceneOf(builder.take("step", 0));
    scene.materials.push_back({.isDoubleSided = true});
    scene.meshes.front().material = 0;
    // The light is 45° above the horizon, beyond the step; one point stands nearer to the step than
    // it is high, the other farther away.
    AreaLight light = makeAreaLight(scene.bounds(), {.sizeRatio = 0.0F});
    light.centre = {10, 10, 0};
    const HostReceivers receivers{{1, 2},
                                  {-1, 5, 0},
                                  {{-0.4F * height, 0, 0.1F, 1}, {-3.0F * height, 0, 0.1F, 1}},
                                  {{0, 1, 0, 0}, {0, 1, 0, 0}},
                                  {{}, {}}};
    const HostVisibilityMask mask = traceVisibility(raycast::RayTracer(scene), receivers, light, 1);
    EXPECT_EQ(mask.litSamples(0), 0);
    EXPECT_EQ(mask.litSamples(1), 1);
}

TEST(AreaLight, SquareOfTheGivenDiagonalAcrossItsDirection) {
    const scene::Box box{{-1, 0, -1}, {1, 1, 1}};  // diagonal 3
    const AreaLight light = makeAreaLight(box, {.sizeRatio = 0.5F, .height = 2.0F});
    EXPECT_NEAR(glm::length(light.corner(2) - light.corner(0)), 1.5F, 1e-5F);
    EXPECT_NEAR(glm::length(light.corner(3) - light.corner(1)), 1.5F, 1e-5F);
    EXPECT_NEAR(glm::length(light.centre - box.centre()), 6.0F, 1e-5F);
    EXPECT_NEAR(glm::dot(light.axes[0], light.axes[1]), 0.0F, 1e-6F);
    EXPECT_NEAR(glm::dot(light.axes[0], light.centre - box.centre()), 0.0F, 1e-5F);
    glm::vec3 mean(0.0F);
    for (int s = 0; s < 16; ++s) mean += light.sample(s % 4, s / 4, 4) / 16.0F;
    EXPECT_NEAR(glm::length(mean - light.centre), 0.0F, 1e-5F);
}

constexpr LightViewFrame kFrames[] = {LightViewFrame::Parallel, LightViewFrame::Aimed};

TEST(AreaLight, ItsViewsHoldTheCastersWhole) {
    const scene::Box box{{-1, 0, -1}, {1, 1, 1}};
    for (int i = 0; i < 6; ++i) {
        const float ratio = std::array{0.0F, 1.0F, 4.0F}[i % 3];
        const AreaLight light =
            makeAreaLight(box, {.sizeRatio = ratio, .viewFrame = kFrames[i / 3]});
        for (int c = 0; c < 4; ++c) {
            const kit::View view = lightView(light, light.corner(c), 256);
            for (int i = 0; i < 8; ++i) {
                const glm::vec3 corner((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : 0,
                                       (i & 4) != 0 ? 1 : -1);
                EXPECT_TRUE(kit::pixelOf(view, corner)) << "ratio " << ratio;
                const glm::vec4 clip = view.clipFromWorld() * glm::vec4(corner, 1.0F);
                EXPECT_LT(std::abs(clip.z), clip.w);
            }
        }
    }
}

/// The width of a pixel of the view from a point, at the middle of the box.
float pixelWidth(const AreaLight& light, const glm::vec3& point) {
    const kit::View view = lightView(light, point, 1024);
    return kit::footprintPerDepth(view) * glm::dot(light.casters.centre() - point, forwardOf(view));
}

/// Sizes of boxes as nest, meadow, city and tree have them.
constexpr glm::vec3 kBoxSizes[] = {
    {2.24F, 1.34F, 1.92F}, {3.02F, 0.81F, 2.97F}, {240, 75, 240}, {13.6F, 14.5F, 12.4F}};

AreaLight lightOverBox(const glm::vec3& size, int step, const AreaLightSettings& settings) {
    AreaLightSettings stepped = settings;
    stepped.sizeRatio = 0.025F * static_cast<float>(step);
    return makeAreaLight({-0.5F * size, 0.5F * size}, stepped);
}

TEST(AreaLight, PixelsFromItsCornersAreAsWideAsFromItsCentre) {
    for (const glm::vec3& size : kBoxSizes) {
        for (const float height : {0.75F, 1.0F, 1.5F}) {
            for (int step = 0; step <= 40; ++step) {
                const AreaLight light = lightOverBox(
                    size, step, {.height = height, .elevationRad = glm::half_pi<float>()});
                for (int c = 0; c < 4; ++c) {
                    EXPECT_NEAR(
                        pixelWidth(light, light.corner(c)) / pixelWidth(light, light.centre), 1.0F,
                        0.1F)
                        << size.y << " m high, light " << height << " diagonals away, step "
                        << step;
                }
            }
        }
    }
}

TEST(AreaLight, PixelsChangeWithItsSizeWithoutAJump) {
    for (const LightViewFrame frame : kFrames) {
        for (const glm::vec3& size : kBoxSizes) {
            for (const float elevation : {0.8F, 1.2F, 1.43F, glm::half_pi<float>()}) {
                float before = 0.0F;
                for (int step = 0; step <= 40; ++step) {
                    const AreaLight light =
                        lightOverBox(size, step, {.elevationRad = elevation, .viewFrame = frame});
                    const float width = pixelWidth(light, light.corner(0));
                    if (step > 0)
                        EXPECT_NEAR(width / before, 1.0F, 0.02F)
                            << size.y << ' ' << elevation << " step " << step;
                    before = width;
                }
            }
        }
    }
}

TEST(AreaLight, PixelsFromItsCornersChangeWithItsElevationWithoutAJump) {
    for (const glm::vec3& size : kBoxSizes) {
        for (const float azimuth : {0.0F, 0.4F, 0.8F}) {
            float before = 0.0F;
            for (int deg = 60; deg <= 90; ++deg) {
                const AreaLight light =
                    lightOverBox(size, 40,
                                 {.height = 1.0F,
                                  .azimuthRad = azimuth,
                                  .elevationRad = glm::radians(static_cast<float>(deg))});
                const float width = pixelWidth(light, light.corner(0));
                EXPECT_NEAR(width / pixelWidth(light, light.centre), 1.0F, 0.1F) << deg;
                if (deg > 60) {
                    EXPECT_NEAR(width / before, 1.0F, 0.02F) << size.y << " m high, " << deg;
                }
                before = width;
            }
        }
    }
}

TEST(AreaLight, APlaneThroughTheSceneIsRefused) {
    const scene::Box box{{-1, 0, -1}, {1, 1, 1}};
    const AreaLight light = makeAreaLight(box, {.height = 0.1F, .azimuthRad = 0.0F});
    EXPECT_EQ(
        errorText([&] { lightView(light, light.centre, 64); }),
        "the scene's box comes within -0.661 m of the plane of the light's view from (0, 0.752, "
        "0.162), at least 0.15 are needed (a twentieth of its diagonal): raise light_height");
    const AreaLight near = makeAreaLight(box, {.height = 0.216F, .elevationRad = 1.5707963F});
    EXPECT_EQ(errorText([&] { lightView(near, near.centre, 64); }).substr(0, 43),
              "the scene's box comes within 0.148 m of the");
    EXPECT_NO_THROW(lightView(makeAreaLight(box, {.height = 0.22F, .elevationRad = 1.5707963F}),
                              {0, 1.16F, 0}, 64));
}

TEST(VisibilityErrors, CountWrongSamplesAndTheirAlgebraicSum) {
    // Two pixels, 64 samples. Pixel 0: 3 wrongly lit, 1 wrongly dark. Pixel 1: right.
    HostVisibilityMask truth{{2, 1}, 64, {0x00FFU, 7U, 0U, 7U}};
    HostVisibilityMask measured{{2, 1}, 64, {0x00FEU, 7U, 0x70U, 7U}};
    const VisibilityErrors errors = compareMasks(measured, truth);
    EXPECT_DOUBLE_EQ(errors.visibilityMax, 16.0);  // 4 of 64, as of 256
    EXPECT_DOUBLE_EQ(errors.visibilityMean, 8.0);
    EXPECT_DOUBLE_EQ(errors.wronglyLitMean, 6.0);
    EXPECT_DOUBLE_EQ(errors.wronglyDarkMean, 2.0);
    EXPECT_DOUBLE_EQ(errors.intensityMax, 8.0);
    EXPECT_DOUBLE_EQ(errors.intensityMean, 4.0);
    EXPECT_EQ(errors.signedIntensity, (std::vector<float>{8.0F, 0.0F}));
    EXPECT_EQ(litShares(truth), (std::vector<float>{8.0F / 64.0F, 6.0F / 64.0F}));
}

TEST(VisibilityErrors, BitsBeyondTheLastSampleDoNotCount) {
    const HostVisibilityMask truth{{1, 1}, 36, {~0U, 0xFU}};
    const HostVisibilityMask measured{{1, 1}, 36, {~0U, ~0U}};
    EXPECT_DOUBLE_EQ(compareMasks(measured, truth).visibilityMax, 0.0);
    EXPECT_EQ(measured.litSamples(0), 36);
}

TEST(VisibilityErrors, PicturesShowTooBrightGreenAndTooDarkRed) {
    const HostReceivers receivers{{1, 2}, {}, {glm::vec4(1), glm::vec4(1)}, {}, {{}, {}}};
    const image::ImageF picture = errorPicture(receivers, {64.0F, -128.0F});
    EXPECT_EQ(picture.at(0, 1, 0), 0.0F);  // pixel 0 is the lower one
    EXPECT_EQ(picture.at(0, 1, 1), 1.0F);
    EXPECT_EQ(picture.at(0, 0, 0), 1.0F);
    EXPECT_EQ(picture.at(0, 0, 1), 0.0F);
}

}  // namespace
}  // namespace gfxrepro::soft_shadows
