// What is recorded of a frame: shares, choice of key frames, memory, errors, pictures.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/gtc/constants.hpp>

#include "engine/image/srgb.h"
#include "techniques/kit/displayed_errors.h"
#include "techniques/kit/image_layers.h"
#include "techniques/kit/percent.h"
#include "techniques/reflection_reuse/linear_fit.h"
#include "techniques/reflection_reuse/match_check.h"
#include "techniques/reflection_reuse/reflection_reuse.h"
#include "techniques/reflections/surface_pictures.h"

namespace gfxrepro::reflection_reuse {

using kit::seenFrom;
using reflections::HostGBuffer;
using reflections::isReflective;

namespace {

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

}  // namespace

void ReflectionReuse::record(technique::Recorder& recorder) {
    const std::vector<std::uint32_t> surfaces = reflections::readSurfaces(gbuffer());
    const auto reflective = static_cast<std::size_t>(std::ranges::count_if(surfaces, isReflective));
    recorder.metric("reflective_pct", kit::percent(reflective, surfaces.size()), "%");
    if (reflective == 0) frame_->scene.printEmptyView();
    const std::size_t frameBytes =
        renderer_ ? renderer_->sizeBytes()
                  : fullTracing_->gbuffer.sizeBytes() + fullTracing_->target.sizeBytes();
    recorder.metric(
        "memory_bytes",
        static_cast<double>(frameBytes + frame_->composite.sizeBytes() + tracer_->sizeBytes()),
        "byte");
    const ReuseCounts counts = renderer_ ? renderer_->counts() : ReuseCounts{};
    if (renderer_) recordReuse(recorder, counts);
    // A key frame is traced, and has nothing to be judged by; the next frame shows it
    // (`key_frame`).
    const bool isJudged = params_.measuresErrors && !counts.isKeyFrame && reflective > 0;
    const bool isShown =
        params_.showsPictures && !(counts.isKeyFrame && frameIndex_ + 1 < frameCount_);
    if (!isJudged && !isShown) return;
    const HostGBuffer host = reflections::readGBuffer(gbuffer());
    const image::ImageF picture = frame_->composite.read();
    const image::ImageF truth = params_.measuresErrors ? truthOf(host) : image::ImageF();
    if (isJudged) recordErrors(recorder, host, picture, truth);
    if (isShown) recordPictures(recorder, host, picture, truth);
}

void ReflectionReuse::recordReuse(technique::Recorder& recorder, const ReuseCounts& counts) {
    const double recomputedPct = kit::percent(counts.recomputedSamples, counts.reflectiveSamples);
    recorder.metric("is_key_frame", counts.isKeyFrame ? 1.0 : 0.0, "1");
    recorder.metric("recomputed_samples", counts.recomputedSamples, "sample");
    if (counts.reflectiveSamples > 0) recorder.metric("saved_pct", 100.0 - recomputedPct, "%");
    recordRecomputeFit(recorder, counts);
    if (counts.isKeyFrame) {
        if (lastKeyFrame_ >= 0 && frameIndex_ > lastKeyFrame_) {
            recorder.metric("key_frame_interval", frameIndex_ - lastKeyFrame_, "frame");
        }
        lastKeyFrame_ = frameIndex_;
        return;
    }
    if (counts.reflectiveSamples > 0) recorder.metric("recomputed_pct", recomputedPct, "%");
    if (params_.method == Method::Reuse) recordMatches(recorder, counts);
}

/// Whether the time follows the number of samples, over all frames that have been rendered, in the
/// last one. Key frames are left out: far from all others they would settle the line alone.
void ReflectionReuse::recordRecomputeFit(technique::Recorder& recorder, const ReuseCounts& counts) {
    if (!recomputeTimes_) return;
    keepLeastRecomputeTime();
    if (leastRecomputeMs_) recomputed_.emplace_back(counts.recomputedSamples, *leastRecomputeMs_);
    leastRecomputeMs_.reset();
    if (frameIndex_ + 1 < frameCount_) return;
    const std::optional<LinearFit> fit = linearFit(recomputed_);
    if (!fit) return;
    recorder.metric("recompute_time_r_squared", fit->rSquared, "1");
    recorder.metric("recompute_fit_us_per_sample", 1e3 * fit->slope, "us");
    recorder.metric("recompute_fit_fixed_ms", fit->intercept, "ms");
}

void ReflectionReuse::recordMatches(technique::Recorder& recorder, const ReuseCounts& counts) {
    const ReflectionDepthImage& key = renderer_->keyFrame();
    const std::vector<std::uint32_t> surfaces = reflections::readSurfaces(key.gbuffer);
    const std::vector<glm::vec2> offsets = readOffsets(renderer_->offsets());
    std::size_t reflective = 0, unmatched = 0;
    for (std::size_t i = 0; i < offsets.size(); ++i) {
        if (!isReflective(surfaces[i])) continue;
        ++reflective;
        unmatched += isValid(offsets[i]) ? 0 : 1;
    }
    if (reflective == 0) return;
    recorder.metric("matching_steps", counts.matchingSteps, "step");
    recorder.metric("unmatched_pct", kit::percent(unmatched, reflective), "%");
    if (renderer_->shifted()) {
        const std::vector<glm::vec4> shifted = readRadiance(renderer_->shifted()->radiance);
        std::size_t unshifted = 0;
        for (std::size_t i = 0; i < shifted.size(); ++i) {
            unshifted += isReflective(surfaces[i]) && shifted[i].a <= 0.5F ? 1 : 0;
        }
        recorder.metric("unshifted_pct", kit::percent(unshifted, reflective), "%");
    }
    if (params_.exhaustiveSamples == 0) return;
    const MatchCheck check = checkMatches(readReflectionDepthImage(key), offsets, view_.eyeWorld,
                                          params_.reuse.matching, params_.exhaustiveSamples);
    recorder.metric("wrong_minimum_pct", kit::percent(check.wrong, check.checked), "%");
}

image::ImageF ReflectionReuse::truthOf(const HostGBuffer& host) {
    if (truthPoses_.hasChanged(frame_->objects.poses()))
        frame_->truth->update(frame_->objects, *frame_->untimed);
    return frame_->pictureOf(gbuffer(), frame_->truth->trace(host));
}

void ReflectionReuse::recordErrors(technique::Recorder& recorder, const HostGBuffer& host,
                                   const image::ImageF& picture, const image::ImageF& truth) {
    frame_->recordErrors(recorder, host, picture, truth);
    if (renderer_) recordUndetected(recorder, host, picture, truth);
}

void ReflectionReuse::recordUndetected(technique::Recorder& recorder, const HostGBuffer& host,
                                       const image::ImageF& picture, const image::ImageF& truth) {
    const std::vector<std::uint8_t> marks =
        undetectedErrors(host, readRecomputed(*renderer_), picture, truth);
    const auto undetected = static_cast<std::size_t>(std::ranges::count(marks, 1));
    recorder.metric("undetected_pct",
                    kit::percent(undetected, renderer_->counts().reflectiveSamples), "%");
    if (params_.showsPictures) frame_->recordMarks(recorder, "undetected", host, picture, marks);
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
    frame_->composite.render(gbuffer(), reflection(), true);
    recorder.image("reflection", frame_->composite.read(), seenFrom(host.view));
    if (!renderer_) return;
    frame_->recordMarks(recorder, "recomputed", host, picture, readRecomputed(*renderer_));
    if (renderer_->counts().isKeyFrame) return;
    const ReflectionDepthImage& key = renderer_->keyFrame();
    frame_->composite.render(key.gbuffer, key.reflection);
    recorder.image("key_frame", frame_->composite.read(), seenFrom(key.gbuffer.view));
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
