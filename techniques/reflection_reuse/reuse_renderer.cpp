#include "techniques/reflection_reuse/reuse_renderer.h"

#include <array>
#include <optional>
#include <utility>

#include "engine/core/error.h"
#include "techniques/reflection_reuse/moved_objects.h"

namespace gfxrepro::reflection_reuse {

namespace {

kit::View emptyView(glm::ivec2 sizePx) {
    kit::View view;
    view.sizePx = sizePx;
    return view;
}

}  // namespace

struct ReuseRenderer::Impl {
    const reflections::GpuObjects& objects;
    reflections::ReflectionTracer& tracer;
    ReuseSettings settings;
    reflections::GBufferRenderer gbufferRenderer;
    PixelMatcher matcher;
    Reprojection reprojection;
    MovedObjects movedObjects;
    gl::Pass mend;
    ReflectionDepthImage key;
    reflections::GBuffer gbuffer;              // of this frame; of a key frame, `key` has it
    reflections::ReflectionTarget reflection;  // of frames that are not key frames
    reflections::ReflectionTarget traced;
    std::array<Offsets, 2> offsets;       // of this and of the frame before
    std::optional<ShiftedImage> shifted;  // of two steps
    gl::Texture wanted;
    gl::SampleQuery recomputed;
    kit::WholeImage wholeImage;
    bool hasFrame = false;
    bool isKeyFrame = false;  // the last frame
    bool hasOffsets = false;  // of the frame before, for the same key frame
    bool hadOffsets = false;  // before the last render()
    bool isUndone = false;    // isKeyFrame is what the next frame is, then, not what the last was

    Impl(const gl::ShaderLibrary& shaders, const reflections::GpuObjects& ofObjects,
         reflections::ReflectionTracer& byTracer, const ReuseSettings& withSettings,
         glm::ivec2 sizePx, float diagonalM)
        : objects(ofObjects),
          tracer(byTracer),
          settings(withSettings),
          gbufferRenderer(shaders, objects.scene()),
          matcher(shaders, settings.matching),
          reprojection(shaders, settings.reprojection, sizePx),
          movedObjects(shaders, sizePx),
          mend(shaders, {"kit/whole_image.vert.glsl", "reflection_reuse/mend.frag.glsl"}),
          key(emptyView(sizePx), diagonalM),
          gbuffer(emptyView(sizePx)),
          reflection(sizePx),
          traced(sizePx),
          offsets{Offsets(sizePx), Offsets(sizePx)},
          wanted(gl::Texture::make2D(GL_R8UI, sizePx)) {
        if (!settings.isDirect && settings.reprojection.resampling == Resampling::Twice)
            shifted.emplace(sizePx);
    }

    std::uint32_t recomputedSamples() const {
        return isKeyFrame ? reprojection.reflectiveSamples()
                          : static_cast<std::uint32_t>(recomputed.result());
    }

    // [xie2017] Sec. 5.4.4: by what the frame before had to recompute.
    bool isKeyFrameNext() const {
        if (isUndone) return isKeyFrame;
        if (!hasFrame) return true;
        if (isKeyFrame) return false;
        const double share = double{settings.keyFrameThreshold};
        return recomputedSamples() > share * reprojection.reflectiveSamples();
    }

    void drawDiffuse(const kit::View& view, gl::Profiler& profiler) {
        const gl::GpuScope scope(profiler, "diffuse");
        gbuffer.view = view;
        gbufferRenderer.render(objects, gbuffer);
    }

    void renderKeyFrame(gl::Profiler& profiler) {
        std::swap(key.gbuffer, gbuffer);
        {
            const gl::GpuScope scope(profiler, "recompute");
            tracer.trace(key.gbuffer, nullptr, key.reflection, profiler);
            reprojection.wantAll(key.gbuffer, wanted);
        }
        const gl::GpuScope scope(profiler, "reflection_shift");
        reprojection.setKeyFrame(key);
        movedObjects.setKeyFrame(objects);
        hasOffsets = false;
    }

    void renderReused(gl::Profiler& profiler, gl::Profiler* recomputeTimes) {
        const bool hasMoved = settings.recomputesMoved && movedObjects.find(objects);
        if (!settings.isDirect) match(profiler);
        const gl::Texture* doubtful =
            hasMoved && !settings.isDirect ? &movedObjects.doubtful(key) : nullptr;
        if (shifted) {
            const gl::GpuScope scope(profiler, "reflection_shift");
            reprojection.shift(key, offsets[0], doubtful, *shifted);
        }
        {
            const gl::GpuScope scope(profiler, "reflection_warp");
            warp(doubtful);
            if (hasMoved) movedObjects.want(objects, gbuffer, key.diagonalM, wanted);
        }
        const gl::GpuScope scope(profiler, "recompute");
        std::optional<gl::GpuScope> own;
        if (recomputeTimes != nullptr) own.emplace(*recomputeTimes, "recompute");
        tracer.trace(gbuffer, &wanted, traced, profiler);
        mendReflections();
    }

