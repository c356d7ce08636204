// Step 1 of [zju2005] Sec. 4.1: the scene's depth as each light sees it.
#pragma once

#include <optional>
#include <span>

#include "techniques/kit/drawable_scene.h"
#include "techniques/kit/whole_image.h"
#include "techniques/shadow_mapping/lights.h"
#include "techniques/shadow_mapping/shadow_steps.h"

namespace gfxrepro::shadow_mapping {

/// A light's map. Standard: window z in R32F. Hardware: a depth texture (compare mode unless the
/// filter reads depths). Variance: mean depth and mean square, RG32F, depth as a share of near …
/// far along the axis.
struct ShadowMap {
    std::vector<LightView> views;
    gl::Texture colour;   // Standard and Variance
    gl::Texture blurred;  // Variance: between the two blurs
    gl::Texture depth;
    gl::Framebuffer framebuffer;
    gl::Framebuffer blurredFramebuffer;
    gl::Framebuffer colourFramebuffer;  // without depth: the second blur

    /// What step 2 fetches from.
    const gl::Texture& lookup() const { return colour.id() != 0 ? colour : depth; }
    std::size_t sizeBytes() const;
};

class ShadowMapRenderer {
  public:
    /// Throws Error as declaredSteps() does.
    ShadowMapRenderer(const gl::ShaderLibrary& shaders, const ShadowMapSettings& settings);

    /// Draws the maps of all lights. Casters are opaque (alpha is not tested) and not culled.
    /// Throws Error for lights without a view (viewsOf) and for more than kMaxLights,
    /// UnsupportedError for maps beyond the device's limits.
    void render(const kit::DrawableScene& scene, std::span<const Light> lights);

    const ShadowMapSettings& settings() const { return settings_; }
    const std::vector<StepDeclaration>& steps() const { return steps_; }
    const std::vector<Light>& lights() const { return lights_; }
    const std::vector<ShadowMap>& maps() const { return maps_; }
    std::size_t sizeBytes() const;

  private:
    ShadowMap makeMap(glm::ivec2 sizePx) const;
    void drawDepth(const kit::DrawableScene& scene, const ShadowMap& map) const;
    void blur(const ShadowMap& map) const;

    ShadowMapSettings settings_;
    std::vector<StepDeclaration> steps_;
    gl::Program depthProgram_;
    std::optional<gl::Pass> blur_;
    kit::WholeImage wholeImage_;
    std::vector<Light> lights_;
    std::vector<ShadowMap> maps_;
};

}  // namespace gfxrepro::shadow_mapping
