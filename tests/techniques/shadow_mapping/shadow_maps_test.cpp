// Shadow terms of a square above a plane, whose shadow is known, with all lights and filters.
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "engine/core/files.h"
#include "scenes/shared/mesh_builder.h"
#include "techniques/shadow_mapping/lights.h"
#include "techniques/shadow_mapping/shaded_view.h"
#include "techniques/shadow_mapping/shadow_map.h"
#include "tests/gl/gl_fixture.h"
#include "tests/support/support.h"

namespace gfxrepro::shadow_mapping {
namespace {

constexpr glm::ivec2 kSize{96, 72};
// Slope: half a texel's change of depth, and a margin.
constexpr Bias kBias{.constant = 2e-4F, .slopeScale = 1.0F};

/// A floor of ±2 at y = 0 and, where asked for, a square of ±0.5 at y = 1.
scene::Scene floorAndSquare(bool hasSquare = true) {
    scene::MeshBuilder builder;
    const auto addSquare = [&](float half, float y) {
        builder.addQuad({-half, y, half}, {half, y, half}, {half, y, -half}, {-half, y, -half});
    };
    addSquare(2.0F, 0.0F);
    if (hasSquare) addSquare(0.5F, 1.0F);
    scene::Scene scene = scene::sceneOf(builder.take("square", 0));
    scene.materials.push_back({.isDoubleSided = true});
    scene.meshes.front().material = 0;
    return scene;
}

Light spotLight() {
    return {.kind = LightKind::Spot,
            .positionWorld = {0.3F, 3.0F, 0.2F},
            .targetWorld = {0.1F, 0.0F, 0.0F},
            .fovRad = 1.6F,
            .nearM = 0.5F,
            .farM = 8.0F};
}
Light pointLight() {
    Light light = spotLight();
    // Low, so that the shadow runs over an edge of the cube.
    light.kind = LightKind::Point;
    light.positionWorld = {-0.9F, 1.6F, 0.3F};
    light.nearM = 0.05F;
    return light;
}
Light directionalLight() {
    return {.kind = LightKind::Directional, .directionWorld = {0.4F, -1.0F, 0.25F}};
}

struct Terms {
    std::vector<glm::vec4> shadow, position;
};

struct ShadowMapsTest : test::GlTest {
    Terms termsOf(const ShadowMapSettings& settings, const std::vector<Light>& lights,
                  bool hasSquare = true) {
        const kit::DrawableScene scene(floorAndSquare(hasSquare));
        scene::Camera camera = scene::framingCamera(scene.bounds(), 4.0F / 3.0F);
        ShadowMapRenderer maps(shaders, settings);
        maps.render(scene, lights);
        ShadedView view(shaders, settings);
        ShadedImage image = makeShadedImage(kit::viewOf(camera, kSize), true);
        view.render(scene, maps, image);
        return {image.shadowTerms.read<glm::vec4>(GL_RGBA, GL_FLOAT, 1),
                image.positions.read<glm::vec4>(GL_RGBA, GL_FLOAT, 1)};
    }
    static bool isFloor(const glm::vec4& position) { return position.w != 0 && position.y < 0.5F; }

