#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "techniques/kit/image_layers.h"
#include "techniques/kit/percent.h"
#include "techniques/kit/picture.h"
#include "techniques/shadow_mapping/outputs.h"
#include "techniques/shadow_mapping/shadow_mapping.h"

namespace gfxrepro::shadow_mapping {
namespace {

/// Light `light` of the four channels.
std::vector<float> channelOf(const std::vector<float>& terms, std::size_t light) {
    std::vector<float> channel(terms.size() / 4);
    for (std::size_t i = 0; i < channel.size(); ++i) channel[i] = terms[4 * i + light];
    return channel;
}

/// White where lit, grey where in shadow, dark where it is not asked: by the truth, or by `terms`
/// of the map.
image::ImageF shadowPicture(const ShadowErrors& errors, const std::vector<float>* terms,
                            glm::ivec2 sizePx) {
    return kit::pictureOf(sizePx, [&](std::size_t i) {
        const float lit = terms ? (*terms)[i] : static_cast<float>(errors.truth[i]);
        return errors.classes[i] != PixelClass::NotCompared ? 0.2F + 0.7F * lit : 0.02F;
    });
}

/// With the normals that only an image with terms has.
kit::ImageLayers layersOf(const ShadedImage& image) {
    const std::vector<float> normals = image.normals.read<float>(GL_RGB, GL_FLOAT, 3);
    std::vector<glm::vec3> normalWorld;
    for (std::size_t i = 0; i < normals.size(); i += 3) {
        normalWorld.emplace_back(normals[i], normals[i + 1], normals[i + 2]);
    }
    kit::ImageLayers layers(image.view);
    layers.windowDepths(image.depth.read<float>(GL_DEPTH_COMPONENT, GL_FLOAT, 1));
    layers.normals(normalWorld);
    return layers;
}

}  // namespace

void ShadowMapping::record(technique::Recorder& recorder) {
    recordSteps(recorder);
    recorder.metric("lights_without_caster", lightsWithoutCaster_, "light");
    recorder.metric("memory_bytes", static_cast<double>(maps_->sizeBytes()), "byte");
    if (params_.showsPictures) recordPicture(recorder);
    if (!params_.measuresErrors && !params_.comparesMethods) return;
    // Once more with the terms that the measured frame does not write.
    ShadedImage image = makeShadedImage(image_->view, true);
    shadedView_->render(*drawable_, *maps_, image);
    if (params_.measuresErrors) recordErrors(recorder, image);
    if (params_.comparesMethods) recordDifference(recorder, image);
}

void ShadowMapping::recordPicture(technique::Recorder& recorder) const {
    const std::vector<float> depths = image_->depth.read<float>(GL_DEPTH_COMPONENT, GL_FLOAT, 1);
    recorder.image("result", image_->colour.readImage(3),
                   kit::ImageLayers(image_->view).windowDepths(depths).options());
}

// [zju2005] Table 4.3
void ShadowMapping::recordSteps(technique::Recorder& recorder) const {
    for (const StepDeclaration& step : maps_->steps()) {
        std::string pass = step.step == "depth map" ? "depth_pass"
                           : step.step == "shading" ? "shading_pass"
                                                    : step.step;
        std::replace(pass.begin(), pass.end(), ' ', '_');
        recorder.metric("colour_writes", step.colourWrites ? 1.0 : 0.0, "1", pass);
        recorder.metric("depth_writes", step.depthWrites ? 1.0 : 0.0, "1", pass);
        recorder.metric("fragment_work", step.fragmentWork ? 1.0 : 0.0, "1", pass);
        recorder.metric("fetches", step.fetches, "1", pass);
        recorder.metric("comparisons", step.comparisons, "1", pass);
    }
}

void ShadowMapping::recordErrors(technique::Recorder& recorder, const ShadedImage& image) {
    const std::vector<float> terms = image.shadowTerms.read<float>(GL_RGBA, GL_FLOAT, 4);
    const std::vector<VisiblePoint> points = visiblePoints(*tracer_, image.view);
    const scene::Box& bounds = drawable_->bounds();
    const ShadowTruth truth(*tracer_, glm::length(bounds.size()));
    std::uint64_t compared = 0, edge = 0, acne = 0, leak = 0;
    const glm::ivec2 sizePx = image.view.sizePx;
    for (std::size_t i = 0; i < lights_.size(); ++i) {
        const std::vector<float> ofLight = channelOf(terms, i);
        const ShadowErrors errors =
            truth.compare(points, truthLight(lights_[i], bounds, params_.maps.sizePx), ofLight,
                          params_.edgeReachTexels());
        compared += errors.compared;
        edge += errors.edge;
        acne += errors.acne;
        leak += errors.leak;
        if (!params_.showsPictures) continue;
        const std::string name = fmt::format("shadow_{}", i);
        const image::ImageF picture = shadowPicture(errors, &ofLight, sizePx);
        const image::ImageF truthPicture = shadowPicture(errors, nullptr, sizePx);
        const std::string truthName = fmt::format("truth_{}", i);
        recorder.image(name, picture,
                       layersOf(image).errors(picture, truthPicture, truthName).options());
        recorder.image(truthName, truthPicture, kit::seenFrom(image.view, name));
        recorder.image(fmt::format("errors_{}", i), classPicture(errors, sizePx),
                       kit::seenFrom(image.view));
    }
    recorder.metric("compared_points", static_cast<double>(compared), "pixel");
    recorder.metric("wrong_pct", kit::percent(edge + acne + leak, compared), "%");
    recorder.metric("acne_pct", kit::percent(acne, compared), "%");
    recorder.metric("leak_pct", kit::percent(leak, compared), "%");
    recorder.metric("edge_pct", kit::percent(edge, compared), "%");
}

// S4: pixels whose shadow differs from that of the other method by more than a filtered fetch may:
// texture units weigh with 8 bits on each axis.
void ShadowMapping::recordDifference(technique::Recorder& recorder, const ShadedImage& image) {
    ShadowMapSettings settings = params_.maps;
    settings.storage =
        settings.storage == Storage::Standard ? Storage::Hardware : Storage::Standard;
    ShadowMapRenderer maps(*shaders_, settings);
    ShadedView view(*shaders_, settings);
    ShadedImage other = makeShadedImage(image.view, true);
    maps.render(*drawable_, lights_);
    view.render(*drawable_, maps, other);
    const std::vector<float> here = image.shadowTerms.read<float>(GL_RGBA, GL_FLOAT, 4);
    const std::vector<float> there = other.shadowTerms.read<float>(GL_RGBA, GL_FLOAT, 4);
    std::uint64_t differing = 0;
    for (std::size_t pixel = 0; pixel < here.size() / 4; ++pixel) {
        bool differs = false;
        for (std::size_t i = 4 * pixel; i < 4 * pixel + lights_.size(); ++i) {
            differs = differs || std::abs(here[i] - there[i]) > 1.0F / 64.0F;
        }
        differing += differs ? 1 : 0;
    }
    recorder.metric("methods_differ_pct", kit::percent(differing, here.size() / 4), "%");
}

namespace {
std::unique_ptr<technique::Technique> create(Params& params) {
    return std::make_unique<ShadowMapping>(params);
}
}  // namespace

const technique::TechniqueInfo kShadowMapping{
    "shadow_mapping", "shadow maps compared in the shader or by the texture unit", create, outputs};

}  // namespace gfxrepro::shadow_mapping
