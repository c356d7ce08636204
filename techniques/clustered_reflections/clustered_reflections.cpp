#include "techniques/clustered_reflections/clustered_reflections.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <memory>
#include <set>
#include <string>

#include "engine/core/error.h"
#include "techniques/clustered_reflections/reflection_errors.h"
#include "techniques/kit/displayed_errors.h"
#include "techniques/kit/image_layers.h"
#include "techniques/kit/number.h"
#include "techniques/kit/path_view.h"
#include "techniques/kit/percent.h"
#include "techniques/reflections/gpu_ray_tracer.h"

namespace gfxrepro::clustered_reflections {

namespace {

constexpr Choice<Method> kMethods[] = {
    {Method::Clustered, "clustered", "clustered depth images (algorithm 6)"},
    {Method::EnvironmentMap, "environment_map", "one environment map of the scene"},
    {Method::ScreenSpace, "screen_space", "rays marched through what the eye sees"},
    {Method::RayTraced, "ray_traced",
     "ray tracing on the same device, its hierarchy rebuilt each frame"},
    {Method::Embree, "embree", "ray tracing on the CPU, its hierarchy rebuilt each frame"},
};
constexpr Choice<Clustering> kClusterings[] = {
    {Clustering::NormalBins, "normal_bins", "bins of the normal's spherical coordinates"},
    {Clustering::KdTree, "kd_tree", "splits by position and normal, largest first"},
};
constexpr Choice<ImageDrawing> kDrawings[] = {
    {ImageDrawing::OneByOne, "one_by_one", "a cluster's image is overwritten by the next one's"},
    {ImageDrawing::Visible, "visible",
     "all images side by side, of the triangles that may be seen, shaded where rays meet them"},
    {ImageDrawing::None, "none",
     "nothing is drawn, clusters and their occlusion errors are counted"},
};
/// Of what the eye sees, for the rays of screen space that pass behind it: ours, in diagonals of
/// the scene's box.
constexpr float kThickness = 0.02F;
constexpr Choice<March> kMarches[] = {
    {March::Linear, "linear", "a texel per step (algorithm 7)"},
    {March::Hierarchical, "hierarchical", "over a pyramid of nearest depths"},
};
constexpr Choice<OwnReflector> kOwnReflectors[] = {
    {OwnReflector::WholeScene, "whole_scene",
     "the first way of Sec. 4.7.4: images are of the whole scene"},
    {OwnReflector::ConcaveDiffuse, "concave_diffuse",
     "the second way, which it recommends: concave clusters show their own reflector's diffuse "
     "colour"},
};

void readLobe(Params& params, reflections::LobeSettings& lobe) {
    lobe.maxHalfAngleRad = glm::radians(
        kit::number(params, "lobe_half_angle_deg", 34.4F,
                    {"half angle of the cone of rays at glossiness 1", "°", 0.0, 90.0}));
    lobe.farExponent = kit::number(
        params, "far_exponent", lobe.farExponent,
        {"e of the distance where reflections of glossiness g end: diagonal · (1 − g)^e", "1", 0.0,
         64.0});
}

BinSettings readBins(Params& params) {
    BinSettings bins;
    bins.exponent =
        kit::number(params, "bin_exponent", bins.exponent,
                    {"e of the share of the most bins that a reflector gets: (a_R / n_v · "
                     "bin_gain)^e, at most 1",
                     "1", 0.0, 8.0});
    bins.gain = kit::number(
        params, "bin_gain", bins.gain,
        {"factor on the number of bins: the more, the finer the clusters", "1", 1e-6, 1e6});
    bins.leastSamples =
        params.getInt("least_samples", bins.leastSamples,
                      {"clusters of fewer samples join a neighbour on the same reflector",
                       "samples", 1, 1 << 20});
    return bins;
}

ClusteredSettings readClustered(Params& params) {
    ClusteredSettings settings;
    settings.clustering = params.getEnum("clustering", Clustering::NormalBins, kClusterings,
                                         {"how samples become clusters"});
    settings.bins = readBins(params);
    settings.drawing = params.getEnum("depth_images", ImageDrawing::OneByOne, kDrawings,
                                      {"how the clusters' depth images are drawn"});
    settings.march = params.getEnum("march", March::Linear, kMarches,
                                    {"how a ray is followed through a depth image"});
    settings.camera.depthImageScale =
        kit::number(params, "depth_image_scale", 1.0F,
                    {"factor on the width and height of the depth images", "1", 0.01, 16.0});
    settings.camera.texelsPerSample = kit::number(
        params, "texels_per_sample", 0.0F,
        {"most texels of a depth image for each sample of its cluster; 0: as many as the "
         "samples' distances ask for",
         "texels", 0.0, 4096.0});
    settings.levelErrorPx = kit::number(
        params, "level_error_px", 0.0F,
        {"how far an object may be simplified, in texels of the depth image; 0: not at all",
         "texels", 0.0, 64.0});
    settings.ownReflector =
        params.getEnum("own_reflector", OwnReflector::ConcaveDiffuse, kOwnReflectors,
                       {"what rays of a cluster see of the reflector that they leave"});
    settings.showsOwnBack = params.getBool(
        "own_back", false,
        {"images that show the own reflector show its back, too, as the thesis has it; no ray "
         "meets it"});
    return settings;
}

}  // namespace

void ReflectionParams::requireScene(const scene::Scene& scene) const {
    FrameSettings::requireScene(scene);
    if (errorsOf.empty()) return;
    const std::set<std::string> names = reflections::reflectorNames(scene, reflectors);
    if (names.contains(errorsOf)) return;
    throw Error(fmt::format("the scene has no reflector '{}' ('errors_of'); reflectors: {}",
                            errorsOf, fmt::join(names, ", ")));
}

ReflectionParams::ReflectionParams(Params& params)
    : method(
          params.getEnum("method", Method::Clustered, kMethods, {"where reflections come from"})) {
    readView(params);
    readMotionAndSupersampling(params, 2);
    readRays(params);
    readLobe(params, lobe);
    clustered = readClustered(params);
    readGlossiness(params, "clustered_reflections");
    readRoughness(params);
    reflectors.splitsParts = params.getBool(
        "reflector_parts", true,
        {"smooth parts of an object are reflectors of their own: foot and shell, in- and outside"});
    readTextureFilter(params);
    measuresErrors = params.getBool("errors", true, {"compares with ray tracing by Embree"});
    errorsOf = params.getText("errors_of", "",
                              {"a reflector, by its mesh's name: occlusion errors of it alone"});
    convergedRays =
        params.getInt("converged_rays", 0,
                      {"rays of a second truth of glossy samples, which has as many whatever the "
                       "picture has; 0: none",
                       "rays", 0, 4096});
    showsPictures = params.getBool("pictures", false, {"result, truth, errors, clusters"});
    params.finish();
    if (method != Method::Clustered) {
        params.refuseGiven({"clustering", "bin_exponent", "bin_gain", "least_samples",
                            "depth_images", "march", "depth_image_scale", "texels_per_sample",
                            "level_error_px", "own_reflector", "own_back", "errors_of"},
                           "'method: clustered'");
    }
    if (!measuresErrors) params.refuseGiven({"converged_rays", "errors_of"}, "'errors: true'");
    if (clustered.clustering != Clustering::NormalBins) {
        params.refuseGiven({"least_samples"}, "'clustering: normal_bins'");
    }
    if (!drawsReflections()) {
        params.refuseGiven(
            {"march", "depth_image_scale", "texels_per_sample", "converged_rays", "pictures"},
            "'depth_images' other than none");
        showsPictures = false;  // nor where they are only offered
    }
    if (clustered.drawing != ImageDrawing::Visible) {
        params.refuseGiven({"level_error_px"}, "'depth_images: visible'");
    }
}

namespace {

using kit::seenFrom;
using reflections::HostGBuffer;

/// What the technique records: each metric with its unit, each pass with its meaning.
config::Outputs outputs() {
    using config::Better;
    constexpr bool kIsDetail = true;
    return reflections::withFrameOutputs({
        {
            {"channel_error_r", "level", "channel_error of red alone", Better::Lower, kIsDetail},
            {"channel_error_g", "level", "channel_error of green alone", Better::Lower, kIsDetail},
            {"channel_error_b", "level", "channel_error of blue alone", Better::Lower, kIsDetail},
            {"channel_error_converged", "level", "channel_error to a truth of many rays per sample",
             Better::Lower},
            {"wrong_hit_pct", "%",
             "share of the mirroring samples whose ray ends more than a hundredth of the scene's "
             "diagonal from where it should",
             Better::Lower},
            {"clusters", "cluster", "clusters of reflective samples"},
            {"environment_pct", "%",
             "share of the clustered samples that fell back to the environment map", Better::Lower},
            {"march_steps", "step", "steps of a ray through its cluster's depth image",
             Better::Lower},
            {"occlusion_error_pct", "%",
             "share of the reflective samples whose cluster's image does not hold what they "
             "reflect",
             Better::Lower},
            {"occlusion_hidden_pct", "%", "of these: it is hidden by something else", Better::Lower,
             kIsDetail},
            {"occlusion_hidden_picture_pct", "%",
             "samples that are hidden so, as a share of the picture's", Better::Lower},
            {"occlusion_near_pct", "%", "of these: it lies before the image's near plane",
             Better::Lower, kIsDetail},
            {"occlusion_side_pct", "%", "of these: it lies beside the image", Better::Lower,
             kIsDetail},
            {"occlusion_self_pct", "%", "of these: it lies on the reflector itself", Better::Lower,
             kIsDetail},
            {"occlusion_error_planar_pct", "%", "occlusion_error_pct of planar reflectors",
             Better::Lower, kIsDetail},
            {"planar_pct", "%", "share of the reflective samples that lie on planes",
             Better::Neither, kIsDetail},
            {"visible_reflectors", "reflector", "reflecting objects that are seen"},
            {"reflectors", "reflector", "reflecting objects"},
            {"parts", "reflector", "smooth parts of the reflecting objects", Better::Neither,
             kIsDetail},
            {"diffuse_triangles", "triangle", "triangles that do not reflect"},
            {"reflective_triangles", "triangle", "triangles that reflect"},
            {"drawn_triangles", "triangle", "triangles drawn into all depth images", Better::Lower},
            {"drawn_left_out", "triangle",
             "triangles left out because the list of `visible` had no room", Better::Neither,
             kIsDetail},
            {"texels_per_sample", "texel", "texels of the depth images for each reflective sample",
             Better::Lower},
            {"frame_buffer_bytes", "byte",
             "memory of colours and depths, of the screen and of the clusters", Better::Lower,
             kIsDetail},
        },
        {
            {"first_pass", "drawing what the eye sees"},
        },
    });
}

/// Neighbouring numbers get hues a golden section apart, and two strengths.
glm::vec3 colorOf(std::uint16_t number) {
    const glm::vec3 pure =
        reflections::hue(std::fmod(0.61803399F * static_cast<float>(number), 1.0F));
    const float strength = number % 2 == 0 ? 0.95F : 0.6F;
    return strength * glm::mix(glm::vec3(1.0F), pure, 0.8F);
}

/// [xie2017] Fig. 22 and 23: a colour a number (of a sample's reflector or cluster), 0 is grey;
/// averaged to output pixels.
template <class NumberOf>
image::ImageF numbersPicture(const HostGBuffer& gbuffer, int supersampling,
                             const NumberOf& numberOf) {
    return reflections::averagedPicture(gbuffer, supersampling, [&](std::size_t i) {
        const auto number = static_cast<std::uint16_t>(numberOf(i));
        return number == 0 ? reflections::dimmed(gbuffer, i) : colorOf(number);
    });
}

/// Of values that are not 0.
template <class T>
std::size_t countOf(const std::vector<T>& values) {
    return values.size() - static_cast<std::size_t>(std::ranges::count(values, T{0}));
}

class ClusteredReflections final : public technique::Technique {
  public:
    explicit ClusteredReflections(Params& params) : params_(params) {}