    gl::ShaderLibrary shaders{dataFolder("shaders")};
};

/// How far inside the square (positive) the ray from a floor point to the light passes it.
float insideSquare(const glm::vec3& point, const Light& light) {
    const glm::vec3 toLight =
        light.kind == LightKind::Directional ? -light.directionWorld : light.positionWorld - point;
    const glm::vec3 at = point + toLight * ((1.0F - point.y) / toLight.y);
    return 0.5F - std::max(std::abs(at.x), std::abs(at.z));
}

TEST_F(ShadowMapsTest, TheShadowIsWhereGeometrySays) {
    for (const Light& light : {spotLight(), directionalLight(), pointLight()}) {
        for (const Storage storage : {Storage::Standard, Storage::Hardware}) {
            const Terms terms =
                termsOf({.storage = storage, .sizePx = 512, .bias = kBias}, {light});
            int lit = 0, dark = 0, wrong = 0;
            for (std::size_t i = 0; i < terms.shadow.size(); ++i) {
                if (!isFloor(terms.position[i])) continue;
                const float inside = insideSquare(glm::vec3(terms.position[i]), light);
                // A texel of the map is less than 0.02 m wide on the square.
                if (std::abs(inside) < 0.02F) continue;
                (inside > 0.0F ? dark : lit) += 1;
                wrong += terms.shadow[i].x == (inside > 0.0F ? 0.0F : 1.0F) ? 0 : 1;
            }
            EXPECT_GT(lit, 500);
            EXPECT_GT(dark, 50);
            EXPECT_EQ(wrong, 0) << static_cast<int>(light.kind) << static_cast<int>(storage);
        }
    }
}

TEST_F(ShadowMapsTest, StandardAndHardwareAgree) {
    for (const Filter filter : {Filter::Nearest, Filter::Bilinear, Filter::Pcf}) {
        ShadowMapSettings settings{.filter = filter, .sizePx = 64, .bias = {.constant = 4e-3F}};
        std::vector<Light> lights{spotLight(), directionalLight(), pointLight()};
        const Terms hardware = termsOf(settings, lights);
        settings.storage = Storage::Standard;
        const Terms standard = termsOf(settings, lights);
        int between = 0;
        float largest = 0.0F;
        for (std::size_t i = 0; i < hardware.shadow.size(); ++i) {
            for (int c = 0; c < 3; ++c) {
                const float term = standard.shadow[i][c];
                between += term > 0.0F && term < 1.0F ? 1 : 0;
                largest = std::max(largest, std::abs(term - hardware.shadow[i][c]));
            }
        }
        EXPECT_LE(largest, 1.0F / 255.0F) << static_cast<int>(filter);
        EXPECT_EQ(between > 100, filter != Filter::Nearest) << static_cast<int>(filter);
    }
}

TEST_F(ShadowMapsTest, StandardAndHardwareAgreeInEveryFormatAndBias) {
    for (const DepthFormat format :
         {DepthFormat::Unorm16, DepthFormat::Unorm24, DepthFormat::Float32}) {
        // Beyond the rounding to 16 bits, 1.5e-5.
        for (const Bias& bias :
             {Bias{.constant = 4e-3F}, Bias{.constant = 1e-4F, .slopeScale = 2.0F}}) {
            ShadowMapSettings settings{.sizePx = 64, .format = format, .bias = bias};
            const std::vector<Light> lights{spotLight(), directionalLight(), pointLight()};
            const Terms hardware = termsOf(settings, lights);
            settings.storage = Storage::Standard;
            const Terms standard = termsOf(settings, lights);
            std::size_t differing = 0;
            for (std::size_t i = 0; i < hardware.shadow.size(); ++i) {
                differing += standard.shadow[i] == hardware.shadow[i] ? 0 : 1;
            }
            // A depth may be rounded to the next of 2^16 steps: a tie.
            EXPECT_LE(differing, format == DepthFormat::Unorm16 ? 2U : 0U)
                << static_cast<int>(format) << ' ' << bias.slopeScale;
        }
    }
}

TEST_F(ShadowMapsTest, NoBiasGivesAcneAndTooMuchLeaksLight) {
    const auto wrongOf = [&](const Bias& bias) {
        const Terms terms = termsOf({.sizePx = 128, .bias = bias}, {directionalLight()});
        glm::ivec2 wrong(0);  // dark that is lit, lit that is dark
        for (std::size_t i = 0; i < terms.shadow.size(); ++i) {
            if (!isFloor(terms.position[i])) continue;
            const float inside = insideSquare(glm::vec3(terms.position[i]), directionalLight());
            if (std::abs(inside) < 0.1F) continue;
            if (inside < 0.0F && terms.shadow[i].x == 0.0F) ++wrong.x;
            if (inside > 0.0F && terms.shadow[i].x == 1.0F) ++wrong.y;
        }
        return wrong;
    };
    const glm::ivec2 none = wrongOf({}), large = wrongOf({.constant = 0.5F});
    EXPECT_GT(none.x, 300);
    EXPECT_EQ(none.y, 0);
    EXPECT_EQ(large.x, 0);
    EXPECT_GT(large.y, 40);
    for (const Bias& bias : {Bias{.constant = 0.02F}, Bias{.slopeScale = 2.0F}}) {
        EXPECT_EQ(wrongOf(bias), glm::ivec2(0));
    }
}

TEST_F(ShadowMapsTest, WithoutACasterAllIsLit) {
    for (const Filter filter :
         {Filter::Nearest, Filter::Bilinear, Filter::Pcf, Filter::Pcss, Filter::Variance}) {
        Light soft = spotLight();
        soft.size = 0.1F;
        const ShadowMapSettings settings{.storage = Storage::Standard,
                                         .filter = filter,
                                         .sizePx = 128,
                                         .bias = {.constant = 0.05F}};
        const Terms terms = termsOf(settings, {soft, directionalLight(), pointLight()}, false);
        for (std::size_t i = 0; i < terms.shadow.size(); ++i) {
            const glm::vec4 at = terms.position[i];
            ASSERT_EQ(terms.shadow[i], glm::vec4(1.0F))
                << static_cast<int>(filter) << " at " << at.x << ' ' << at.y << ' ' << at.z;
        }
    }
}

TEST_F(ShadowMapsTest, PcfHasNoStripesWhereOneComparisonHasNone) {
    for (const Storage storage : {Storage::Standard, Storage::Hardware}) {
        const Terms terms =
            termsOf({.storage = storage, .filter = Filter::Pcf, .sizePx = 64, .bias = kBias},
                    {spotLight(), directionalLight(), pointLight()}, false);
        for (std::size_t i = 0; i < terms.shadow.size(); ++i) {
            const glm::vec4 at = terms.position[i];
            ASSERT_EQ(terms.shadow[i], glm::vec4(1.0F))
                << static_cast<int>(storage) << " at " << at.x << ' ' << at.y << ' ' << at.z;
        }
    }
}

TEST_F(ShadowMapsTest, PcssOfALightWithoutSizeIsNearest) {
    for (const Storage storage : {Storage::Standard, Storage::Hardware}) {
        ShadowMapSettings settings{.storage = storage, .sizePx = 64, .bias = {.constant = 4e-3F}};
        const std::vector<Light> lights{spotLight(), directionalLight(), pointLight()};
        const Terms nearest = termsOf(settings, lights);
        settings.filter = Filter::Pcss;
        EXPECT_EQ(termsOf(settings, lights).shadow, nearest.shadow);
    }
}

TEST_F(ShadowMapsTest, PcssPenumbraIsAsWideAsGeometrySays) {
    // Under parallel rays of angular width s, the square 1 m above the floor has a penumbra of s.
    Light light{.kind = LightKind::Directional};
    light.size = 0.3F;
    const Terms terms =
        termsOf({.filter = Filter::Pcss, .sizePx = 512, .bias = {.constant = 5e-3F}}, {light});
    int full = 0, half = 0;
    for (std::size_t i = 0; i < terms.shadow.size(); ++i) {
        const glm::vec3 at(terms.position[i]);
        if (!isFloor(terms.position[i]) || std::abs(at.z) > 0.3F) continue;
        const float outside = std::abs(at.x) - 0.5F;
        // 7 taps across: steps of s/7. A straight edge hides a linearly growing share.
        if (std::abs(outside) < 0.15F) {
            EXPECT_NEAR(terms.shadow[i].x, 0.5F + outside / 0.3F, 0.1F);
            ++half;
        } else if (std::abs(outside) > 0.17F) {
            EXPECT_EQ(terms.shadow[i].x, outside > 0.0F ? 1.0F : 0.0F);
            ++full;
        }
    }
    EXPECT_GT(half, 20);
    EXPECT_GT(full, 100);
}

TEST_F(ShadowMapsTest, VarianceIsBoundedAndRightFarFromEdges) {
    const Light light = directionalLight();
    const Terms terms = termsOf({.storage = Storage::Standard,
                                 .filter = Filter::Variance,
                                 .sizePx = 256,
                                 .bias = {.constant = 0.02F}},
                                {light});
    for (std::size_t i = 0; i < terms.shadow.size(); ++i) {
        if (!isFloor(terms.position[i])) continue;
        const float inside = insideSquare(glm::vec3(terms.position[i]), light);
        if (inside < -0.15F) EXPECT_EQ(terms.shadow[i].x, 1.0F);
        if (inside > 0.15F) EXPECT_LT(terms.shadow[i].x, 0.01F);
        EXPECT_GE(terms.shadow[i].x, 0.0F);
        EXPECT_LE(terms.shadow[i].x, 1.0F);
    }
}

TEST_F(ShadowMapsTest, VarianceOfTwoParallelPlanesIsTheLitShareOfTheBlur) {
    // [Donnelly and Lauritzen 2006] Sec. 4.2: Chebyshev's bound is met where a plane casts on one
    // parallel to it. Straight from above, a box of n texels over a straight edge is lit linearly.
    const Light light{.kind = LightKind::Directional};
    constexpr int kTexels = 64;
    const Terms terms = termsOf(
        {.storage = Storage::Standard, .filter = Filter::Variance, .sizePx = kTexels}, {light});
    // The map holds the floor's 4 m and a margin; the edge lies within a texel of the square's.
    constexpr float kBlurM = kFilterTexels * 4.0F / kTexels, kTexelM = 1.2F * 4.0F / kTexels;
    int between = 0;
    for (std::size_t i = 0; i < terms.shadow.size(); ++i) {
        const glm::vec3 at(terms.position[i]);
        if (!isFloor(terms.position[i]) || std::abs(at.z) > 0.2F) continue;
        const float outside = std::abs(at.x) - 0.5F;
        const float least = std::clamp(0.5F + (outside - kTexelM) / kBlurM, 0.0F, 1.0F);
        const float most = std::clamp(0.5F + (outside + kTexelM) / kBlurM, 0.0F, 1.0F);
        EXPECT_GE(terms.shadow[i].x, least - 1e-3F) << outside;
        EXPECT_LE(terms.shadow[i].x, most + 1e-3F) << outside;
        between += terms.shadow[i].x > 0.1F && terms.shadow[i].x < 0.9F ? 1 : 0;
    }
    EXPECT_GT(between, 10);
}

TEST_F(ShadowMapsTest, MapsBeyondTheDeviceAndTooManyLightsAreRefused) {
    const kit::DrawableScene scene(floorAndSquare());
    GLint limit = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
    ShadowMapRenderer maps(shaders, {.sizePx = limit + 1});
    EXPECT_EQ(errorText([&] { maps.render(scene, std::vector<Light>{spotLight()}); }),
              "a 2D texture of " + std::to_string(limit + 1) +
                  " pixels is beyond this device's GL_MAX_TEXTURE_SIZE = " + std::to_string(limit));
    EXPECT_EQ(errorText([&] { maps.render(scene, std::vector<Light>(5, spotLight())); }),
              "5 lights with shadows: at most 4");
}

// Views of lights, their errors, and the steps as declared.

constexpr scene::Box kBounds{glm::vec3(-2.0F, 0.0F, -2.0F), glm::vec3(2.0F, 1.0F, 2.0F)};

std::string errorOf(const Light& light, const scene::Box& bounds = kBounds, int sizePx = 64) {
    return errorText([&] { viewsOf(light, bounds, sizePx); });
}

std::string errorOf(const ShadowMapSettings& settings) {
    return errorText([&] { declaredSteps(settings); });
}

TEST(Lights, DegenerateLightsAreRefused) {
    const float pi = glm::pi<float>();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(errorOf(Light{}), "a spot light's target is its position: it looks nowhere");
    Light spot{.positionWorld = {0, 3, 0}};
    EXPECT_EQ(errorOf(spot), "no error");
    spot.fovRad = 0.0F;
    EXPECT_EQ(errorOf(spot), "a spot light's angle of 0 degrees: more than 0, less than 180");
    spot.fovRad = pi;
    EXPECT_EQ(errorOf(spot), "a spot light's angle of 180 degrees: more than 0, less than 180");
    spot.positionWorld.x = nan;
    EXPECT_EQ(errorOf(spot), "a light's position is not finite");
    EXPECT_EQ(errorOf({.kind = LightKind::Point, .nearM = 2.0F, .farM = 2.0F}),
              "a light's near plane at 2 m and far plane at 2 m: 0 < near < far");
    EXPECT_EQ(errorOf({.kind = LightKind::Point}, kBounds, 8),
              "a point light's faces of 8 pixels: more than 8, their border");
    EXPECT_EQ(errorOf({.kind = LightKind::Directional, .directionWorld = glm::vec3(0.0F)}),
              "a directional light has no direction");
    EXPECT_EQ(errorOf({.kind = LightKind::Directional}, scene::Box{}),
              "a directional light is fitted to a scene: it is empty");
}

TEST(Lights, TheDirectionalViewHoldsTheSceneAndNotMuchMore) {
    const Light light{.kind = LightKind::Directional, .directionWorld = {0.3F, -1.0F, 0.2F}};
    const LightView view = viewsOf(light, kBounds, 64).front();
    float widest = 0.0F;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 at(corner & 1 ? 2.0F : -2.0F, corner & 2 ? 1.0F : 0.0F,
                           corner & 4 ? 2.0F : -2.0F);
        const glm::vec3 clip = glm::abs(glm::vec3(view.clipFromWorld * glm::vec4(at, 1.0F)));
        EXPECT_LT(std::max({clip.x, clip.y, clip.z}), 1.0F);
        widest = std::max({widest, clip.x, clip.y});
    }
    EXPECT_GT(widest, 0.9F);
}

TEST(ShadowSteps, ContradictingSettingsAreRefused) {
    EXPECT_EQ(errorOf({.filter = Filter::Variance}),
              "variance shadow maps hold moments, which a depth texture cannot: their storage is "
              "standard");
    EXPECT_EQ(errorOf({.storage = Storage::Standard, .filter = Filter::Variance}), "no error");
    EXPECT_EQ(errorOf({.sizePx = 0}), "a shadow map of 0 pixels: 1 to 1048576");
    EXPECT_EQ(errorOf({.bias = {.constant = -1.0F}}), "a shadow bias of -1: 0 or more, finite");
}

TEST(ShadowSteps, AreThoseOfTheThesis) {
    const auto standard = declaredSteps({.storage = Storage::Standard, .filter = Filter::Bilinear});
    const auto hardware = declaredSteps({.storage = Storage::Hardware, .filter = Filter::Bilinear});
    const StepDeclaration map{"depth map", "R32F", true, true, true, 0, 0};
    EXPECT_EQ(standard.front(), map);
    const StepDeclaration depthOnly{"depth map", "DEPTH24", false, true, false, 0, 0};
    EXPECT_EQ(hardware.front(), depthOnly);
    EXPECT_EQ(standard.back().fetches, 4);
    EXPECT_EQ(standard.back().comparisons, 4);
    EXPECT_EQ(hardware.back().fetches, 1);
    EXPECT_EQ(hardware.back().comparisons, 0);
}

}  // namespace
}  // namespace gfxrepro::shadow_mapping
