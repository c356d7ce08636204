// What is recorded of a frame: shares, choice of key frames, memory, errors, pictures.

#include <algorithm>
#include <cstdlib>

#include "runner/image/srgb.h"
#include "runner/metrics/flip.h"
#include "techniques/kit/displayed_errors.h"
#include "techniques/kit/image_layers.h"
#include "techniques/kit/percent.h"
#include "techniques/reflection_reuse/linear_fit.h"
#include "techniques/reflection_reuse/match_check.h"
#include "techniques/reflection_reuse/reflection_reuse.h"
#include "techniques/reflection_reuse/reuse_pictures.h"
#include "techniques/reflections/surface_pictures.h"

namespace gfxrepro::reflection_reuse {

using kit::seenFrom;
using reflections::HostGBuffer;

namespace {

double meanOf(const glm::dvec3& channels) {
    return (channels.x + channels.y + channels.z) / 3.0;
}

std::vector<glm::vec2> readOffsets(const Offsets& offsets) {
    const std::vector<float> values = offsets.offset.read<float>(GL_RG, GL_FLOAT, 2);
    std::vector<glm::vec2> pairs;
    pairs.reserve(values.size() / 2);
    for (std::size_t i = 0; i < values.size(); i += 2) pairs.emplace_back(values[i], values[i + 1]);
    return pairs;
}

std::vector<glm::vec4> readRadiance(const gl::Texture& radiance) {
    const std::vector<float> values = radiance.read<float>(GL_RGBA, GL_FLOAT, 4);
    std::vector<glm::vec4> colours;
    colours.reserve(values.size() / 4);
    for (std::size_t i = 0; i < values.size(); i += 4) {
        colours.emplace_back(values[i], values[i + 1], values[i + 2], values[i + 3]);
    }
    return colours;
}

std::vector<std::uint8_t> readRecomputed(const ReuseRenderer& renderer) {
    return renderer.recomputed().read<std::uint8_t>(GL_RED_INTEGER, GL_UNSIGNED_BYTE, 1);
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

}  // namespace

void ReflectionReuse::record(technique::Recorder& recorder) {
    const HostGBuffer host = reflections::readGBuffer(gbuffer());
    std::size_t reflective = 0;
    for (std::size_t i = 0; i < host.surface.size(); ++i)
        reflective += host.isReflective(i) ? 1 : 0;
    recorder.metric("reflective_pct", kit::percent(reflective, host.surface.size()), "%");
    if (reflective == 0) scene_->printEmptyView();
    const std::size_t frameBytes =
        renderer_ ? renderer_->sizeBytes()
                  : fullTracing_->gbuffer.sizeBytes() + fullTracing_->target.sizeBytes();
    recorder.metric(
        "memory_bytes",
        static_cast<double>(frameBytes + composite_->sizeBytes() + tracer_->sizeBytes()), "byte");
    if (renderer_) recordReuse(recorder);
    // A key frame is traced, and has nothing to be judged by; the next frame shows it
    // (`key_frame`).
    const bool isKeyFrame = renderer_ && renderer_->counts().isKeyFrame;
    const bool isJudged = params_.measuresErrors && !isKeyFrame && reflective > 0;
    const bool isShown = params_.showsPictures && !(isKeyFrame && frame_ + 1 < frameCount_);
    if (!isJudged && !isShown) return;
    const image::ImageF picture = composite_->read();
    const image::ImageF truth = params_.measuresErrors ? truthOf(host) : image::ImageF();
    if (isJudged) recordErrors(recorder, host, picture, truth);
    if (isShown) recordPictures(recorder, host, picture, truth);
}

void ReflectionReuse::recordReuse(technique::Recorder& recorder) {
    const ReuseCounts counts = renderer_->counts();
    const double recomputedPct = kit::percent(counts.recomputedSamples, counts.reflectiveSamples);
    recorder.metric("is_key_frame", counts.isKeyFrame ? 1.0 : 0.0, "1");
    recorder.metric("recomputed_samples", counts.recomputedSamples, "sample");
    if (counts.reflectiveSamples > 0) recorder.metric("saved_pct", 100.0 - recomputedPct, "%");
    recordRecomputeFit(recorder, counts);
    if (counts.isKeyFrame) {
        if (lastKeyFrame_ >= 0 && frame_ > lastKeyFrame_) {
            recorder.metric("key_frame_interval", frame_ - lastKeyFrame_, "frame");
        }
        lastKeyFrame_ = frame_;
        return;
    }
    if (counts.reflectiveSamples > 0) recorder.metric("recomputed_pct", recomputedPct, "%");
    if (params_.method == Method::Reuse) recordMatches(recorder);
}

/// Whether the time follows the number of samples, over all frames that have been rendered, in the
/// last one. Key frames are left out: far from all others they would settle the line alone.
void ReflectionReuse::recordRecomputeFit(technique::Recorder& recorder, const ReuseCounts& counts) {
    if (!recomputeTimes_) return;
    keepLeastRecomputeTime();
    if (leastRecomputeMs_) recomputed_.emplace_back(counts.recomputedSamples, *leastRecomputeMs_);
    leastRecomputeMs_.reset();
    if (frame_ + 1 < frameCount_) return;
    const std::optional<LinearFit> fit = linearFit(recomputed_);
    if (!fit) return;
    recorder.metric("recompute_time_r_squared", fit->rSquared, "1");
    recorder.metric("recompute_fit_us_per_sample", 1e3 * fit->slope, "us");
    recorder.metric("recompute_fit_fixed_ms", fit->intercept, "ms");
}

void ReflectionReuse::recordMatches(technique::Recorder& recorder) {
    const HostReflectionDepthImage key = readReflectionDepthImage(renderer_->keyFrame());
    const std::vector<glm::vec2> offsets = readOffsets(renderer_->offsets());
    std::size_t reflective = 0, unmatched = 0;
    for (std::size_t i = 0; i < offsets.size(); ++i) {
        if (!key.gbuffer.isReflective(i)) continue;
        ++reflective;
        unmatched += isValid(offsets[i]) ? 0 : 1;
    }
    if (reflective == 0) return;
    recorder.metric("matching_steps", renderer_->counts().matchingSteps, "step");
    recorder.metric("unmatched_pct", kit::percent(unmatched, reflective), "%");
    if (renderer_->shifted()) {
        const std::vector<glm::vec4> shifted = readRadiance(renderer_->shifted()->radiance);
        std::size_t unshifted = 0;
        for (std::size_t i = 0; i < shifted.size(); ++i) {
            unshifted += key.gbuffer.isReflective(i) && shifted[i].a <= 0.5F ? 1 : 0;
        }
        recorder.metric("unshifted_pct", kit::percent(unshifted, reflective), "%");
    }
    if (params_.exhaustiveSamples == 0) return;
    const MatchCheck check = checkMatches(key, offsets, view_.eyeWorld, params_.reuse.matching,
                                          params_.exhaustiveSamples);
    recorder.metric("wrong_minimum_pct", kit::percent(check.wrong, check.checked), "%");
}

/// The same composite makes a picture of Embree's rays, so that nothing but the reflections
/// differs.
image::ImageF ReflectionReuse::truthOf(const HostGBuffer& host) {
    if (truthPoses_.hasChanged(objects_->poses())) truthTracer_->update(*objects_, *untimed_);
    std::vector<glm::vec4> radiance;
    radiance.reserve(host.surface.size());
    for (const reflections::TracedSample& sample : truthTracer_->trace(host)) {
        radiance.emplace_back(sample.radiance, 1.0F);
    }
    reflections::ReflectionTarget target(host.view.sizePx);
    target.radiance.upload(GL_RGBA, GL_FLOAT, radiance.data());
    composite_->render(gbuffer(), target);
    return composite_->read();
}

void ReflectionReuse::recordErrors(technique::Recorder& recorder, const HostGBuffer& host,
                                   const image::ImageF& picture, const image::ImageF& truth) {
    const std::vector<std::uint8_t> reflective =
        reflections::reflectivePixels(host, params_.supersampling);
    recorder.metric("channel_error", meanOf(kit::channelErrors(picture, truth, &reflective)),
                    "level");
    recorder.metric("channel_error_image", meanOf(kit::channelErrors(picture, truth, nullptr)),
                    "level");
    recorder.metric("flip_mean", metrics::flip(truth, picture), "1");
    recorder.metric("psnr_db", kit::shownPsnrDb(picture, truth), "dB");
    if (renderer_) recordUndetected(recorder, host, picture, truth);
}

void ReflectionReuse::recordUndetected(technique::Recorder& recorder, const HostGBuffer& host,
                                       const image::ImageF& picture, const image::ImageF& truth) {
    const std::vector<std::uint8_t> marks =
        undetectedErrors(host, readRecomputed(*renderer_), picture, truth);
    const auto undetected = static_cast<std::size_t>(std::ranges::count(marks, 1));
    recorder.metric("undetected_pct",
                    kit::percent(undetected, renderer_->counts().reflectiveSamples), "%");
    if (!params_.showsPictures) return;
    recorder.image("undetected",
                   reflections::markedPicture(picture, marks, host, params_.supersampling),
                   seenFrom(host.view));
}

void ReflectionReuse::recordPictures(technique::Recorder& recorder, const HostGBuffer& host,
                                     const image::ImageF& picture, const image::ImageF& truth) {
    kit::ImageLayers layers = reflections::surfaceLayers(host, params_.supersampling);
    if (!truth.empty()) layers.errors(picture, truth);
    recorder.image("result", picture, layers.options());
    if (!truth.empty()) {
        recorder.image("truth", truth, seenFrom(host.view, "result"));
        recorder.image("error", kit::errorPicture(picture, truth, 1), seenFrom(host.view));
        recorder.image("error_60", kit::errorPicture(picture, truth, 60), seenFrom(host.view));
    }
    composite_->render(gbuffer(), reflection(), true);
    recorder.image("reflection", composite_->read(), seenFrom(host.view));
    if (!renderer_) return;
    recorder.image("recomputed",
                   reflections::markedPicture(picture, readRecomputed(*renderer_), host,
                                              params_.supersampling),
                   seenFrom(host.view));
    if (renderer_->counts().isKeyFrame) return;
    const ReflectionDepthImage& key = renderer_->keyFrame();
    composite_->render(key.gbuffer, key.reflection);
    recorder.image("key_frame", composite_->read(), seenFrom(key.gbuffer.view));
    if (params_.method != Method::Reuse) return;
    const HostGBuffer hostKey = reflections::readGBuffer(key.gbuffer);
    recorder.image(
        "offsets",
        offsetsPicture(hostKey, readOffsets(renderer_->offsets()), params_.supersampling),
        seenFrom(hostKey.view));
    if (!renderer_->shifted()) return;
    recorder.image("shifted",
                   shiftedPicture(hostKey, readRadiance(renderer_->shifted()->radiance),
                                  params_.supersampling),
                   seenFrom(hostKey.view));
}

}  // namespace gfxrepro::reflection_reuse
