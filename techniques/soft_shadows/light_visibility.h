// Which samples of the light an output pixel sees: shadow maps and the bits they leave.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "runner/gl/program.h"
#include "runner/raycast/ray_tracer.h"
#include "techniques/shared/drawable_scene.h"
#include "techniques/soft_shadows/area_light.h"
#include "techniques/soft_shadows/reconstruction.h"

namespace gfxrepro::soft_shadows {

/// The output samples: world position and unit geometric normal (turned to the eye) of what each
/// pixel of the output image shows; w of the position is 0 where nothing is seen.
struct Receivers {
    depth_images::View view;
    gl::Texture positions;  // RGBA32F
    gl::Texture normals;    // RGBA16F
    gl::Texture shading;    // RGBA8, unshadowed colour of the surface (no light term)
};

/// One bit a light sample and output pixel: 1 where the pixel sees the sample. Bit k of layer l is
/// light sample 32·l + k; sample (i, j) of an n × n light is number j·n + i. A pixel without a
/// surface sees all.
struct VisibilityMask {
    gl::Texture bits;  // R32UI array
    int sampleCount = 0;
};

struct HostVisibilityMask {
    glm::ivec2 sizePx{0};
    int sampleCount = 0;
    std::vector<std::uint32_t> bits;  // layer by layer, rows from the bottom
};

/// What casts shadows into a shadow map.
class ShadowCaster {
  public:
    virtual ~ShadowCaster() = default;
    /// Draws depth only; framebuffer, viewport and depth state are set. Binds its own program.
    virtual void draw(const depth_images::View& lightView) const = 0;
    virtual std::uint64_t triangleCount() const = 0;
};

struct ShadowMapSettings {
    int sizePx = 1024;
    /// How far the receiver is moved towards the light before the test, in shadow-map texels of its
    /// depth (the larger part along its normal; without it, surfaces shadow themselves).
    float biasTexels = 2.0F;
};

/// [xie2017] Algorithm 5, step 3: for each light sample a shadow map of the casters, and a test of
/// every output sample.
class LightVisibility {
  public:
    LightVisibility(const gl::ShaderLibrary& shaders, const ShadowMapSettings& settings);
    VisibilityMask accumulate(const Receivers& receivers, const AreaLight& light, int gridSize,
                              std::span<const ShadowCaster* const> casters);
};

HostVisibilityMask readMask(const VisibilityMask& mask);

/// The same bits by shadow rays: no shadow maps, no bias but the offset that keeps a ray off its
/// own triangle. Runs on all cores.
HostVisibilityMask traceVisibility(const raycast::RayTracer& tracer,
                                   const std::vector<glm::vec4>& positions,
                                   const std::vector<glm::vec4>& normals, glm::ivec2 sizePx,
                                   const AreaLight& light, int gridSize);

/// Errors of `measured` against `truth` ([xie2017] Sec. 3.4.2), scaled to 256 light samples,
/// over all pixels of the output image.
struct ShadowErrors {
    double visibilityMean = 0.0, visibilityMax = 0.0;  // wrong samples a pixel
    double intensityMean = 0.0, intensityMax = 0.0;    // |samples too bright − samples too dark|
    std::vector<float> signedError;  // a pixel: lit − truly lit, in samples of 256 (figure 16)
};
ShadowErrors compareMasks(const HostVisibilityMask& measured, const HostVisibilityMask& truth);

}  // namespace gfxrepro::soft_shadows
