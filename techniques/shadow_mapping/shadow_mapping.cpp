#include "techniques/shadow_mapping/shadow_mapping.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>
#include <optional>
#include <string>
#include <vector>

#include "techniques/kit/image_layers.h"
#include "techniques/kit/number.h"
#include "techniques/kit/path_view.h"
#include "techniques/kit/percent.h"
#include "techniques/kit/picture.h"
#include "techniques/kit/requirements.h"
#include "techniques/shadow_mapping/shaded_view.h"
#include "techniques/shadow_mapping/shadow_truth.h"

namespace gfxrepro::shadow_mapping {
namespace {

enum class LightPlace {
    Orbit,  // around the scene's box
    Scene,  // the scene's own lights
};

/// An error so near a true edge, and half the filter, is the edge's: ours, in texels of the map.
constexpr float kEdgeTexels = 1.5F;
/// The diameter of the lights, for pcss, in the box's diagonals: ours.
constexpr float kLightSize = 0.02F;

struct ShadowMappingParams {
    ShadowMapSettings maps;
    LightKind lightKind = LightKind::Spot;
    LightPlace lightPlace = LightPlace::Orbit;
    int lightCount = 1;
    float lightDistance = 1.2F;  // from the box's centre, in its diagonals
    float azimuthRad = 0.0F;
    float elevationRad = 0.0F;
    bool isStatic = false;
    bool measuresErrors = false;
    bool comparesMethods = false;
    bool drawsYardstick = false;
    bool showsPictures = false;
    std::string view;  // kit::stillCamera()

    /// Declares the parameters. Throws Error for combinations that mean nothing.
    explicit ShadowMappingParams(Params& params);

