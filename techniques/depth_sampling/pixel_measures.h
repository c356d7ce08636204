// The measures of [xie2017] Sec. 2.3.2 under the pixel definition, on the device.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "engine/gl/pass.h"
#include "techniques/depth_sampling/visibility.h"
#include "techniques/kit/depth_image.h"
#include "techniques/kit/depth_image_renderer.h"
#include "techniques/kit/whole_image.h"

namespace gfxrepro::depth_sampling {

using ImageSpan = std::span<const kit::DepthImage* const>;

/// Pixel redundancy of samples with images, tested one fragment a sample ([xie2017] Algorithm 3):
/// sample s of image I is redundant with image J when the pixel of J in which s lands holds the
/// triangle of s. A sample outside of J or behind its eye is not.
class PixelMeasures {
  public:
    /// At most this many images in one test: with the samples and their marks nineteen textures.
    /// GL promises a stage sixteen; every device of GL 4.5 that is known has 32.
    static constexpr std::size_t kMaxImages = 16;

    explicit PixelMeasures(const gl::ShaderLibrary& shaders);

    /// Marks with kSample alone.
    gl::Texture makeMarks(const kit::DepthImage& image);

    /// Adds `bit` to the marks of those samples of `image` that have all bits of `among` and that
    /// are redundant (`isRedundant`) with one of `images`, or (else) with none. Samples that
    /// already have the bit are not tested again. At most kMaxImages.
    void mark(const kit::DepthImage& image, gl::Texture& marks, ImageSpan images, bool isRedundant,
              std::uint32_t among, Mark bit);

    /// Pixels whose marks hold all of `bits`; waits for the device.
    std::uint64_t count(const gl::Texture& marks, std::uint32_t bits);

    /// Enqueues the test which samples of a frame are redundant with at least one of `images`: the
    /// pass that is timed. Forgets the frame before.
    void beginAvailability(const kit::DepthImage& frame, ImageSpan images);
    /// Waits for the test of the last frame.
    FrameCounts finishAvailability();

  private:
    /// One variant for each number of images, so that the shader's loop over them is unrolled.
    using Variants = std::map<std::size_t, gl::Pass>;
    /// Into chosen_: the pixels whose marks have all bits of `among` and not `without`.
    void choose(const gl::Texture& marks, std::uint32_t among, Mark without);
    const gl::Pass& variant(Variants& variants, const char* file, std::size_t imageCount);

    const gl::ShaderLibrary& shaders_;
    Variants markPasses_, availabilityPasses_;
    gl::Pass choosePass_, countPass_, samplesPass_;
    gl::Texture chosen_;  // a depth buffer of the size of the marks that were made last
    kit::WholeImage wholeImage_;
    gl::SampleQuery countQuery_, samplesQuery_, availableQuery_;
};

// Where to put the next reference image, ahead of [xie2017], whose views are given.

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
