#include "techniques/reflection_reuse/reflection_reuse.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/gtc/constants.hpp>
#include <memory>

#include "engine/image/srgb.h"
#include "techniques/clustered_reflections/clustered_tracer.h"
#include "techniques/kit/image_layers.h"
#include "techniques/kit/number.h"
#include "techniques/kit/percent.h"
#include "techniques/reflections/gpu_ray_tracer.h"

namespace gfxrepro::reflection_reuse {

namespace {

constexpr Choice<Method> kMethods[] = {
    {Method::Reuse, "reuse", "key frames' reflections moved to where they are seen (algorithm 8)"},
    {Method::Direct, "direct", "the same by depth alone, as if they were painted on"},
    {Method::RayTraced, "ray_traced", "every sample of every frame"},
};
constexpr Choice<Tracer> kTracers[] = {
    {Tracer::Compute, "compute", "ray tracing on the same device"},
    {Tracer::Embree, "embree", "ray tracing on the CPU"},
    {Tracer::Clustered, "clustered", "clustered depth images, as clustered_reflections has them"},
};
constexpr Choice<reflections::Blend> kBlends[] = {
    {reflections::Blend::Fresnel, "fresnel", "by view, normal and reflectivity"},
    {reflections::Blend::Reflectivity, "reflectivity", "by reflectivity alone, as chapter 4"},
};
constexpr Choice<Matching> kMatchings[] = {
    {Matching::FirstOrder, "first_order", "among planes, pixel by pixel (algorithm 9)"},
    {Matching::SecondOrder, "second_order", "among bent surfaces, between pixels"},
};
constexpr Choice<Forward> kForwards[] = {
    {Forward::Grid, "grid", "a mesh over the image"},
    {Forward::Splats, "splats", "a point per pixel"},
};

constexpr Choice<Resampling> kResamplings[] = {
    {Resampling::Twice, "twice",
     "shifted in the key frame's view, then warped (Sec. 5.4.2, 5.4.3)"},
    {Resampling::Gather, "gather", "found in the key frame by the new view's samples"},
};

ReuseSettings readReuse(Params& params) {
    ReuseSettings settings;
    settings.keyFrameThreshold = static_cast<float>(params.getDouble(
        "threshold", 0.3,
        {"share of recomputed samples above which the next frame is a key frame; 1: never", "1",
         0.0, 1.0}));
    settings.matching.matching = params.getEnum("matching", settings.matching.matching, kMatchings,
                                                {"how matches are found"});
    const double silhouette = params.getDouble(
        "silhouette", 0.05,
        {"neighbours whose eye depths differ by more of the nearer one are not connected", "1", 0.0,
         100.0});
    settings.matching.silhouette = static_cast<float>(silhouette);
    settings.reprojection.silhouette = static_cast<float>(silhouette);
    settings.reprojection.forward = params.getEnum("forward", settings.reprojection.forward,
                                                   kForwards, {"how images are drawn forward"});
    settings.reprojection.resampling =
        params.getEnum("resampling", settings.reprojection.resampling, kResamplings,
                       {"how reflections come from the key frame to the new view"});
    settings.reprojection.maxGrowth = kit::number(
        params, "max_growth", settings.reprojection.maxGrowth,
        {"how much a grid triangle's area may grow; a larger one is left out", "1", 1.0, 1e6});
    settings.reprojection.depthTolerance =
        kit::number(params, "depth_tolerance", 0.01F,
                    {"ε: share by which the depth of a reused sample may be off", "1", 0.0, 1.0});
    return settings;
}

}  // namespace

ReuseParams::ReuseParams(Params& params)
    : method(params.getEnum("method", Method::Reuse, kMethods, {"where reflections come from"})),
      tracer(params.getEnum("tracer", Tracer::Compute, kTracers,
                            {"what traces key frames and recomputed samples"})) {
    readView(params);
    pathFrames = params.getInt(
        "path_frames", pathFrames,
        {"frames of the whole path, which give the speed along it", "frames", 1, 1000000});
    firstFrame = params.getInt("first_frame", firstFrame,
                               {"frame of the path where measuring begins", "frame", 0, 999999});
    readMotionAndSupersampling(params, 1);
    blend = params.getEnum("blend", reflections::Blend::Fresnel, kBlends,
                           {"what weighs the reflected colour"});
    reuse = readReuse(params);
    readRoughness(params);
    readTextureFilter(params);
    readGlossiness(params, "reflection_reuse");
    readRays(params);
    measuresErrors = params.getBool("errors", true, {"compares with ray tracing by Embree"});
    showsPictures = params.getBool(
        "pictures", false, {"result, truth, errors, recomputed samples, key frame, offsets"});
    exhaustiveSamples = params.getInt(
        "exhaustive_samples", 0,
        {"matches of a frame that are compared with a search of the whole reflector; 0: none",
         "samples", 0, 1000000});
    params.finish();
    reuse.isDirect = method == Method::Direct;
    if (method == Method::RayTraced) {
        params.refuseGiven({"threshold", "silhouette", "forward", "max_growth", "depth_tolerance"},
                           "'method: reuse' or 'method: direct'");
    }
    if (method != Method::Reuse) {
        params.refuseGiven({"matching", "resampling", "exhaustive_samples"}, "'method: reuse'");
    } else if (reuse.reprojection.resampling == Resampling::Gather) {
        params.refuseGiven({"matching", "exhaustive_samples"}, "'resampling: twice'");
        params.refuseGiven({"silhouette", "forward", "max_growth"},
                           "'resampling: twice' or 'method: direct'");
    }
    if (firstFrame >= pathFrames) {
        throw Error(params.locationOf("first_frame"),
                    fmt::format("'first_frame' is {}; the path has frames 0 … {} ('path_frames')",
                                firstFrame, pathFrames - 1));
    }
}

namespace {

using kit::seenFrom;
using reflections::HostGBuffer;
using reflections::isReflective;

/// What the technique records: each metric with its unit, each pass with its meaning.
config::Outputs outputs() {
    using config::Better;
    constexpr bool kIsDetail = true;
    return reflections::withFrameOutputs({
        {
            {"recomputed_pct", "%",
             "share of the reflective samples that were traced, in frames between key frames",
             Better::Lower},
            {"saved_pct", "%",
             "share of the reflective samples that were not traced, over all frames",
             Better::Higher},
            {"undetected_pct", "%",
             "share of the reflective samples that were reused although they are off by more than "
             "16 levels",
             Better::Lower},
            {"recomputed_samples", "sample", "samples that were traced", Better::Neither,
             kIsDetail},
            {"is_key_frame", "1", "1 where all of the frame was traced", Better::Neither,
             kIsDetail},
            {"key_frame_interval", "frame", "frames since the key frame before", Better::Higher},
            {"unmatched_pct", "%",
             "share of the key frame's reflective samples for which the search found no place",
             Better::Lower},
            {"unshifted_pct", "%",
             "share of the key frame's reflective samples that were not shifted", Better::Lower},
            {"matching_steps", "step", "mean number of steps of a search", Better::Lower,
             kIsDetail},
            {"wrong_minimum_pct", "%",
             "share of the searches checked in full that ended at the wrong place", Better::Lower},
        },
        {
            {"diffuse", "drawing what the eye sees"},
            {"recompute", "tracing what is not reused"},
            {"reflection_shift", "moving the key frame's reflections to their new places"},
            {"reflection_warp", "moving them on to the new view, or finding them for it"},
            {"pixel_matching", "searching where the new view shows a reflected point"},
        },
    });
}

std::vector<glm::vec2> readOffsets(const Offsets& offsets) {
    return offsets.offset.read<glm::vec2>(GL_RG, GL_FLOAT, 1);
}

std::vector<glm::vec4> readRadiance(const gl::Texture& radiance) {
    return radiance.read<glm::vec4>(GL_RGBA, GL_FLOAT, 1);
}

/// Reused samples whose output pixel is off by more than this in a channel, of 0 … 255 as shown,
/// are errors that the method did not detect (Fig. 42); resampling of what is there gives less but
/// along edges.
constexpr int kUndetectedLevels = 16;

/// A byte a sample.
std::vector<std::uint8_t> undetectedErrors(const HostGBuffer& gbuffer,
                                           const std::vector<std::uint8_t>& recomputed,
                                           const image::ImageF& picture,
                                           const image::ImageF& truth) {
    const image::Image8 a = image::toSrgb8(picture);
    const image::Image8 b = image::toSrgb8(truth);
    const int supersampling = gbuffer.view.sizePx.x / a.width();
    std::vector<std::uint8_t> marks(gbuffer.surface.size());
    for (int y = 0; y < gbuffer.view.sizePx.y; ++y) {
        for (int x = 0; x < gbuffer.view.sizePx.x; ++x) {
            const std::size_t i = gbuffer.indexOf({x, y});
            if (!gbuffer.isReflective(i) || recomputed[i] != 0) continue;
            int most = 0;
            for (int c = 0; c < 3; ++c) {
                const int row = a.height() - 1 - y / supersampling;
                const int difference =
                    int{a.at(x / supersampling, row, c)} - int{b.at(x / supersampling, row, c)};
                most = std::max(most, std::abs(difference));
            }
            marks[i] = most > kUndetectedLevels ? 1 : 0;
        }
    }
    return marks;
}

/// White where `strength` is 0, the pure hue of a direction where it is 1.
glm::vec3 colorOf(const glm::vec2& direction, float strength) {
    const float turn = std::atan2(direction.y, direction.x) / glm::two_pi<float>();
    return glm::mix(glm::vec3(1.0F), reflections::hue(turn < 0.0F ? turn + 1.0F : turn), strength);
}

/// [xie2017] Fig. 36 B: hue by direction, stronger the longer an offset is beside the longest;
/// samples without a match are black, without a reflection grey. `key` is the key frame's.
image::ImageF offsetsPicture(const HostGBuffer& key, const std::vector<glm::vec2>& offsets,
                             int supersampling) {
    std::vector<float> lengthsPx;
    for (std::size_t i = 0; i < offsets.size(); ++i) {
        if (!key.isReflective(i) || !isValid(offsets[i])) continue;
        lengthsPx.push_back(glm::length(offsets[i]));
    }
    const auto middle = lengthsPx.begin() + static_cast<std::ptrdiff_t>(lengthsPx.size() / 2);
    std::nth_element(lengthsPx.begin(), middle, lengthsPx.end());
    const float medianPx = middle == lengthsPx.end() ? 1.0F : std::max(*middle, 1.0F);
    return reflections::averagedPicture(key, supersampling, [&](std::size_t i) {
        if (!key.isReflective(i)) return reflections::dimmed(key, i);
        if (!isValid(offsets[i])) return glm::vec3(0.0F);
        // Half of the hue at the median: few samples go far, and neither do they clip nor do they
        // leave the others white.
        const float lengthPx = glm::length(offsets[i]);
        return colorOf(offsets[i], lengthPx / (lengthPx + medianPx));
    });
}

/// Fig. 36 C: radiance of the shifted image, red where a reflective sample got nothing valid.
image::ImageF shiftedPicture(const HostGBuffer& key, const std::vector<glm::vec4>& radiance,
                             int supersampling) {
    return reflections::averagedPicture(key, supersampling, [&](std::size_t i) {
        if (!key.isReflective(i)) return reflections::dimmed(key, i);
        return radiance[i].a > 0.5F ? glm::vec3(radiance[i]) : glm::vec3(1.0F, 0.0F, 0.0F);
    });
}

class ReflectionReuse final : public technique::Technique {
  public:
    explicit ReflectionReuse(Params& params) : params_(params) {}

