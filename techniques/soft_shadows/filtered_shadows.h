// Modern comparators: soft shadows by filtering one shadow map from the light's centre.
#pragma once

#include <vector>

#include "techniques/soft_shadows/light_visibility.h"

namespace gfxrepro::soft_shadows {

enum class ShadowFilter {
    Pcss,      // percentage-closer soft shadows: blocker search, penumbra estimate, filter
    Variance,  // variance soft shadow mapping: the same with Chebyshev's bound over moments
};

/// One shadow map from the light's centre and a filter as wide as the penumbra that similar
/// triangles give: w = w_light · (d_receiver − d_blocker) / d_blocker.
class FilteredShadows {
  public:
    FilteredShadows(const gl::ShaderLibrary& shaders, ShadowFilter filter,
                    const ShadowMapSettings& settings);

    /// The share of the light that each output sample sees: R32F of the receivers' size, 1 where
    /// there is no surface.
    void render(const Receivers& receivers, const AreaLight& light,
                std::span<const ShadowCaster* const> casters, const gl::Texture& litShares);

    static gl::Texture makeShares(glm::ivec2 sizePx) {
        return gl::Texture::make2D(GL_R32F, sizePx);
    }

  private:
    void makeMoments(const kit::View& view);

    ShadowMapSettings settings_;
    LightVisibility shadowMap_;
    gl::Pass filter_;
    gl::Pass moments_;           // variance only
    gl::Texture momentPyramid_;  // RG32F, all levels; variance only
};

}  // namespace gfxrepro::soft_shadows
