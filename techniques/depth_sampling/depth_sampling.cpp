#include "techniques/depth_sampling/depth_sampling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "techniques/depth_sampling/pixel_measures.h"
#include "techniques/depth_sampling/reference_views.h"
#include "techniques/depth_sampling/sampling_experiment.h"
#include "techniques/depth_sampling/visibility.h"
#include "techniques/kit/image_layers.h"
#include "techniques/kit/percent.h"
#include "techniques/kit/requirements.h"

namespace gfxrepro::depth_sampling {
namespace {

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
enum class Timed { ReferenceImages, OutputFrame };

struct DepthSamplingParams {
    Method method = Method::Conventional;
    Redundancy redundancy = Redundancy::Pixel;
    int views = 3;
    Placement placement = Placement::Fixed;
    PeeledFrom peeledFrom = PeeledFrom::Centre;
    ViewTriangleSettings triangle;  // all but the aspect
    kit::TriangleIds triangleIds = kit::TriangleIds::PrimitiveId;
    kit::DepthFormat depthFormat = kit::DepthFormat::Float32;
    MeasureSettings measures;
    int outputFrames = 1000;
    int frameSizePx = 0;  // 0: as the reference images
    bool showsPictures = false;
    Timed measured = Timed::ReferenceImages;

    /// Declares the parameters. Throws Error for combinations that mean nothing.
    explicit DepthSamplingParams(Params& params);
};

constexpr Choice<Method> kMethods[] = {
    {Method::Conventional, "conventional", "ordinary depth images: the nearest sample of a pixel"},
    {Method::NonRedundant, "non_redundant",
     "the nearest sample that no earlier image has (algorithm 1)"},
    {Method::DepthPeeling, "depth_peeling", "layers of one view"},
};
constexpr Choice<Redundancy> kRedundancies[] = {
    {Redundancy::Pixel, "pixel",
     "the earlier image's pixel has the same triangle (algorithm 3); drawn on the device"},
    {Redundancy::Visibility, "visibility",
     "visible from the earlier image's view (algorithm 2); ray cast on the CPU"},
};
constexpr Choice<OccludedIn> kOccludedIn[] = {
    {OccludedIn::UpToOwn, "up_to_own", "the conventional images up to the image's own view"},
    {OccludedIn::All, "all", "the conventional images of all views"},
};
constexpr Choice<Placement> kPlacements[] = {
    {Placement::Fixed, "fixed", "the triangle's corners, then evenly inside of it"},
    {Placement::Automatic, "automatic", "each next view where the images so far lack most"},
};
constexpr Choice<PeeledFrom> kPeeledFrom[] = {
    {PeeledFrom::Centre, "centre", "the centre of the triangle of views"},
    {PeeledFrom::FirstView, "first_view", "V0, as figures 11 and 12 have it"},
};
constexpr Choice<kit::TriangleIds> kTriangleIds[] = {
    {kit::TriangleIds::PrimitiveId, "primitive_id", "gl_PrimitiveID"},
    {kit::TriangleIds::GeometryShader, "geometry_shader",
     "by a geometry stage, as the thesis has it"},
};
constexpr Choice<kit::DepthFormat> kDepthFormats[] = {
    {kit::DepthFormat::Unorm24, "unorm24", "24-bit integers"},
    {kit::DepthFormat::Float32, "float32", "32-bit floats, 0 at the near plane"},
    {kit::DepthFormat::ReversedFloat32, "reversed_float32", "32-bit floats, 0 at the far plane"},
};
constexpr Choice<Timed> kTimed[] = {
    {Timed::ReferenceImages, "reference_images", "making the reference images"},
    {Timed::OutputFrame, "output_frame",
     "one output frame, and the test which of its samples the reference images have"},
};

ViewTriangleSettings readTriangle(Params& params) {
    const auto number = [&](const char* name, double fallback, const ParamSpec& spec) {
        return static_cast<float>(params.getDouble(name, fallback, spec));
    };
    ViewTriangleSettings settings;
    settings.spread = number(
        "view_spread", 0.5,
        {"side of the triangle of views, in diagonals of the scene's box", "diagonals", 0.0, 10.0});
    settings.distance =
        number("view_distance", 1.0,
               {"factor on the camera's distance from its target", "1", 0.01, 100.0});
    settings.yawRad = glm::radians(
        number("view_yaw_deg", 0.0, {"turns the camera about its target", "°", -360.0, 360.0}));
    settings.pitchRad = glm::radians(
        number("view_pitch_deg", 0.0, {"raises the camera about its target", "°", -180.0, 180.0}));
    settings.rollRad = glm::radians(number(
        "view_roll_deg", 0.0,
        {"turns the triangle of views in its plane; the views stay upright", "°", -360.0, 360.0}));
    settings.view = params.getText(
        "view", "",
        {"where the middle of the triangle looks from: a path of the scene, seen from its middle, "
         "a camera, \"X Y Z > X Y Z\" from and to, or where from to frame it, \"AZIMUTH "
         "ELEVATION\" in degrees; none: its first camera"});
    return settings;
}

[[noreturn]] void refuse(const Params& params, const char* name, const std::string& because) {
    throw Error(params.locationOf(name), because);
}

void checkPlacement(const Params& params, const DepthSamplingParams& read) {
    if (read.placement == Placement::Fixed) return;
    if (read.redundancy != Redundancy::Pixel) {
        refuse(params, "placement", "'placement: automatic' needs 'redundancy: pixel'");
    }
    if (read.method == Method::DepthPeeling) {
        refuse(params, "placement",
               "'placement: automatic' chooses views; 'method: depth_peeling' has only one");
    }
    if (read.views < 2) {
        refuse(params, "views", "'placement: automatic' needs 2 views or more; found 1");
    }
}

/// Rays have neither a depth buffer nor primitives.
void checkVisibility(const Params& params, const DepthSamplingParams& read) {
    if (read.redundancy == Redundancy::Pixel) return;
    params.refuseGiven({"depth_format", "triangle_ids"}, "'redundancy: pixel'");
    if (read.measured == Timed::OutputFrame) {
        refuse(params, "measured", "'measured: output_frame' needs 'redundancy: pixel'");
    }
}

void checkFrames(const Params& params, const DepthSamplingParams& read) {
    const bool hasFrames = read.measures.usefulness || read.measures.availability ||
                           read.showsPictures || read.measured == Timed::OutputFrame;
    if (hasFrames) return;
    params.refuseGiven({"frame_size", "output_frames"},
                       "'usefulness', 'availability', 'pictures' or 'measured: output_frame'");
}

DepthSamplingParams::DepthSamplingParams(Params& params)
    : method(params.getEnum("method", Method::Conventional, kMethods, {"which images are taken"})),
      redundancy(params.getEnum("redundancy", Redundancy::Pixel, kRedundancies,
                                {"which samples count as captured"})),
      views(params.getInt("views", 3,
                          {"reference images, or layers of depth peeling", "images", 1,
                           kit::kMaxEarlierImages + 1})),
      placement(params.getEnum("placement", Placement::Fixed, kPlacements,
                               {"where reference images are taken"})),
      peeledFrom(params.getEnum("peeled_from", PeeledFrom::Centre, kPeeledFrom,
                                {"the one view of depth_peeling"})),
      triangle(readTriangle(params)),
      triangleIds(params.getEnum("triangle_ids", kit::TriangleIds::PrimitiveId, kTriangleIds,
                                 {"where triangle ids come from"})),
      depthFormat(params.getEnum("depth_format", kit::DepthFormat::Float32, kDepthFormats,
                                 {"what the depth test compares"})),
      outputFrames(params.getInt("output_frames", 1000,
                                 {"views in the hull of the reference views", "frames", 1, 10000})),
      frameSizePx(
          params.getInt("frame_size", 0,
                        {"side of an output frame; 0: the reference images' size", "px", 0, 4096})),
      showsPictures(params.getBool("pictures", false, {"save images with what was measured"})),
      measured(params.getEnum("measured", Timed::ReferenceImages, kTimed, {"what is timed"})) {
    measures.occluded =
        params.getEnum("occluded", OccludedIn::UpToOwn, kOccludedIn,
                       {"which images lack an occluded sample of a non-redundant one"});
    measures.usefulness = params.getBool(
        "usefulness", false, {"count the occluded samples that an output frame needs (measure 3)"});
    measures.availability = params.getBool(
        "availability", false, {"count what reference images have of output frames (measure 4)"});
    if (method != Method::NonRedundant) {
        params.refuseGiven({"occluded"}, "'method: non_redundant'");
    }
    checkPlacement(params, *this);
    checkVisibility(params, *this);
    checkFrames(params, *this);
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
    recorder.metric("unavailable_mean_pct", 100.0 * (1.0 - mean));
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
            "view; change 'view', 'view_distance', 'view_spread', 'view_yaw_deg' or "
            "'view_pitch_deg'",
            i, eye.x, eye.y, eye.z, scene));
    }
}

