// Polygons of files as triangles.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace gfxrepro::scene {

/// For LeftOut. Ears are found in a time that grows with the square of the corners, hence the
/// limit.
inline constexpr const char* kOverlap =
    "the shape of a polygon that crosses itself, or is not convex and has more than 4096 corners: "
    "its triangles overlap";

/// Fills polygons of three or more corners, convex or not.
class PolygonFiller {
  public:
    /// n − 2 triangles over the numbers 0 … n − 1 of the corners, turning as the polygon does: a
    /// fan around its first corner where that fills it, else ears clipped in the plane of its
    /// normal. Valid until the next call.
    std::span<const glm::uvec3> fill(std::span<const glm::vec3> corners);

    /// Polygons so far whose triangles overlap: kOverlap says why.
    std::size_t overlappingCount() const { return overlappingCount_; }

  private:
    void project(std::span<const glm::vec3> corners);
    bool isFilled() const;
    bool isEar(std::uint32_t corner, bool mayTouch) const;
    void clipEars();

    std::vector<glm::dvec2> points_;  // the corners in the plane, the first at 0
    double twiceArea_ = 0.0;          // of the polygon there
    std::vector<std::uint32_t> next_, previous_;
    std::vector<glm::uvec3> triangles_;
    std::size_t overlappingCount_ = 0;
};

}  // namespace gfxrepro::scene
