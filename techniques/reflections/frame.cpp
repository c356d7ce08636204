#include "techniques/reflections/frame.h"

#include <fmt/format.h>

#include "engine/metrics/flip.h"
#include "engine/scene/animation.h"
#include "techniques/kit/displayed_errors.h"
#include "techniques/kit/path_view.h"
#include "techniques/reflections/surface_pictures.h"

namespace gfxrepro::reflections {

void FrameSettings::readView(Params& params) {
    view = params.getText(
        "view", "", {"a path or camera of the scene; none: its first path, else its first camera"});
}

void FrameSettings::readMotionAndSupersampling(Params& params, int defaultSupersampling) {
    hasMotion = params.getBool("motion", false, {"objects move as the scene says"});
    supersampling = params.getInt("supersampling", defaultSupersampling,
                                  {"samples along each edge of an output pixel", "samples", 1, 8});
}

void FrameSettings::readGlossiness(Params& params, const std::string& technique) {
    const auto given = static_cast<float>(params.getDouble(
        "glossiness", -1.0,
        {"of all reflectors, 0 a mirror, 1 the widest lobe; -1: as their materials say", "1", -1.0,
         1.0}));
    if (given == -1.0F) return;
    if (given < 0.0F) {
        throw Error(
            params.locationOf("glossiness"),
            fmt::format("technique '{}': glossiness is {}; allowed: -1, 0 … 1", technique, given));
    }
    if (given > 0.0F && given < 0.5F / 255.0F) {  // surfaces hold it in 255ths
        throw Error(params.locationOf("glossiness"),
                    fmt::format("technique '{}': glossiness is {}, which is drawn as a mirror; "
                                "allowed: -1, 0, 0.002 … 1",
                                technique, given));
    }
    glossiness = given;
}

void FrameSettings::readRoughness(Params& params) {
    reflectors.maxRoughness = static_cast<float>(params.getDouble(
        "reflector_roughness", 0.4, {"materials up to this roughness reflect", "1", 0.0, 1.0}));
}

void FrameSettings::readTextureFilter(Params& params) {
    textureFilter =
        params.getEnum("texture_filter", textureFilter, kTextureFilters, kTextureFilterSpec);
}

void FrameSettings::readRays(Params& params) {
    lobe.rays = params.getInt(
        "rays", 0, {"rays of a glossy sample; 0: 8 … 49, with the glossiness", "rays", 0, 4096});
}

namespace {

ReflectiveScene prepared(const scene::Scene& given, const FrameSettings& settings) {
    ReflectiveScene scene(given, settings.reflectors, settings.textureFilter);
    scene.printWarnings();
    if (settings.glossiness) scene.setGlossiness(*settings.glossiness);
    return scene;
}

}  // namespace

void FrameSettings::requireScene(const scene::Scene& scene) const {
    requireReflectors(scene, reflectors);
    kit::cameraAtTime(scene, view, 0.0, 1.0F);
}

Frame::Frame(technique::SetupContext& context, const FrameSettings& wanted)
    : settings(wanted),
      outputSizePx(context.outputSizePx),
      scene(prepared(*context.scene, wanted)),
      objects(scene, context.device.info().isSoftware),
      map(context.shaders, scene),
      composite(context.shaders, outputSizePx, wanted.supersampling, wanted.blend) {
    map.render(objects);
    if (!settings.measuresErrors) return;
    untimed.emplace(context.device.info().isSoftware);
    truth.emplace(context.shaders, scene, map, settings.lobe);
}

kit::View Frame::viewAt(double time) const {
    const glm::vec2 size(outputSizePx);
    return kit::viewOf(kit::cameraAtTime(scene.scene(), settings.view, time, size.x / size.y),
                       samplesPx());
}

void Frame::poseAt(double time) {
    if (settings.hasMotion) objects.setPoses(scene::posesAt(scene.scene(), time));
}

image::ImageF Frame::pictureOf(const GBuffer& gbuffer, std::span<const TracedSample> samples) {
    std::vector<glm::vec4> radiance;
    radiance.reserve(samples.size());
    for (const TracedSample& sample : samples) radiance.emplace_back(sample.radiance, 1.0F);
    ReflectionTarget target(gbuffer.view.sizePx);
    target.radiance.upload(GL_RGBA, GL_FLOAT, radiance.data());
    composite.render(gbuffer, target);
    return composite.read();
}

glm::dvec3 Frame::recordErrors(technique::Recorder& recorder, const HostGBuffer& gbuffer,
                               const image::ImageF& picture, const image::ImageF& known) const {
    const std::vector<std::uint8_t> reflective = reflectivePixels(gbuffer, settings.supersampling);
    const glm::dvec3 errors = kit::channelErrors(picture, known, &reflective);
    recorder.metric("channel_error", meanOf(errors), "level");
    recorder.metric("channel_error_image", meanOf(kit::channelErrors(picture, known, nullptr)),
                    "level");
    recorder.metric("flip_mean", metrics::flip(known, picture), "1");
    recorder.metric("psnr_db", kit::shownPsnrDb(picture, known), "dB");
    return errors;
}

void Frame::recordMarks(technique::Recorder& recorder, const std::string& name,
                        const HostGBuffer& gbuffer, const image::ImageF& picture,
                        const std::vector<std::uint8_t>& marks) const {
    recorder.image(name, markedPicture(picture, marks, gbuffer, settings.supersampling),
                   kit::seenFrom(gbuffer.view));
}

double meanOf(const glm::dvec3& channels) {
    return (channels.x + channels.y + channels.z) / 3.0;
}

}  // namespace gfxrepro::reflections
