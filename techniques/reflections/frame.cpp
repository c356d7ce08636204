#include "techniques/reflections/frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "engine/core/error.h"
#include "engine/metrics/flip.h"
#include "engine/scene/animation.h"
#include "techniques/kit/displayed_errors.h"
#include "techniques/kit/image_layers.h"
#include "techniques/kit/path_view.h"

namespace gfxrepro::reflections {

namespace {

constexpr Choice<TextureFilter> kTextureFilters[] = {
    {TextureFilter::Footprint, "footprint", "averaged over what a sample, a texel or a ray covers"},
    {TextureFilter::FinestLevel, "finest_level", "as they are, however much a sample covers"},
};

/// Frames of rough floors take a dozen times as long as those of mirrors.
void warnOfManyRays(const ReflectiveScene& scene, const FrameSettings& settings) {
    int most = 1;
    for (const Object& object : scene.objects()) {
        if (object.reflector == 0) continue;
        most = std::max(most, raysOf(settings.lobe, object.hasOneGlossiness
                                                        ? object.glossiness
                                                        : settings.reflectors.maxRoughness));
    }
    if (most == 1) return;
    fmt::print(stderr,
               "warning: scene '{}': what reflects is as rough as its materials say, with up to {} "
               "rays a sample; 'glossiness: 0' makes mirrors of it, 'rays' sets how many\n",
               scene.scene().name, most);
}

ReflectiveScene prepared(const scene::Scene& given, const FrameSettings& settings) {
    ReflectiveScene scene(given, settings.reflectors, settings.textureFilter);
    scene.printWarnings();
    if (settings.glossiness) {
        scene.setGlossiness(*settings.glossiness);
    } else if (settings.lobe.rays == 0) {
        warnOfManyRays(scene, settings);
    }
    return scene;
}

}  // namespace

void FrameSettings::readView(Params& params) {
    view = params.getText(
        "view", "",
        {"a path or camera of the scene, where from to frame it, \"AZIMUTH ELEVATION\" in degrees, "
         "or keys of a path, \"X Y Z > X Y Z; …\" from and to; none: its first path, "
         "else its first camera"});
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
        params.getEnum("texture_filter", textureFilter, kTextureFilters, {"how textures are read"});
}

void FrameSettings::readRays(Params& params) {
    lobe.rays = params.getInt(
        "rays", 0, {"rays of a glossy sample; 0: 8 … 49, with the glossiness", "rays", 0, 4096});
}

void FrameSettings::requireScene(const scene::Scene& scene) const {
    requireReflectors(scene, reflectors);
    kit::cameraAtTime(scene, view, 0.0, 1.0F);
}

Frame::Frame(technique::SetupContext& context, const FrameSettings& wanted)
    : settings(wanted),
      outputSizePx(context.outputSizePx),
      scene(prepared(*context.scene, wanted)),
      objects(scene, context.device.info().isSoftware),
      composite(context.shaders, outputSizePx, wanted.supersampling, wanted.blend) {
    if (!settings.measuresErrors) return;
    untimed.emplace(context.device.info().isSoftware);
    truth.emplace(scene, settings.lobe);
}

kit::View Frame::viewAt(double time) const {
    const glm::vec2 size(outputSizePx);
    return kit::viewOf(kit::cameraAtTime(scene.scene(), settings.view, time, size.x / size.y),
                       samplesPx());
}

void Frame::poseAt(double time) {
    if (settings.hasMotion) objects.setPoses(scene::posesAt(scene.scene(), time));
}

const EnvironmentMap& Frame::environmentMap(technique::SetupContext& context) {
    map = technique::sharedResult<EnvironmentMap>(
        context.shared, "environment map",
        {"method", "view", "motion", "errors", "errors_of", "rays", "converged_rays", "glossiness",
         "clustering", "bin_gain", "depth_images", "depth_image_scale", "own_reflector",
         "own_back"},
        [&] {
            EnvironmentMap made(context.shaders, scene);
            made.render(objects);
            return made;
        });
    return *map;
}

bool Frame::updateTruth() {
    const bool hasMoved = truthPoses.hasChanged(objects.poses());
    if (hasMoved) truth->update(objects, *untimed);
    return hasMoved;
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

TracedPicture Frame::traced(const GBuffer& gbuffer, const HostGBuffer& host) {
    updateTruth();
    return {pictureOf(gbuffer, truth->trace(host))};
}

glm::dvec3 Frame::recordErrors(technique::Recorder& recorder, const HostGBuffer& gbuffer,
                               const image::ImageF& picture, const image::ImageF& known) const {
    const std::vector<std::uint8_t> reflective = reflectivePixels(gbuffer, settings.supersampling);
    const glm::dvec3 errors = kit::channelErrors(picture, known, &reflective);
    recorder.metric("channel_error", meanOf(errors));
    recorder.metric("channel_error_image", meanOf(kit::channelErrors(picture, known, nullptr)));
    recorder.metric("display_flip", metrics::flip(known, picture));
    recorder.metric("display_psnr_db", kit::shownPsnrDb(picture, known));
    return errors;
}

void Frame::recordResult(technique::Recorder& recorder, const HostGBuffer& gbuffer,
                         const image::ImageF& picture, const image::ImageF& known) const {
    std::vector<std::uint32_t> reflectors;  // 0: none
    for (const std::uint32_t surface : gbuffer.surface) {
        reflectors.push_back(static_cast<std::uint32_t>(reflectorOf(surface)));
    }
    kit::ImageLayers layers(gbuffer.view, settings.supersampling);
    layers.depths(gbuffer.depthM).normals(gbuffer.normalWorld).ids("id", reflectors);
    if (!known.empty()) layers.errors(picture, known);
    recorder.image("result", picture, layers.options());
}

void Frame::recordTruth(technique::Recorder& recorder, const HostGBuffer& gbuffer,
                        const image::ImageF& picture, const image::ImageF& known, int gain) const {
    recorder.image("truth", known, kit::seenFrom(gbuffer.view, "result"));
    recorder.image("error", kit::errorPicture(picture, known, 1), kit::seenFrom(gbuffer.view));
    recorder.image(fmt::format("error_{}", gain), kit::errorPicture(picture, known, gain),
                   kit::seenFrom(gbuffer.view));
}

void Frame::recordReflection(technique::Recorder& recorder, const GBuffer& gbuffer,
                             const ReflectionTarget& target) {
    composite.render(gbuffer, target, true);
    recorder.image("reflection", composite.read(), kit::seenFrom(gbuffer.view));
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

config::Outputs withFrameOutputs(config::Outputs own) {
    using config::Better;
    constexpr bool kIsDetail = true;
    config::Outputs all;
    all.passes = std::move(own.passes);
    all.withTruth = {"result"};
    all.metrics = {
        {"channel_error", "level",
         "mean absolute difference of a colour channel (0 … 255) to the truth, over reflective "
         "pixels",
         Better::Lower},
        {"channel_error_image", "level", "channel_error over all pixels", Better::Lower, kIsDetail},
        {"display_psnr_db", "dB",
         "peak signal-to-noise ratio of the whole picture as displayed, in sRGB of 8 bits; 120 of "
         "equal ones",
         Better::Higher},
        {"display_flip", "1",
         "mean FLIP error of the whole picture as displayed, without values beyond 1",
         Better::Lower},
        {"reflective_pct", "%", "share of all samples that reflect"},
        {"memory_bytes", "byte", "memory on the device", Better::Lower},
    };
    std::ranges::move(own.metrics, std::back_inserter(all.metrics));
    all.passes.insert(all.passes.end(),
                      {
                          // Of the tracers (ReflectionTracer), in every technique that has them.
                          {"first_pass_and_clustering",
                           "clustering the reflective samples, after drawing what the eye sees "
                           "where that is no pass of its own"},
                          {"cluster_cameras", "placing a camera for each cluster"},
                          {"depth_images", "drawing the depth images of the clusters"},
                          {"bvh_build", "building the ray tracer's bounding volume hierarchy"},
                          {"bvh_codes", "of that: places along a curve"},
                          {"bvh_sort", "of that: sorting"},
                          {"bvh_hierarchy", "of that: nodes"},
                          {"bvh_boxes", "of that: boxes"},
                          {"ray_list", "listing the samples that need rays"},
                          {"transfer", "copying between device and host"},
                          {"intersection", "tracing reflected rays to where they meet the scene"},
                          {"environment_map", "drawing the scene around the room's centre"},
                          {"composite", "joining diffuse and reflected light to the picture"},
                      });
    return all;
}

Composite::Composite(const gl::ShaderLibrary& shaders, glm::ivec2 outputSizePx, int supersampling,
                     Blend blend)
    : pass_(shaders, {"kit/whole_image.vert.glsl", "reflections/composite.frag.glsl"}),
      output_(gl::Texture::make2D(GL_RGBA16F, outputSizePx)),
      framebuffer_(std::array<const gl::Texture*, 1>{&output_}),
      supersampling_(supersampling),
      blend_(blend) {
    GFXREPRO_ASSERT(supersampling >= 1);
}

void Composite::render(const GBuffer& gbuffer, const ReflectionTarget& reflection,
                       bool showsReflectionOnly) {
    const glm::ivec2 sizePx = glm::ivec2(output_.size()) * supersampling_;
    GFXREPRO_ASSERT(gbuffer.view.sizePx == sizePx);
    GFXREPRO_ASSERT(glm::ivec2(reflection.radiance.size()) == sizePx);
    pass_.set("supersampling", supersampling_);
    pass_.set("showsReflectionOnly", showsReflectionOnly ? 1 : 0);
    pass_.set("hasFresnel", blend_ == Blend::Fresnel ? 1 : 0);
    pass_.use(gl::Resources{{"reflected", reflection.radiance}}.with(gbuffer.resourcesFor(pass_)));
    framebuffer_.bind();
    wholeImage_.draw();
}

image::ImageF Composite::read() const {
    return output_.readImage(3);
}

std::size_t Composite::sizeBytes() const {
    return output_.sizeBytes();
}

std::vector<std::uint8_t> reflectivePixels(const HostGBuffer& gbuffer, int supersampling) {
    const glm::ivec2 size = gbuffer.view.sizePx / supersampling;
    std::vector<std::uint8_t> pixels(static_cast<std::size_t>(size.x) *
                                     static_cast<std::size_t>(size.y));
    for (int y = 0; y < size.y * supersampling; ++y) {
        for (int x = 0; x < size.x * supersampling; ++x) {
            if (!gbuffer.isReflective(gbuffer.indexOf({x, y}))) continue;
            const int row = size.y - 1 - y / supersampling;
            pixels[static_cast<std::size_t>(row * size.x + x / supersampling)] = 1;
        }
    }
    return pixels;
}

image::ImageF averagedPicture(const HostGBuffer& gbuffer, int supersampling,
                              const std::function<glm::vec3(std::size_t)>& colorOf) {
    const glm::ivec2 size = gbuffer.view.sizePx / supersampling;
    image::ImageF picture(size.x, size.y, 3);
    const float weight = 1.0F / static_cast<float>(supersampling * supersampling);
    for (int y = 0; y < size.y * supersampling; ++y) {
        for (int x = 0; x < size.x * supersampling; ++x) {
            const glm::vec3 value = weight * colorOf(gbuffer.indexOf({x, y}));
            for (int c = 0; c < 3; ++c) {
                picture.at(x / supersampling, size.y - 1 - y / supersampling, c) += value[c];
            }
        }
    }
    return picture;
}

glm::vec3 dimmed(const HostGBuffer& gbuffer, std::size_t index) {
    constexpr glm::vec3 kLuminance{0.2126F, 0.7152F, 0.0722F};
    return glm::vec3(0.05F + 0.3F * glm::dot(gbuffer.diffuse[index], kLuminance));
}

glm::vec3 hue(float turn) {
    const float sixth = 6.0F * turn;
    return glm::clamp(glm::vec3(std::abs(sixth - 3.0F) - 1.0F, 2.0F - std::abs(sixth - 2.0F),
                                2.0F - std::abs(sixth - 4.0F)),
                      0.0F, 1.0F);
}

image::ImageF markedPicture(const image::ImageF& picture, const std::vector<std::uint8_t>& marks,
                            const HostGBuffer& gbuffer, int supersampling) {
    const image::ImageF shares = averagedPicture(gbuffer, supersampling, [&](std::size_t i) {
        return glm::vec3(marks[i] != 0 ? 1.0F : 0.0F);
    });
    image::ImageF marked = picture;
    for (int y = 0; y < marked.height(); ++y) {
        for (int x = 0; x < marked.width(); ++x) {
            const float share = shares.at(x, y);
            for (int c = 0; c < 3; ++c) {
                float& value = marked.at(x, y, c);
                value = glm::mix(0.6F * value, c == 0 ? 1.0F : 0.0F, share);
            }
        }
    }
    return marked;
}

}  // namespace gfxrepro::reflections