    /// How near a true edge an error counts as one of the edge: kEdgeTexels and half the filter.
    float edgeReachTexels() const;
};

constexpr Choice<Storage> kMethods[] = {
    {Storage::Standard, "standard", "depths in a float colour texture, compared in the shader"},
    {Storage::Hardware, "hardware", "a depth texture, compared by the texture unit"},
};
constexpr Choice<Filter> kFilters[] = {
    {Filter::Nearest, "nearest", "one comparison"},
    {Filter::Bilinear, "bilinear", "four comparisons, weighted"},
    {Filter::Pcf, "pcf", "the mean of 5 × 5 comparisons"},
    {Filter::Pcss, "pcss", "percentage-closer soft shadows"},
    {Filter::Variance, "variance", "variance shadow maps, blurred"},
};
constexpr Choice<LightKind> kLightKinds[] = {
    {LightKind::Spot, "spot", "one perspective map around the scene"},
    {LightKind::Directional, "directional", "one orthographic map around the scene"},
    {LightKind::Point, "point", "six maps, the sides of a cube"},
};
constexpr Choice<LightPlace> kLightPlaces[] = {
    {LightPlace::Orbit, "orbit", "around the scene's box, evenly over the azimuth"},
    {LightPlace::Scene, "scene", "the scene's own lights, in their order"},
};
constexpr Choice<DepthFormat> kFormats[] = {
    {DepthFormat::Unorm16, "unorm16", "D16"},
    {DepthFormat::Unorm24, "unorm24", "D24"},
    {DepthFormat::Float32, "float32", "32-bit float"},
};

void readLights(Params& params, ShadowMappingParams& p) {
    p.lightKind = params.getEnum("light_kind", LightKind::Spot, kLightKinds, {"of all lights"});
    p.lightPlace =
        params.getEnum("light_place", LightPlace::Orbit, kLightPlaces, {"where lights stand"});
    p.lightCount = params.getInt("lights", 1, {"number of lights", "lights", 1, kMaxLights});
    p.lightDistance = kit::number(params, "light_distance", 1.2F,
                                  {"from the centre of the scene's box", "diagonals", 0.0, 100.0});
    p.azimuthRad = glm::radians(kit::number(
        params, "light_azimuth_deg", -40.0F,
        {"direction to the first light about y, from +z towards +x", "°", -360.0, 360.0}));
    p.elevationRad = glm::radians(kit::number(params, "light_elevation_deg", 50.0F,
                                              {"… above the horizon", "°", -90.0, 90.0}));
}

void refuseUnread(const Params& params, const ShadowMappingParams& p) {
    if (p.lightPlace == LightPlace::Scene) {
        params.refuseGiven({"light_distance", "light_azimuth_deg", "light_elevation_deg"},
                           "'light_place: orbit'");
    }
    if (p.lightKind == LightKind::Directional) {
        params.refuseGiven({"light_distance"}, "'light_kind: spot' or 'light_kind: point'");
    }
    if (p.isStatic) params.refuseGiven({"yardstick"}, "'static: false'");
    if (p.maps.filter == Filter::Variance) {
        if (p.maps.storage == Storage::Hardware) {
            throw Error(params.locationOf("filter"),
                        "'filter: variance' needs 'method: standard': moments are colours");
        }
        params.refuseGiven({"compare_methods"}, "a filter that both methods have");
    }
}

ShadowMappingParams::ShadowMappingParams(Params& params) {
    maps.storage =
        params.getEnum("method", Storage::Hardware, kMethods, {"how depths are compared"});
    maps.filter =
        params.getEnum("filter", Filter::Nearest, kFilters, {"how comparisons are filtered"});
    maps.sizePx =
        params.getInt("shadow_map_size", 1024,
                      {"side of a shadow map; a point light has six of them", "pixels", 16, 16384});
    maps.format = params.getEnum("depth_format", DepthFormat::Unorm24, kFormats,
                                 {"of the depth test; of the map where it is hardware's"});
    maps.bias.constant =
        kit::number(params, "bias", 0.0005F,
                    {"ε: how much is taken from the receiver's window depth", "1", 0.0, 1.0});
    maps.bias.slopeScale = kit::number(
        params, "slope_bias", 1.0F,
        {"how many times the caster's change of depth from texel to texel (pcf: over its 5) is "
         "added to the bias",
         "1", 0.0, 100.0});
    readLights(params, *this);
    view = params.getText("view", "",
                          {"a path of the scene, seen from its middle, a camera, \"X Y Z > X Y Z\" "
                           "from and to, or where from to "
                           "frame it, \"AZIMUTH ELEVATION\" in degrees; none: its first camera"});
    isStatic = params.getBool("static", false, {"the maps are drawn once and used again"});
    measuresErrors = params.getBool("errors", false, {"compares with shadow rays"});
    comparesMethods =
        params.getBool("compare_methods", false, {"compares with the other method's shadows"});
    drawsYardstick =
        params.getBool("yardstick", false,
                       {"draws the maps again, depth alone and without a bias: yardstick_pass"});
    showsPictures = params.getBool("pictures", false, {"the image, the truth, classes of errors"});
    params.finish();
    refuseUnread(params, *this);
}

float ShadowMappingParams::edgeReachTexels() const {
    const int size = maps.filter == Filter::Variance ? kFilterTexels : kernelSizeOf(maps.filter);
    return kEdgeTexels + 0.5F * static_cast<float>(size - 1);
}

/// Lights of several get their share of the brightness.
Light lightAt(const ShadowMappingParams& params, const scene::Box& box, const glm::vec3& position,
              const glm::vec3& color) {
    const float diagonal = glm::length(box.size());
    const float radius = 0.5F * diagonal;
    const glm::vec3 towards = box.centre() - position;
    const float distance = glm::length(towards);
    Light light;
    light.kind = params.lightKind;
    light.positionWorld = position;
    light.targetWorld = box.centre();
    light.directionWorld = towards;
    light.color = color / static_cast<float>(params.lightCount);
    const bool isDirectional = params.lightKind == LightKind::Directional;
    light.size = kLightSize * (isDirectional ? 1.0F : diagonal);
    // The planes hold the ball around the box, the near one at least 1/500 of its diagonal away:
    // window depth is spent near the light.
    light.nearM = std::max(distance - radius, 0.002F * diagonal);
    light.farM = distance + radius;
    // As wide as the ball; where the light stands near it, no wider than 120°, and what lies
    // outside of the cone is lit.
    constexpr float kWidestRad = glm::pi<float>() * 2.0F / 3.0F;
    light.fovRad =
        distance > radius ? std::min(2.0F * std::asin(radius / distance), kWidestRad) : kWidestRad;
    return light;
}

/// The lights of the parameters for a scene. Throws Error where the scene has too few.
std::vector<Light> makeLights(const ShadowMappingParams& params, const scene::Scene& scene) {
    const scene::Box box = scene.bounds();
    const float diagonal = glm::length(box.size());
    std::vector<Light> lights;
    if (params.lightPlace == LightPlace::Scene) {
        if (scene.lights.size() < static_cast<std::size_t>(params.lightCount)) {
            throw Error(fmt::format("'light_place: scene' with {} lights: the scene has {}",
                                    params.lightCount, scene.lights.size()));
        }
        for (int i = 0; i < params.lightCount; ++i) {
            const scene::PointLight& light = scene.lights[static_cast<std::size_t>(i)];
            lights.push_back(lightAt(params, box, light.position, light.intensity));
        }
        return lights;
    }
    for (int i = 0; i < params.lightCount; ++i) {
        const float azimuth = params.azimuthRad + glm::two_pi<float>() * static_cast<float>(i) /
                                                      static_cast<float>(params.lightCount);
        const float flat = std::cos(params.elevationRad);
        const glm::vec3 direction(flat * std::sin(azimuth), std::sin(params.elevationRad),
                                  flat * std::cos(azimuth));
        // Of a directional light only the direction counts.
        const float distance =
            (params.lightKind == LightKind::Directional ? 1.0F : params.lightDistance) * diagonal;
        lights.push_back(
            lightAt(params, box, box.centre() + distance * direction, glm::vec3(1.0F)));
    }
    return lights;
}

/// What shadow rays need to know of a light and its map.
TruthLight truthLight(const Light& light, const scene::Box& bounds, int sizePx) {
    TruthLight truth;
    truth.isDirectional = light.kind == LightKind::Directional;
    truth.position = light.positionWorld;
    if (truth.isDirectional) truth.toLight = -glm::normalize(light.directionWorld);
    truth.texel = viewsOf(light, bounds, sizePx).front().texelPerDistance;
    if (light.kind == LightKind::Spot) {
        truth.forward = glm::normalize(light.targetWorld - light.positionWorld);
    }
    return truth;
}

/// Light `light` of the four channels.
std::vector<float> channelOf(const std::vector<glm::vec4>& terms, std::size_t light) {
    std::vector<float> channel;
    for (const glm::vec4& term : terms) channel.push_back(term[static_cast<int>(light)]);
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
    kit::ImageLayers layers(image.view);
    layers.windowDepths(image.depth.read<float>(GL_DEPTH_COMPONENT, GL_FLOAT, 1));
    layers.normals(image.normals.read<glm::vec3>(GL_RGB, GL_FLOAT, 1));
    return layers;
}

class ShadowMapping final : public technique::Technique {
  public:
    explicit ShadowMapping(Params& params) : params_(params) {}

