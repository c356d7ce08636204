#include "techniques/reflections/gpu_bvh.h"

#include <algorithm>

#include "techniques/kit/draws.h"

namespace gfxrepro::reflections {

namespace {

/// Of the passes that build; kObjectsBinding is 0.
enum Storage : unsigned {
    kPositions = 1,
    kIndices = 2,
    kObjectOfTriangle = 3,
    kPairs = 4,
    kNodes = 5,
    kTriangles = 6,
};

constexpr std::uint32_t kGroupSize = 256;
constexpr std::uint32_t kAxisBits = 10;

gl::Program pass(const gl::ShaderLibrary& shaders, const char* file) {
    return {shaders,
            {file},
            {{"OBJECTS_BINDING", static_cast<unsigned>(kObjectsBinding)},
             {"POSITIONS_BINDING", static_cast<unsigned>(kPositions)},
             {"INDICES_BINDING", static_cast<unsigned>(kIndices)},
             {"OBJECT_OF_TRIANGLE_BINDING", static_cast<unsigned>(kObjectOfTriangle)},
             {"PAIRS_BINDING", static_cast<unsigned>(kPairs)},
             {"NODES_BINDING", static_cast<unsigned>(kNodes)},
             {"TRIANGLES_BINDING", static_cast<unsigned>(kTriangles)},
             {"GROUP_SIZE", kGroupSize}}};
}

void dispatchOver(std::uint32_t count) {
    glDispatchCompute(kit::groupsFor(count, kGroupSize), 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

}  // namespace

GpuBvh::GpuBvh(const gl::ShaderLibrary& shaders, const GpuObjects& objects)
    : objects_(objects),
      codes_(pass(shaders, "reflections/bvh_codes.comp.glsl")),
      hierarchy_(pass(shaders, "reflections/bvh_hierarchy.comp.glsl")),
      boxes_(pass(shaders, "reflections/bvh_boxes.comp.glsl")),
      sort_(shaders, objects.triangleCount()),
      pairs_(objects.triangleCount() * sizeof(glm::uvec2)),
      nodes_(nodeCount() * sizeof(Node)),
      triangles_(triangleCount() * sizeof(Triangle)) {}

std::uint32_t GpuBvh::nodeCount() const {
    return std::max(triangleCount(), 2U) - 1;
}

void GpuBvh::build(gl::Profiler& profiler) {
    const gl::GpuScope scope(profiler, "bvh_build");
    bindForBuilding();
    {
        const gl::GpuScope part(profiler, "bvh_codes");
        writeCodes();
    }
    {
        const gl::GpuScope part(profiler, "bvh_sort");
        sort_.sort(pairs_, triangleCount(), 3 * kAxisBits);
    }
    bindForBuilding();  // sorting has bindings of its own, and swaps the pairs
    {
        const gl::GpuScope part(profiler, "bvh_hierarchy");
        linkNodes();
    }
    {
        const gl::GpuScope part(profiler, "bvh_boxes");
        growBoxes();
    }
}

void GpuBvh::bindForBuilding() const {
    objects_.records().bindStorage(kObjectsBinding);
    objects_.positions().bindStorage(kPositions);
    objects_.indices().bindStorage(kIndices);
    objects_.objectOfTriangle().bindStorage(kObjectOfTriangle);
    pairs_.bindStorage(kPairs);
    nodes_.bindStorage(kNodes);
    triangles_.bindStorage(kTriangles);
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
    codes_.use();
    codes_.set("triangleCount", triangleCount());
    codes_.set("boundsMin", bounds.min);
    codes_.set("cellsPerMetre", cellsPerMetre);
    dispatchOver(triangleCount());
}

void GpuBvh::linkNodes() {
    if (triangleCount() == 1) return;  // growBoxes() makes the root
    hierarchy_.use();
    hierarchy_.set("triangleCount", static_cast<int>(triangleCount()));
    dispatchOver(nodeCount());
}

void GpuBvh::growBoxes() {
    boxes_.use();
    boxes_.set("triangleCount", triangleCount());
    dispatchOver(triangleCount());
}

void GpuBvh::bind() const {
    nodes_.bindStorage(kNodesBinding);
    triangles_.bindStorage(kTrianglesBinding);
}

gl::Defines GpuBvh::defines() {
    return {{"BVH_NODES_BINDING", kNodesBinding}, {"BVH_TRIANGLES_BINDING", kTrianglesBinding}};
}

std::size_t GpuBvh::sizeBytes() const {
    return sort_.sizeBytes() + pairs_.sizeBytes() + nodes_.sizeBytes() + triangles_.sizeBytes();
}

}  // namespace gfxrepro::reflections