    void setup(technique::SetupContext& context) override {
        const gl::ShaderLibrary& shaders = context.shaders;
        shared_ = context.shared;
        frame_.emplace(context, params_);
        gbufferRenderer_.emplace(shaders, frame_->scene);
        gbuffer_.emplace(frame_->viewAt(kit::frameTime(0, 1)),
                         params_.method == Method::RayTraced || params_.method == Method::Embree);
        target_.emplace(frame_->samplesPx());
        tracer_ = makeTracer(context);
    }

    technique::SceneNeed sceneNeed() const override { return technique::SceneNeed::Model; }
    void requireFrames(int /*frameCount*/) const override {}  // along a path
    void requireScene(const scene::Scene& scene) const override { params_.requireScene(scene); }
    // [xie2017] Algorithm 6
    void render(technique::FrameContext& context) override {
        gl::Profiler& profiler = context.profiler;
        const double time = kit::frameTime(context.frame, context.frameCount);
        frameIndex_ = context.frame;
        gbuffer_->view = frame_->viewAt(time);
        frame_->poseAt(time);
        {  // step 1
            const gl::GpuScope scope(profiler,
                                     clusteredTracer_ ? "first_pass_and_clustering" : "first_pass");
            gbufferRenderer_->render(frame_->objects, *gbuffer_);
        }
        // Steps 2 and 3, or what stands for them.
        tracer_->update(frame_->objects, profiler);
        tracer_->trace(*gbuffer_, nullptr, *target_, profiler);
        if (!params_.drawsReflections()) return;
        const gl::GpuScope scope(profiler, "composite");  // step 3.c.iii
        frame_->composite.render(*gbuffer_, *target_);
    }

