#include "techniques/depth_sampling/visibility_experiment.h"

#include <tbb/parallel_for.h>

#include <utility>

#include "techniques/depth_sampling/visibility_measures.h"

namespace gfxrepro::depth_sampling {

namespace {

/// Calls markOf(point) for the sample of each pixel that has one.
template <class MarkOf>
std::vector<std::uint32_t> marksOf(const VisibilitySequence& sequence, std::size_t index,
                                   const MarkOf& markOf) {
    const glm::ivec2 size = sequence.views()[index].sizePx;
    const auto width = static_cast<std::size_t>(size.x);
    std::vector<std::uint32_t> marks(width * static_cast<std::size_t>(size.y), 0);
    tbb::parallel_for(0, size.y, [&](int y) {
        for (int x = 0; x < size.x; ++x) {
            const std::optional<SurfacePoint> point = sequence.sample(index, {x, y});
            if (!point) continue;
            marks[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)] =
                kSample | markOf(*point);
        }
    });
    return marks;
}

}  // namespace

VisibilityExperiment::VisibilityExperiment(const scene::Scene& scene, raycast::RayTracer tracer,
                                           Method method, const Views& views, Earlier earlier)
    : method_(method),
      tracer_(std::move(tracer)),
      shading_(scene),
      sequence_(tracer_, views.images, method != Method::Conventional, earlier),
      conventional_(tracer_, views.conventional, false),
      frames_(tracer_, views.frames, false),
      neededBy_(tracer_, {}, false) {}

// [xie2017] Algorithm 1
void VisibilityExperiment::makeReferenceImages(gl::Profiler& profiler) {
    const gl::CpuScope all(profiler, "reference_images");
    images_.clear();
    for (std::size_t i = 0; i < sequence_.views().size(); ++i) {
        const gl::CpuScope one(profiler, imageName(i));
        images_.push_back(rayCastImage(sequence_, i, shading_));
    }
}

Measures VisibilityExperiment::measure(const MeasureSettings& settings) {
    if (settings.usefulness) neededBy_ = frames_;
    Measures result;
    for (std::size_t i = 0; i < images_.size(); ++i) {
        const VisibilityCounts counts = countSamples(sequence_, i, conventional_, neededBy_);
        std::uint64_t occludedLiterally = 0;
        // Departure [xie2017] Sec. 2.3.2: see PixelExperiment::markImage().
        if (method_ == Method::NonRedundant) occludedLiterally = counts.occludedLiterally;
        if (method_ == Method::DepthPeeling) occludedLiterally = counts.occluded;
        result.images.push_back({.samples = counts.samples,
                                 .redundant = counts.redundant,
                                 .occluded = counts.occluded,
                                 .occludedLiterally = occludedLiterally,
                                 .useful = counts.useful});
    }
    if (!settings.availability) return result;
    for (const VisibilityAvailability& counts : countAvailable(sequence_, frames_)) {
        result.frames.push_back({counts.samples, counts.available});
    }
    return result;
}

MarkedImage VisibilityExperiment::markedImage(std::size_t index) const {
    const auto markOf = [&](const SurfacePoint& point) -> std::uint32_t {
        if (conventional_.anyHolds(conventional_.views().size(), point)) return 0;
        std::uint32_t marks = kOccluded;
        if (neededBy_.anyHolds(neededBy_.views().size(), point)) marks |= kUseful;
        return marks;
    };
    return {images_[index], marksOf(sequence_, index, markOf)};
}

MarkedImage VisibilityExperiment::markedFrame(std::size_t index) {
    const auto markOf = [&](const SurfacePoint& point) -> std::uint32_t {
        if (!sequence_.anyHolds(sequence_.views().size(), point)) return 0;
        return kAvailable;
    };
    return {rayCastImage(frames_, index, shading_), marksOf(frames_, index, markOf)};
}

std::size_t VisibilityExperiment::referenceImageBytes() const {
    std::size_t bytes = 0;
    for (const kit::HostDepthImage& image : images_) {
        bytes += image.shading.size() * sizeof(glm::u8vec4) + image.depthM.size() * sizeof(float) +
                 image.triangleId.size() * sizeof(std::uint32_t);
    }
    return bytes;
}

}  // namespace gfxrepro::depth_sampling
