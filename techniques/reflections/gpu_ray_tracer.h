// Ray tracing on the same GL device, its hierarchy rebuilt each frame: the baseline that a speed-up
// is fair against.
#pragma once

#include <cstdint>

#include "engine/gl/objects.h"
#include "engine/gl/pass.h"
#include "engine/gl/profiler.h"
#include "techniques/kit/prefix_sum.h"
#include "techniques/reflections/gpu_objects.h"
#include "techniques/reflections/reflection_tracer.h"

namespace gfxrepro::reflections {

/// A stable radix sort from the least significant digit (Satish et al. 2009, "Designing Efficient
/// Sorting Algorithms for Manycore GPUs"), six bits a pass: each tile of keys counts its digits,
/// one scan over all tiles' counts gives every tile's first place of a digit, and each tile puts
/// its pairs there.
class RadixSort {
  public:
    /// Pairs that one work group takes, and digits of a pass.
    static constexpr std::uint32_t kGroupSize = 64, kKeysPerInvocation = 32;
    static constexpr std::uint32_t kTileSize = kGroupSize * kKeysPerInvocation;
    static constexpr std::uint32_t kDigitBits = 6;

    /// For at most `capacity` pairs.
    RadixSort(const gl::ShaderLibrary& shaders, std::uint32_t capacity);
    /// Sorts uvec2(key, value) by the lower `keyBits` bits of the keys. `pairs` holds `capacity`
    /// of them, of which the first `count` count; it is swapped with a buffer of this object. Ends
    /// with a barrier for storage.
    void sort(gl::Buffer& pairs, std::uint32_t count, std::uint32_t keyBits);
    std::size_t sizeBytes() const;

  private:
    gl::Pass count_;
    kit::PrefixSum scan_;
    gl::Pass scatter_;
    gl::Buffer otherPairs_, counts_;
};

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

/// GpuBvh, rebuilt by every update(), traversed in a compute shader: one invocation a sample of a
/// compacted list of those that want a reflection, one ray after the other. Passes: `bvh_build`
/// (and its parts), `ray_list`, `intersection`.
class GpuRayTracer final : public ReflectionTracer {
  public:
    /// `objects` outlives this.
    GpuRayTracer(const gl::ShaderLibrary& shaders, const GpuObjects& objects,
                 const LobeSettings& lobe, float diagonalM);
    /// `objects` are those of the constructor.
    void update(const GpuObjects& objects, gl::Profiler& profiler) override;
    void trace(const GBuffer& gbuffer, const gl::Texture* wanted, ReflectionTarget& target,
               gl::Profiler& profiler) override;
    std::size_t sizeBytes() const override;

    const GpuBvh& bvh() const { return bvh_; }

  private:
    void listSamples(const GBuffer& gbuffer, const gl::Texture* wanted);
    void traceSamples(const GBuffer& gbuffer, ReflectionTarget& target);

    const GpuObjects& objects_;
    LobeSettings lobe_;
    float diagonalM_;
    GpuBvh bvh_;
    gl::Pass list_, trace_;
    gl::Buffer samples_, arguments_;
};

}  // namespace gfxrepro::reflections
