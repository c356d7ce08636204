#include "techniques/reflections/gpu_ray_tracer.h"

#include "engine/core/error.h"
#include "techniques/kit/draws.h"
#include "techniques/reflections/embree_tracer.h"

namespace gfxrepro::reflections {

namespace {

constexpr int kTileWidth = 8, kTileHeight = 4;  // of ray_list.comp.glsl
constexpr int kListGroupSize = 64;
constexpr unsigned kTraceGroupSize = 64;
/// Work groups along one axis that every device takes; beyond, invocations take several samples.
constexpr unsigned kMaxGroups = 65535;

/// What ray_list.comp.glsl counts and the indirect dispatch reads.
struct Arguments {
    std::uint32_t groups[3] = {0, 0, 0};
    std::uint32_t samples = 0;
};
static_assert(sizeof(Arguments) == 16);

gl::Defines passDefines(const ReflectiveScene& scene) {
    gl::Defines defines = surfaceDefines(scene);
    defines.merge(gl::Defines{{"LIST_GROUP_SIZE", kListGroupSize},
                              {"TRACE_GROUP_SIZE", kTraceGroupSize},
                              {"MAX_GROUPS", kMaxGroups}});
    return defines;
}

}  // namespace

GpuRayTracer::GpuRayTracer(const gl::ShaderLibrary& shaders, const GpuObjects& objects,
                           const EnvironmentMap& map, const LobeSettings& lobe, float diagonalM)
    : objects_(objects),
      map_(map),
      lobe_(lobe),
      diagonalM_(diagonalM),
      bvh_(shaders, objects),
      list_(shaders, {"reflections/ray_list.comp.glsl"}, passDefines(objects.scene())),
      trace_(shaders, {"reflections/trace_rays.comp.glsl"}, passDefines(objects.scene())),
      arguments_(sizeof(Arguments)) {
    arguments_.clear();
}

void GpuRayTracer::update(const GpuObjects& objects, gl::Profiler& profiler) {
    GFXREPRO_ASSERT(&objects == &objects_);
    bvh_.build(profiler);
}

void GpuRayTracer::trace(const GBuffer& gbuffer, const gl::Texture* wanted,
                         ReflectionTarget& target, gl::Profiler& profiler) {
    {
        const gl::GpuScope scope(profiler, "ray_list");
        listSamples(gbuffer, wanted);
    }
    const gl::GpuScope scope(profiler, "intersection");
    traceSamples(gbuffer, target);
}

void GpuRayTracer::listSamples(const GBuffer& gbuffer, const gl::Texture* wanted) {
    const glm::ivec2 size = gbuffer.view.sizePx;
    const std::size_t bytes =
        static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * sizeof(std::uint32_t);
    if (samples_.sizeBytes() != bytes) samples_ = gl::Buffer(bytes);
    arguments_.clear();  // on the device: a write would wait for the last frame's trace
    list_.set("isChosen", wanted ? 1 : 0);
    const GLuint tiles = kit::groupsFor(size.x, kTileWidth) * kit::groupsFor(size.y, kTileHeight);
    list_.dispatch({kit::groupsFor(tiles, kListGroupSize), 1, 1},
                   gl::Resources{{"Samples", samples_},
                                 {"Arguments", arguments_},
                                 {"wanted", wanted ? *wanted : gbuffer.surface}}
                       .with(gbuffer.resourcesFor(list_)));
}

void GpuRayTracer::traceSamples(const GBuffer& gbuffer, ReflectionTarget& target) {
    setLobe(trace_, lobe_, diagonalM_);
    trace_.set("rayStart", EmbreeTracer::kStart * diagonalM_);
    trace_.dispatchIndirect(arguments_, 0,
                            gl::Resources{{"Samples", samples_},
                                          {"Arguments", arguments_},
                                          {"Indices", objects_.indices()},
                                          {"Normals", objects_.normals()},
                                          {"Texcoords", objects_.texcoords()},
                                          {"Colors", objects_.colors()},
                                          {"ObjectOfTriangle", objects_.objectOfTriangle()},
                                          {"radianceImage", target.radiance},
                                          {"distanceImage", target.distance}}
                                .with(objects_.resources())
                                .with(bvh_.resources())
                                .with(map_.resources())
                                .with(gbuffer.resourcesFor(trace_)));
}

std::size_t GpuRayTracer::sizeBytes() const {
    return bvh_.sizeBytes() + samples_.sizeBytes() + arguments_.sizeBytes();
}

}  // namespace gfxrepro::reflections
