#include "techniques/reflections/gpu_ray_tracer.h"

#include <algorithm>
#include <glm/glm.hpp>

#include "engine/core/error.h"
#include "techniques/kit/draws.h"
#include "techniques/reflections/embree_tracer.h"

namespace gfxrepro::reflections {

namespace {

constexpr std::uint32_t kDigits = 1U << RadixSort::kDigitBits;
static_assert(kDigits == RadixSort::kGroupSize, "an invocation scans one digit of its tile");

std::uint32_t tilesOf(std::uint32_t count) {
    return kit::groupsFor(count, RadixSort::kTileSize);
}

gl::Pass pass(const gl::ShaderLibrary& shaders, const char* file) {
    return {shaders,
            {file},
            {{"GROUP_SIZE", RadixSort::kGroupSize},
             {"KEYS_PER_INVOCATION", RadixSort::kKeysPerInvocation},
             {"DIGITS", kDigits}}};
}

}  // namespace

RadixSort::RadixSort(const gl::ShaderLibrary& shaders, std::uint32_t capacity)
    : count_(pass(shaders, "reflections/sort_count.comp.glsl")),
      scan_(shaders, "uint", kit::PrefixSum::Total::None),
      scatter_(pass(shaders, "reflections/sort_scatter.comp.glsl")),
      otherPairs_(std::max(capacity, 1U) * sizeof(glm::uvec2)),
      counts_(std::max(tilesOf(capacity), 1U) * kDigits * sizeof(std::uint32_t)) {}

void RadixSort::sort(gl::Buffer& pairs, std::uint32_t count, std::uint32_t keyBits) {
    GFXREPRO_ASSERT_EQ(pairs.sizeBytes(), otherPairs_.sizeBytes());
    GFXREPRO_ASSERT(count * sizeof(glm::uvec2) <= pairs.sizeBytes() && keyBits <= 32);
    if (count == 0) return;
    const std::uint32_t tiles = tilesOf(count);
    for (std::uint32_t shift = 0; shift < keyBits; shift += kDigitBits) {
        count_.set("pairCount", count);
        count_.set("shift", shift);
        count_.dispatch({tiles, 1, 1}, {{"Pairs", pairs}, {"Counts", counts_}});
        scan_.run(counts_, tiles * kDigits);
        scatter_.set("pairCount", count);
        scatter_.set("shift", shift);
        scatter_.dispatch({tiles, 1, 1},
                          {{"Pairs", pairs}, {"SortedPairs", otherPairs_}, {"Counts", counts_}});
        std::swap(pairs, otherPairs_);
    }
}

std::size_t RadixSort::sizeBytes() const {
    return otherPairs_.sizeBytes() + counts_.sizeBytes();
}

namespace {

constexpr std::uint32_t kBvhGroupSize = 256;
constexpr std::uint32_t kAxisBits = 10;

gl::Pass bvhPass(const gl::ShaderLibrary& shaders, const char* file) {
    gl::Defines defines = objectDefines();
    defines["GROUP_SIZE"] = kBvhGroupSize;
    return {shaders, {file}, defines};
}

}  // namespace

GpuBvh::GpuBvh(const gl::ShaderLibrary& shaders, const GpuObjects& objects)
    : objects_(objects),
      codes_(bvhPass(shaders, "reflections/bvh_codes.comp.glsl")),
      hierarchy_(bvhPass(shaders, "reflections/bvh_hierarchy.comp.glsl")),
      boxes_(bvhPass(shaders, "reflections/bvh_boxes.comp.glsl")),
      sort_(shaders, objects.triangleCount()),
      pairs_(objects.triangleCount() * sizeof(glm::uvec2)),
      nodes_(nodeCount() * sizeof(Node)),
      triangles_(triangleCount() * sizeof(Triangle)) {}

std::uint32_t GpuBvh::nodeCount() const {
    return std::max(triangleCount(), 2U) - 1;
}

void GpuBvh::build(gl::Profiler& profiler) {
    const gl::GpuScope scope(profiler, "bvh_build");
    {
        const gl::GpuScope part(profiler, "bvh_codes");
        writeCodes();
    }
    {
        const gl::GpuScope part(profiler, "bvh_sort");
        sort_.sort(pairs_, triangleCount(), 3 * kAxisBits);
    }
    {
        const gl::GpuScope part(profiler, "bvh_hierarchy");
        linkNodes();
    }
    {
        const gl::GpuScope part(profiler, "bvh_boxes");
        growBoxes();
    }
}

void GpuBvh::dispatch(const gl::Pass& pass, std::uint32_t count) const {
    pass.dispatch({kit::groupsFor(count, kBvhGroupSize), 1, 1},
                  gl::Resources{}.with({{"Objects", objects_.records()},
                                        {"Positions", objects_.positions()},
                                        {"Indices", objects_.indices()},
                                        {"ObjectOfTriangle", objects_.objectOfTriangle()},
                                        {"Pairs", pairs_},
                                        {"Nodes", nodes_},
                                        {"Triangles", triangles_}}));
}

void GpuBvh::writeCodes() {
    scene::Box bounds;
    for (const scene::Box& box : objects_.boundsWorld()) bounds.add(box);
    const glm::vec3 size = bounds.size();
    const auto cells = static_cast<float>(1U << kAxisBits);
    glm::vec3 cellsPerMetre(0.0F);
    for (int axis = 0; axis < 3; ++axis) {
        if (size[axis] > 0.0F) cellsPerMetre[axis] = cells / size[axis];
    }
    codes_.set("triangleCount", triangleCount());
    codes_.set("boundsMin", bounds.min);
    codes_.set("cellsPerMetre", cellsPerMetre);
    dispatch(codes_, triangleCount());
}

void GpuBvh::linkNodes() {
    if (triangleCount() == 1) return;  // growBoxes() makes the root
    hierarchy_.set("triangleCount", static_cast<int>(triangleCount()));
    dispatch(hierarchy_, nodeCount());
}

void GpuBvh::growBoxes() {
    boxes_.set("triangleCount", triangleCount());
    dispatch(boxes_, triangleCount());
}

gl::Resources GpuBvh::resources() const {
    return {{"BvhNodes", nodes_}, {"BvhTriangles", triangles_}};
}

std::size_t GpuBvh::sizeBytes() const {
    return sort_.sizeBytes() + pairs_.sizeBytes() + nodes_.sizeBytes() + triangles_.sizeBytes();
}

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
                           const LobeSettings& lobe, float diagonalM)
    : objects_(objects),
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
    trace_.set("rayLift", EmbreeTracer::kLift * diagonalM_);
    trace_.set("rayGrazing", EmbreeTracer::kGrazing);
    trace_.set("background", kBackground);
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
                                .with(gbuffer.resourcesFor(trace_)));
}

std::size_t GpuRayTracer::sizeBytes() const {
    return bvh_.sizeBytes() + samples_.sizeBytes() + arguments_.sizeBytes();
}

}  // namespace gfxrepro::reflections