    void setup(technique::SetupContext& context) override {
        const gl::ShaderLibrary& shaders = context.shaders;
        shared_ = context.shared;
        frame_.emplace(context, params_);
        tracer_ = makeTracer(context);
        place({0, 1, context.profiler});
        if (params_.method == Method::RayTraced) {
            fullTracing_.emplace(FullTracing{reflections::GBufferRenderer(shaders, frame_->scene),
                                             reflections::GBuffer(view_),
                                             reflections::ReflectionTarget(frame_->samplesPx())});
        } else {
            ReuseSettings settings = params_.reuse;
            settings.reprojection.splitsDraws = context.device.info().isSoftware;
            renderer_.emplace(shaders, frame_->objects, *tracer_, settings, frame_->samplesPx(),
                              frame_->scene.diagonalM());
        }
    }

    technique::SceneNeed sceneNeed() const override { return technique::SceneNeed::Model; }
    void requireScene(const scene::Scene& scene) const override { params_.requireScene(scene); }
    void requireFrames(int frameCount) const override {
        const int last = params_.firstFrame + frameCount - 1;
        if (last < params_.pathFrames) return;
        throw Error(
            fmt::format("frames {} … {} do not lie on a path of {} ('first_frame', 'path_frames')",
                        params_.firstFrame, last, params_.pathFrames));
    }

