// The technique `clustered_reflections`: chapter 4 of xie2017. See README.md.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "runner/technique/technique.h"
#include "techniques/clustered_reflections/reflection_params.h"
#include "techniques/reflections/frame.h"

namespace gfxrepro::clustered_reflections {

/// What the technique records: each metric with its unit, each pass with its meaning.
config::Outputs outputs();

class ClusteredReflections final : public technique::Technique {
  public:
    explicit ClusteredReflections(Params& params);

    void setup(technique::SetupContext& context) override;
    technique::SceneNeed sceneNeed() const override { return technique::SceneNeed::Model; }
    void requireScene(const scene::Scene& scene) const override { params_.requireScene(scene); }
    void render(technique::FrameContext& context) override;
    void record(technique::Recorder& recorder) override;
    const gl::Texture* frameImage() const override {
        return frame_ && params_.drawsReflections() ? &frame_->composite.output() : nullptr;
    }

  private:
    /// What Embree says of the last frame; with the picture that it makes of it.
    struct Truth {
        kit::View view;
        std::vector<glm::mat4> poses;
        std::vector<reflections::TracedSample> samples;
        image::ImageF picture;
        image::ImageF converged;  // of ReflectionParams::convergedRays, if there are any
    };

    std::unique_ptr<reflections::ReflectionTracer> makeTracer(const gl::ShaderLibrary& shaders);
    /// Traced once for frames that are the same.
    const Truth& truthOf(const reflections::HostGBuffer& gbuffer);

    void recordShares(technique::Recorder& recorder,
                      const std::vector<std::uint32_t>& surfaces) const;
    void recordMemory(technique::Recorder& recorder) const;
    void recordErrors(technique::Recorder& recorder, const reflections::HostGBuffer& gbuffer,
                      const image::ImageF& picture);
    void recordClusters(technique::Recorder& recorder);
    std::vector<std::uint16_t> readClusters() const;
    void recordClusterErrors(technique::Recorder& recorder, const reflections::HostGBuffer& gbuffer,
                             const image::ImageF& picture);
    void recordOcclusion(technique::Recorder& recorder, const reflections::HostGBuffer& gbuffer,
                         const image::ImageF& picture, std::vector<std::uint16_t> clusterOfSample);
    std::vector<std::uint8_t> reflectorsOf(const std::string& name) const;

    ReflectionParams params_;
    std::optional<reflections::Frame> frame_;
    std::optional<reflections::GBufferRenderer> gbufferRenderer_;
    std::optional<reflections::GBuffer> gbuffer_;
    std::optional<reflections::ReflectionTarget> target_;
    std::unique_ptr<reflections::ReflectionTracer> tracer_;
    ClusteredTracer* clusteredTracer_ = nullptr;  // the same, of `method: clustered`

    std::optional<reflections::EmbreeTracer> convergedTracer_;  // more rays for glossy samples
    std::optional<Truth> truth_;
    bool hasReflections_ = false;  // in the view that record() is at
};

extern const technique::TechniqueInfo kClusteredReflections;

}  // namespace gfxrepro::clustered_reflections
