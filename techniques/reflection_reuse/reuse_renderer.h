// [xie2017] Algorithm 8: key frames traced, frames between them reprojected and mended.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "engine/gl/objects.h"
#include "engine/gl/program.h"
#include "techniques/kit/whole_image.h"
#include "techniques/reflection_reuse/pixel_matcher.h"
#include "techniques/reflection_reuse/reprojection.h"
#include "techniques/reflections/reflection_tracer.h"

namespace gfxrepro::reflection_reuse {

struct ReuseSettings {
    /// When more than this share of a frame's reflective samples was recomputed, the next frame is
    /// a key frame (Sec. 5.4.4). 0: every frame that needs any; 1: never again.
    float keyFrameThreshold = 0.3F;
    MatchingSettings matching;  // of Resampling::Twice
    /// Not the printed algorithm, as which a reprojection begins: a gather errs less in less time
    /// (README.md).
    ReprojectionSettings reprojection{.resampling = Resampling::Gather};
    /// The comparator: depth alone, as if reflections were painted on the surface.
    bool isDirect = false;
};

/// Of one frame.
struct ReuseCounts {
    bool isKeyFrame = false;
    std::uint32_t reflectiveSamples = 0;
    std::uint32_t recomputedSamples = 0;  // of a key frame: all
};

/// Passes, named as Table 23: `diffuse`, `pixel_matching`, `reflection_shift`, `reflection_warp`,
/// `recompute` (around the tracer's own); `composite` is the caller's. A gather counts as the warp,
/// the preparation of a key frame as the shift.
class ReuseRenderer {
  public:
    /// `objects` and `tracer` outlive this.
    ReuseRenderer(const gl::ShaderLibrary& shaders, const reflections::GpuObjects& objects,
                  reflections::ReflectionTracer& tracer, const ReuseSettings& settings,
                  glm::ivec2 sizePx, float diagonalM);

    /// The objects are posed and the tracer is updated. The first frame is a key frame.
    void render(const kit::View& view, gl::Profiler& profiler);
    /// Takes the last render() back but for what gbuffer() and the others hold: the next one
    /// decides and starts as it did, so that a frame can be rendered again.
    void undo();
    const reflections::GBuffer& gbuffer() const { return isKeyFrame_ ? key_.gbuffer : gbuffer_; }
    const reflections::ReflectionTarget& reflection() const {
        return isKeyFrame_ ? key_.reflection : reflection_;
    }
    /// Of the last render(); waits for the device.
    ReuseCounts counts() const;
    /// 1 where a sample of the last frame was recomputed ([xie2017] Fig. 40), R8UI.
    const gl::Texture& recomputed() const { return wanted_; }
    /// Of the last frame that was not a key frame.
    const Offsets& offsets() const { return offsets_[0]; }
    /// Of the last frame that was not a key frame; null: there is none (gathered, direct), and no
    /// offsets().
    const ShiftedImage* shifted() const { return shifted_ ? &*shifted_ : nullptr; }
    const ReflectionDepthImage& keyFrame() const { return key_; }
    std::size_t sizeBytes() const;

  private:
    std::uint32_t recomputedSamples() const;
    bool isKeyFrameNext() const;
    void renderKeyFrame(gl::Profiler& profiler);
    void renderReused(gl::Profiler& profiler);
    void match(gl::Profiler& profiler);
    void mendReflections();

    const reflections::GpuObjects& objects_;
    reflections::ReflectionTracer& tracer_;
    ReuseSettings settings_;
    reflections::GBufferRenderer gbufferRenderer_;
    PixelMatcher matcher_;
    Reprojection reprojection_;
    gl::Pass mend_;
    ReflectionDepthImage key_;
    reflections::GBuffer gbuffer_;              // of this frame; of a key frame, `key_` has it
    reflections::ReflectionTarget reflection_;  // of frames that are not key frames
    reflections::ReflectionTarget traced_;
    std::array<Offsets, 2> offsets_;       // of this and of the frame before
    std::optional<ShiftedImage> shifted_;  // of two steps
    gl::Texture wanted_;
    gl::SampleQuery recomputed_;
    kit::WholeImage wholeImage_;
    bool hasFrame_ = false;
    bool isKeyFrame_ = false;  // the last frame
    bool hasOffsets_ = false;  // of the frame before, for the same key frame
    bool hadOffsets_ = false;  // before the last render()
    bool isUndone_ = false;    // isKeyFrame_ is what the next frame is, then, not what the last was
};

}  // namespace gfxrepro::reflection_reuse
