#include "techniques/depth_sampling/depth_sampling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "techniques/depth_sampling/next_view.h"
#include "techniques/depth_sampling/outputs.h"
#include "techniques/depth_sampling/pictures.h"
#include "techniques/depth_sampling/view_check.h"
#include "techniques/depth_sampling/visibility_experiment.h"
#include "techniques/kit/image_layers.h"
#include "techniques/kit/percent.h"
#include "techniques/kit/requirements.h"

namespace gfxrepro::depth_sampling {
namespace {

std::unique_ptr<technique::Technique> create(Params& params) {
    return std::make_unique<DepthSampling>(params);
}

std::vector<kit::View> viewsOf(const std::vector<scene::Camera>& cameras, glm::ivec2 sizePx) {
    std::vector<kit::View> views;
    views.reserve(cameras.size());
    for (const scene::Camera& camera : cameras) {
        views.push_back(kit::viewOf(camera, sizePx));
    }
    return views;
}

/// As many independent samples as would leave the mean of the frames' shares (0 … 1) as uncertain
/// as the frames leave it (Kish 1965, "Survey Sampling", the design effect); at most all `samples`,
/// as those of a frame go together.
double effectiveSamples(const std::vector<double>& shares, double mean, double samples) {
    double squares = 0.0;
    for (const double share : shares) squares += (share - mean) * (share - mean);
    const auto frames = static_cast<double>(shares.size());
    const double varianceOfMean = squares / (frames - 1.0) / frames;
    const double effective = mean * (1.0 - mean) / varianceOfMean;
    return std::isfinite(effective) ? std::clamp(effective, 1.0, samples) : samples;
}

void recordAvailability(technique::Recorder& recorder, const std::vector<FrameCounts>& frames) {
    std::vector<double> shares;  // a frame without samples says nothing
    double samples = 0.0, sum = 0.0;
    const FrameCounts* worst = nullptr;
    const auto shareOf = [](const FrameCounts& frame) {
        return static_cast<double>(frame.available) / static_cast<double>(frame.samples);
    };
    for (const FrameCounts& frame : frames) {
        if (frame.samples == 0) continue;
        shares.push_back(shareOf(frame));
        sum += shares.back();
        samples += static_cast<double>(frame.samples);
        if (!worst || shares.back() < shareOf(*worst)) worst = &frame;
    }
    if (!worst) return;
    const double mean = sum / static_cast<double>(shares.size());
    const double count = effectiveSamples(shares, mean, samples);
    recorder.share("available_mean_pct", mean * count, count, "sample");
    recorder.share("available_min_pct", static_cast<double>(worst->available),
                   static_cast<double>(worst->samples), "sample");
    recorder.metric("unavailable_mean_pct", 100.0 * (1.0 - mean), "%");
}

/// A conventional image without samples is of a view that looks past the scene. A later one of the
/// other methods may have none: all that it sees is redundant.
void requireSamples(const Measures& measures, Method method, const Views& views,
                    const std::string& scene) {
    for (std::size_t i = 0; i < measures.images.size(); ++i) {
        if (measures.images[i].samples > 0 || (i > 0 && method != Method::Conventional)) continue;
        const glm::vec3& eye = views.images[i].eyeWorld;
        throw Error(fmt::format(
            "reference image {} has no sample: from ({:g}, {:g}, {:g}) nothing of scene '{}' is in "
            "view; change 'view_distance', 'view_spread', 'view_yaw_deg', 'view_pitch_deg' or the "
            "scene's camera",
            i, eye.x, eye.y, eye.z, scene));
    }
}

}  // namespace

DepthSampling::DepthSampling(Params& params) : params_(params) {
    params.finish();
}

std::vector<scene::Camera> DepthSampling::chooseCameras(technique::SetupContext& context,
                                                        const ViewTriangle& triangle) const {
    if (params_.placement == Placement::Fixed) return referenceCameras(triangle, params_.views);
    // Every candidate is tried against every frame: fewer and smaller ones than are measured.
    constexpr int kFrames = 24;
    constexpr int kLongestSidePx = 256;
    const glm::ivec2 size = context.outputSizePx;
    const int longestPx = std::max(size.x, size.y);
    const glm::ivec2 trialSize =
        longestPx > kLongestSidePx ? glm::max(size * kLongestSidePx / longestPx, 1) : size;

    const kit::DrawableScene drawable(*context.scene);
    kit::DepthImageRenderer renderer(context.shaders, params_.triangleIds, params_.depthFormat);
    NextView nextView(context.shaders, renderer, drawable,
                      candidateCameras(triangle, params_.views, params_.candidates),
                      outputCameras(triangle, params_.views, kFrames), trialSize);
    std::vector<scene::Camera> cameras;
    std::vector<kit::DepthImage> images;
    images.reserve(static_cast<std::size_t>(params_.views));
    std::vector<const kit::DepthImage*> imagesSoFar;
    for (int i = 0; i < params_.views; ++i) {
        cameras.push_back(nextView.next(imagesSoFar).camera);
        images.push_back(renderer.makeImage(kit::viewOf(cameras.back(), trialSize)));
        renderer.render(drawable, images.back(), imagesSoFar);
        imagesSoFar.push_back(&images.back());
    }
    return cameras;
}

Views DepthSampling::makeViews(technique::SetupContext& context) const {
    const glm::ivec2 size = context.outputSizePx;
    ViewTriangleSettings settings = params_.triangle;
    settings.aspect = static_cast<float>(size.x) / static_cast<float>(size.y);
    const ViewTriangle triangle = makeViewTriangle(*context.scene, settings);

    Views views;
    views.conventional = viewsOf(chooseCameras(context, triangle), size);
    views.images = views.conventional;
    if (params_.method == Method::DepthPeeling) {
        const kit::View view = params_.peeledFrom == PeeledFrom::FirstView
                                   ? views.conventional.front()
                                   : kit::viewOf(triangle.centre, size);
        views.images.assign(static_cast<std::size_t>(params_.views), view);
    }
    const glm::ivec2 frameSize = params_.frameSizePx > 0 ? glm::ivec2(params_.frameSizePx) : size;
    views.frames = viewsOf(outputCameras(triangle, params_.views, params_.outputFrames), frameSize);
    return views;
}

void DepthSampling::requireScene(const scene::Scene& scene) const {
    kit::requireTriangles(scene, "depth_sampling");
}

void DepthSampling::setup(technique::SetupContext& context) {
    const scene::Scene& scene = *context.scene;
    kit::requireIdsFor(scene.triangleCount());
    const Views views = makeViews(context);
    views_ = views;
    sceneName_ = scene.name;
    raycast::RayTracer tracer(scene);
    checkViews(tracer, views.conventional);
    if (params_.method == Method::DepthPeeling) checkViews(tracer, {&views.images[0], 1});

    if (params_.redundancy == Redundancy::Visibility) {
        experiment_ = std::make_unique<VisibilityExperiment>(
            scene, std::move(tracer), params_.method, views, params_.earlier);
        return;
    }
    auto experiment = std::make_unique<PixelExperiment>(
        context.shaders, scene, params_.method, params_.triangleIds, params_.depthFormat, views);
    pixelExperiment_ = experiment.get();
    experiment_ = std::move(experiment);
    if (params_.measured == Measured::OutputFrame) {
        gl::Profiler untimed(context.device.info().isSoftware);
        experiment_->makeReferenceImages(untimed);
    }
}

void DepthSampling::render(technique::FrameContext& context) {
    if (params_.measured == Measured::ReferenceImages) {
        experiment_->makeReferenceImages(context.profiler);
        return;
    }
    // Measured frames spread over the output frames.
    const auto frame = static_cast<std::int64_t>(context.frame) * params_.outputFrames /
                       std::max(context.frameCount, 1);
    pixelExperiment_->drawOutputFrame(context.profiler, static_cast<std::size_t>(frame));
}

void DepthSampling::record(technique::Recorder& recorder) {
    if (params_.measured == Measured::OutputFrame) {
        const FrameCounts counts = pixelExperiment_->outputFrameCounts();
        if (counts.samples > 0) {
            recorder.share("available_pct", static_cast<double>(counts.available),
                           static_cast<double>(counts.samples), "sample", "output_frame");
        }
    }
    // The reference images are the same in each frame.
    if (!measures_) {
        measures_ = experiment_->measure(params_.measures);
        requireSamples(*measures_, params_.method, views_, sceneName_);
        if (params_.showsPictures) recordPictures(recorder);
    }
    const glm::ivec2 size = views_.images.front().sizePx;
    recordMeasures(recorder, *measures_, params_.measures.usefulness,
                   static_cast<std::uint64_t>(size.x) * static_cast<std::uint64_t>(size.y));
    recorder.metric("reference_image_bytes",
                    static_cast<double>(experiment_->referenceImageBytes()), "byte");
    const bool usesFrames = params_.measures.usefulness || params_.measures.availability;
    recorder.metric("output_frames", usesFrames ? params_.outputFrames : 0, "frame");
}

void DepthSampling::recordPictures(technique::Recorder& recorder) const {
    for (std::size_t i = 0; i < measures_->images.size(); ++i) {
        const MarkedImage marked = experiment_->markedImage(i);
        recorder.image(imageName(i), kit::shadingPicture(marked.image),
                       kit::layersOf(marked.image).options());
        recorder.image(fmt::format("classes_{}", i), occludedPicture(marked.image, marked.marks),
                       kit::seenFrom(marked.image.view));
    }
    const MarkedImage frame =
        experiment_->markedFrame(static_cast<std::size_t>(params_.outputFrames) / 2);
    recorder.image("output_frame", kit::shadingPicture(frame.image),
                   kit::layersOf(frame.image).options());
    recorder.image("unavailable", availabilityPicture(frame.image, frame.marks),
                   kit::seenFrom(frame.image.view));
}

void recordMeasures(technique::Recorder& recorder, const Measures& measures, bool hasUsefulness,
                    std::uint64_t pixels) {
    double occludedSumPct = 0.0;
    double usefulSumPct = 0.0;
    for (std::size_t i = 0; i < measures.images.size(); ++i) {
        const ImageCounts& counts = measures.images[i];
        const std::string pass = imageName(i);
        const auto ofSamples = [&](const char* name, std::uint64_t part) {
            recorder.share(name, static_cast<double>(part), static_cast<double>(counts.samples),
                           "sample", pass);
        };
        recorder.metric("samples", static_cast<double>(counts.samples), "sample", pass);
        recorder.metric("coverage_pct", kit::percent(counts.samples, pixels), "%", pass);
        if (counts.samples == 0) continue;
        ofSamples("redundant_pct", counts.redundant);
        recorder.metric("redundant_of_pixels_pct", kit::percent(counts.redundant, pixels), "%",
                        pass);
        ofSamples("occluded_pct", counts.occluded);
        ofSamples("occluded_literal_pct", counts.occludedLiterally);
        occludedSumPct += kit::percent(counts.occluded, counts.samples);
        if (!hasUsefulness) continue;
        ofSamples("useful_of_samples_pct", counts.useful);
        // Of no occluded sample none is useful: the thesis prints 0 for the first images.
        if (counts.occluded == 0) {
            recorder.metric("useful_pct", 0.0, "%", pass);
        } else {
            recorder.share("useful_pct", static_cast<double>(counts.useful),
                           static_cast<double>(counts.occluded), "sample", pass);
        }
        usefulSumPct += kit::percent(counts.useful, counts.samples);
    }
    recorder.metric("occluded_sum_pct", occludedSumPct, "%");
    if (hasUsefulness) recorder.metric("useful_sum_pct", usefulSumPct, "%");
    if (!measures.frames.empty()) recordAvailability(recorder, measures.frames);
}

const technique::TechniqueInfo kDepthSampling = {
    "depth_sampling",
    "non-redundant depth images, conventional ones and depth peeling (xie2017, chapter 2)", &create,
    &outputs};

}  // namespace gfxrepro::depth_sampling
