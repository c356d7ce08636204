// EWA splatting's screen-space covariance on the host, in double precision (zju2005 Eq. 3, 8–13).
#pragma once

#include <glm/glm.hpp>

namespace gfxrepro::point_splatting {

/// Orthonormal tangents of a unit normal: the first of (0, −n_z, n_y), (n_z, 0, −n_x),
/// (−n_y, n_x, 0) that is longest, normalized, and n × it (Sec. 3.3.2.3).
struct Tangents {
    glm::dvec3 s, t;
};
Tangents tangentsOf(const glm::dvec3& normal);

/// J of Eq. (8), for focal length 1: d(x/z, y/z) of moves along s and t from o, all in eye space
/// with z the distance along the view axis.
glm::dmat2 screenJacobian(const glm::dvec3& o, const glm::dvec3& s, const glm::dvec3& t);

/// H = J V^r Jᵀ + V^h of Eq. (3) in pixels², with the radii's squares on the diagonals.
glm::dmat2 ewaCovariance(const glm::dvec3& o, const Tangents& tangents, double radius,
                         double focalPx, double lowPassRadiusPx);

}  // namespace gfxrepro::point_splatting
