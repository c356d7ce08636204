// Step 3.c of [xie2017] Algorithm 6: reflection rays against the clusters' depth images.
#pragma once

#include "techniques/clustered_reflections/cluster_images.h"
#include "techniques/reflections/environment_map.h"

namespace gfxrepro::clustered_reflections {

/// How a ray goes through a depth image (march.glsl).
enum class March {
    Linear,        // Algorithm 7: a texel a step along the longer axis
    Hierarchical,  // the same samples, but those in tiles that are nearer than all that the tile
                   // holds are stepped over, by a pyramid of nearest depths: the same hits
};

/// Cameras and places must be bound to kCamerasBinding and kPlacesBinding.
class ClusterIntersection {
  public:
    ClusterIntersection(const gl::ShaderLibrary& shaders, const reflections::ReflectiveScene& scene,
                        const CameraSettings& settings, March march, bool mayShowOwn,
                        TexelContent content, glm::ivec2 sizePx);

    /// Of all samples in a pass over the G-buffer: images in an atlas.
    void intersectAll(const reflections::GBuffer& gbuffer, const Clusters& clusters,
                      const ClusterImages& images, const reflections::EnvironmentMap& map,
                      reflections::ReflectionTarget& target);

    /// Of one cluster's samples after the other, each between the drawing of its image and of the
    /// next: `range` is its entry of Clusters::ranges. What they share is set up once a frame, and
    /// what they write is awaited once.
    void beginClusters(const reflections::GBuffer& gbuffer, const Clusters& clusters,
                       const reflections::EnvironmentMap& map,
                       reflections::ReflectionTarget& target) const;
    void intersectCluster(std::uint32_t cluster, const glm::uvec4& range,
                          const ClusterImages& images) const;
    static void endClusters();

    /// Once a frame, before either.
    void clearEnvironmentSamples();
    const gl::Texture& environmentSamples() const { return environmentSamples_; }
    std::size_t sizeBytes() const { return environmentSamples_.sizeBytes(); }

  private:
    void prepare(const gl::Program& program, const reflections::GBuffer& gbuffer,
                 const reflections::EnvironmentMap& map) const;

    CameraSettings settings_;
    gl::Program all_, one_;
    gl::Texture environmentSamples_;  // R8UI: 1 where a mirror ray took the environment map
    kit::WholeImage wholeImage_;
};

}  // namespace gfxrepro::clustered_reflections