    /// Frames are consecutive. One that is rendered again starts from what was there before it.
    void render(technique::FrameContext& context) override {
        gl::Profiler& profiler = context.profiler;
        place(context);
        // Chapter 5 walks through rooms at rest: its ray tracer's frames (Table 22) take less time
        // than chapter 4 needs for the BVH of one frame (Sec. 4.7.2), so that it cannot have built
        // one a frame.
        if (traced_.hasChanged(frame_->objects.poses())) tracer_->update(frame_->objects, profiler);
        if (renderer_) {
            // Warm-ups and repetitions must not move the choice of key frames on.
            if (context.frame == frameIndex_) renderer_->undo();
            renderer_->render(view_, profiler);
        } else {
            traceFully(profiler);
        }
        frameIndex_ = context.frame;
        frameCount_ = context.frameCount;
        const gl::GpuScope scope(profiler, "composite");
        frame_->composite.render(gbuffer(), reflection());
    }

    void record(technique::Recorder& recorder) override {
        const std::vector<std::uint32_t> surfaces = reflections::readSurfaces(gbuffer());
        const auto reflective =
            static_cast<std::size_t>(std::ranges::count_if(surfaces, isReflective));
        recorder.metric("reflective_pct", kit::percent(reflective, surfaces.size()));
        if (reflective == 0) frame_->scene.printEmptyView();
        const std::size_t frameBytes =
            renderer_ ? renderer_->sizeBytes()
                      : fullTracing_->gbuffer.sizeBytes() + fullTracing_->target.sizeBytes();
        recorder.metric(
            "memory_bytes",
            static_cast<double>(frameBytes + frame_->composite.sizeBytes() + tracer_->sizeBytes()));
        const ReuseCounts counts = renderer_ ? renderer_->counts() : ReuseCounts{};
        if (renderer_) recordReuse(recorder, counts);
        hasReflections_ = reflective > 0;
    }

