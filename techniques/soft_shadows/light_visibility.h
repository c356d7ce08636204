// Which samples of the light an output pixel sees, by shadow maps: one bit each.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/gl/pass.h"
#include "techniques/kit/drawable_scene.h"
#include "techniques/kit/view.h"
#include "techniques/kit/whole_image.h"

namespace gfxrepro::soft_shadows {

// A rectangular light and the views from its points.

/// How the views from a light's points stand: the image's edges are along the light's in both.
enum class LightViewFrame {
    Parallel,  // image planes parallel to the light, frusta off centre (Heckbert and Herf 1997)
    Aimed,     // each view looks at the centre of the casters' box
};

struct AreaLightSettings {
    float sizeRatio = 1.0F;     // diagonal of the light : diagonal of the scene's box; 0: a point
    float height = 1.5F;        // distance of its centre from the box's centre, in box diagonals
    float azimuthRad = 0.6F;    // of the direction to the light, about y, from +z towards +x
    float elevationRad = 1.0F;  // of that direction above the horizon
    LightViewFrame viewFrame = LightViewFrame::Parallel;
};

/// A square in space that faces the centre of the scene's box. Corner order: around the square.
struct AreaLight {
    glm::vec3 centre;
    glm::mat3 axes;      // unit: right and up along its edges, and the way back from the scene
    float halfEdge;      // m
    scene::Box casters;  // what its views must hold
    LightViewFrame viewFrame = LightViewFrame::Parallel;

    /// The point at (x, y), each from −1 to 1 on the light.
    glm::vec3 at(const glm::vec2& position) const;
    glm::vec3 corner(int index) const;  // 0 … 3
    /// Point (i, j) of an n × n grid: the middle of its cell.
    glm::vec3 sample(int i, int j, int n) const;
};

AreaLight makeAreaLight(const scene::Box& casters, const AreaLightSettings& settings);

/// The view from a point on the light, which need not be one of its samples. Its frustum is the
/// narrowest square one that holds the casters' box, with a margin of two pixels. Throws Error when
/// the box comes near to the plane of its eye or beyond: it would have to be half of space.
kit::View lightView(const AreaLight& light, const glm::vec3& point, int sizePx);

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

struct SampleMapSettings {
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
    LightVisibility(const gl::ShaderLibrary& shaders, const SampleMapSettings& settings);

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

    SampleMapSettings settings_;
    gl::Texture shadowMap_;
    gl::Framebuffer framebuffer_;
    gl::Pass test_;
    gl::Program plainPass_;
    kit::WholeImage wholeImage_;
};

// Modern comparators: soft shadows by filtering one shadow map from the light's centre.

enum class ShadowFilter {
    Pcss,      // percentage-closer soft shadows: blocker search, penumbra estimate, filter
    Variance,  // variance soft shadow mapping: the same with Chebyshev's bound over moments
};

/// One shadow map from the light's centre and a filter as wide as the penumbra that similar
/// triangles give: w = w_light · (d_receiver − d_blocker) / d_blocker.
class FilteredShadows {
  public:
    FilteredShadows(const gl::ShaderLibrary& shaders, ShadowFilter filter,
                    const SampleMapSettings& settings);

    /// The share of the light that each output sample sees: R32F of the receivers' size, 1 where
    /// there is no surface.
    void render(const Receivers& receivers, const AreaLight& light,
                std::span<const ShadowCaster* const> casters, const gl::Texture& litShares);

    static gl::Texture makeShares(glm::ivec2 sizePx) {
        return gl::Texture::make2D(GL_R32F, sizePx);
    }

  private:
    void makeMoments(const kit::View& view);

    SampleMapSettings settings_;
    LightVisibility shadowMap_;
    gl::Pass filter_;
    gl::Pass moments_;           // variance only
    gl::Texture momentPyramid_;  // RG32F, all levels; variance only
};

}  // namespace gfxrepro::soft_shadows
