#include "techniques/ray_tracing/ray_tracing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runner/scene/animation.h"
#include "techniques/shared/reflections/displayed_errors.h"
#include "techniques/shared/reflections/path_view.h"

namespace gfxrepro::ray_tracing {

using reflections::HostGBuffer;

namespace {

constexpr config::Choice<Method> kMethods[] = {
    {Method::Compute, "compute", "compute shaders, a linear BVH rebuilt each frame"},
    {Method::Embree, "embree", "Embree on the CPU, its BVH rebuilt each frame"},
};

/// Two hits of a ray at distances that differ by more than this share of the farther one are
/// different hits: beyond rounding, below what separates surfaces.
constexpr float kSameHit = 1e-4F;

double percent(std::size_t part, std::size_t whole) {
    return whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

RayTracingParams::RayTracingParams(config::Params& params)
    : method(params.getEnum("method", Method::Compute, kMethods, {"what traces the rays"})),
      view(params.getText("view", "",
                          {"a path or camera of the scene; none: its first path, else its first "
                           "camera"})),
      hasMotion(params.getBool("motion", false, {"objects move as the scene says"})),
      supersampling(params.getInt("supersampling", 2,
                                  {"samples along each edge of an output pixel", "samples", 1, 8})),
      measuresErrors(
          params.getBool("errors", false, {"compares the hits of mirror rays with Embree's"})) {
    const double given = params.getDouble(
        "glossiness", -1.0,
        {"of all reflectors, 0 a mirror, 1 the widest lobe; -1: as their materials say", "1", -1.0,
         1.0});
    if (given >= 0.0) {
        glossiness = static_cast<float>(given);
    } else if (given != -1.0) {
        throw Error(
            params.locationOf("glossiness"),
            fmt::format("technique 'ray_tracing': glossiness is {}; allowed: -1, 0 … 1", given));
    }
    lobe.rays = params.getInt(
        "rays", 0, {"rays of a glossy sample; 0: 8 … 49, with the glossiness", "rays", 0, 4096});
    reflectors.maxRoughness = static_cast<float>(
        params.getDouble("reflector_roughness", static_cast<double>(reflectors.maxRoughness),
                         {"materials up to this roughness reflect", "1", 0.0, 1.0}));
    params.finish();
    if (method == Method::Embree && params.isGiven("errors")) {
        throw Error(params.locationOf("errors"), "'errors' needs 'method: compute'");
    }
}

RayTracing::RayTracing(config::Params& params) : params_(params) {}

void RayTracing::setup(technique::SetupContext& context) {
    if (!context.scene) throw Error("technique 'ray_tracing' needs a scene");
    const gl::ShaderLibrary& shaders = context.shaders;
    scene_.emplace(*context.scene, params_.reflectors);
    if (params_.glossiness) scene_->setGlossiness(*params_.glossiness);
    outputSizePx_ = context.outputSizePx;
    const glm::ivec2 samplesPx = params_.supersampling * outputSizePx_;
    const glm::vec2 size(outputSizePx_);
    const scene::Camera camera =
        reflections::cameraFor(scene_->scene(), params_.view, 0, 1, size.x / size.y);

    objects_.emplace(*scene_);
    map_.emplace(shaders, scene_->boundsWorld().centre());
    map_->render(*objects_);
    gbufferRenderer_.emplace(shaders);
    gbuffer_.emplace(depth_images::viewOf(camera, samplesPx));
    target_.emplace(samplesPx);
    composite_.emplace(shaders, outputSizePx_, params_.supersampling);
    if (params_.method == Method::Compute) {
        computeTracer_.emplace(shaders, *objects_, *map_, params_.lobe, scene_->diagonalM());
    }
    if (params_.method == Method::Embree || params_.measuresErrors) {
        embreeTracer_.emplace(*scene_, *map_, params_.lobe);
    }
}

void RayTracing::render(technique::FrameContext& context) {
    gl::Profiler& profiler = context.profiler;
    const glm::vec2 size(outputSizePx_);
    const scene::Camera camera = reflections::cameraFor(
        scene_->scene(), params_.view, context.frame, context.frameCount, size.x / size.y);
    gbuffer_->view = depth_images::viewOf(camera, params_.supersampling * outputSizePx_);
    if (params_.hasMotion) {
        const double time = reflections::frameTime(context.frame, context.frameCount);
        objects_->setPoses(scene::posesAt(scene_->scene(), time));
    }
    {
        const gl::GpuScope scope(profiler, "first_pass");
        gbufferRenderer_->render(*objects_, *gbuffer_);
    }
    reflections::ReflectionTracer& tracer =
        computeTracer_ ? static_cast<reflections::ReflectionTracer&>(*computeTracer_)
                       : *embreeTracer_;
    tracer.update(*objects_, profiler);
    tracer.trace(*gbuffer_, nullptr, *target_, profiler);
    const gl::GpuScope scope(profiler, "composite");
    composite_->render(*gbuffer_, *target_);
}

void RayTracing::record(technique::Recorder& recorder) {
    const HostGBuffer gbuffer = reflections::readGBuffer(*gbuffer_);
    std::size_t reflective = 0, rays = 0;
    for (std::size_t i = 0; i < gbuffer.surface.size(); ++i) {
        if (!gbuffer.isReflective(i)) continue;
        ++reflective;
        rays += static_cast<std::size_t>(reflections::raysOf(params_.lobe, gbuffer.glossiness(i)));
    }
    recorder.metric("reflective_pct", percent(reflective, gbuffer.surface.size()), "%");
    recorder.metric("rays", static_cast<double>(rays), "ray");
    recorder.metric("triangles", static_cast<double>(objects_->triangleCount()), "triangle");
    if (computeTracer_) {
        recorder.metric("nodes", static_cast<double>(computeTracer_->bvh().nodeCount()), "node");
        recorder.metric("memory_bytes", static_cast<double>(computeTracer_->sizeBytes()), "byte");
    }
    recorder.image("result", composite_->read(),
                   reflections::surfaceLayers(gbuffer, params_.supersampling).options());
    if (params_.measuresErrors) recordErrors(recorder, gbuffer);
}

void RayTracing::recordErrors(technique::Recorder& recorder, const HostGBuffer& gbuffer) {
    gl::Profiler untimed(false);
    embreeTracer_->update(*objects_, untimed);
    const std::vector<reflections::TracedSample> truth = embreeTracer_->trace(gbuffer);
    const auto distances = target_->distance.read<float>(GL_RED, GL_FLOAT, 1);
    const auto radiances = target_->radiance.read<glm::vec4>(GL_RGBA, GL_FLOAT, 1);
    // Rays start off their surface; hits nearer than that apart are told apart by rounding alone.
    const float roundingM = 0.1F * reflections::EmbreeTracer::kStart * scene_->diagonalM();
    std::size_t reflective = 0, mismatches = 0;
    float maxDistanceM = 0.0F;
    double radianceSum = 0.0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        if (!gbuffer.isReflective(i)) continue;
        ++reflective;
        const float a = truth[i].distanceM, b = distances[i];
        const bool isMatch =
            (a > 0.0F) == (b > 0.0F) && std::abs(a - b) <= kSameHit * std::max(a, b) + roundingM;
        if (isMatch) {
            maxDistanceM = std::max(maxDistanceM, std::abs(a - b));
        } else {
            ++mismatches;
        }
        const glm::vec3 error = glm::abs(glm::vec3(radiances[i]) - truth[i].radiance);
        radianceSum += static_cast<double>(error.x + error.y + error.z) / 3.0;
    }
    const auto count = static_cast<double>(std::max<std::size_t>(reflective, 1));
    recorder.metric("mismatch_pct", percent(mismatches, reflective), "%");
    recorder.metric("max_distance_error_m", static_cast<double>(maxDistanceM), "m");
    recorder.metric("radiance_error", radianceSum / count, "1");
}

namespace {
std::unique_ptr<technique::Technique> create(config::Params& params) {
    return std::make_unique<RayTracing>(params);
}
}  // namespace

const technique::TechniqueInfo kRayTracing{
    "ray_tracing", "reflections by ray tracing, on the GL device or on the CPU", create};

}  // namespace gfxrepro::ray_tracing