/// Records `measures` of images of so many pixels as metrics. An image without samples has no
/// shares but its coverage; frames without samples have no availability; nothing is said of useful
/// samples that nobody counted.
void recordMeasures(technique::Recorder& recorder, const Measures& measures, bool hasUsefulness,
                    std::uint64_t pixels) {
    double usefulSumPct = 0.0;
    for (std::size_t i = 0; i < measures.images.size(); ++i) {
        const ImageCounts& counts = measures.images[i];
        const std::string pass = imageName(i);
        const auto ofSamples = [&](const char* name, std::uint64_t part) {
            recorder.share(name, static_cast<double>(part), static_cast<double>(counts.samples),
                           "sample", pass);
        };
        recorder.metric("samples", static_cast<double>(counts.samples), pass);
        recorder.metric("coverage_pct", kit::percent(counts.samples, pixels), pass);
        if (counts.samples == 0) continue;
        ofSamples("redundant_pct", counts.redundant);
        recorder.metric("redundant_of_pixels_pct", kit::percent(counts.redundant, pixels), pass);
        ofSamples("occluded_pct", counts.occluded);
        if (!hasUsefulness) continue;
        ofSamples("useful_of_samples_pct", counts.useful);
        // Of no occluded sample none is useful: the thesis prints 0 for the first images.
        if (counts.occluded == 0) {
            recorder.metric("useful_pct", 0.0, pass);
        } else {
            recorder.share("useful_pct", static_cast<double>(counts.useful),
                           static_cast<double>(counts.occluded), "sample", pass);
        }
        usefulSumPct += kit::percent(counts.useful, counts.samples);
    }
    if (hasUsefulness) recorder.metric("useful_sum_pct", usefulSumPct);
    if (!measures.frames.empty()) recordAvailability(recorder, measures.frames);
}

