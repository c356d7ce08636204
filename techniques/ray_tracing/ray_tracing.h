// The technique `ray_tracing`: the ray tracer that chapter 4 of xie2017 compares with. See
// README.md.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "runner/technique/technique.h"
#include "techniques/shared/reflections/composite.h"
#include "techniques/shared/reflections/embree_tracer.h"
#include "techniques/shared/reflections/gpu_ray_tracer.h"

namespace gfxrepro::ray_tracing {

enum class Method {
    Compute,  // on the GL device
    Embree,   // on the CPU
};

struct RayTracingParams {
    Method method = Method::Compute;
    std::string
        view;  // a path or camera of the scene; empty: its first path, else its first camera
    bool hasMotion = false;
    int supersampling = 2;
    std::optional<float> glossiness;  // overrides the materials'
    reflections::LobeSettings lobe;
    reflections::ReflectorRule reflectors;
    bool measuresErrors = false;  // against Embree, ray by ray

    /// Declares the parameters. Throws Error for combinations that mean nothing.
    explicit RayTracingParams(config::Params& params);
};

class RayTracing final : public technique::Technique {
  public:
    explicit RayTracing(config::Params& params);

    void setup(technique::SetupContext& context) override;
    void render(technique::FrameContext& context) override;
    void record(technique::Recorder& recorder) override;
    const gl::Texture* frameImage() const override {
        return composite_ ? &composite_->output() : nullptr;
    }

  private:
    void recordErrors(technique::Recorder& recorder, const reflections::HostGBuffer& gbuffer);

    RayTracingParams params_;
    glm::ivec2 outputSizePx_{0};
    std::optional<reflections::ReflectiveScene> scene_;
    std::optional<reflections::GpuObjects> objects_;
    std::optional<reflections::EnvironmentMap> map_;
    std::optional<reflections::GBufferRenderer> gbufferRenderer_;
    std::optional<reflections::GBuffer> gbuffer_;
    std::optional<reflections::ReflectionTarget> target_;
    std::optional<reflections::GpuRayTracer> computeTracer_;
    std::optional<reflections::EmbreeTracer> embreeTracer_;  // the method, or the truth
    std::optional<reflections::Composite> composite_;
};

extern const technique::TechniqueInfo kRayTracing;

}  // namespace gfxrepro::ray_tracing
