// The technique `depth_sampling`: chapter 2 of xie2017. See README.md.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "runner/technique/technique.h"
#include "techniques/depth_sampling/experiment.h"
#include "techniques/depth_sampling/reference_views.h"
#include "techniques/depth_sampling/visibility.h"

namespace gfxrepro::depth_sampling {

using kit::Redundancy;  // which definition makes the images and measures them

/// Where reference images are taken.
enum class Placement {
    Fixed,
    Automatic,  // the next view is chosen by what the images so far lack
};

/// The one view of depth peeling.
enum class PeeledFrom {
    Centre,     // of the triangle (or segment) of views: the tables
    FirstView,  // V₀: figures 11 and 12
};

/// What render() does, and is timed.
enum class Measured { ReferenceImages, OutputFrame };

struct DepthSamplingParams {
    Method method = Method::Conventional;
    Redundancy redundancy = Redundancy::Pixel;
    Earlier earlier = Earlier::Views;  // by visibility
    int views = 3;
    Placement placement = Placement::Fixed;
    int candidates = 16;
    PeeledFrom peeledFrom = PeeledFrom::Centre;
    ViewTriangleSettings triangle;  // all but the aspect
    kit::TriangleIds triangleIds = kit::TriangleIds::PrimitiveId;
    kit::DepthFormat depthFormat = kit::DepthFormat::Float32;
    MeasureSettings measures;
    int outputFrames = 1000;
    int frameSizePx = 0;  // 0: as the reference images
    bool showsPictures = false;
    Measured measured = Measured::ReferenceImages;

    /// Declares the parameters. Throws Error for combinations that mean nothing.
    explicit DepthSamplingParams(Params& params);
};

class DepthSampling final : public technique::Technique {
  public:
    explicit DepthSampling(Params& params);

    void setup(technique::SetupContext& context) override;
    technique::SceneNeed sceneNeed() const override { return technique::SceneNeed::Model; }
    void requireScene(const scene::Scene& scene) const override;
    void render(technique::FrameContext& context) override;
    void record(technique::Recorder& recorder) override;

  private:
    std::vector<scene::Camera> chooseCameras(technique::SetupContext& context,
                                             const ViewTriangle& triangle) const;
    Views makeViews(technique::SetupContext& context) const;
    void recordPictures(technique::Recorder& recorder) const;

    DepthSamplingParams params_;
    Views views_;
    std::string sceneName_;
    std::unique_ptr<Experiment> experiment_;
    PixelExperiment* pixelExperiment_ = nullptr;  // the same, under the pixel definition
    std::optional<Measures> measures_;            // of all frames alike: taken once
};

/// Records `measures` of images of so many pixels as metrics. An image without samples has no
/// shares but its coverage; frames without samples have no availability; nothing is said of useful
/// samples that nobody counted.
void recordMeasures(technique::Recorder& recorder, const Measures& measures, bool hasUsefulness,
                    std::uint64_t pixels);

extern const technique::TechniqueInfo kDepthSampling;

}  // namespace gfxrepro::depth_sampling
