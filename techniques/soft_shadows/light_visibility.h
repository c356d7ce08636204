// Which samples of the light an output pixel sees, by shadow maps: one bit each.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/gl/pass.h"
#include "techniques/kit/drawable_scene.h"
#include "techniques/kit/whole_image.h"
#include "techniques/soft_shadows/area_light.h"

namespace gfxrepro::soft_shadows {

/// The output samples: what each pixel of the output image shows.
struct Receivers {
    kit::View view;
    gl::Texture positions;  // RGBA32F, world space; w is 0 where nothing is seen
    gl::Texture normals;    // RGBA16F, unit, geometric, turned to the eye
    gl::Texture shading;    // RGBA8, linear, the surface's colour without light
};

Receivers renderReceivers(const gl::ShaderLibrary& shaders, const kit::DrawableScene& scene,
                          const kit::View& view);

/// One bit a light sample and output pixel: 1 where the pixel sees the sample. Sample (i, j) of an
/// n × n light is number s = j·n + i, bit s mod 32 of layer s div 32. A pixel without a surface
/// sees all. Layers are textures of their own, so that each can be drawn to.
struct VisibilityMask {
    struct Layer {
        gl::Texture bits;  // R32UI
        gl::Framebuffer framebuffer;
    };
    std::vector<Layer> layers;
    int sampleCount = 0;
};

/// The unit axis of a view.
glm::vec3 forwardOf(const kit::View& view);

/// What casts shadows into a shadow map.
class ShadowCaster {
  public:
    virtual ~ShadowCaster() = default;
    /// Draws depth only; framebuffer, viewport and depth state are set. Binds its own program and
    /// sets culling.
    virtual void draw(const kit::View& lightView) const = 0;
    virtual std::uint64_t triangleCount() const = 0;
};

struct ShadowMapSettings {
    int sizePx = 1024;
    /// How far a receiver is moved towards the light before the test, in texels at its distance.
    /// Its plane is compared at the texel's centre, so planes need none; it covers surfaces that
    /// bend within a texel. Higher values lift shadows off their casters.
    float biasTexels = 1.0F;
};

/// [xie2017] Algorithm 5, step 3: for each light sample a shadow map of all casters, and a test of
/// every output sample. Memory: one shadow map, reused.
class LightVisibility {
  public:
    LightVisibility(const gl::ShaderLibrary& shaders, const ShadowMapSettings& settings);

    /// Makes the mask for `gridSize`² samples of the light.
    static VisibilityMask makeMask(glm::ivec2 sizePx, int gridSize);
    /// Overwrites `mask`.
    void accumulate(VisibilityMask& mask, const Receivers& receivers, const AreaLight& light,
                    int gridSize, std::span<const ShadowCaster* const> casters) const;

    /// What accumulate() is measured against: the same shadow maps, and a pass that only writes
    /// instead of each test. Leaves nothing of use in `mask`.
    void drawMapsAndPlainPasses(VisibilityMask& mask, const AreaLight& light, int gridSize,
                                std::span<const ShadowCaster* const> casters) const;

    /// The two halves of one light sample.
    void drawShadowMap(const kit::View& lightView,
                       std::span<const ShadowCaster* const> casters) const;
    void test(VisibilityMask& mask, int sample, const Receivers& receivers,
              const kit::View& lightView) const;

    /// Bias in metres a metre of distance from the light.
    float biasPerDistance(const kit::View& lightView) const;
    /// Window depth (0 near … 1 far) of the last shadow map, Depth32F.
    const gl::Texture& shadowMap() const { return shadowMap_; }

  private:
    void drawBits(VisibilityMask& mask, int sample) const;

    ShadowMapSettings settings_;
    gl::Texture shadowMap_;
    gl::Framebuffer framebuffer_;
    gl::Pass test_;
    gl::Program plainPass_;
    kit::WholeImage wholeImage_;
};

}  // namespace gfxrepro::soft_shadows