    void record(technique::Recorder& recorder) override {
        const std::vector<std::uint32_t> surfaces = reflections::readSurfaces(*gbuffer_);
        // A view that reflects nothing has no errors and no clusters: claims on them are left
        // unmeasured.
        hasReflections_ = std::ranges::any_of(surfaces, reflections::isReflective);
        if (!hasReflections_) frame_->scene.printEmptyView();
        recordShares(recorder, surfaces);
        recordMemory(recorder);
        if (clusteredTracer_ && hasReflections_) recordClusters(recorder);
    }

    void recordOnce(technique::Recorder& recorder) override {
        const bool hasErrors = params_.measuresErrors && hasReflections_;
        if (!hasErrors && !params_.showsPictures) return;

        const HostGBuffer gbuffer = hasErrors
                                        ? gbufferRenderer_->readForRays(frame_->objects, *gbuffer_)
                                        : readGBuffer(*gbuffer_);
        const image::ImageF picture =
            params_.drawsReflections() ? frame_->composite.read() : image::ImageF();
        if (params_.showsPictures) {
            frame_->recordResult(
                recorder, gbuffer, picture,
                params_.measuresErrors ? truthOf(gbuffer).picture : image::ImageF());
            recorder.image("reflectors",
                           numbersPicture(gbuffer, params_.supersampling,
                                          [&](std::size_t i) { return gbuffer.reflector(i); }),
                           seenFrom(gbuffer.view));
            frame_->recordReflection(recorder, *gbuffer_, *target_);
        }
        if (hasErrors && params_.drawsReflections()) recordErrors(recorder, gbuffer, picture);
        if (clusteredTracer_) recordClusterErrors(recorder, gbuffer, picture);
    }

