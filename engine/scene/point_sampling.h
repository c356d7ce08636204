// Surfaces turned into points, and what points lack made up for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>

#include "engine/scene/scene.h"

namespace gfxrepro::scene {

// Spread of points: mean, covariance and its principal axes.

/// Sums over points in double precision, relative to the first one so that nothing cancels far from
/// the origin.
class Covariance {
  public:
    void add(const glm::vec3& point) {
        if (count_ == 0) origin_ = glm::dvec3(point);
        const glm::dvec3 p = glm::dvec3(point) - origin_;
        sum_ += p;
        squares_ += glm::outerProduct(p, p);
        ++count_;
    }
    std::size_t count() const { return count_; }
    glm::dvec3 mean() const;
    /// Σ (p − mean)(p − mean)ᵀ / count; zero for no points.
    glm::dmat3 matrix() const;

  private:
    glm::dvec3 origin_{0.0}, sum_{0.0};
    glm::dmat3 squares_{0.0};
    std::size_t count_ = 0;
};

/// Of a symmetric matrix: eigenvalues ascending, unit eigenvectors as columns in the same order.
struct Eigensystem {
    glm::dvec3 values{0.0};
    glm::dmat3 vectors{1.0};
};
/// Jacobi's method.
Eigensystem eigensystem(const glm::dmat3& symmetric);

/// All instances as one mesh in world space, whose attributes points of it have. Normals are the
/// meshes' own (area-weighted ones where a mesh has none: a scan is smooth), of any length; colours
/// are of material times vertex (none without either, or all white; textures are not read).
Mesh surfaceOf(const Scene& scene);

/// `count` points on the triangles of a scene: evenly by area, and within a triangle by the R₂
/// sequence (Roberts 2018). Normals and colours are interpolated over surfaceOf(), which they keep,
/// radii are twice those of discs that together have the surface's area: neighbours overlap. Same
/// input, same bytes. Throws Error for scenes without area and for no points.
PointCloud sampledPoints(const Scene& scene, std::size_t count);

/// `count` of the points, at equal steps along a space-filling curve (Morton order); all of them
/// where there are not more. Radii grow by √(all / count).
PointCloud thinnedPoints(const PointCloud& points, std::size_t count);

/// What completePoints() did.
struct PointRepairs {
    std::size_t dropped = 0;     // positions that are not finite
    std::size_t duplicates = 0;  // points at the place of another one: dropped, too
    std::size_t normals = 0;     // estimated: missing, not finite or zero
    std::size_t radii = 0;       // estimated: missing, not finite or not positive
};
/// Makes every attribute but the colour complete. Normals are the least principal axis of the 16
/// nearest neighbours, turned the way of neighbours that have one, else upwards at the topmost
/// point of each connected part (Hoppe et al. 1992); radii are the mean distance to the 6 nearest
/// neighbours, at most 4 times that distance's median. A point without neighbours gets the normal
/// +y and the radius 1. Throws Error when no point is left.
PointRepairs completePoints(PointCloud& points);

}  // namespace gfxrepro::scene
