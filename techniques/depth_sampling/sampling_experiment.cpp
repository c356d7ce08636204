#include "techniques/depth_sampling/sampling_experiment.h"

#include <algorithm>
#include <utility>

#include "techniques/depth_sampling/pixel_measures.h"
#include "techniques/depth_sampling/visibility.h"

namespace gfxrepro::depth_sampling {

using kit::DepthImage;
using kit::View;

namespace {

/// How many of the conventional images, from the first on, must lack an occluded sample of image
/// `index`.
std::size_t conventionalImages(Method method, OccludedIn occluded, std::size_t index,
                               std::size_t all) {
    // Departure [xie2017] Sec. 2.3.2, which has V₀ … Vᵢ₋₁: nothing of image 1 would be in one.
    const bool isUpToOwn = method == Method::NonRedundant && occluded == OccludedIn::UpToOwn;
    return isUpToOwn ? std::min(index + 1, all) : all;
}

}  // namespace

PixelExperiment::PixelExperiment(const gl::ShaderLibrary& shaders, const scene::Scene& scene,
                                 Method method, kit::TriangleIds ids, kit::DepthFormat format,
                                 Views views, technique::SharedResults* shared)
    : method_(method),
      views_(std::move(views)),
      shared_(shared),
      scene_(scene),
      renderer_(shaders, ids, format),
      measures_(shaders) {
    for (const View& view : views_.images) images_.push_back(renderer_.makeImage(view));
}

// [xie2017] Algorithm 1
void PixelExperiment::makeReferenceImages(gl::Profiler& profiler) {
    const gl::GpuScope all(profiler, "reference_images");
    for (std::size_t i = 0; i < images_.size(); ++i) {
        const gl::GpuScope one(profiler, imageName(i));
        const std::size_t earlier = method_ == Method::Conventional ? 0 : i;
        renderer_.render(scene_, images_[i], kit::firstOf(images_, earlier));
    }
}

void PixelExperiment::drawConventionalImages() {
    if (method_ == Method::Conventional || !conventional_.empty()) return;
    for (const View& view : views_.conventional) {
        conventional_.push_back(renderer_.makeImage(view));
        renderer_.render(scene_, conventional_.back());
    }
}

void PixelExperiment::drawFrame(std::size_t index) {
    const View& view = views_.frames.at(index);
    if (!outputFrame_) outputFrame_.emplace(renderer_.makeImage(view));
    outputFrame_->view = view;  // all frames are of one size
    renderer_.render(scene_, *outputFrame_);
}

void PixelExperiment::drawOutputFrame(gl::Profiler& profiler, std::size_t index) {
    {
        const gl::GpuScope scope(profiler, "output_frame");
        drawFrame(index);
    }
    const gl::GpuScope scope(profiler, "availability_test");
    measures_.beginAvailability(*outputFrame_, kit::firstOf(images_, images_.size()));
}

void PixelExperiment::markImage(std::size_t index, OccludedIn occluded) {
    const DepthImage& image = images_[index];
    gl::Texture& marks = marks_[index];
    // For the method's own sequence; a conventional image's earlier ones are conventional.
    measures_.mark(image, marks, kit::firstOf(images_, index), true, kSample, kRedundant);
    const std::size_t count = conventionalImages(method_, occluded, index, conventional().size());
    measures_.mark(image, marks, kit::firstOf(conventional(), count), false, kSample, kOccluded);
}

namespace {

std::size_t bytesOfSamples(glm::ivec2 sizePx) {
    return (sizeof(float) + sizeof(std::uint32_t)) * static_cast<std::size_t>(sizePx.x) *
           static_cast<std::size_t>(sizePx.y);
}

}  // namespace

std::size_t PixelExperiment::OutputFrames::sizeBytes() const {
    std::size_t bytes = 0;
    for (const DepthImage& image : images) bytes += bytesOfSamples(image.view.sizePx);
    return bytes;
}

std::shared_ptr<const PixelExperiment::OutputFrames> PixelExperiment::sharedFrames() {
    const std::size_t bytes = views_.frames.size() * bytesOfSamples(views_.frames.front().sizePx);
    if (!shared_ || bytes > shared_->mostBytes()) return nullptr;
    return technique::sharedResult<OutputFrames>(
        shared_, "output frames",
        {"method", "peeled_from", "occluded", "usefulness", "availability"}, [&] {
            OutputFrames frames;
            for (const View& view : views_.frames) {
                DepthImage& image = frames.images.emplace_back(renderer_.makeImage(view));
                renderer_.render(scene_, image, {}, kit::Redundancy::Pixel,
                                 kit::DepthImageRenderer::Content::Samples);
                image.framebuffer = {};
                image.shading = {};
                image.depthBuffer = {};
            }
            return frames;
        });
}

Measures PixelExperiment::measure(const MeasureSettings& settings) {
    drawConventionalImages();
    marks_.clear();
    for (std::size_t i = 0; i < images_.size(); ++i) {
        marks_.push_back(measures_.makeMarks(images_[i]));
        markImage(i, settings.occluded);
    }
    // Of an image without occluded samples none can be useful: often of all conventional ones.
    std::vector<std::size_t> open;
    for (std::size_t i = 0; settings.usefulness && i < images_.size(); ++i) {
        if (measures_.count(marks_[i], kOccluded) > 0) open.push_back(i);
    }
    Measures result;
    const std::vector<const DepthImage*> images = kit::firstOf(images_, images_.size());
    const bool needsFrames = settings.availability || !open.empty();
    const std::size_t frameCount = needsFrames ? views_.frames.size() : 0;
    const std::shared_ptr<const OutputFrames> shared = frameCount > 0 ? sharedFrames() : nullptr;
    std::vector<DepthImage> own;  // samples are tested with as many at once as a test takes
    if (!shared) own.reserve(PixelMeasures::kMaxImages);
    std::vector<const DepthImage*> together;
    for (std::size_t f = 0; f < frameCount; ++f) {
        const View& view = views_.frames[f];
        const std::size_t slot = f % PixelMeasures::kMaxImages;
        if (!shared) {
            if (slot == own.size()) own.push_back(renderer_.makeImage(view));
            own[slot].view = view;  // all frames are of one size
            renderer_.render(scene_, own[slot], {}, kit::Redundancy::Pixel,
                             kit::DepthImageRenderer::Content::Samples);
        }
        const DepthImage& frame = shared ? shared->images[f] : own[slot];
        if (settings.availability) {
            measures_.beginAvailability(frame, images);
            result.frames.push_back(measures_.finishAvailability());
        }
        together.push_back(&frame);
        if (slot + 1 < PixelMeasures::kMaxImages && f + 1 < frameCount) continue;
        for (const std::size_t i : open) {
            measures_.mark(images_[i], marks_[i], together, true, kOccluded, kUseful);
        }
        together.clear();
    }
    for (const gl::Texture& marks : marks_) {
        result.images.push_back({.samples = measures_.count(marks, kSample),
                                 .redundant = measures_.count(marks, kRedundant),
                                 .occluded = measures_.count(marks, kOccluded),
                                 .useful = measures_.count(marks, kUseful)});
    }
    return result;
}

MarkedImage PixelExperiment::markedImage(std::size_t index) const {
    return {readDepthImage(images_[index]),
            marks_[index].read<std::uint32_t>(GL_RED_INTEGER, GL_UNSIGNED_INT, 1)};
}

MarkedImage PixelExperiment::markedFrame(std::size_t index) {
    drawFrame(index);
    gl::Texture marks = measures_.makeMarks(*outputFrame_);
    measures_.mark(*outputFrame_, marks, kit::firstOf(images_, images_.size()), true, kSample,
                   kAvailable);
    return {readDepthImage(*outputFrame_),
            marks.read<std::uint32_t>(GL_RED_INTEGER, GL_UNSIGNED_INT, 1)};
}

std::size_t PixelExperiment::referenceImageBytes() const {
    std::size_t bytes = 0;
    for (const DepthImage& image : images_) bytes += image.sizeBytes();
    return bytes;
}

VisibilityExperiment::VisibilityExperiment(const scene::Scene& scene, raycast::RayTracer tracer,
                                           Method method, const Views& views)
    : method_(method),
      tracer_(std::move(tracer)),
      shading_(scene),
      sequence_(tracer_, views.images, method != Method::Conventional),
      conventional_(tracer_, views.conventional, false),
      frames_(tracer_, views.frames, false) {}

// [xie2017] Algorithm 1
void VisibilityExperiment::makeReferenceImages(gl::Profiler& profiler) {
    const gl::CpuScope all(profiler, "reference_images");
    samples_.clear();
    images_.clear();
    for (std::size_t i = 0; i < sequence_.views().size(); ++i) {
        const gl::CpuScope one(profiler, imageName(i));
        samples_.push_back(samplesOf(sequence_, i));
        images_.push_back(rayCastImage(sequence_.views()[i], samples_.back(), shading_));
    }
}

Measures VisibilityExperiment::measure(const MeasureSettings& settings) {
    const VisibilitySequence noFrames(tracer_, {}, false);
    marks_.clear();
    Measures result;
    for (std::size_t i = 0; i < images_.size(); ++i) {
        const std::size_t count =
            conventionalImages(method_, settings.occluded, i, conventional_.views().size());
        marks_.push_back(markedSamples(sequence_, samples_[i], conventional_, count,
                                       settings.usefulness ? frames_ : noFrames));
        result.images.push_back(countsOf(marks_.back()));
    }
    if (settings.availability) result.frames = countAvailable(sequence_, frames_);
    return result;
}

MarkedImage VisibilityExperiment::markedImage(std::size_t index) const {
    return {images_[index], marks_[index]};
}

MarkedImage VisibilityExperiment::markedFrame(std::size_t index) {
    const ImageSamples samples = samplesOf(frames_, index);
    MarkedImage frame{rayCastImage(frames_.views()[index], samples, shading_), {}};
    for (const SurfacePoint& point : samples.points) {
        const bool isSample = point.triangleId != 0;
        const bool isHeld = isSample && sequence_.anyHolds(sequence_.views().size(), point);
        frame.marks.push_back((isSample ? kSample : 0U) | (isHeld ? kAvailable : 0U));
    }
    return frame;
}

std::size_t VisibilityExperiment::referenceImageBytes() const {
    std::size_t bytes = 0;
    for (const kit::HostDepthImage& image : images_) {
        bytes += image.shading.size() * sizeof(glm::u8vec4) + image.depthM.size() * sizeof(float) +
                 image.triangleId.size() * sizeof(std::uint32_t);
    }
    return bytes;
}

using kit::HostDepthImage;

namespace {

glm::vec3 shadingOf(const HostDepthImage& image, std::size_t index) {
    return glm::vec3(image.shading[index]) / 255.0F;
}

/// Luminance of linear Rec. 709.
float brightness(const glm::vec3& color) {
    return glm::dot(color, glm::vec3(0.2126F, 0.7152F, 0.0722F));
}

/// The legend's colour, darkened by the shading so that shapes stay visible, but never below 0.3 of
/// it, so that a dark leaf can still be told green from yellow.
glm::vec3 tinted(const glm::vec3& color, const glm::vec3& shading) {
    return color * (0.3F + 0.7F * brightness(shading));
}

/// `colorOf(index)` of all samples.
template <class ColorOf>
image::ImageF picture(const HostDepthImage& image, std::span<const std::uint32_t> marks,
                      ColorOf&& colorOf) {
    GFXREPRO_ASSERT_EQ(marks.size(), image.triangleId.size());
    return kit::pictureOf(image.view.sizePx, [&](std::size_t index) {
        return (marks[index] & kSample) != 0 ? colorOf(index) : kPictureBackground;
    });
}

}  // namespace

image::ImageF occludedPicture(const HostDepthImage& image, std::span<const std::uint32_t> marks) {
    return picture(image, marks, [&](std::size_t index) {
        const glm::vec3 shading = shadingOf(image, index);
        if ((marks[index] & kUseful) != 0) return tinted(kUsefulColor, shading);
        if ((marks[index] & kOccluded) != 0) return tinted(kOccludedColor, shading);
        return glm::vec3(brightness(shading));
    });
}

image::ImageF availabilityPicture(const HostDepthImage& frame,
                                  std::span<const std::uint32_t> marks) {
    return picture(frame, marks, [&](std::size_t index) {
        const glm::vec3 shading = shadingOf(frame, index);
        return (marks[index] & kAvailable) != 0 ? shading : tinted(kUnavailableColor, shading);
    });
}

}  // namespace gfxrepro::depth_sampling