    const gl::Texture* frameImage() const override {
        return frame_ && params_.drawsReflections() ? &frame_->composite.output() : nullptr;
    }

  private:
    /// What Embree says of the last frame; with the picture that it makes of it.
    struct Truth {
        kit::View view;
        std::vector<reflections::TracedSample> samples;
        image::ImageF picture;
        image::ImageF converged;  // of ReflectionParams::convergedRays, if there are any

        std::size_t sizeBytes() const {
            return samples.size() * sizeof(reflections::TracedSample) +
                   sizeof(float) * (picture.values().size() + converged.values().size());
        }
    };

    std::unique_ptr<reflections::ReflectionTracer> makeTracer(technique::SetupContext& context) {
        const gl::ShaderLibrary& shaders = context.shaders;
        const reflections::LobeSettings& lobe = params_.lobe;
        const float diagonalM = frame_->scene.diagonalM();
        switch (params_.method) {
            case Method::EnvironmentMap:
                ownMap_.emplace(shaders, frame_->scene);
                return std::make_unique<reflections::EnvironmentTracer>(shaders, *ownMap_, lobe,
                                                                        diagonalM);
            case Method::ScreenSpace:
                return std::make_unique<reflections::ScreenSpaceTracer>(
                    shaders, frame_->environmentMap(context), lobe, diagonalM,
                    kThickness * diagonalM);
            case Method::RayTraced:
                return std::make_unique<reflections::GpuRayTracer>(shaders, frame_->objects, lobe,
                                                                   diagonalM);
            case Method::Embree:
                return std::make_unique<reflections::EmbreeTracer>(frame_->scene, lobe);
            case Method::Clustered:
                break;
        }
        ClusteredSettings settings = params_.clustered;
        settings.camera.diagonalM = diagonalM;
        settings.camera.lobe = lobe;
        auto tracer = std::make_unique<ClusteredTracer>(shaders, frame_->scene, frame_->objects,
                                                        frame_->environmentMap(context), settings,
                                                        frame_->samplesPx());
        clusteredTracer_ = tracer.get();
        return tracer;
    }

