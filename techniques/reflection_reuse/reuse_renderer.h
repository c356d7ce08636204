// [xie2017] Algorithm 8: key frames traced, frames between them reprojected and mended.
#pragma once

#include <memory>
#include <optional>

#include "techniques/reflection_reuse/pixel_matcher.h"
#include "techniques/reflection_reuse/reprojection.h"
#include "techniques/reflections/reflection_tracer.h"

namespace gfxrepro::reflection_reuse {

struct ReuseSettings {
    /// When more than this share of a frame's reflective samples was recomputed, the next frame is
    /// a key frame (Sec. 5.4.4). 0: every frame that needs any; 1: never again.
    float keyFrameThreshold = 0.3F;
    /// Not the printed algorithm, as which matcher and reprojection begin: matches between pixels,
    /// resampled once, err less in less time (README.md).
    MatchingSettings matching{.matching = Matching::SecondOrder};
    ReprojectionSettings reprojection{.resampling = Resampling::Once};
    /// The comparator: depth alone, as if reflections were painted on the surface.
    bool isDirect = false;
    /// Outlook of Sec. 5.5.4: samples whose reflected segment, then or now, passes the box of an
    /// object that has moved since the key frame are recomputed.
    bool recomputesMoved = false;
    /// Outlook: recomputed samples within this distance of a reused one of their reflector are
    /// mixed with the reused ones around; pixels, 0: none.
    int seamPx = 0;
};

/// Of one frame.
struct ReuseCounts {
    bool isKeyFrame = false;
    std::uint32_t reflectiveSamples = 0;
    std::uint32_t recomputedSamples = 0;  // of a key frame: all
    double matchingSteps = 0.0;  // mean ring steps a reflective sample of the key frame; 0 without
                                 // matching
};

/// Passes, named as Table 23: `diffuse`, `pixel_matching`, `reflection_shift`, `reflection_warp`,
/// `recompute` (around the tracer's own); `composite` is the caller's. Shift and warp at once count
/// as the warp, the preparation of a key frame for them as the shift.
class ReuseRenderer {
  public:
    /// `objects` and `tracer` outlive this.
    ReuseRenderer(const gl::ShaderLibrary& shaders, const reflections::GpuObjects& objects,
                  reflections::ReflectionTracer& tracer, const ReuseSettings& settings,
                  glm::ivec2 sizePx, float diagonalM);
    ~ReuseRenderer();

    /// The objects are posed and the tracer is updated. The first frame is a key frame. A profiler
    /// for `recomputeTimes` gets a scope of its own within `recompute`, between key frames.
    void render(const kit::View& view, gl::Profiler& profiler,
                gl::Profiler* recomputeTimes = nullptr);
    /// Takes the last render() back but for what gbuffer() and the others hold: the next one
    /// decides and starts as it did, so that a frame can be rendered again.
    void undo();
    const reflections::GBuffer& gbuffer() const;
    const reflections::ReflectionTarget& reflection() const;
    /// Of the last render(); waits for the device.
    ReuseCounts counts() const;
    /// 1 where a sample of the last frame was recomputed ([xie2017] Fig. 40), R8UI.
    const gl::Texture& recomputed() const;
    /// Of the last frame that was not a key frame.
    const Offsets& offsets() const;
    /// Of the last frame that was not a key frame; null: there is none (Resampling::Once, direct).
    const ShiftedImage* shifted() const;
    const ReflectionDepthImage& keyFrame() const;
    std::size_t sizeBytes() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace gfxrepro::reflection_reuse
