#include "techniques/reflections/gpu_bvh.h"

#include <algorithm>

#include "techniques/kit/draws.h"

namespace gfxrepro::reflections {

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

}  // namespace gfxrepro::reflections