    void recordOnce(technique::Recorder& recorder) override {
        const ReuseCounts counts = renderer_ ? renderer_->counts() : ReuseCounts{};
        // A key frame is traced, and has nothing to be judged by; the next frame shows it
        // (`key_frame`).
        const bool isJudged = params_.measuresErrors && !counts.isKeyFrame && hasReflections_;
        const bool isShown =
            params_.showsPictures && !(counts.isKeyFrame && frameIndex_ + 1 < frameCount_);
        if (!isJudged && !isShown) return;
        const HostGBuffer host = reflections::readGBuffer(gbuffer());
        const image::ImageF picture = frame_->composite.read();
        const image::ImageF truth =
            params_.measuresErrors ? truthOf(host)->picture : image::ImageF();
        if (isJudged) frame_->recordErrors(recorder, host, picture, truth);
        if (isJudged && renderer_) recordUndetected(recorder, host, picture, truth);
        if (isShown) recordPictures(recorder, host, picture, truth);
    }

    const gl::Texture* frameImage() const override {
        return frame_ ? &frame_->composite.output() : nullptr;
    }

  private:
    /// Of the last frame, however its reflections are made.
    std::shared_ptr<const reflections::TracedPicture> truthOf(const HostGBuffer& host) {
        return technique::sharedResult<reflections::TracedPicture>(
            shared_, fmt::format("frame {}", frameIndex_),
            {"method", "matching", "resampling", "forward"},
            [&] { return frame_->traced(gbuffer(), host); });
    }
    /// Frames of `method: ray_traced`.
    struct FullTracing {
        reflections::GBufferRenderer renderer;
        reflections::GBuffer gbuffer;
        reflections::ReflectionTarget target;
    };

