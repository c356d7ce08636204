// Depth images sampled by ray casting: the pictures of visibility redundancy.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/scene/scene.h"
#include "techniques/depth_sampling/visibility.h"
#include "techniques/kit/depth_image.h"

namespace gfxrepro::depth_sampling {

/// What DepthImageRenderer shades with, on the CPU: interpolated normals (the triangle's where the
/// mesh has none) and the material's base colour times the vertex's. Textures are left out.
class SurfaceShading {
  public:
    explicit SurfaceShading(const scene::Scene& scene);

    /// Direct light that goes from the point towards the eye: the formula at kLightDirectionWorld.
    glm::vec3 radiance(const SurfacePoint& point, const glm::vec3& eyeWorld) const;

  private:
    std::vector<glm::vec3> positions_, normals_, colors_;  // normals: zero where there are none
    std::vector<glm::uvec3> triangles_;
    std::vector<bool> isDoubleSided_;  // by triangle
};

/// Image `index` of the sequence, all its pixels.
kit::HostDepthImage rayCastImage(const VisibilitySequence& sequence, std::size_t index,
                                 const SurfaceShading& shading);

}  // namespace gfxrepro::depth_sampling
