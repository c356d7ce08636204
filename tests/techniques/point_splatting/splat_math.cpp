#include "tests/techniques/point_splatting/splat_math.h"

#include <cmath>
#include <glm/gtc/constants.hpp>

namespace gfxrepro::point_splatting {

namespace {

double cosineToNormal(const EyeSplat& splat) {
    const glm::dvec3 normal = glm::cross(splat.tangent, splat.bitangent);
    return std::abs(glm::dot(normal, glm::normalize(splat.centre)));
}

}  // namespace

glm::dmat2 screenJacobian(const EyeSplat& splat) {
    const glm::dvec3& o = splat.centre;
    const auto column = [&](const glm::dvec3& direction) {
        return glm::dvec2(direction.x - o.x / o.z * direction.z,
                          direction.y - o.y / o.z * direction.z) /
               o.z;
    };
    return {column(splat.tangent), column(splat.bitangent)};
}

double jacobianDeterminant(const EyeSplat& splat) {
    const glm::dvec3& o = splat.centre;
    const double slope2 = (o.x * o.x + o.y * o.y) / (o.z * o.z);
    return cosineToNormal(splat) / (o.z * o.z) * std::sqrt(slope2 + 1.0);
}

double projectedArea(const EyeSplat& splat) {
    return glm::pi<double>() * splat.radius * splat.radius * cosineToNormal(splat) /
           (splat.centre.z * splat.centre.z);
}

glm::dmat2 ewaCovariance(const EyeSplat& splat, double focalPx, double lowPassRadiusPx) {
    const glm::dmat2 j = focalPx * screenJacobian(splat);
    return splat.radius * splat.radius * (j * glm::transpose(j)) +
           lowPassRadiusPx * lowPassRadiusPx * glm::dmat2(1.0);
}

}  // namespace gfxrepro::point_splatting