    void match(gl::Profiler& profiler) {
        const gl::GpuScope scope(profiler, "pixel_matching");
        std::swap(offsets[0], offsets[1]);
        matcher.match(key, gbuffer.view.eyeWorld, hasOffsets ? &offsets[1] : nullptr, offsets[0]);
        hasOffsets = true;
    }

    void warp(const gl::Texture* doubtful) {
        if (shifted) {
            reprojection.warp(key, shifted->radiance, gbuffer, reflection, wanted);
        } else if (settings.isDirect) {
            reprojection.warp(key, key.reflection.radiance, gbuffer, reflection, wanted);
        } else {
            reprojection.project(key, offsets[0], doubtful, gbuffer, reflection, wanted);
        }
    }

    void mendReflections() {
        // Read while it is drawn to: OpenGL 4.5 (Sec. 9.3.1) allows it where the texels read and
        // those written are different ones, as reused and recomputed samples are.
        glTextureBarrier();
        mend.set("seamPx", settings.seamPx);
        mend.use(gl::Resources{{"wanted", wanted},
                               {"traced", traced.radiance},
                               {"tracedDistance", traced.distance},
                               {"reused", reflection.radiance}}
                     .with(gbuffer.resourcesFor(mend)));
        reflection.framebuffer.bind();
        recomputed.begin();
        wholeImage.draw();
        recomputed.end();
    }
};

ReuseRenderer::ReuseRenderer(const gl::ShaderLibrary& shaders,
                             const reflections::GpuObjects& objects,
                             reflections::ReflectionTracer& tracer, const ReuseSettings& settings,
                             glm::ivec2 sizePx, float diagonalM)
    : impl_(std::make_unique<Impl>(shaders, objects, tracer, settings, sizePx, diagonalM)) {
    GFXREPRO_ASSERT(settings.seamPx >= 0);
}

ReuseRenderer::~ReuseRenderer() = default;

void ReuseRenderer::render(const kit::View& view, gl::Profiler& profiler,
                           gl::Profiler* recomputeTimes) {
    GFXREPRO_ASSERT(view.sizePx == impl_->gbuffer.view.sizePx);
    // First what every frame needs: the device draws it while the count of the frame before, by
    // which this one is a key frame or not, is waited for.
    impl_->drawDiffuse(view, profiler);
    impl_->isKeyFrame = impl_->isKeyFrameNext();
    impl_->hadOffsets = impl_->hasOffsets;
    if (impl_->isKeyFrame) {
        impl_->renderKeyFrame(profiler);
    } else {
        impl_->renderReused(profiler, recomputeTimes);
    }
    impl_->hasFrame = true;
    impl_->isUndone = false;
}

void ReuseRenderer::undo() {
    GFXREPRO_ASSERT(impl_->hasFrame && !impl_->isUndone);
    impl_->isUndone = true;
    if (impl_->isKeyFrame) return;  // it overwrote all there was, and so will the next
    impl_->hasOffsets = impl_->hadOffsets;
    if (!impl_->settings.isDirect) std::swap(impl_->offsets[0], impl_->offsets[1]);
}

const reflections::GBuffer& ReuseRenderer::gbuffer() const {
    return impl_->isKeyFrame ? impl_->key.gbuffer : impl_->gbuffer;
}

const reflections::ReflectionTarget& ReuseRenderer::reflection() const {
    return impl_->isKeyFrame ? impl_->key.reflection : impl_->reflection;
}

ReuseCounts ReuseRenderer::counts() const {
    ReuseCounts counts;
    counts.isKeyFrame = impl_->isKeyFrame;
    if (!impl_->hasFrame) return counts;
    counts.reflectiveSamples = impl_->reprojection.reflectiveSamples();
    counts.recomputedSamples = impl_->recomputedSamples();
    if (!impl_->isKeyFrame && !impl_->settings.isDirect) {
        counts.matchingSteps = impl_->matcher.counts(impl_->key, impl_->offsets[0]).meanSteps();
    }
    return counts;
}

const gl::Texture& ReuseRenderer::recomputed() const {
    return impl_->wanted;
}

const Offsets& ReuseRenderer::offsets() const {
    return impl_->offsets[0];
}

const ShiftedImage* ReuseRenderer::shifted() const {
    return impl_->shifted ? &*impl_->shifted : nullptr;
}

const ReflectionDepthImage& ReuseRenderer::keyFrame() const {
    return impl_->key;
}

std::size_t ReuseRenderer::sizeBytes() const {
    return impl_->key.sizeBytes() + impl_->gbuffer.sizeBytes() + impl_->reflection.sizeBytes() +
           impl_->traced.sizeBytes() + impl_->offsets[0].sizeBytes() +
           impl_->offsets[1].sizeBytes() + (impl_->shifted ? impl_->shifted->sizeBytes() : 0) +
           impl_->wanted.sizeBytes() + impl_->reprojection.sizeBytes() +
           impl_->movedObjects.sizeBytes();
}

}  // namespace gfxrepro::reflection_reuse
