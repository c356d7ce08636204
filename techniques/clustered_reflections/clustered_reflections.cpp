#include "techniques/clustered_reflections/clustered_reflections.h"

#include "techniques/kit/path_view.h"
#include "techniques/reflections/gpu_ray_tracer.h"
#include "techniques/reflections/screen_space_tracer.h"

namespace gfxrepro::clustered_reflections {

ClusteredReflections::ClusteredReflections(Params& params) : params_(params) {}

void ClusteredReflections::setup(technique::SetupContext& context) {
    const gl::ShaderLibrary& shaders = context.shaders;
    frame_.emplace(context, params_);
    gbufferRenderer_.emplace(shaders, frame_->scene);
    gbuffer_.emplace(frame_->viewAt(kit::frameTime(0, 1)));
    target_.emplace(frame_->samplesPx());
    tracer_ = makeTracer(shaders);
    if (!params_.measuresErrors || params_.convergedRays == 0) return;
    reflections::LobeSettings lobe = params_.lobe;
    lobe.rays = params_.convergedRays;
    convergedTracer_.emplace(shaders, frame_->scene, frame_->map, lobe);
}

std::unique_ptr<reflections::ReflectionTracer> ClusteredReflections::makeTracer(
    const gl::ShaderLibrary& shaders) {
    const reflections::LobeSettings& lobe = params_.lobe;
    const float diagonalM = frame_->scene.diagonalM();
    switch (params_.method) {
        case Method::EnvironmentMap:
            return std::make_unique<reflections::EnvironmentTracer>(shaders, frame_->map, lobe,
                                                                    diagonalM);
        case Method::ScreenSpace:
            return std::make_unique<reflections::ScreenSpaceTracer>(
                shaders, frame_->map, lobe, diagonalM, params_.thickness * diagonalM);
        case Method::RayTraced:
            return std::make_unique<reflections::GpuRayTracer>(shaders, frame_->objects,
                                                               frame_->map, lobe, diagonalM);
        case Method::Embree:
            return std::make_unique<reflections::EmbreeTracer>(shaders, frame_->scene, frame_->map,
                                                               lobe);
        case Method::Clustered:
            break;
    }
    ClusteredSettings settings = params_.clustered;
    settings.camera.diagonalM = diagonalM;
    settings.camera.lobe = lobe;
    auto tracer = std::make_unique<ClusteredTracer>(shaders, frame_->scene, frame_->objects,
                                                    frame_->map, settings, frame_->samplesPx());
    clusteredTracer_ = tracer.get();
    return tracer;
}

// [xie2017] Algorithm 6
void ClusteredReflections::render(technique::FrameContext& context) {
    gl::Profiler& profiler = context.profiler;
    const double time = kit::frameTime(context.frame, context.frameCount);
    gbuffer_->view = frame_->viewAt(time);
    frame_->poseAt(time);
    {  // step 1
        const gl::GpuScope scope(profiler,
                                 clusteredTracer_ ? "first_pass_and_clustering" : "first_pass");
        gbufferRenderer_->render(frame_->objects, *gbuffer_);
    }
    // Steps 2 and 3, or what stands for them.
    tracer_->update(frame_->objects, profiler);
    tracer_->trace(*gbuffer_, nullptr, *target_, profiler);
    if (!params_.drawsReflections()) return;
    const gl::GpuScope scope(profiler, "composite");  // step 3.c.iii
    frame_->composite.render(*gbuffer_, *target_);
}

namespace {
std::unique_ptr<technique::Technique> create(Params& params) {
    return std::make_unique<ClusteredReflections>(params);
}
}  // namespace

const technique::TechniqueInfo kClusteredReflections{
    "clustered_reflections", "mirror and glossy reflections from clustered depth images", create,
    outputs};

}  // namespace gfxrepro::clustered_reflections
