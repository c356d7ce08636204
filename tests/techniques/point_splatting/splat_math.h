// EWA splatting's screen-space covariance on the host, in double precision (zju2005 Eq. 3, 8–13).
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

namespace gfxrepro::point_splatting {

/// A splat in eye space with z the distance along the view axis (positive before the eye).
struct EyeSplat {
    glm::dvec3 centre{0.0, 0.0, 1.0};     // (o)
    glm::dvec3 tangent{1.0, 0.0, 0.0};    // (s), unit
    glm::dvec3 bitangent{0.0, 1.0, 0.0};  // (t), unit, at right angles to (s)
    double radius = 1.0;                  // r_k
};

inline double cosineToNormal(const EyeSplat& splat) {
    const glm::dvec3 normal = glm::cross(splat.tangent, splat.bitangent);
    return std::abs(glm::dot(normal, glm::normalize(splat.centre)));
}

/// J of Eq. (8): derivatives of (x / z, y / z) along s and t, in columns. For focal length 1.
inline glm::dmat2 screenJacobian(const EyeSplat& splat) {
    const glm::dvec3& o = splat.centre;
    const auto column = [&](const glm::dvec3& direction) {
        return glm::dvec2(direction.x - o.x / o.z * direction.z,
                          direction.y - o.y / o.z * direction.z) /
               o.z;
    };
    return {column(splat.tangent), column(splat.bitangent)};
}

/// |J| of Eq. (11), from the angle between the view ray and the normal.
inline double jacobianDeterminant(const EyeSplat& splat) {
    const glm::dvec3& o = splat.centre;
    const double slope2 = (o.x * o.x + o.y * o.y) / (o.z * o.z);
    return cosineToNormal(splat) / (o.z * o.z) * std::sqrt(slope2 + 1.0);
}

/// S_proj = π r_k² cos θ / o_z², for focal length 1 (the text of it lost o_z², which Eq. 12 needs).
inline double projectedArea(const EyeSplat& splat) {
    return glm::pi<double>() * splat.radius * splat.radius * cosineToNormal(splat) /
           (splat.centre.z * splat.centre.z);
}

/// H = J V^r Jᵀ + V^h of Eq. (3), in pixels².
inline glm::dmat2 ewaCovariance(const EyeSplat& splat, double focalPx, double lowPassRadiusPx) {
    const glm::dmat2 j = focalPx * screenJacobian(splat);
    return splat.radius * splat.radius * (j * glm::transpose(j)) +
           lowPassRadiusPx * lowPassRadiusPx * glm::dmat2(1.0);
}

}  // namespace gfxrepro::point_splatting