    void setup(technique::SetupContext& context) override {
        const scene::Scene& scene = *context.scene;
        shaders_ = &context.shaders;
        lights_ = makeLights(params_, scene);
        tracer_.emplace(scene);
        requireOutside(*tracer_, lights_);
        lightsWithoutCaster_ = lightsWithoutCaster(lights_, scene, params_.maps.sizePx);

        drawable_.emplace(scene);
        maps_.emplace(context.shaders, params_.maps);
        if (params_.drawsYardstick) {
            ShadowMapSettings depthAlone;
            depthAlone.sizePx = params_.maps.sizePx;
            depthAlone.format = params_.maps.format;
            yardstick_.emplace(context.shaders, depthAlone);
        }
        shadedView_.emplace(context.shaders, params_.maps);
        const glm::vec2 size(context.outputSizePx);
        const scene::Camera camera = kit::stillCamera(scene, params_.view, size.x / size.y);
        image_.emplace(makeShadedImage(kit::viewOf(camera, context.outputSizePx), false));
        // [zju2005] Sec. 4.1: the map is used again while the light and the objects stand still.
        if (params_.isStatic) maps_->render(*drawable_, lights_);
    }

    technique::SceneNeed sceneNeed() const override { return technique::SceneNeed::Model; }

    void requireScene(const scene::Scene& scene) const override {
        kit::requireTriangles(scene, "shadow_mapping");
        kit::stillCamera(scene, params_.view, 1.0F);
        makeLights(params_, scene);  // refuses a scene with fewer lights than are asked for
    }

