// Where to put the next reference image, ahead of [xie2017], whose views are given.
#pragma once

#include <cstdint>
#include <vector>

#include "techniques/depth_sampling/pixel_measures.h"
#include "techniques/kit/depth_image_renderer.h"

namespace gfxrepro::depth_sampling {

/// Greedy: of candidate views, the one whose non-redundant image makes the most samples of the
/// output frames available (pixel definition) that no image so far holds. Ties go to the first
/// candidate.
class NextView {
  public:
    /// Draws the output frames, `sizePx` each; references must outlive this.
    NextView(const gl::ShaderLibrary& shaders, kit::DepthImageRenderer& renderer,
             const kit::DrawableScene& scene, std::vector<scene::Camera> candidates,
             const std::vector<scene::Camera>& outputCameras, glm::ivec2 sizePx);

    struct Choice {
        scene::Camera camera;
        std::size_t candidate = 0;
        std::uint64_t gainedSamples = 0;  // of all output frames; 0: no candidate gains anything
    };
    /// `imagesSoFar`, of any size, at most kit::kMaxEarlierImages. Waits for the device.
    Choice next(ImageSpan imagesSoFar);

  private:
    PixelMeasures measures_;
    kit::DepthImageRenderer& renderer_;
    const kit::DrawableScene& scene_;
    std::vector<scene::Camera> candidates_;
    std::vector<kit::DepthImage> outputs_;
    glm::ivec2 sizePx_;
};

}  // namespace gfxrepro::depth_sampling
