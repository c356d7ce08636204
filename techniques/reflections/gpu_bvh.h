// A bounding volume hierarchy made on the device, from the posed scene, each frame.
#pragma once

#include "engine/gl/objects.h"
#include "engine/gl/pass.h"
#include "engine/gl/profiler.h"
#include "techniques/reflections/gpu_objects.h"
#include "techniques/reflections/radix_sort.h"

namespace gfxrepro::reflections {

/// Linear BVH (Karras 2012, "Maximizing Parallelism in the Construction of BVHs, Octrees, and k-d
/// Trees"): world triangles, 30-bit Morton codes of their centres, radix sort, hierarchy, boxes
/// from the leaves up. All in compute passes. Shaders traverse it by shaders/bvh.glsl:
/// `bool closestHit(vec3 origin, vec3 direction, float tMin, float tMax, out RayHit hit)`, with
/// `RayHit { float t; vec2 barycentric; uint triangle; }`.
class GpuBvh {
  public:
    /// As bvh_layout.glsl has them (std430).
    struct Node {
        glm::vec3 leftMin;
        std::uint32_t left;
        glm::vec3 leftMax;
        std::uint32_t right;
        glm::vec3 rightMin;
        std::uint32_t parent;
        glm::vec3 rightMax;
        std::uint32_t visits;
    };
    struct Triangle {
        glm::vec3 a;
        std::uint32_t triangle;
        glm::vec3 b;
        std::uint32_t leafParent;
        glm::vec3 c;
        std::uint32_t unused;
    };
    static_assert(sizeof(Node) == 64 && sizeof(Triangle) == 48);
    static constexpr std::uint32_t kLeaf = 0x80000000U;

    /// `objects` outlives this.
    GpuBvh(const gl::ShaderLibrary& shaders, const GpuObjects& objects);
    /// Scopes: `bvh_build` with its parts `bvh_codes`, `bvh_sort`, `bvh_hierarchy`, `bvh_boxes`.
    void build(gl::Profiler& profiler);
    /// For passes that include bvh.glsl.
    gl::Resources resources() const;
    std::size_t sizeBytes() const;

    std::uint32_t triangleCount() const { return objects_.triangleCount(); }
    /// One less than there are triangles, but at least the root.
    std::uint32_t nodeCount() const;
    /// Node nodes[nodeCount()] and Triangle triangles[triangleCount()], a leaf each.
    const gl::Buffer& nodes() const { return nodes_; }
    const gl::Buffer& triangles() const { return triangles_; }

  private:
    void dispatch(const gl::Pass& pass, std::uint32_t count) const;
    void writeCodes();
    void linkNodes();
    void growBoxes();

    const GpuObjects& objects_;
    gl::Pass codes_, hierarchy_, boxes_;
    RadixSort sort_;
    gl::Buffer pairs_, nodes_, triangles_;
};

}  // namespace gfxrepro::reflections