    // [zju2005] Sec. 4.1
    void render(technique::FrameContext& context) override {
        if (!params_.isStatic) {
            const gl::GpuScope scope(context.profiler, "depth_pass");
            maps_->render(*drawable_, lights_);
        }
        if (yardstick_) {
            const gl::GpuScope scope(context.profiler, "yardstick_pass");
            yardstick_->render(*drawable_, lights_);
        }
        const gl::GpuScope scope(context.profiler, "shading_pass");
        shadedView_->render(*drawable_, *maps_, *image_);
    }

    void record(technique::Recorder& recorder) override {
        recordSteps(recorder);
        recorder.metric("lights_without_caster", lightsWithoutCaster_);
        recorder.metric("memory_bytes", static_cast<double>(maps_->sizeBytes()));
    }

    void recordOnce(technique::Recorder& recorder) override {
        if (params_.showsPictures) recordPicture(recorder);
        if (!params_.measuresErrors && !params_.comparesMethods) return;
        // Once more with the terms that the measured frame does not write.
        ShadedImage image = makeShadedImage(image_->view, true);
        shadedView_->render(*drawable_, *maps_, image);
        if (params_.measuresErrors) recordErrors(recorder, image);
        if (params_.comparesMethods) recordDifference(recorder, image);
    }

    const gl::Texture* frameImage() const override { return &image_->colour; }

  private:
    // [zju2005] Table 4.3
    void recordSteps(technique::Recorder& recorder) const {
        for (const StepDeclaration& step : maps_->steps()) {
            std::string pass = step.step == "depth map" ? "depth_pass"
                               : step.step == "shading" ? "shading_pass"
                                                        : step.step;
            std::replace(pass.begin(), pass.end(), ' ', '_');
            recorder.metric("colour_writes", step.colourWrites ? 1.0 : 0.0, pass);
            recorder.metric("depth_writes", step.depthWrites ? 1.0 : 0.0, pass);
            recorder.metric("fragment_work", step.fragmentWork ? 1.0 : 0.0, pass);
            recorder.metric("fetches", step.fetches, pass);
            recorder.metric("comparisons", step.comparisons, pass);
        }
    }

    void recordPicture(technique::Recorder& recorder) const {
        const std::vector<float> depths =
            image_->depth.read<float>(GL_DEPTH_COMPONENT, GL_FLOAT, 1);
        recorder.image("result", image_->colour.readImage(3),
                       kit::ImageLayers(image_->view).windowDepths(depths).options());
    }

    void recordErrors(technique::Recorder& recorder, const ShadedImage& image) {
        const auto terms = image.shadowTerms.read<glm::vec4>(GL_RGBA, GL_FLOAT, 1);
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
        recorder.metric("compared_points", static_cast<double>(compared));
        recorder.metric("wrong_pct", kit::percent(edge + acne + leak, compared));
        recorder.metric("acne_pct", kit::percent(acne, compared));
        recorder.metric("leak_pct", kit::percent(leak, compared));
        recorder.metric("edge_pct", kit::percent(edge, compared));
    }

