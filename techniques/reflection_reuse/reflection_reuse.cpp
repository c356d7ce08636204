#include "techniques/reflection_reuse/reflection_reuse.h"

#include <fmt/format.h>

#include <algorithm>

#include "techniques/clustered_reflections/clustered_tracer.h"
#include "techniques/reflections/gpu_ray_tracer.h"

namespace gfxrepro::reflection_reuse {

ReflectionReuse::ReflectionReuse(Params& params) : params_(params) {}

void ReflectionReuse::setup(technique::SetupContext& context) {
    const gl::ShaderLibrary& shaders = context.shaders;
    frame_.emplace(context, params_);
    tracer_ = std::make_unique<RestingTracer>(makeTracer(shaders));
    place({0, 1, context.profiler});
    if (params_.method == Method::RayTraced) {
        fullTracing_.emplace(FullTracing{reflections::GBufferRenderer(shaders, frame_->scene),
                                         reflections::GBuffer(view_),
                                         reflections::ReflectionTarget(frame_->samplesPx())});
    } else {
        ReuseSettings settings = params_.reuse;
        settings.reprojection.splitsDraws = context.device.info().isSoftware;
        renderer_.emplace(shaders, frame_->objects, *tracer_, settings, frame_->samplesPx(),
                          frame_->scene.diagonalM());
    }
    if (params_.fitsRecompute) recomputeTimes_.emplace(context.device.info().isSoftware);
}

std::unique_ptr<reflections::ReflectionTracer> ReflectionReuse::makeTracer(
    const gl::ShaderLibrary& shaders) {
    const reflections::LobeSettings& lobe = params_.lobe;
    const float diagonalM = frame_->scene.diagonalM();
    switch (params_.tracer) {
        case Tracer::Compute:
            return std::make_unique<reflections::GpuRayTracer>(shaders, frame_->objects,
                                                               frame_->map, lobe, diagonalM);
        case Tracer::Embree:
            return std::make_unique<reflections::EmbreeTracer>(shaders, frame_->scene, frame_->map,
                                                               lobe);
        case Tracer::Clustered:
            break;
    }
    clustered_reflections::ClusteredSettings settings;
    settings.camera.diagonalM = diagonalM;
    settings.camera.lobe = lobe;
    return std::make_unique<clustered_reflections::ClusteredTracer>(
        shaders, frame_->scene, frame_->objects, frame_->map, settings, frame_->samplesPx());
}

void ReflectionReuse::requireFrames(int frameCount) const {
    const int last = params_.firstFrame + frameCount - 1;
    if (last < params_.pathFrames) return;
    throw Error(
        fmt::format("frames {} … {} do not lie on a path of {} ('first_frame', 'path_frames')",
                    params_.firstFrame, last, params_.pathFrames));
}

/// Camera and objects as they are in a frame.
void ReflectionReuse::place(const technique::FrameContext& context) {
    requireFrames(context.frameCount);
    const double time = static_cast<double>(params_.firstFrame + context.frame) /
                        static_cast<double>(params_.pathFrames);
    view_ = frame_->viewAt(time);
    frame_->poseAt(time);
}

void ReflectionReuse::render(technique::FrameContext& context) {
    gl::Profiler& profiler = context.profiler;
    place(context);
    tracer_->update(frame_->objects, profiler);
    if (renderer_) {
        // Warm-ups and repetitions must not move the choice of key frames on.
        if (context.frame == frameIndex_) renderer_->undo();
        if (recomputeTimes_) keepLeastRecomputeTime();
        renderer_->render(view_, profiler, recomputeTimes_ ? &*recomputeTimes_ : nullptr);
    } else {
        traceFully(profiler);
    }
    frameIndex_ = context.frame;
    frameCount_ = context.frameCount;
    const gl::GpuScope scope(profiler, "composite");
    frame_->composite.render(gbuffer(), reflection());
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
        full.renderer.render(frame_->objects, full.gbuffer);
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
std::unique_ptr<technique::Technique> create(Params& params) {
    return std::make_unique<ReflectionReuse>(params);
}
}  // namespace

const technique::TechniqueInfo kReflectionReuse{
    "reflection_reuse", "mirror reflections of key frames reused in the frames after them", create,
    outputs};

}  // namespace gfxrepro::reflection_reuse
