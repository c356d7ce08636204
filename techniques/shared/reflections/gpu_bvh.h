// A bounding volume hierarchy made on the device, from the posed scene, each frame.
#pragma once

#include "runner/gl/objects.h"
#include "runner/gl/profiler.h"
#include "runner/gl/program.h"
#include "techniques/shared/reflections/gpu_objects.h"

namespace gfxrepro::reflections {

/// Linear BVH (Karras 2012, "Maximizing Parallelism in the Construction of BVHs, Octrees, and k-d
/// Trees"): world triangles, 30-bit Morton codes of their centres, radix sort, hierarchy, boxes
/// from the leaves up. All in compute passes. Shaders traverse it by shaders/bvh.glsl:
/// `bool closestHit(vec3 origin, vec3 direction, float tMin, float tMax, out RayHit hit)`, with
/// `RayHit { float t; vec2 barycentric; uint triangle; }`.
class GpuBvh {
  public:
    GpuBvh(const gl::ShaderLibrary& shaders, const GpuObjects& objects);
    /// Scopes: `bvh_build` with its parts `bvh_codes`, `bvh_sort`, `bvh_hierarchy`, `bvh_boxes`.
    void build(gl::Profiler& profiler);
    /// For shaders that include bvh.glsl: storage bindings 1 … 7.
    void bind() const;
    std::size_t sizeBytes() const;
    /// Limits for messages and tests.
    std::uint32_t triangleCount() const { return objects_.triangleCount(); }

  private:
    const GpuObjects& objects_;
    gl::Program codes_, sortCount_, sortScan_, sortScatter_, hierarchy_, boxes_;
    gl::Buffer triangles_, nodes_, keys_, values_, otherKeys_, otherValues_, counts_, visits_;
};

}  // namespace gfxrepro::reflections
