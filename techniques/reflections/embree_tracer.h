// Ray tracing on the CPU: the truth, and the CPU's baseline.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/raycast/ray_tracer.h"
#include "techniques/reflections/gbuffer.h"
#include "techniques/reflections/reflection_tracer.h"

namespace gfxrepro::reflections {

/// What a sample's mirror ray meets.
struct TracedSample {
    glm::vec3 radiance{0.0F};  // weighted mean over the lobe, as ReflectionTarget has it
    float distanceM = 0.0F;    // of the mirror ray; 0: it meets nothing, or is below its triangle
    std::uint32_t object = 0;  // 1 + object that the mirror ray meets; 0: none
};

/// Embree over the posed scene, its BVH rebuilt by every update() (the scenes are dynamic). Rays
/// start from the G-buffer's samples. Passes: `bvh_build`, `intersection` (CPU), and `transfer`
/// (CPU) for reading the G-buffer and for writing the result.
class EmbreeTracer final : public ReflectionTracer {
  public:
    /// Rays start where they are this far off their triangle, in diagonals of the scene's box, but
    /// no further along themselves than 1 / kGrazing times it: less would meet the surface that
    /// they leave.
    static constexpr float kLift = 1e-5F, kGrazing = 0.1F;

    /// The scene must outlive this.
    EmbreeTracer(const ReflectiveScene& scene, const LobeSettings& lobe);
    void update(const GpuObjects& objects, gl::Profiler& profiler) override;
    void trace(const GBuffer& gbuffer, const gl::Texture* wanted, ReflectionTarget& target,
               gl::Profiler& profiler) override;
    std::size_t sizeBytes() const override { return 0; }

    /// On the host, a sample a pixel of the G-buffer, rows from the bottom, in parallel. Needs an
    /// update() before.
    std::vector<TracedSample> trace(const HostGBuffer& gbuffer) const {
        return trace(gbuffer, lobe_);
    }
    std::vector<TracedSample> trace(const HostGBuffer& gbuffer, const LobeSettings& lobe) const;
    /// Likewise, without radiance: for what asks only where mirror rays end.
    std::vector<TracedSample> traceMirrorRays(const HostGBuffer& gbuffer) const;
    /// Of the last update().
    const raycast::RayTracer& rays() const { return *rays_; }

  private:
    template <class Visit>
    void forEachReflective(const HostGBuffer& gbuffer, const Visit& visit) const;
    std::optional<raycast::Hit> closestHit(const glm::vec3& origin, const glm::vec3& direction,
                                           const glm::vec3& triangleNormal) const;
    TracedSample traceSample(const HostGBuffer& gbuffer, glm::ivec2 pixel,
                             const LobeSettings& lobe) const;
    glm::vec3 radianceAt(const raycast::Hit& hit, const glm::vec3& direction, float beamArea) const;

    const ReflectiveScene& scene_;
    LobeSettings lobe_;
    scene::Scene posed_;  // the triangles alone: all that a BVH is built of
    std::vector<glm::mat3> normalFromMesh_;
    std::optional<raycast::RayTracer> rays_;
};

}  // namespace gfxrepro::reflections
