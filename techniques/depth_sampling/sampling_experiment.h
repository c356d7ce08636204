// One method's reference images and what is measured of them, under either definition of
// redundancy.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/gl/profiler.h"
#include "engine/image/image.h"
#include "engine/raycast/ray_tracer.h"
#include "runner/technique/shared_results.h"
#include "techniques/depth_sampling/pixel_measures.h"
#include "techniques/depth_sampling/visibility.h"
#include "techniques/kit/depth_image.h"
#include "techniques/kit/depth_image_renderer.h"

namespace gfxrepro::depth_sampling {

/// Which images are taken.
enum class Method { Conventional, NonRedundant, DepthPeeling };

/// What a reference image is of, and what it is compared with.
struct Views {
    std::vector<kit::View> images;        // of the reference images, in their order
    std::vector<kit::View> conventional;  // V₀ … Vₙ₋₁, what "occluded" refers to
    std::vector<kit::View> frames;        // output frames
};

struct Measures {
    std::vector<ImageCounts> images;
    std::vector<FrameCounts> frames;  // empty unless availability is measured
};

/// What the measures found of an image's samples: Mark, one a pixel in the order of `image`.
struct MarkedImage {
    kit::HostDepthImage image;
    std::vector<std::uint32_t> marks;
};

/// Which conventional images a sample of a non-redundant image i must be missing in to be occluded.
/// A sample of a peeled layer must be missing in all ([xie2017] Sec. 2.3.2).
enum class OccludedIn {
    UpToOwn,  // V₀ … Vᵢ
    All,      // V₀ … Vₙ₋₁
};

/// What is measured beside samples and redundancy.
struct MeasureSettings {
    OccludedIn occluded = OccludedIn::UpToOwn;
    bool usefulness = false;
    bool availability = false;
};

class SamplingExperiment {
  public:
    virtual ~SamplingExperiment() = default;

    /// The pass that is timed: "reference_images", and in it "image_0", "image_1", …
    virtual void makeReferenceImages(gl::Profiler& profiler) = 0;
    /// Of the reference images as they are.
    virtual Measures measure(const MeasureSettings& settings) = 0;
    /// After measure().
    virtual MarkedImage markedImage(std::size_t index) const = 0;
    /// An output frame as it is seen, with kAvailable.
    virtual MarkedImage markedFrame(std::size_t index) = 0;
    virtual std::size_t referenceImageBytes() const = 0;
};

inline std::string imageName(std::size_t index) {
    return "image_" + std::to_string(index);
}

// The experiment under the pixel definition: images are drawn, samples are tested on the device.

class PixelExperiment final : public SamplingExperiment {
  public:
    /// `shaders` and `shared`, which may be null, must outlive this.
    PixelExperiment(const gl::ShaderLibrary& shaders, const scene::Scene& scene, Method method,
                    kit::TriangleIds ids, kit::DepthFormat format, Views views,
                    technique::SharedResults* shared);

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
    /// Depths and ids of all output frames, which the methods have in common.
    struct OutputFrames {
        std::vector<kit::DepthImage> images;

        std::size_t sizeBytes() const;
    };
    /// Null where they would be too large to be kept.
    std::shared_ptr<const OutputFrames> sharedFrames();
    void drawConventionalImages();
    void drawFrame(std::size_t index);
    const std::vector<kit::DepthImage>& conventional() const {
        return method_ == Method::Conventional ? images_ : conventional_;
    }
    void markImage(std::size_t index, OccludedIn occluded);

    Method method_;
    Views views_;
    technique::SharedResults* shared_;
    kit::DrawableScene scene_;
    kit::DepthImageRenderer renderer_;
    PixelMeasures measures_;
    std::vector<kit::DepthImage> images_;
    std::vector<kit::DepthImage> conventional_;   // unless these are the images
    std::vector<gl::Texture> marks_;              // of images_
    std::optional<kit::DepthImage> outputFrame_;  // one for all of views_.frames
};

// The experiment under the visibility definition: images are ray cast, samples are tested by rays.

class VisibilityExperiment final : public SamplingExperiment {
  public:
    VisibilityExperiment(const scene::Scene& scene, raycast::RayTracer tracer, Method method,
                         const Views& views);

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
    std::vector<ImageSamples> samples_;
    std::vector<kit::HostDepthImage> images_;        // of samples_
    std::vector<std::vector<std::uint32_t>> marks_;  // of samples_
};

// Depth images as pictures that show what the measures found: rows from the top, 3 linear channels.

/// Where there is no sample.
constexpr glm::vec3 kPictureBackground{0.020F, 0.022F, 0.030F};
/// The legend's colours, of fully lit white surfaces.
constexpr glm::vec3 kOccludedColor{0.06F, 0.62F, 0.10F};
constexpr glm::vec3 kUsefulColor{1.00F, 0.78F, 0.03F};
constexpr glm::vec3 kUnavailableColor{0.85F, 0.03F, 0.03F};

/// A reference image: useful samples yellow, other occluded ones green, the rest grey ([xie2017]
/// Table 3, Fig. 9). `marks` (Mark) one a pixel in the order of HostDepthImage.
image::ImageF occludedPicture(const kit::HostDepthImage& image,
                              std::span<const std::uint32_t> marks);

/// An output frame: samples without kAvailable red, the others in their shading ([xie2017] Fig.
/// 12).
image::ImageF availabilityPicture(const kit::HostDepthImage& frame,
                                  std::span<const std::uint32_t> marks);

}  // namespace gfxrepro::depth_sampling