    Truth tracedTruth(const HostGBuffer& gbuffer) {
        Truth truth;
        truth.view = gbuffer.view;
        const reflections::EmbreeTracer& tracer = *frame_->truth;
        if (!params_.drawsReflections()) {
            truth.samples = tracer.traceMirrorRays(gbuffer);
            return truth;
        }
        truth.samples = tracer.trace(gbuffer);
        truth.picture = frame_->pictureOf(*gbuffer_, truth.samples);
        if (params_.convergedRays > 0) {
            reflections::LobeSettings lobe = params_.lobe;
            lobe.rays = params_.convergedRays;
            truth.converged = frame_->pictureOf(*gbuffer_, tracer.trace(gbuffer, lobe));
        }
        return truth;
    }

    /// Traced once for frames that are the same, however their reflections are made.
    const Truth& truthOf(const HostGBuffer& gbuffer) {
        const bool hasMoved = frame_->updateTruth();
        if (truth_ && !hasMoved && truth_->view == gbuffer.view) return *truth_;
        const char* what = params_.drawsReflections() ? "reflections" : "mirror rays";
        truth_ = technique::sharedResult<Truth>(
            shared_, fmt::format("{}, frame {}", what, frameIndex_),
            {"method", "clustering", "bin_gain", "own_reflector", "own_back"},
            [&] { return tracedTruth(gbuffer); });
        return *truth_;
    }

    void recordShares(technique::Recorder& recorder,
                      const std::vector<std::uint32_t>& surfaces) const {
        const reflections::ReflectiveScene& scene = frame_->scene;
        const std::vector<std::uint32_t> families = reflectorFamilies(scene);
        std::uint64_t diffuseTriangles = 0, reflectiveTriangles = 0;
        for (const reflections::Object& object : scene.objects()) {
            (object.reflector == 0 ? diffuseTriangles : reflectiveTriangles) +=
                object.triangleCount;
        }
        std::vector<std::size_t> samples(families.size());
        for (const std::uint32_t surface : surfaces) {
            ++samples[static_cast<std::size_t>(reflections::reflectorOf(surface))];
        }
        std::size_t reflective = 0, planar = 0;
        std::set<std::uint32_t> visible;
        for (std::size_t reflector = 1; reflector < samples.size(); ++reflector) {
            reflective += samples[reflector];
            planar += isPlanar(families[reflector]) ? samples[reflector] : 0;
            if (samples[reflector] == 0) continue;
            visible.insert(wholeOf(families[reflector]));
        }
        recorder.metric("reflective_pct", kit::percent(reflective, surfaces.size()));
        if (reflective > 0) recorder.metric("planar_pct", kit::percent(planar, reflective));
        // Objects, as the thesis counts them; parts are what the clusters are made of.
        recorder.metric("visible_reflectors", static_cast<double>(visible.size()));
        recorder.metric("reflectors", scene.wholeReflectorCount());
        recorder.metric("parts", scene.reflectorCount());
        recorder.metric("diffuse_triangles", static_cast<double>(diffuseTriangles));
        recorder.metric("reflective_triangles", static_cast<double>(reflectiveTriangles));
    }

