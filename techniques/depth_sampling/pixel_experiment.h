// The experiment under the pixel definition: images are drawn, samples are tested on the device.
#pragma once

#include "techniques/depth_sampling/experiment.h"

namespace gfxrepro::depth_sampling {

class PixelExperiment final : public Experiment {
  public:
    /// `shaders` must outlive this.
    PixelExperiment(const gl::ShaderLibrary& shaders, const scene::Scene& scene, Method method,
                    kit::TriangleIds ids, kit::DepthFormat format, Views views);

    void makeReferenceImages(gl::Profiler& profiler) override;
    Measures measure(const MeasureSettings& settings) override;
    MarkedImage markedImage(std::size_t index) const override;
    MarkedImage markedFrame(std::size_t index) override;
    std::size_t referenceImageBytes() const override;

    /// Draws one output frame ("output_frame") and counts what the reference images have of it
    /// ("availability_test").
    void drawOutputFrame(gl::Profiler& profiler, std::size_t index);
    /// Of the frame drawn last.
    FrameCounts outputFrameCounts() { return measures_.finishAvailability(); }

  private:
    void drawConventionalImages();
    void drawFrame(std::size_t index);
    std::vector<const kit::DepthImage*> first(const std::vector<kit::DepthImage>& images,
                                              std::size_t count) const;
    const std::vector<kit::DepthImage>& conventional() const {
        return method_ == Method::Conventional ? images_ : conventional_;
    }
    void markImage(std::size_t index);

    Method method_;
    Views views_;
    kit::DrawableScene scene_;
    kit::DepthImageRenderer renderer_;
    PixelMeasures measures_;
    std::vector<kit::DepthImage> images_;
    std::vector<kit::DepthImage> conventional_;   // unless these are the images
    std::vector<gl::Texture> marks_;              // of images_
    std::optional<kit::DepthImage> outputFrame_;  // one for all of views_.frames
};

}  // namespace gfxrepro::depth_sampling