class DepthSampling final : public technique::Technique {
  public:
    explicit DepthSampling(Params& params) : params_(params) { params.finish(); }

    void setup(technique::SetupContext& context) override {
        const scene::Scene& scene = *context.scene;
        kit::requireIdsFor(scene.triangleCount());
        const Views views = makeViews(context);
        views_ = views;
        sceneName_ = scene.name;
        raycast::RayTracer tracer(scene);
        checkViews(tracer, views.conventional);
        if (params_.method == Method::DepthPeeling) checkViews(tracer, {&views.images[0], 1});

        if (params_.redundancy == Redundancy::Visibility) {
            experiment_ = std::make_unique<VisibilityExperiment>(scene, std::move(tracer),
                                                                 params_.method, views);
            return;
        }
        auto experiment = std::make_unique<PixelExperiment>(
            context.shaders, scene, params_.method, params_.triangleIds, params_.depthFormat, views,
            context.shared);
        pixelExperiment_ = experiment.get();
        experiment_ = std::move(experiment);
        if (params_.measured == Timed::OutputFrame) {
            gl::Profiler untimed(context.device.info().isSoftware);
            experiment_->makeReferenceImages(untimed);
        }
    }

    technique::SceneNeed sceneNeed() const override { return technique::SceneNeed::Model; }
    void requireFrames(int /*frameCount*/) const override {}  // along a path

    void requireScene(const scene::Scene& scene) const override {
        kit::requireTriangles(scene, "depth_sampling");
        makeViewTriangle(scene, params_.triangle);  // that there is one
    }

    void render(technique::FrameContext& context) override {
        if (params_.measured == Timed::ReferenceImages) {
            experiment_->makeReferenceImages(context.profiler);
            return;
        }
        // Measured frames spread over the output frames.
        const auto frame = static_cast<std::int64_t>(context.frame) * params_.outputFrames /
                           std::max(context.frameCount, 1);
        pixelExperiment_->drawOutputFrame(context.profiler, static_cast<std::size_t>(frame));
    }

    void record(technique::Recorder& recorder) override {
        if (params_.measured == Timed::OutputFrame) {
            const FrameCounts counts = pixelExperiment_->outputFrameCounts();
            if (counts.samples > 0) {
                recorder.share("available_pct", static_cast<double>(counts.available),
                               static_cast<double>(counts.samples), "sample", "output_frame");
            }
        }
    }

