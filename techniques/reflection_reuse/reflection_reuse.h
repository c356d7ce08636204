// The technique `reflection_reuse`: chapter 5 of xie2017. See README.md.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "runner/technique/technique.h"
#include "techniques/reflection_reuse/reflection_reuse_params.h"
#include "techniques/reflection_reuse/resting_tracer.h"

namespace gfxrepro::reflection_reuse {

/// What the technique records: each metric with its unit, each pass with its meaning.
config::Outputs outputs();

class ReflectionReuse final : public technique::Technique {
  public:
    explicit ReflectionReuse(Params& params);

    void setup(technique::SetupContext& context) override;
    technique::SceneNeed sceneNeed() const override { return technique::SceneNeed::Model; }
    void requireScene(const scene::Scene& scene) const override { params_.requireScene(scene); }
    void requireFrames(int frameCount) const override;
    /// Frames are consecutive. One that is rendered again starts from what was there before it.
    void render(technique::FrameContext& context) override;
    void record(technique::Recorder& recorder) override;
    const gl::Texture* frameImage() const override {
        return frame_ ? &frame_->composite.output() : nullptr;
    }

  private:
    /// Frames of `method: ray_traced`.
    struct FullTracing {
        reflections::GBufferRenderer renderer;
        reflections::GBuffer gbuffer;
        reflections::ReflectionTarget target;
    };

    std::unique_ptr<reflections::ReflectionTracer> makeTracer(const gl::ShaderLibrary& shaders);
    void place(const technique::FrameContext& context);
    void traceFully(gl::Profiler& profiler);
    const reflections::GBuffer& gbuffer() const;
    const reflections::ReflectionTarget& reflection() const;

    void recordReuse(technique::Recorder& recorder, const ReuseCounts& counts);
    void keepLeastRecomputeTime();
    void recordRecomputeFit(technique::Recorder& recorder, const ReuseCounts& counts);
    void recordMatches(technique::Recorder& recorder, const ReuseCounts& counts);
    image::ImageF truthOf(const reflections::HostGBuffer& gbuffer);
    void recordErrors(technique::Recorder& recorder, const reflections::HostGBuffer& gbuffer,
                      const image::ImageF& picture, const image::ImageF& truth);
    void recordUndetected(technique::Recorder& recorder, const reflections::HostGBuffer& gbuffer,
                          const image::ImageF& picture, const image::ImageF& truth);
    /// `truth` is empty where errors are not measured.
    void recordPictures(technique::Recorder& recorder, const reflections::HostGBuffer& gbuffer,
                        const image::ImageF& picture, const image::ImageF& truth);

    ReuseParams params_;
    std::optional<reflections::Frame> frame_;
    std::unique_ptr<reflections::ReflectionTracer> tracer_;
    std::optional<ReuseRenderer> renderer_;   // of `reuse` and `direct`
    std::optional<FullTracing> fullTracing_;  // of `ray_traced`
    kit::View view_;
    int frameIndex_ = -1;    // last rendered
    int lastKeyFrame_ = -1;  // last recorded key frame
    int frameCount_ = 0;

    std::optional<gl::Profiler> recomputeTimes_;  // of `recompute_fit`
    std::optional<double> leastRecomputeMs_;      // of the frame at hand
    std::vector<glm::dvec2> recomputed_;          // (samples, ms) of frames that are not key frames

    PoseWatch truthPoses_;
};

extern const technique::TechniqueInfo kReflectionReuse;

}  // namespace gfxrepro::reflection_reuse
