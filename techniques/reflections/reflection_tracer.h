// The one interface of everything that finds what reflective samples reflect.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

#include "engine/gl/objects.h"
#include "engine/gl/pass.h"
#include "engine/gl/profiler.h"
#include "techniques/kit/whole_image.h"
#include "techniques/reflections/gbuffer.h"

namespace gfxrepro::reflections {

/// Glossy reflection ([xie2017] Sec. 4.6). The lobe of a sample with glossiness g is a cone around
/// the mirror direction of half angle g · maxHalfAngleRad; its rays lie on a Vogel spiral, even in
/// solid angle, the same for every sample and method (shaders/lobe.glsl). g = 0: the mirror ray
/// alone.
struct LobeSettings {
    int rays = 0;  // a glossy sample; 0: 8 (narrowest) … 49 (widest lobe), linearly in g
    float maxHalfAngleRad = 0.6F;
    /// Where reflections of glossiness g end: diagonal · (1 − g)^farExponent. The weight of what is
    /// reflected falls linearly to 0 over the last third of the way there. Mirrors (g = 0) do not
    /// fade.
    float farExponent = 4.0F;
};
int raysOf(const LobeSettings& lobe, float glossiness);
/// Ray `index` of `count` around a unit direction, as shaders/lobe.glsl has it. Unit.
glm::vec3 lobeDirection(const LobeSettings& lobe, const glm::vec3& mirrorDirection,
                        float glossiness, int index, int count);
float farPlaneM(const LobeSettings& lobe, float glossiness, float diagonalM);
/// Weight of a hit at `distanceM`: 1 for mirrors. Misses weigh 0 for glossy samples and 1 for
/// mirrors.
float fadeOf(const LobeSettings& lobe, float glossiness, float distanceM, float diagonalM);
/// Sets the active ones of the uniforms of shaders/lobe.glsl.
void setLobe(const gl::Program& program, const LobeSettings& lobe, float diagonalM);

/// What was found, a texel a sample of the G-buffer; undefined where nothing was asked for.
struct ReflectionTarget {
    gl::Texture radiance;  // RGBA16F, linear: rgb_n of Algorithm 6, weighted mean over the rays,
                           // the diffuse colour standing in for the rays' missing weight; a = 1
    gl::Texture distance;  // R32F, metres along the mirror ray; 0: it left the scene (or the method
                           // does not know)
    gl::Framebuffer framebuffer;  // attachments 0 and 1

    explicit ReflectionTarget(glm::ivec2 sizePx);
    std::size_t sizeBytes() const;
};

/// Second-order rays only: what they meet shows its diffuse colour (Sec. 4.7.4). Rays that meet
/// nothing show kBackground in the ray tracers; the other methods take the environment map in their
/// direction, for what their images lack as well.
class ReflectionTracer {
  public:
    virtual ~ReflectionTracer() = default;
    /// Once a frame, when the objects have been posed: acceleration structures are rebuilt.
    virtual void update(const GpuObjects& objects, gl::Profiler& profiler) = 0;
    /// For every reflective sample, or, where `wanted` (R8UI, the G-buffer's size) is given, for
    /// those of them where it is not 0. The passes are scopes of `profiler`.
    virtual void trace(const GBuffer& gbuffer, const gl::Texture* wanted, ReflectionTarget& target,
                       gl::Profiler& profiler) = 0;
    /// Held on the device by this method, the scene itself not counted.
    virtual std::size_t sizeBytes() const = 0;
    /// Of them, colours and depths that it draws reflections from.
    virtual std::size_t frameBufferBytes() const { return 0; }
};

/// A cube map of the scene's diffuse colours from the middle of its box (or where told),
/// kBackground where nothing is seen. Made once; render() again for moved objects. Shaders:
/// shaders/environment.glsl, `radianceFrom(direction)`.
class EnvironmentMap {
  public:
    static constexpr int kFaceSizePx = 512;
    /// From the middle of the scene's box.
    EnvironmentMap(const gl::ShaderLibrary& shaders, const ReflectiveScene& scene)
        : EnvironmentMap(shaders, scene, scene.boundsWorld().centre()) {}
    EnvironmentMap(const gl::ShaderLibrary& shaders, const ReflectiveScene& scene,
                   const glm::vec3& centreWorld);
    /// `objects` are of the constructor's scene.
    void render(const GpuObjects& objects);
    /// For passes that include environment.glsl.
    gl::Resources resources() const { return {{"environmentMap", cube_}}; }
    const gl::Texture& cube() const { return cube_; }
    std::size_t sizeBytes() const;

  private:
    glm::vec3 centreWorld_;
    gl::Texture cube_, depth_;
    gl::Pass pass_;
};

/// Environment mapping: every ray takes the map in its direction, wherever it starts. All rays
/// weigh the same, glossy ones too: the map knows no distances to fade by. Passes:
/// `environment_map` when it is drawn again, `intersection`.
class EnvironmentTracer final : public ReflectionTracer {
  public:
    EnvironmentTracer(const gl::ShaderLibrary& shaders, EnvironmentMap& map,
                      const LobeSettings& lobe, float diagonalM);
    /// Draws the map, again when an object has moved.
    void update(const GpuObjects& objects, gl::Profiler& profiler) override;
    void trace(const GBuffer& gbuffer, const gl::Texture* wanted, ReflectionTarget& target,
               gl::Profiler& profiler) override;
    std::size_t sizeBytes() const override;

  private:
    EnvironmentMap& map_;
    LobeSettings lobe_;
    float diagonalM_;
    gl::Pass pass_;
    kit::WholeImage wholeImage_;
    PoseWatch poses_;  // in which the map was drawn
};

/// McGuire and Mara 2014, "Efficient GPU Screen-Space Ray Tracing": each ray is marched texel by
/// texel through the G-buffer's depth, perspective-correct; a hit is a texel whose depth the ray
/// passes within `thicknessM` and that shows the side which the ray meets. What the eye does not
/// see takes the environment map. Pass: `intersection`.
class ScreenSpaceTracer final : public ReflectionTracer {
  public:
    ScreenSpaceTracer(const gl::ShaderLibrary& shaders, const EnvironmentMap& map,
                      const LobeSettings& lobe, float diagonalM, float thicknessM);
    void update(const GpuObjects&, gl::Profiler&) override {}
    void trace(const GBuffer& gbuffer, const gl::Texture* wanted, ReflectionTarget& target,
               gl::Profiler& profiler) override;
    std::size_t sizeBytes() const override { return 0; }

  private:
    const EnvironmentMap& map_;
    LobeSettings lobe_;
    float diagonalM_, thicknessM_;
    gl::Pass pass_;
    kit::WholeImage wholeImage_;
};

}  // namespace gfxrepro::reflections
