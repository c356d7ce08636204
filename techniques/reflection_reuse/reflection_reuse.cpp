#include "techniques/reflection_reuse/reflection_reuse.h"

#include <fmt/format.h>

#include <algorithm>

#include "runner/scene/animation.h"
#include "techniques/clustered_reflections/clustered_tracer.h"
#include "techniques/kit/path_view.h"
#include "techniques/kit/requirements.h"
#include "techniques/reflection_reuse/outputs.h"
#include "techniques/reflections/gpu_ray_tracer.h"

namespace gfxrepro::reflection_reuse {

ReflectionReuse::ReflectionReuse(config::Params& params) : params_(params) {}

void ReflectionReuse::setup(technique::SetupContext& context) {
    const gl::ShaderLibrary& shaders = context.shaders;
    scene_.emplace(kit::requireScene(context, "reflection_reuse"), params_.reflectors,
                   params_.textureFilter);
    scene_->printWarnings();
    scene_->requireReflectors();
    if (params_.glossiness) scene_->setGlossiness(*params_.glossiness);
    outputSizePx_ = context.outputSizePx;
    const glm::ivec2 samplesPx = params_.supersampling * outputSizePx_;

    objects_.emplace(*scene_, context.device.info().isSoftware);
    map_.emplace(shaders, *scene_);
    map_->render(*objects_);
    tracer_ = std::make_unique<RestingTracer>(makeTracer(shaders));
    composite_.emplace(shaders, outputSizePx_, params_.supersampling, params_.blend);
    place({0, 1, context.profiler});
    if (params_.method == Method::RayTraced) {
        fullTracing_.emplace(FullTracing{reflections::GBufferRenderer(shaders, *scene_),
                                         reflections::GBuffer(view_),
                                         reflections::ReflectionTarget(samplesPx)});
    } else {
        ReuseSettings settings = params_.reuse;
        settings.reprojection.splitsDraws = context.device.info().isSoftware;
        renderer_.emplace(shaders, *objects_, *tracer_, settings, samplesPx, scene_->diagonalM());
    }
    if (params_.fitsRecompute) recomputeTimes_.emplace(context.device.info().isSoftware);
    if (!params_.measuresErrors) return;
    untimed_ = std::make_unique<gl::Profiler>(context.device.info().isSoftware);
    truthTracer_.emplace(shaders, *scene_, *map_, params_.lobe);
}

std::unique_ptr<reflections::ReflectionTracer> ReflectionReuse::makeTracer(
    const gl::ShaderLibrary& shaders) {
    const reflections::LobeSettings& lobe = params_.lobe;
    const float diagonalM = scene_->diagonalM();
    switch (params_.tracer) {
        case Tracer::Compute:
            return std::make_unique<reflections::GpuRayTracer>(shaders, *objects_, *map_, lobe,
                                                               diagonalM);
        case Tracer::Embree:
            return std::make_unique<reflections::EmbreeTracer>(shaders, *scene_, *map_, lobe);
        case Tracer::Clustered:
            break;
    }
    clustered_reflections::ClusteredSettings settings;
    settings.camera.diagonalM = diagonalM;
    settings.camera.lobe = lobe;
    return std::make_unique<clustered_reflections::ClusteredTracer>(
        shaders, *scene_, *objects_, *map_, settings, params_.supersampling * outputSizePx_);
}

/// Camera and objects as they are in a frame.
void ReflectionReuse::place(const technique::FrameContext& context) {
    const int last = params_.firstFrame + context.frameCount - 1;
    if (last >= params_.pathFrames) {
        throw Error(
            fmt::format("frames {} … {} do not lie on a path of {} ('first_frame', "
                        "'path_frames')",
                        params_.firstFrame, last, params_.pathFrames));
    }
    const double time = static_cast<double>(params_.firstFrame + context.frame) /
                        static_cast<double>(params_.pathFrames);
    const glm::vec2 size(outputSizePx_);
    const scene::Camera camera =
        kit::cameraAtTime(scene_->scene(), params_.view, time, size.x / size.y);
    view_ = kit::viewOf(camera, params_.supersampling * outputSizePx_);
    if (params_.hasMotion) objects_->setPoses(scene::posesAt(scene_->scene(), time));
}

void ReflectionReuse::render(technique::FrameContext& context) {
    gl::Profiler& profiler = context.profiler;
    place(context);
    tracer_->update(*objects_, profiler);
    if (renderer_) {
        // Warm-ups and repetitions must not move the choice of key frames on.
        if (context.frame == frame_) renderer_->undo();
        if (recomputeTimes_) keepLeastRecomputeTime();
        renderer_->render(view_, profiler, recomputeTimes_ ? &*recomputeTimes_ : nullptr);
    } else {
        traceFully(profiler);
    }
    frame_ = context.frame;
    frameCount_ = context.frameCount;
    const gl::GpuScope scope(profiler, "composite");
    composite_->render(gbuffer(), reflection());
}

/// Of a frame's repetitions the fastest counts: what else runs on the machine only adds.
void ReflectionReuse::keepLeastRecomputeTime() {
    for (const gl::PassTime& time : recomputeTimes_->collect()) {
        leastRecomputeMs_ = std::min(leastRecomputeMs_.value_or(time.timeMs), time.timeMs);
    }
}

// The passes have the names that they have between key frames.
void ReflectionReuse::traceFully(gl::Profiler& profiler) {
    FullTracing& full = *fullTracing_;
    full.gbuffer.view = view_;
    {
        const gl::GpuScope scope(profiler, "diffuse");
        full.renderer.render(*objects_, full.gbuffer);
    }
    const gl::GpuScope scope(profiler, "recompute");
    tracer_->trace(full.gbuffer, nullptr, full.target, profiler);
}

const reflections::GBuffer& ReflectionReuse::gbuffer() const {
    return renderer_ ? renderer_->gbuffer() : fullTracing_->gbuffer;
}

const reflections::ReflectionTarget& ReflectionReuse::reflection() const {
    return renderer_ ? renderer_->reflection() : fullTracing_->target;
}

namespace {
std::unique_ptr<technique::Technique> create(config::Params& params) {
    return std::make_unique<ReflectionReuse>(params);
}
}  // namespace

const technique::TechniqueInfo kReflectionReuse{
    "reflection_reuse", "mirror reflections of key frames reused in the frames after them", create,
    outputs};

}  // namespace gfxrepro::reflection_reuse
