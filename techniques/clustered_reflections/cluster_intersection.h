// Step 3.c of [xie2017] Algorithm 6: reflection rays against the clusters' depth images.
#pragma once

#include "techniques/clustered_reflections/cluster_images.h"
#include "techniques/reflections/environment_map.h"

namespace gfxrepro::clustered_reflections {

/// How a ray goes through a depth image (march.glsl).
enum class March {
    Linear,        // Algorithm 7: a texel per step along the longer axis
    Hierarchical,  // the same samples, but those in tiles that are nearer than all that the tile
                   // holds are stepped over, by a pyramid of nearest depths: the same hits
};

/// What rays are intersected with; of one frame.
struct IntersectionInput {
    const reflections::GBuffer& gbuffer;
    const Clusters& clusters;
    const gl::Resources& drawn;  // Cameras, Places, and what else the images' painter hands on
    const ClusterImages& images;
    const reflections::EnvironmentMap& map;
};

class ClusterIntersection {
  public:
    ClusterIntersection(const gl::ShaderLibrary& shaders, const reflections::ReflectiveScene& scene,
                        const CameraSettings& settings, March march, bool mayShowOwn,
                        TexelContent content, glm::ivec2 sizePx);

    /// Of all samples in a pass over the G-buffer: images in an atlas.
    void intersectAll(const IntersectionInput& input, reflections::ReflectionTarget& target);

    /// Of one cluster's samples after the other, each between the drawing of its image and of the
    /// next: `range` is its entry of Clusters::ranges. What they share is set once a frame.
    void beginClusters(const reflections::GBuffer& gbuffer) const;
    void intersectCluster(std::uint32_t cluster, const glm::uvec4& range,
                          const IntersectionInput& input,
                          reflections::ReflectionTarget& target) const;

    /// Once a frame, before either.
    void clearEnvironmentSamples();
    const gl::Texture& environmentSamples() const { return environmentSamples_; }
    std::size_t sizeBytes() const { return environmentSamples_.sizeBytes(); }

  private:
    void setUniforms(const gl::Pass& pass, const reflections::GBuffer& gbuffer) const;

    CameraSettings settings_;
    gl::Pass all_, one_;
    gl::Texture environmentSamples_;  // R8UI: 1 where a mirror ray took the environment map
    kit::WholeImage wholeImage_;
};

}  // namespace gfxrepro::clustered_reflections
