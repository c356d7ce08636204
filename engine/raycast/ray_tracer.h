// Ground truth on the CPU: Embree over a scene or a mesh.
#pragma once

#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "engine/scene/scene.h"

namespace gfxrepro::raycast {

struct Hit {
    float distance = 0.0F;  // along the unit direction
    glm::vec3 position{0.0F};
    glm::vec3 geometricNormal{0.0F};  // unit, by winding
    glm::vec2 barycentric{0.0F};      // weights of vertices 1 and 2
    unsigned instance = 0;            // into Scene::instances
    unsigned triangle = 0;            // into the instance's mesh
    unsigned flattenedTriangle = 0;   // into scene::flattened(scene).triangles
};

/// One triangle met by a ray.
struct TriangleHit {
    float distance = 0.0F;  // along the unit direction
    unsigned triangle = 0;  // into scene::flattened(scene).triangles
};

/// Which sides of triangles a ray meets.
enum class Faces {
    All,
    Drawn,  // as drawn with back-face culling: triangles of materials that are not double-sided are
            // passed through from behind. Texels that an alpha test would cut out count as surface.
};

/// A triangle as it lies in the world: counter-clockwise seen from outside.
struct WorldTriangle {
    glm::vec3 corners[3];
    bool isDoubleSided = false;

    /// Whether a drawn face is turned to the point; not for points in the triangle's plane.
    bool isDrawnFrom(const glm::vec3& point) const;
    /// Whether a ray meets a drawn face in (tMin, tMax) beyond doubt: so far from the edges and
    /// from both ends, and so steeply, that no rounding of a tracer could miss it.
    bool isClearlyHit(const glm::vec3& origin, const glm::vec3& direction, float tMin,
                      float tMax) const;
};

/// Stands for "no triangle".
constexpr unsigned kNoTriangle = std::numeric_limits<unsigned>::max();

/// A BVH over the instanced triangles of a scene; it keeps no reference to the scene. Watertight
/// (Embree's robust mode): no ray slips between triangles that share an edge. The price is that a
/// ray through a shared edge may be reported for both triangles; closestHit() and isOccluded() do
/// not care, hitsBetween() has both.
///
/// Directions need not be of unit length; distances, tMin and tMax always count along the unit
/// direction, in the scene's units. All queries may run on several threads at once.
class RayTracer {
  public:
    explicit RayTracer(const scene::Scene& scene);
    ~RayTracer();
    RayTracer(RayTracer&&) noexcept;
    RayTracer& operator=(RayTracer&&) noexcept;

    /// The nearest hit in (tMin, tMax).
    std::optional<Hit> closestHit(const glm::vec3& origin, const glm::vec3& direction,
                                  float tMin = 0.0F,
                                  float tMax = std::numeric_limits<float>::infinity(),
                                  Faces faces = Faces::All) const;
    /// All hits in (tMin, tMax), nearest first, put into `hits` (cleared; its memory is reused),
    /// each triangle once. A ray through a shared edge may have both triangles.
    void hitsBetween(const glm::vec3& origin, const glm::vec3& direction, float tMin, float tMax,
                     Faces faces, std::vector<TriangleHit>& hits) const;
    /// Whether there is a hit in (tMin, tMax). `ignored` (of the flattened scene) does not count.
    bool isOccluded(const glm::vec3& origin, const glm::vec3& direction, float tMin, float tMax,
                    Faces faces = Faces::All, unsigned ignored = kNoTriangle) const;

    /// What isOccluded() found in the way: the number of any of these triangles.
    std::optional<unsigned> occluder(const glm::vec3& origin, const glm::vec3& direction,
                                     float tMin, float tMax, Faces faces, unsigned ignored) const;

    /// The point of a triangle that is nearest to `point`; none where all are farther than that.
    std::optional<Hit> nearest(const glm::vec3& point,
                               float distanceAtMost = std::numeric_limits<float>::infinity()) const;

    /// By its number in scene::flattened(scene).triangles.
    WorldTriangle triangle(unsigned flattenedTriangle) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace gfxrepro::raycast