    std::unique_ptr<reflections::ReflectionTracer> makeTracer(technique::SetupContext& context) {
        const gl::ShaderLibrary& shaders = context.shaders;
        const reflections::LobeSettings& lobe = params_.lobe;
        const float diagonalM = frame_->scene.diagonalM();
        switch (params_.tracer) {
            case Tracer::Compute:
                return std::make_unique<reflections::GpuRayTracer>(shaders, frame_->objects, lobe,
                                                                   diagonalM);
            case Tracer::Embree:
                return std::make_unique<reflections::EmbreeTracer>(frame_->scene, lobe);
            case Tracer::Clustered:
                break;
        }
        clustered_reflections::ClusteredSettings settings;
        settings.camera.diagonalM = diagonalM;
        settings.camera.lobe = lobe;
        return std::make_unique<clustered_reflections::ClusteredTracer>(
            shaders, frame_->scene, frame_->objects, frame_->environmentMap(context), settings,
            frame_->samplesPx());
    }

    /// Camera and objects as they are in a frame.
    void place(const technique::FrameContext& context) {
        requireFrames(context.frameCount);
        const double time = static_cast<double>(params_.firstFrame + context.frame) /
                            static_cast<double>(params_.pathFrames);
        view_ = frame_->viewAt(time);
        frame_->poseAt(time);
        if (context.frame == 0 && context.frameCount > 1) warnOfAStill(context.frameCount, time);
    }

    void warnOfAStill(int frameCount, double time) {
        const double last = time + (frameCount - 1) / static_cast<double>(params_.pathFrames);
        if (hasWarned_ || params_.method == Method::RayTraced ||
            frame_->viewAt(last).viewFromWorld != view_.viewFromWorld)
            return;
        hasWarned_ = true;
        fmt::print(stderr,
                   "warning: scene '{}': the camera stands still over {} frames: what is saved "
                   "tells nothing of a path ('view')\n",
                   frame_->scene.scene().name, frameCount);
    }

    // The passes have the names that they have between key frames.
    void traceFully(gl::Profiler& profiler) {
        FullTracing& full = *fullTracing_;
        full.gbuffer.view = view_;
        {
            const gl::GpuScope scope(profiler, "diffuse");
            full.renderer.render(frame_->objects, full.gbuffer);
        }
        const gl::GpuScope scope(profiler, "recompute");
        tracer_->trace(full.gbuffer, nullptr, full.target, profiler);
    }

    const reflections::GBuffer& gbuffer() const {
        return renderer_ ? renderer_->gbuffer() : fullTracing_->gbuffer;
    }

    const reflections::ReflectionTarget& reflection() const {
        return renderer_ ? renderer_->reflection() : fullTracing_->target;
    }

    void recordReuse(technique::Recorder& recorder, const ReuseCounts& counts) {
        const double recomputedPct =
            kit::percent(counts.recomputedSamples, counts.reflectiveSamples);
        recorder.metric("is_key_frame", counts.isKeyFrame ? 1.0 : 0.0);
        recorder.metric("recomputed_samples", counts.recomputedSamples);
        if (counts.reflectiveSamples > 0) recorder.metric("saved_pct", 100.0 - recomputedPct);
        if (counts.isKeyFrame) {
            if (lastKeyFrame_ >= 0 && frameIndex_ > lastKeyFrame_) {
                recorder.metric("key_frame_interval", frameIndex_ - lastKeyFrame_);
            }
            lastKeyFrame_ = frameIndex_;
            return;
        }
        if (counts.reflectiveSamples > 0) recorder.metric("recomputed_pct", recomputedPct);
        if (renderer_->shifted()) recordMatches(recorder);
    }

