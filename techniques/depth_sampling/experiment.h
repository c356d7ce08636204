// One method's reference images and what is measured of them, under either definition of
// redundancy.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/gl/profiler.h"
#include "engine/raycast/ray_tracer.h"
#include "techniques/depth_sampling/pixel_measures.h"
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

/// Counts of samples of one reference image ([xie2017] Sec. 2.3.2).
struct ImageCounts {
    std::uint64_t samples = 0;
    std::uint64_t redundant = 0;          // measure 1
    std::uint64_t occluded = 0;           // measure 2, as figure 9's text reads it
    std::uint64_t occludedLiterally = 0;  // measure 2, as Sec. 2.3.2 prints it
    std::uint64_t useful = 0;             // measure 3
};

/// Measure 4 of one output frame.
using FrameCounts = PixelMeasures::Availability;

struct Measures {
    std::vector<ImageCounts> images;
    std::vector<FrameCounts> frames;  // empty unless availability is measured
};

/// What the measures found of an image's samples: Mark, one a pixel in the order of `image`.
struct MarkedImage {
    kit::HostDepthImage image;
    std::vector<std::uint32_t> marks;
};

/// Which of the measures that look at all output frames are taken.
struct MeasureSettings {
    bool usefulness = false;
    bool availability = false;
};

class Experiment {
  public:
    virtual ~Experiment() = default;

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

}  // namespace gfxrepro::depth_sampling
