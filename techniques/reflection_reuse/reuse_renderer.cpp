#include "techniques/reflection_reuse/reuse_renderer.h"

#include <array>
#include <cstddef>
#include <optional>
#include <utility>

#include "engine/core/error.h"

namespace gfxrepro::reflection_reuse {

namespace {

/// Boxes grow by this share of the scene's diagonal on all sides: a ray ends on the surface, which
/// often is the box's, give or take rounding.
constexpr float kBoxMargin = 1e-3F;

/// Moved of moved_objects.glsl.
struct Moved {
    glm::vec4 keyCentre;
    glm::vec4 keyHalfSize;
    std::uint32_t object;
    std::uint32_t padding[3];
};
static_assert(offsetof(Moved, object) == 32);
static_assert(sizeof(Moved) == 48);

}  // namespace

MovedObjects::MovedObjects(const gl::ShaderLibrary& shaders, glm::ivec2 sizePx)
    : then_(shaders, {"kit/whole_image.vert.glsl", "reflection_reuse/doubt_moved.frag.glsl"},
            reflections::objectDefines()),
      now_(shaders, {"kit/whole_image.vert.glsl", "reflection_reuse/want_moved.frag.glsl"},
           reflections::objectDefines()),
      doubtful_(gl::Texture::make2D(GL_R8UI, sizePx)),
      framebuffer_(std::array<const gl::Texture*, 1>{&doubtful_}) {}

void MovedObjects::setKeyFrame(const reflections::GpuObjects& objects) {
    keyPoses_.assign(objects.poses().begin(), objects.poses().end());
    keyBounds_.assign(objects.boundsWorld().begin(), objects.boundsWorld().end());
}

bool MovedObjects::find(const reflections::GpuObjects& objects) {
    GFXREPRO_ASSERT_EQ(objects.poses().size(), keyPoses_.size());
    std::vector<Moved> moved;
    for (std::size_t i = 0; i < keyPoses_.size(); ++i) {
        // Without triangles it neither is nor was anywhere.
        if (objects.poses()[i] == keyPoses_[i] || keyBounds_[i].isEmpty()) continue;
        moved.push_back({glm::vec4(keyBounds_[i].centre(), 1.0F),
                         glm::vec4(0.5F * keyBounds_[i].size(), 0.0F),
                         static_cast<std::uint32_t>(i),
                         {}});
    }
    movedCount_ = static_cast<unsigned>(moved.size());
    if (!moved.empty()) moved_ = gl::Buffer::of(moved);
    return !moved.empty();
}

const gl::Texture& MovedObjects::doubtful(const ReflectionDepthImage& key) {
    framebuffer_.bind();
    then_.set("movedCount", movedCount_);
    then_.set("margin", kBoxMargin * key.diagonalM);
    then_.set("missDistance", key.diagonalM);
    then_.use(gl::Resources{{"MovedObjects", moved_}, {"distanceM", key.reflection.distance}}.with(
        key.gbuffer.resourcesFor(then_)));
    wholeImage_.draw();
    return doubtful_;
}

void MovedObjects::want(const reflections::GpuObjects& objects, const reflections::GBuffer& gbuffer,
                        float diagonalM, gl::Texture& wanted) {
    const gl::Framebuffer framebuffer(std::array<const gl::Texture*, 1>{&wanted});
    framebuffer.bind();
    now_.set("movedCount", movedCount_);
    now_.set("margin", kBoxMargin * diagonalM);
    now_.use(gl::Resources{{"MovedObjects", moved_}}
                 .with(objects.resources())
                 .with(gbuffer.resourcesFor(now_)));
    wholeImage_.draw();
}

std::size_t MovedObjects::sizeBytes() const {
    return doubtful_.sizeBytes() + moved_.sizeBytes();
}

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
      movedObjects_(shaders, sizePx),
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
    movedObjects_.setKeyFrame(objects_);
    hasOffsets_ = false;
}

void ReuseRenderer::renderReused(gl::Profiler& profiler) {
    const bool hasMoved = settings_.recomputesMoved && movedObjects_.find(objects_);
    const gl::Texture* doubtful =
        hasMoved && !settings_.isDirect ? &movedObjects_.doubtful(key_) : nullptr;
    if (shifted_) {
        match(profiler);
        const gl::GpuScope scope(profiler, "reflection_shift");
        reprojection_.shift(key_, offsets_[0], doubtful, *shifted_);
    }
    {
        const gl::GpuScope scope(profiler, "reflection_warp");
        if (isGathered(settings_)) {
            reprojection_.gather(key_, doubtful, gbuffer_, reflection_, wanted_);
        } else {
            reprojection_.warp(key_, shifted_ ? shifted_->radiance : key_.reflection.radiance,
                               gbuffer_, reflection_, wanted_);
        }
        if (hasMoved) movedObjects_.want(objects_, gbuffer_, key_.diagonalM, wanted_);
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
    if (!isKeyFrame_ && shifted_) {
        counts.matchingSteps = matcher_.counts(key_, offsets_[0]).meanSteps();
    }
    return counts;
}

std::size_t ReuseRenderer::sizeBytes() const {
    return key_.sizeBytes() + gbuffer_.sizeBytes() + reflection_.sizeBytes() + traced_.sizeBytes() +
           offsets_[0].sizeBytes() + offsets_[1].sizeBytes() +
           (shifted_ ? shifted_->sizeBytes() : 0) + wanted_.sizeBytes() +
           reprojection_.sizeBytes() + movedObjects_.sizeBytes();
}

}  // namespace gfxrepro::reflection_reuse
