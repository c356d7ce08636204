// Screen-space reflection: the modern comparator that needs no more than the eye's own image.
#pragma once

#include "techniques/kit/whole_image.h"
#include "techniques/reflections/environment_map.h"
#include "techniques/reflections/reflection_tracer.h"

namespace gfxrepro::reflections {

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
