// The experiment under the visibility definition: images are ray cast, samples are tested by rays.
#pragma once

#include "techniques/depth_sampling/experiment.h"
#include "techniques/depth_sampling/ray_cast_image.h"
#include "techniques/depth_sampling/visibility.h"

namespace gfxrepro::depth_sampling {

class VisibilityExperiment final : public Experiment {
  public:
    VisibilityExperiment(const scene::Scene& scene, raycast::RayTracer tracer, Method method,
                         const Views& views, Earlier earlier);

    void makeReferenceImages(gl::Profiler& profiler) override;
    Measures measure(const MeasureSettings& settings) override;
    MarkedImage markedImage(std::size_t index) const override;
    MarkedImage markedFrame(std::size_t index) override;
    std::size_t referenceImageBytes() const override;

  private:
    Method method_;
    raycast::RayTracer tracer_;
    SurfaceShading shading_;
    VisibilitySequence sequence_;
    VisibilitySequence conventional_;
    VisibilitySequence frames_;
    VisibilitySequence neededBy_;  // frames_ when usefulness is measured, else none
    std::vector<kit::HostDepthImage> images_;
};

}  // namespace gfxrepro::depth_sampling