    // Sec. 4.7.1 counts what holds colours and depths of the screen and of a cluster as frame
    // buffers.
    void recordMemory(technique::Recorder& recorder) const {
        const std::size_t ofScreen =
            gbuffer_->sizeBytes() + target_->sizeBytes() + frame_->composite.sizeBytes();
        recorder.metric("memory_bytes", static_cast<double>(ofScreen + tracer_->sizeBytes()));
        recorder.metric("frame_buffer_bytes",
                        static_cast<double>(ofScreen + tracer_->frameBufferBytes()));
    }

    void recordErrors(technique::Recorder& recorder, const HostGBuffer& gbuffer,
                      const image::ImageF& picture) {
        const Truth& known = truthOf(gbuffer);
        const image::ImageF& truth = known.picture;
        const glm::dvec3 errors = frame_->recordErrors(recorder, gbuffer, picture, truth);
        for (int c = 0; c < 3; ++c)
            recorder.metric(fmt::format("channel_error_{}", "rgb"[c]), errors[c]);
        if (params_.method != Method::EnvironmentMap) {
            const auto wrong = wrongHitPct(gbuffer, known.samples,
                                           target_->distance.read<float>(GL_RED, GL_FLOAT, 1),
                                           frame_->scene.diagonalM());
            if (wrong) recorder.metric("wrong_hit_pct", *wrong);
        }
        if (!known.converged.empty()) {
            const auto reflective = reflections::reflectivePixels(gbuffer, params_.supersampling);
            recorder.metric("channel_error_converged", reflections::meanOf(kit::channelErrors(
                                                           picture, known.converged, &reflective)));
        }
        if (!params_.showsPictures) return;
        frame_->recordTruth(recorder, gbuffer, picture, truth, 50);
        if (!known.converged.empty())
            recorder.image("converged", known.converged, seenFrom(gbuffer.view, "result"));
    }

    void recordClusters(technique::Recorder& recorder) {
        recorder.metric("clusters", clusteredTracer_->clusterCount());
        if (!params_.drawsReflections()) return;
        const std::vector<std::uint16_t> clusterOfSample = readClusters();
        const std::vector<std::uint8_t> environment = clusteredTracer_->environmentSamples();
        const std::size_t clustered = countOf(clusterOfSample), fallen = countOf(environment);
        if (clustered > 0) recorder.metric("environment_pct", kit::percent(fallen, clustered));
        if (clustered > 0) recorder.metric("march_steps", marchedSteps(clusterOfSample));
        const ClusteredTracer::Drawn drawn = clusteredTracer_->drawn();
        recorder.metric("drawn_triangles", static_cast<double>(drawn.triangles));
        recorder.metric("drawn_left_out", static_cast<double>(drawn.leftOut));
        if (clustered > 0) {
            recorder.metric("texels_per_sample",
                            static_cast<double>(drawn.texels) / static_cast<double>(clustered));
        }
    }

    /// Of a ray, in the mean over the samples that have a cluster (intersect.glsl).
    double marchedSteps(const std::vector<std::uint16_t>& clusterOfSample) const {
        const auto radiance = target_->radiance.read<glm::vec4>(GL_RGBA, GL_FLOAT, 1);
        double sum = 0.0;
        for (std::size_t i = 0; i < radiance.size(); ++i) {
            if (clusterOfSample[i] != 0) sum += static_cast<double>(radiance[i].a) - 1.0;
        }
        return sum / static_cast<double>(countOf(clusterOfSample));
    }

    std::vector<std::uint16_t> readClusters() const {
        return clusteredTracer_->clusters().clusterOfSample.read<std::uint16_t>(
            GL_RED_INTEGER, GL_UNSIGNED_SHORT, 1);
    }