    // S4: pixels whose shadow differs from that of the other method by more than a filtered fetch
    // may: texture units weigh with 8 bits on each axis.
    void recordDifference(technique::Recorder& recorder, const ShadedImage& image) {
        ShadowMapSettings settings = params_.maps;
        settings.storage =
            settings.storage == Storage::Standard ? Storage::Hardware : Storage::Standard;
        ShadowMapRenderer maps(*shaders_, settings);
        ShadedView view(*shaders_, settings);
        ShadedImage other = makeShadedImage(image.view, true);
        maps.render(*drawable_, lights_);
        view.render(*drawable_, maps, other);
        const auto here = image.shadowTerms.read<glm::vec4>(GL_RGBA, GL_FLOAT, 1);
        const auto there = other.shadowTerms.read<glm::vec4>(GL_RGBA, GL_FLOAT, 1);
        std::uint64_t differing = 0;
        for (std::size_t pixel = 0; pixel < here.size(); ++pixel) {
            bool differs = false;
            for (int i = 0; i < static_cast<int>(lights_.size()); ++i) {
                differs = differs || std::abs(here[pixel][i] - there[pixel][i]) > 1.0F / 64.0F;
            }
            differing += differs ? 1 : 0;
        }
        recorder.metric("methods_differ_pct", kit::percent(differing, here.size()));
    }

    ShadowMappingParams params_;
    const gl::ShaderLibrary* shaders_ = nullptr;
    std::optional<raycast::RayTracer> tracer_;
    std::optional<kit::DrawableScene> drawable_;
    std::vector<Light> lights_;
    int lightsWithoutCaster_ = 0;
    std::optional<ShadowMapRenderer> maps_;
    std::optional<ShadowMapRenderer> yardstick_;  // depth alone, no bias
    std::optional<ShadedView> shadedView_;
    std::optional<ShadedImage> image_;
};

config::Outputs outputs() {
    using config::Better;
    constexpr bool kIsDetail = true;
    return {
        {
            {"wrong_pct", "%", "share of the compared points that are lit or shadowed wrongly",
             Better::Lower},
            {"acne_pct", "%", "share of the compared points that are shadowed by their own surface",
             Better::Lower},
            {"leak_pct", "%",
             "share of the compared points that are lit although a caster hides the light",
             Better::Lower},
            {"edge_pct", "%",
             "share of the compared points that are wrong within 1.5 texels of the shadow's edge",
             Better::Lower},
            {"compared_points", "pixel", "points that were compared, of all lights"},
            {"methods_differ_pct", "%",
             "share of the pixels where the other method shows another shadow", Better::Lower},
            {"memory_bytes", "byte", "memory of the shadow maps", Better::Lower},
            {"lights_without_caster", "light", "lights without anything before them", Better::Lower,
             kIsDetail},
            {"colour_writes", "1", "1 where the step writes colours", Better::Neither, kIsDetail},
            {"depth_writes", "1", "1 where the step writes depths", Better::Neither, kIsDetail},
            {"fragment_work", "1", "1 where the step runs a fragment program", Better::Neither,
             kIsDetail},
            {"fetches", "1", "texels that the step fetches", Better::Lower, kIsDetail},
            {"comparisons", "1", "comparisons in the step's program", Better::Lower, kIsDetail},
        },
        {
            {"depth_pass", "drawing the shadow maps"},
            {"shading_pass", "drawing the picture with shadows"},
            {"yardstick_pass", "drawing the same geometry without shadows"},
            {"blur_along_x", "blurring the maps' variances along x"},
            {"blur_along_y", "blurring the maps' variances along y"},
        },
        false,
        {"shadow_0", "shadow_1", "shadow_2", "shadow_3"},
        {"colour_writes", "depth_writes", "fragment_work", "fetches", "comparisons"}};
}

}  // namespace

const technique::TechniqueInfo kShadowMapping{
    "shadow_mapping", "shadow maps compared in the shader or by the texture unit",
    technique::make<ShadowMapping>, outputs};

}  // namespace gfxrepro::shadow_mapping
