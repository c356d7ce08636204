#include "techniques/clustered_reflections/clustered_reflections.h"

#include <fmt/format.h>

#include "runner/scene/animation.h"
#include "techniques/clustered_reflections/outputs.h"
#include "techniques/kit/path_view.h"
#include "techniques/kit/requirements.h"
#include "techniques/reflections/gpu_ray_tracer.h"
#include "techniques/reflections/screen_space_tracer.h"

namespace gfxrepro::clustered_reflections {

ClusteredReflections::ClusteredReflections(config::Params& params) : params_(params) {}

void ClusteredReflections::setup(technique::SetupContext& context) {
    const gl::ShaderLibrary& shaders = context.shaders;
    scene_.emplace(kit::requireScene(context, "clustered_reflections"), params_.reflectors,
                   params_.textureFilter);
    scene_->printWarnings();
    scene_->requireReflectors();
    if (params_.glossiness) scene_->setGlossiness(*params_.glossiness);
    outputSizePx_ = context.outputSizePx;
    const glm::ivec2 samplesPx = params_.supersampling * outputSizePx_;
    const glm::vec2 size(outputSizePx_);
    const scene::Camera camera =
        kit::cameraFor(scene_->scene(), params_.view, 0, 1, size.x / size.y);

    objects_.emplace(*scene_, context.device.info().isSoftware);
    map_.emplace(shaders, *scene_);
    map_->render(*objects_);
    gbufferRenderer_.emplace(shaders, *scene_);
    gbuffer_.emplace(kit::viewOf(camera, samplesPx));
    target_.emplace(samplesPx);
    tracer_ = makeTracer(shaders);
    composite_.emplace(shaders, outputSizePx_, params_.supersampling);
    if (!params_.measuresErrors) return;
    untimed_ = std::make_unique<gl::Profiler>(context.device.info().isSoftware);
    truthTracer_.emplace(shaders, *scene_, *map_, params_.lobe);
    if (params_.convergedRays == 0) return;
    reflections::LobeSettings lobe = params_.lobe;
    lobe.rays = params_.convergedRays;
    convergedTracer_.emplace(shaders, *scene_, *map_, lobe);
}

std::unique_ptr<reflections::ReflectionTracer> ClusteredReflections::makeTracer(
    const gl::ShaderLibrary& shaders) {
    const reflections::LobeSettings& lobe = params_.lobe;
    const float diagonalM = scene_->diagonalM();
    switch (params_.method) {
        case Method::EnvironmentMap:
            return std::make_unique<reflections::EnvironmentTracer>(shaders, *map_, lobe,
                                                                    diagonalM);
        case Method::ScreenSpace:
            return std::make_unique<reflections::ScreenSpaceTracer>(shaders, *map_, lobe, diagonalM,
                                                                    params_.thickness * diagonalM);
        case Method::RayTraced:
            return std::make_unique<reflections::GpuRayTracer>(shaders, *objects_, *map_, lobe,
                                                               diagonalM);
        case Method::Embree:
            return std::make_unique<reflections::EmbreeTracer>(shaders, *scene_, *map_, lobe);
        case Method::Clustered:
            break;
    }
    ClusteredSettings settings = params_.clustered;
    settings.camera.diagonalM = diagonalM;
    settings.camera.lobe = lobe;
    auto tracer = std::make_unique<ClusteredTracer>(shaders, *scene_, *objects_, *map_, settings,
                                                    params_.supersampling * outputSizePx_);
    clusteredTracer_ = tracer.get();
    return tracer;
}

// [xie2017] Algorithm 6
void ClusteredReflections::render(technique::FrameContext& context) {
    gl::Profiler& profiler = context.profiler;
    const glm::vec2 size(outputSizePx_);
    const scene::Camera camera = kit::cameraFor(scene_->scene(), params_.view, context.frame,
                                                context.frameCount, size.x / size.y);
    gbuffer_->view = kit::viewOf(camera, params_.supersampling * outputSizePx_);
    if (params_.hasMotion) {
        const double time = kit::frameTime(context.frame, context.frameCount);
        objects_->setPoses(scene::posesAt(scene_->scene(), time));
    }
    {  // step 1
        const gl::GpuScope scope(profiler,
                                 clusteredTracer_ ? "first_pass_and_clustering" : "first_pass");
        gbufferRenderer_->render(*objects_, *gbuffer_);
    }
    // Steps 2 and 3, or what stands for them.
    tracer_->update(*objects_, profiler);
    tracer_->trace(*gbuffer_, nullptr, *target_, profiler);
    const gl::GpuScope scope(profiler, "composite");  // step 3.c.iii
    composite_->render(*gbuffer_, *target_);
}

namespace {
std::unique_ptr<technique::Technique> create(config::Params& params) {
    return std::make_unique<ClusteredReflections>(params);
}
}  // namespace

const technique::TechniqueInfo kClusteredReflections{
    "clustered_reflections", "mirror and glossy reflections from clustered depth images", create,
    outputs};

}  // namespace gfxrepro::clustered_reflections
