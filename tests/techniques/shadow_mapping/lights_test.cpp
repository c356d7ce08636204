// Views of lights, their errors, and the steps as declared.
#include "techniques/shadow_mapping/lights.h"

#include <algorithm>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "techniques/shadow_mapping/shadow_map.h"
#include "tests/support/support.h"

namespace gfxrepro::shadow_mapping {
namespace {

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