    void recordOnce(technique::Recorder& recorder) override {
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
                        static_cast<double>(experiment_->referenceImageBytes()));
        const bool usesFrames = params_.measures.usefulness || params_.measures.availability;
        recorder.metric("output_frames", usesFrames ? params_.outputFrames : 0);
    }

  private:
    std::vector<scene::Camera> chooseCameras(technique::SetupContext& context,
                                             const ViewTriangle& triangle) const {
        if (params_.placement == Placement::Fixed) return referenceCameras(triangle, params_.views);
        // Every candidate is tried against every frame: fewer and smaller ones than are measured.
        constexpr int kFrames = 24;
        constexpr int kCandidates = 16;  // views to choose from
        static_assert(kCandidates > kit::kMaxEarlierImages, "as many as there may be views");
        constexpr int kLongestSidePx = 256;
        const glm::ivec2 size = context.outputSizePx;
        const int longestPx = std::max(size.x, size.y);
        const glm::ivec2 trialSize =
            longestPx > kLongestSidePx ? glm::max(size * kLongestSidePx / longestPx, 1) : size;

        const kit::DrawableScene drawable(*context.scene);
        kit::DepthImageRenderer renderer(context.shaders, params_.triangleIds, params_.depthFormat);
        NextView nextView(context.shaders, renderer, drawable,
                          candidateCameras(triangle, params_.views, kCandidates),
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

    Views makeViews(technique::SetupContext& context) const {
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
        const glm::ivec2 frameSize =
            params_.frameSizePx > 0 ? glm::ivec2(params_.frameSizePx) : size;
        views.frames =
            viewsOf(outputCameras(triangle, params_.views, params_.outputFrames), frameSize);
        return views;
    }

    void recordPictures(technique::Recorder& recorder) const {
        for (std::size_t i = 0; i < measures_->images.size(); ++i) {
            const MarkedImage marked = experiment_->markedImage(i);
            recorder.image(imageName(i), kit::shadingPicture(marked.image),
                           kit::layersOf(marked.image).options());
            recorder.image(fmt::format("classes_{}", i),
                           occludedPicture(marked.image, marked.marks),
                           kit::seenFrom(marked.image.view));
        }
        const MarkedImage frame =
            experiment_->markedFrame(static_cast<std::size_t>(params_.outputFrames) / 2);
        recorder.image("output_frame", kit::shadingPicture(frame.image),
                       kit::layersOf(frame.image).options());
        recorder.image("unavailable", availabilityPicture(frame.image, frame.marks),
                       kit::seenFrom(frame.image.view));
    }

    DepthSamplingParams params_;
    Views views_;
    std::string sceneName_;
    std::unique_ptr<SamplingExperiment> experiment_;
    PixelExperiment* pixelExperiment_ = nullptr;  // the same, under the pixel definition
    std::optional<Measures> measures_;            // of all frames alike: taken once
};

config::Outputs outputs() {
    using config::Better;
    constexpr bool kIsDetail = true;
    return {
        {
            {"redundant_pct", "%", "share of an image's samples that an earlier image has already",
             Better::Lower},
            {"occluded_pct", "%", "share of an image's samples that the conventional images lack",
             Better::Higher},
            {"useful_pct", "%", "share of the occluded samples that some output frame shows",
             Better::Higher},
            {"useful_sum_pct", "%", "useful_pct, summed over all images", Better::Higher},
            {"available_pct", "%", "share of an output frame's samples that the images have",
             Better::Higher},
            {"available_mean_pct", "%", "available_pct, mean of all output frames", Better::Higher},
            {"available_min_pct", "%", "available_pct of the worst output frame", Better::Higher},
            {"unavailable_mean_pct", "%", "100 less available_mean_pct", Better::Lower, kIsDetail},
            {"samples", "sample", "samples of an image", Better::Neither, kIsDetail},
            {"coverage_pct", "%", "share of an image's pixels that have a sample", Better::Neither,
             kIsDetail},
            {"redundant_of_pixels_pct", "%", "redundant samples as a share of an image's pixels",
             Better::Lower, kIsDetail},
            {"useful_of_samples_pct", "%",
             "share of an image's samples that are occluded and useful", Better::Higher, kIsDetail},
            {"reference_image_bytes", "byte", "memory of all images on the device", Better::Lower},
            {"output_frames", "frame", "frames over which usefulness and availability are counted",
             Better::Neither, kIsDetail},
        },
        {
            {"reference_images", "drawing all depth images"},
            {"image_*", "drawing one depth image; they are counted from 0"},
            {"output_frame", "drawing a frame from the images"},
            {"availability_test", "testing which of the frame's samples the images have"},
        },
        false,
        {},
        {"redundant_pct", "occluded_pct", "useful_pct", "samples", "coverage_pct",
         "redundant_of_pixels_pct", "useful_of_samples_pct"}};
}

}  // namespace

const technique::TechniqueInfo kDepthSampling = {
    "depth_sampling",
    "non-redundant depth images, conventional ones and depth peeling (xie2017, chapter 2)",
    technique::make<DepthSampling>, &outputs};

}  // namespace gfxrepro::depth_sampling