    void recordClusterErrors(technique::Recorder& recorder, const HostGBuffer& gbuffer,
                             const image::ImageF& picture) {
        const std::vector<std::uint16_t> clusterOfSample = readClusters();
        if (params_.measuresErrors && hasReflections_)
            recordOcclusion(recorder, gbuffer, picture, clusterOfSample);
        if (!params_.showsPictures) return;
        recorder.image("clusters",
                       numbersPicture(gbuffer, params_.supersampling,
                                      [&](std::size_t i) { return clusterOfSample[i]; }),
                       seenFrom(gbuffer.view));
        frame_->recordMarks(recorder, "environment", gbuffer, picture,
                            clusteredTracer_->environmentSamples());
    }

    void recordOcclusion(technique::Recorder& recorder, const HostGBuffer& gbuffer,
                         const image::ImageF& picture, std::vector<std::uint16_t> clusterOfSample) {
        if (!params_.errorsOf.empty()) {
            const std::vector<std::uint8_t> isNamed = reflectorsOf(params_.errorsOf);
            for (std::size_t i = 0; i < clusterOfSample.size(); ++i) {
                if (isNamed[static_cast<std::size_t>(gbuffer.reflector(i))] == 0)
                    clusterOfSample[i] = 0;
            }
        }
        const OcclusionErrors errors = occlusionErrors(
            {gbuffer, truthOf(gbuffer).samples, clusterOfSample, clusteredTracer_->cameras(),
             frame_->scene, frame_->truth->rays(), params_.lobe, reflectorFamilies(frame_->scene)});
        const auto share = [&](const char* name, std::size_t samples) {
            recorder.metric(name, kit::percent(samples, errors.reflective));
        };
        if (errors.reflective == 0) return;
        share("occlusion_error_pct", errors.missing());
        share("occlusion_hidden_pct", errors.of(Sight::Hidden));
        recorder.metric("occlusion_hidden_picture_pct",
                        kit::percent(errors.of(Sight::Hidden), gbuffer.surface.size()));
        share("occlusion_near_pct", errors.of(Sight::BeforeNear));
        share("occlusion_side_pct", errors.of(Sight::Beside));
        share("occlusion_self_pct", errors.of(Sight::Self));
        if (errors.planar > 0) {
            recorder.metric("occlusion_error_planar_pct",
                            kit::percent(errors.planarMissing, errors.planar));
        }
        if (params_.showsPictures) {
            frame_->recordMarks(recorder, "occlusion", gbuffer, picture, errors.isMissing);
        }
    }

    /// By reflector id, 1 where its mesh has this name.
    std::vector<std::uint8_t> reflectorsOf(const std::string& name) const {
        const reflections::ReflectiveScene& scene = frame_->scene;
        std::vector<std::uint8_t> isNamed(static_cast<std::size_t>(scene.reflectorCount()) + 1);
        for (std::size_t i = 0; i < scene.objects().size(); ++i) {
            const auto reflector = static_cast<std::size_t>(scene.objects()[i].reflector);
            const auto mesh = static_cast<std::size_t>(scene.scene().instances[i].mesh);
            isNamed[reflector] = reflector != 0 && scene.scene().meshes[mesh].name == name ? 1 : 0;
        }
        return isNamed;
    }

    ReflectionParams params_;
    std::optional<reflections::Frame> frame_;
    std::optional<reflections::GBufferRenderer> gbufferRenderer_;
    std::optional<reflections::GBuffer> gbuffer_;
    std::optional<reflections::ReflectionTarget> target_;
    std::optional<reflections::EnvironmentMap> ownMap_;  // of `method: environment_map`
    std::unique_ptr<reflections::ReflectionTracer> tracer_;
    ClusteredTracer* clusteredTracer_ = nullptr;  // the same, of `method: clustered`

    technique::SharedResults* shared_ = nullptr;
    int frameIndex_ = 0;  // last rendered
    std::shared_ptr<const Truth> truth_;
    bool hasReflections_ = false;  // in the view that record() is at
};

}  // namespace

const technique::TechniqueInfo kClusteredReflections{
    "clustered_reflections", "mirror and glossy reflections from clustered depth images",
    technique::make<ClusteredReflections>, outputs};

}  // namespace gfxrepro::clustered_reflections
