// Ground truth on the CPU: Embree over a scene or a mesh.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "runner/image/image.h"
#include "runner/scene/scene.h"

namespace gfxrepro::raycast {

struct Hit {
    float distance = 0.0F;  // along the unit direction
    glm::vec3 position{0.0F};
    glm::vec3 geometricNormal{0.0F};  // unit, by winding
    glm::vec2 barycentric{0.0F};      // weights of vertices 1 and 2
    unsigned instance = 0;            // into Scene::instances
    unsigned triangle = 0;            // into the instance's mesh
};

/// A BVH over the instanced triangles of a scene; it keeps no reference to the scene. Watertight
/// (Embree's robust mode): no ray slips between triangles that share an edge.
class RayTracer {
  public:
    explicit RayTracer(const scene::Scene& scene);
    ~RayTracer();
    RayTracer(RayTracer&&) noexcept;
    RayTracer& operator=(RayTracer&&) noexcept;

    /// The nearest hit in (tMin, tMax); `direction` need not be of unit length.
    std::optional<Hit> closestHit(const glm::vec3& origin, const glm::vec3& direction,
                                  float tMin = 0.0F,
                                  float tMax = std::numeric_limits<float>::infinity()) const;
    bool isOccluded(const glm::vec3& origin, const glm::vec3& direction, float tMin,
                    float tMax) const;
    /// Distances of all crossings, ascending, through `occlusion`-free traversal (every triangle
    /// counts).
    std::vector<float> allHits(const glm::vec3& origin, const glm::vec3& direction) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// A look at a scene, ray traced: base colours (textured) under a headlight, N·V shading. The
/// rasterized look of gpu_scene uses the same formula, so that the two agree.
image::ImageF renderPreview(const scene::Scene& scene, const scene::Camera& camera, int width,
                            int height);

}  // namespace gfxrepro::raycast
