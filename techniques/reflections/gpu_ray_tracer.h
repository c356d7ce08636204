// Ray tracing on the same GL device: the baseline that a speed-up is fair against.
#pragma once

#include "techniques/reflections/environment_map.h"
#include "techniques/reflections/gpu_bvh.h"
#include "techniques/reflections/reflection_tracer.h"

namespace gfxrepro::reflections {

/// GpuBvh, rebuilt by every update(), traversed in a compute shader: one invocation a sample of a
/// compacted list of those that want a reflection, one ray after the other. Passes: `bvh_build`
/// (and its parts), `ray_list`, `intersection`.
class GpuRayTracer final : public ReflectionTracer {
  public:
    /// `objects` and `map` outlive this.
    GpuRayTracer(const gl::ShaderLibrary& shaders, const GpuObjects& objects,
                 const EnvironmentMap& map, const LobeSettings& lobe, float diagonalM);
    /// `objects` are those of the constructor.
    void update(const GpuObjects& objects, gl::Profiler& profiler) override;
    void trace(const GBuffer& gbuffer, const gl::Texture* wanted, ReflectionTarget& target,
               gl::Profiler& profiler) override;
    std::size_t sizeBytes() const override;

    const GpuBvh& bvh() const { return bvh_; }

  private:
    void listSamples(const GBuffer& gbuffer, const gl::Texture* wanted);
    void traceSamples(const GBuffer& gbuffer, ReflectionTarget& target);

    const GpuObjects& objects_;
    const EnvironmentMap& map_;
    LobeSettings lobe_;
    float diagonalM_;
    GpuBvh bvh_;
    gl::Pass list_, trace_;
    gl::Buffer samples_, arguments_;
};

}  // namespace gfxrepro::reflections
