#include "techniques/reflection_reuse/reuse_renderer.h"

#include <utility>

#include "engine/core/error.h"

namespace gfxrepro::reflection_reuse {

namespace {

kit::View emptyView(glm::ivec2 sizePx) {
    kit::View view;
    view.sizePx = sizePx;
    return view;
}

bool isGathered(const ReuseSettings& settings) {
    return !settings.isDirect && settings.reprojection.resampling == Resampling::Gather;
}

ReprojectionSettings reprojectionOf(const ReuseSettings& settings) {
    ReprojectionSettings reprojection = settings.reprojection;
    if (!isGathered(settings)) reprojection.resampling = Resampling::Twice;
    return reprojection;
}

}  // namespace

ReuseRenderer::ReuseRenderer(const gl::ShaderLibrary& shaders,
                             const reflections::GpuObjects& objects,
                             reflections::ReflectionTracer& tracer, const ReuseSettings& settings,
                             glm::ivec2 sizePx, float diagonalM)
    : objects_(objects),
      tracer_(tracer),
      settings_(settings),
      gbufferRenderer_(shaders, objects.scene()),
      matcher_(shaders, settings.matching),
      reprojection_(shaders, reprojectionOf(settings), sizePx),
      mend_(shaders, {"kit/whole_image.vert.glsl", "reflection_reuse/mend.frag.glsl"}),
      key_(emptyView(sizePx), diagonalM),
      gbuffer_(emptyView(sizePx)),
      reflection_(sizePx),
      traced_(sizePx),
      offsets_{Offsets(sizePx), Offsets(sizePx)},
      wanted_(gl::Texture::make2D(GL_R8UI, sizePx)) {
    if (!settings.isDirect && !isGathered(settings)) shifted_.emplace(sizePx);
}

void ReuseRenderer::render(const kit::View& view, gl::Profiler& profiler) {
    GFXREPRO_ASSERT(view.sizePx == gbuffer_.view.sizePx);
    // First what every frame needs: the device draws it while the count of the frame before, by
    // which this one is a key frame or not, is waited for.
    {
        const gl::GpuScope scope(profiler, "diffuse");
        gbuffer_.view = view;
        gbufferRenderer_.render(objects_, gbuffer_);
    }
    isKeyFrame_ = isKeyFrameNext();
    hadOffsets_ = hasOffsets_;
    if (isKeyFrame_) {
        renderKeyFrame(profiler);
    } else {
        renderReused(profiler);
    }
    hasFrame_ = true;
    isUndone_ = false;
}

std::uint32_t ReuseRenderer::recomputedSamples() const {
    return isKeyFrame_ ? reprojection_.reflectiveSamples()
                       : static_cast<std::uint32_t>(recomputed_.result());
}

// [xie2017] Sec. 5.4.4: by what the frame before had to recompute.
bool ReuseRenderer::isKeyFrameNext() const {
    if (isUndone_) return isKeyFrame_;
    if (!hasFrame_) return true;
    if (isKeyFrame_) return false;
    const double share = double{settings_.keyFrameThreshold};
    return recomputedSamples() > share * reprojection_.reflectiveSamples();
}

void ReuseRenderer::renderKeyFrame(gl::Profiler& profiler) {
    std::swap(key_.gbuffer, gbuffer_);
    {
        const gl::GpuScope scope(profiler, "recompute");
        tracer_.trace(key_.gbuffer, nullptr, key_.reflection, profiler);
        reprojection_.wantAll(key_.gbuffer, wanted_);
    }
    const gl::GpuScope scope(profiler, "reflection_shift");
    reprojection_.setKeyFrame(key_);
    hasOffsets_ = false;
}

void ReuseRenderer::renderReused(gl::Profiler& profiler) {
    if (shifted_) {
        match(profiler);
        const gl::GpuScope scope(profiler, "reflection_shift");
        reprojection_.shift(key_, offsets_[0], *shifted_);
    }
    {
        const gl::GpuScope scope(profiler, "reflection_warp");
        if (isGathered(settings_)) {
            reprojection_.gather(key_, gbuffer_, reflection_, wanted_);
        } else {
            reprojection_.warp(key_, shifted_ ? shifted_->radiance : key_.reflection.radiance,
                               gbuffer_, reflection_, wanted_);
        }
    }
    const gl::GpuScope scope(profiler, "recompute");
    tracer_.trace(gbuffer_, &wanted_, traced_, profiler);
    mendReflections();
}

void ReuseRenderer::match(gl::Profiler& profiler) {
    const gl::GpuScope scope(profiler, "pixel_matching");
    std::swap(offsets_[0], offsets_[1]);
    matcher_.match(key_, gbuffer_.view.eyeWorld, hasOffsets_ ? &offsets_[1] : nullptr, offsets_[0]);
    hasOffsets_ = true;
}

void ReuseRenderer::mendReflections() {
    mend_.use(
        {{"wanted", wanted_}, {"traced", traced_.radiance}, {"tracedDistance", traced_.distance}});
    reflection_.framebuffer.bind();
    recomputed_.begin();
    wholeImage_.draw();
    recomputed_.end();
}

void ReuseRenderer::undo() {
    GFXREPRO_ASSERT(hasFrame_ && !isUndone_);
    isUndone_ = true;
    if (isKeyFrame_) return;  // it overwrote all there was, and so will the next
    hasOffsets_ = hadOffsets_;
    if (shifted_) std::swap(offsets_[0], offsets_[1]);
}

ReuseCounts ReuseRenderer::counts() const {
    ReuseCounts counts;
    counts.isKeyFrame = isKeyFrame_;
    if (!hasFrame_) return counts;
    counts.reflectiveSamples = reprojection_.reflectiveSamples();
    counts.recomputedSamples = recomputedSamples();
    return counts;
}

std::size_t ReuseRenderer::sizeBytes() const {
    return key_.sizeBytes() + gbuffer_.sizeBytes() + reflection_.sizeBytes() + traced_.sizeBytes() +
           offsets_[0].sizeBytes() + offsets_[1].sizeBytes() +
           (shifted_ ? shifted_->sizeBytes() : 0) + wanted_.sizeBytes() + reprojection_.sizeBytes();
}

}  // namespace gfxrepro::reflection_reuse
