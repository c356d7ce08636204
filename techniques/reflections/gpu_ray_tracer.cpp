#include "techniques/reflections/gpu_ray_tracer.h"

#include "runner/core/error.h"
#include "techniques/reflections/embree_tracer.h"

namespace gfxrepro::reflections {

namespace {

/// Storage of the traversal's passes, behind kObjectsBinding and GpuBvh's.
enum Storage : unsigned {
    kIndices = 3,
    kNormals = 4,
    kTexcoords = 5,
    kColors = 6,
    kObjectOfTriangle = 7,
    kSamples = kFirstFreeStorage,
    kArguments = kFirstFreeStorage + 1,
};
enum Unit : unsigned {
    kEnvironmentUnit = kFirstFreeUnit,
    kWantedUnit = kFirstFreeUnit + 1,
    kGBufferUnit = kFirstFreeUnit + 2,  // … + 5
};
enum ImageUnit : unsigned { kRadianceImage = 0, kDistanceImage = 1 };

constexpr int kTileWidth = 8, kTileHeight = 4;  // of ray_list.comp.glsl
constexpr int kListGroupSize = 64;
constexpr unsigned kTraceGroupSize = 64;
/// Work groups along one axis that every device takes; beyond, invocations take several samples.
constexpr unsigned kMaxGroups = 65535;

/// What ray_list.comp.glsl counts and the indirect dispatch reads.
struct Arguments {
    std::uint32_t groups[3] = {0, 0, 0};
    std::uint32_t samples = 0, rays = 0;
};
static_assert(sizeof(Arguments) == 20);

gl::Defines passDefines(const ReflectiveScene& scene) {
    gl::Defines defines = surfaceDefines(scene);
    defines.merge(GpuBvh::defines());
    defines.merge(
        gl::Defines{{"INDICES_BINDING", static_cast<unsigned>(kIndices)},
                    {"NORMALS_BINDING", static_cast<unsigned>(kNormals)},
                    {"TEXCOORDS_BINDING", static_cast<unsigned>(kTexcoords)},
                    {"COLORS_BINDING", static_cast<unsigned>(kColors)},
                    {"OBJECT_OF_TRIANGLE_BINDING", static_cast<unsigned>(kObjectOfTriangle)},
                    {"SAMPLES_BINDING", static_cast<unsigned>(kSamples)},
                    {"ARGUMENTS_BINDING", static_cast<unsigned>(kArguments)},
                    {"ENVIRONMENT_UNIT", static_cast<unsigned>(kEnvironmentUnit)},
                    {"WANTED_UNIT", static_cast<unsigned>(kWantedUnit)},
                    {"GBUFFER_UNIT", static_cast<unsigned>(kGBufferUnit)},
                    {"RADIANCE_IMAGE", static_cast<unsigned>(kRadianceImage)},
                    {"DISTANCE_IMAGE", static_cast<unsigned>(kDistanceImage)},
                    {"LIST_GROUP_SIZE", kListGroupSize},
                    {"TRACE_GROUP_SIZE", kTraceGroupSize},
                    {"MAX_GROUPS", kMaxGroups}});
    return defines;
}

int ceilDivided(int count, int size) {
    return (count + size - 1) / size;
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
    samples_.bindStorage(kSamples);
    arguments_.bindStorage(kArguments);
    list_.use();
    gbuffer.bind(list_, kGBufferUnit);
    if (wanted) wanted->bind(kWantedUnit);
    list_.set("isChosen", wanted ? 1 : 0);
    setLobe(list_, lobe_, diagonalM_);
    const int tiles = ceilDivided(size.x, kTileWidth) * ceilDivided(size.y, kTileHeight);
    glDispatchCompute(static_cast<GLuint>(ceilDivided(tiles, kListGroupSize)), 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
}

void GpuRayTracer::traceSamples(const GBuffer& gbuffer, ReflectionTarget& target) {
    objects_.bind();
    bvh_.bind();
    objects_.indices().bindStorage(kIndices);
    objects_.normals().bindStorage(kNormals);
    objects_.texcoords().bindStorage(kTexcoords);
    objects_.colors().bindStorage(kColors);
    objects_.objectOfTriangle().bindStorage(kObjectOfTriangle);
    map_.bind(kEnvironmentUnit);
    target.radiance.bindImage(kRadianceImage, GL_WRITE_ONLY);
    target.distance.bindImage(kDistanceImage, GL_WRITE_ONLY);
    trace_.use();
    gbuffer.bind(trace_, kGBufferUnit);
    setLobe(trace_, lobe_, diagonalM_);
    trace_.set("rayStart", EmbreeTracer::kStart * diagonalM_);
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, arguments_.id());
    glDispatchComputeIndirect(0);
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, 0);
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT |
                    GL_SHADER_STORAGE_BARRIER_BIT);
}

std::size_t GpuRayTracer::sizeBytes() const {
    return bvh_.sizeBytes() + samples_.sizeBytes() + arguments_.sizeBytes();
}

GpuRayTracer::Counts GpuRayTracer::lastCounts() const {
    const Arguments arguments = arguments_.read<Arguments>(1).front();
    return {arguments.samples, arguments.rays};
}

}  // namespace gfxrepro::reflections