    void recordMatches(technique::Recorder& recorder) {
        const ReflectionDepthImage& key = renderer_->keyFrame();
        const MatchingCounts counts = countMatches(key, renderer_->offsets());
        if (counts.reflectiveSamples == 0) return;
        recorder.metric("matching_steps", counts.meanSteps());
        recorder.metric("unmatched_pct",
                        kit::percent(counts.invalidSamples, counts.reflectiveSamples));
        const std::vector<std::uint32_t> surfaces = reflections::readSurfaces(key.gbuffer);
        const std::vector<glm::vec4> shifted = readRadiance(renderer_->shifted()->radiance);
        std::size_t unshifted = 0;
        for (std::size_t i = 0; i < shifted.size(); ++i) {
            unshifted += isReflective(surfaces[i]) && shifted[i].a <= 0.5F ? 1 : 0;
        }
        recorder.metric("unshifted_pct", kit::percent(unshifted, counts.reflectiveSamples));
        if (params_.exhaustiveSamples == 0) return;
        const MatchCheck check =
            checkMatches(readReflectionDepthImage(key), readOffsets(renderer_->offsets()),
                         view_.eyeWorld, params_.exhaustiveSamples);
        recorder.metric("wrong_minimum_pct", kit::percent(check.wrong, check.checked));
    }

    void recordUndetected(technique::Recorder& recorder, const HostGBuffer& host,
                          const image::ImageF& picture, const image::ImageF& truth) {
        const std::vector<std::uint8_t> marks =
            undetectedErrors(host, reflections::readMask(renderer_->recomputed()), picture, truth);
        const auto undetected = static_cast<std::size_t>(std::ranges::count(marks, 1));
        recorder.metric("undetected_pct",
                        kit::percent(undetected, renderer_->counts().reflectiveSamples));
        if (params_.showsPictures)
            frame_->recordMarks(recorder, "undetected", host, picture, marks);
    }

    /// `truth` is empty where errors are not measured.
    void recordPictures(technique::Recorder& recorder, const HostGBuffer& host,
                        const image::ImageF& picture, const image::ImageF& truth) {
        frame_->recordResult(recorder, host, picture, truth);
        if (!truth.empty()) frame_->recordTruth(recorder, host, picture, truth, 60);
        frame_->recordReflection(recorder, gbuffer(), reflection());
        if (!renderer_) return;
        frame_->recordMarks(recorder, "recomputed", host, picture,
                            reflections::readMask(renderer_->recomputed()));
        if (renderer_->counts().isKeyFrame) return;
        const ReflectionDepthImage& key = renderer_->keyFrame();
        frame_->composite.render(key.gbuffer, key.reflection);
        recorder.image("key_frame", frame_->composite.read(), seenFrom(key.gbuffer.view));
        if (!renderer_->shifted()) return;
        const HostGBuffer hostKey = reflections::readGBuffer(key.gbuffer);
        recorder.image(
            "offsets",
            offsetsPicture(hostKey, readOffsets(renderer_->offsets()), params_.supersampling),
            seenFrom(hostKey.view));
        recorder.image("shifted",
                       shiftedPicture(hostKey, readRadiance(renderer_->shifted()->radiance),
                                      params_.supersampling),
                       seenFrom(hostKey.view));
    }

    ReuseParams params_;
    std::optional<reflections::Frame> frame_;
    std::unique_ptr<reflections::ReflectionTracer> tracer_;
    reflections::PoseWatch traced_;           // poses that tracer_ knows
    std::optional<ReuseRenderer> renderer_;   // of `reuse` and `direct`
    std::optional<FullTracing> fullTracing_;  // of `ray_traced`
    technique::SharedResults* shared_ = nullptr;
    kit::View view_;
    int frameIndex_ = -1;          // last rendered
    int lastKeyFrame_ = -1;        // last recorded key frame
    bool hasReflections_ = false;  // in the frame that record() is at
    int frameCount_ = 0;

    bool hasWarned_ = false;
};

}  // namespace

const technique::TechniqueInfo kReflectionReuse{
    "reflection_reuse", "mirror reflections of key frames reused in the frames after them",
    technique::make<ReflectionReuse>, outputs};

}  // namespace gfxrepro::reflection_reuse
