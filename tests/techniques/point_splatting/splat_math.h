// EWA splatting's screen-space covariance on the host, in double precision (zju2005 Eq. 3, 8–13).
#pragma once

#include <glm/glm.hpp>

namespace gfxrepro::point_splatting {

/// A splat in eye space with z the distance along the view axis (positive before the eye).
struct EyeSplat {
    glm::dvec3 centre{0.0, 0.0, 1.0};     // (o)
    glm::dvec3 tangent{1.0, 0.0, 0.0};    // (s), unit
    glm::dvec3 bitangent{0.0, 1.0, 0.0};  // (t), unit, at right angles to (s)
    double radius = 1.0;                  // r_k
};

/// J of Eq. (8): derivatives of (x / z, y / z) along s and t, in columns. For focal length 1.
glm::dmat2 screenJacobian(const EyeSplat& splat);
/// |J| of Eq. (11), from the angle between the view ray and the normal.
double jacobianDeterminant(const EyeSplat& splat);
/// S_proj = π r_k² cos θ / o_z², for focal length 1 (the text of it lost o_z², which Eq. 12 needs).
double projectedArea(const EyeSplat& splat);
/// H = J V^r Jᵀ + V^h of Eq. (3), in pixels².
glm::dmat2 ewaCovariance(const EyeSplat& splat, double focalPx, double lowPassRadiusPx);

}  // namespace gfxrepro::point_splatting
