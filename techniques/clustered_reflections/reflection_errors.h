// What the clusters' depth images lack ([xie2017] Sec. 4.7.1).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "techniques/clustered_reflections/cluster_images.h"
#include "techniques/reflections/embree_tracer.h"

namespace gfxrepro::clustered_reflections {

/// Why a point of the scene is not in a depth image; by the first of these that is so.
enum class Sight : std::uint8_t {
    Seen,
    Self,        // on the cluster's own reflector, or back to back with it: its image leaves it out
    BeforeNear,  // before the near plane, which cuts it off
    Beside,      // at the sides of the image, or beyond the far plane
    Hidden,      // behind something that the image has
};
constexpr std::size_t kSightCount = 5;

/// Samples whose true hit is missing from their cluster's depth image.
struct OcclusionErrors {
    std::vector<std::uint8_t> isMissing;  // a sample
    std::size_t reflective = 0;
    std::array<std::size_t, kSightCount> ofSight{};  // of those, by Sight
    std::size_t planar = 0, planarMissing = 0;       // of those, samples of planar clusters

    std::size_t of(Sight sight) const { return ofSight[static_cast<std::size_t>(sight)]; }
    std::size_t missing() const { return reflective - of(Sight::Seen); }
};

/// What the measure needs to know of a frame.
struct OcclusionInput {
    const reflections::HostGBuffer& gbuffer;
    const std::vector<reflections::TracedSample>& truth;
    const std::vector<std::uint16_t>& clusterOfSample;  // 1 + cluster; 0: not reflective
    const std::vector<ClusterCamera>& cameras;
    const reflections::ReflectiveScene& scene;
    const raycast::RayTracer& rays;  // over the posed scene
    const reflections::LobeSettings& lobe;
    std::vector<std::uint32_t> families = {};  // reflectorFamilies(scene); empty: none are related
};

/// A hit Q of a sample's mirror ray counts as seen by its cluster's camera when the image has the
/// object that it lies on, it lies in the camera's frustum, and nothing lies before it on the line
/// from e_c, but what is before the near plane, and the cluster's own reflector where the image
/// leaves it out (kShowsOwn is not set, or it faces away and kShowsOwnBack is not set). Rays, not
/// images, decide, so that the measure does not depend on the resolution. Samples whose mirror ray
/// leaves the scene, or ends before Q (glossy samples' far plane), miss nothing.
///
/// Tolerance: kOcclusionTolerance of the scene's diagonal. The line from e_c to Q of a planar
/// cluster is the mirror ray itself up to rounding: without the tolerance, edges that the two pass
/// on different sides would count.
constexpr float kOcclusionTolerance = 2e-4F;
OcclusionErrors occlusionErrors(const OcclusionInput& input);

/// Of a point of the world, as above; `reflector` is that which it lies on, 0 for none.
Sight sightOf(const ClusterCamera& camera, const glm::vec3& pointWorld, std::uint32_t reflector,
              const OcclusionInput& input);

/// Share of the samples of glossiness 0 whose mirror ray ends more than a hundredth of the scene's
/// diagonal from where it truly does, in %; of others a lobe's first ray ends elsewhere. Distances
/// are a ReflectionTarget's. None: there is no such sample.
std::optional<double> wrongHitPct(const reflections::HostGBuffer& gbuffer,
                                  const std::vector<reflections::TracedSample>& truth,
                                  const std::vector<float>& distancesM, float diagonalM);

}  // namespace gfxrepro::clustered_reflections
