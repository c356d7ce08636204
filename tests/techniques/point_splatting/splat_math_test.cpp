#include "tests/techniques/point_splatting/splat_math.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "engine/core/random.h"
#include "techniques/point_splatting/patch_selection.h"

namespace gfxrepro::point_splatting {
namespace {

EyeSplat randomSplat(Random& random) {
    EyeSplat splat;
    splat.centre.z = random.uniform(1.0F, 5.0F);
    splat.centre.x = random.uniform(-0.4F, 0.4F) * splat.centre.z;  // within 45°
    splat.centre.y = random.uniform(-0.4F, 0.4F) * splat.centre.z;
    const glm::dvec3 a{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    const glm::dvec3 b{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    splat.tangent = glm::normalize(a);
    splat.bitangent = glm::normalize(glm::cross(splat.tangent, b));
    splat.radius = random.uniform(0.01F, 0.1F);
    return splat;
}

/// [zju2005] Eq. (8): the derivative of the projection, by differences.
TEST(SplatMath, JacobianIsTheProjectionsDerivative) {
    Random random(1);
    for (int trial = 0; trial < 200; ++trial) {
        const EyeSplat splat = randomSplat(random);
        const glm::dmat2 j = screenJacobian(splat);
        const double h = 1e-6;
        const auto project = [](const glm::dvec3& p) { return glm::dvec2(p) / p.z; };
        for (int column = 0; column < 2; ++column) {
            const glm::dvec3 d = column == 0 ? splat.tangent : splat.bitangent;
            const glm::dvec2 slope =
                (project(splat.centre + h * d) - project(splat.centre - h * d)) / (2.0 * h);
            EXPECT_NEAR(glm::distance(slope, j[column]), 0.0, 1e-8);
        }
    }
}

/// Eq. (11).
TEST(SplatMath, DeterminantIsThatOfEquation11) {
    Random random(2);
    for (int trial = 0; trial < 200; ++trial) {
        const EyeSplat splat = randomSplat(random);
        EXPECT_NEAR(std::abs(glm::determinant(screenJacobian(splat))), jacobianDeterminant(splat),
                    1e-12);
    }
}

/// Eq. (13), squared: S² / π² ≤ |J V^r Jᵀ| ≤ S² / π² · C_η², within the window.
TEST(SplatMath, ProjectedAreaBoundsTheCovariance) {
    Random random(3);
    const double fovRad = 2.0 * std::atan(0.4);
    for (int trial = 0; trial < 500; ++trial) {
        const EyeSplat splat = randomSplat(random);
        const double determinant = glm::determinant(ewaCovariance(splat, 1.0, 0.0));
        const double area = projectedArea(splat) / glm::pi<double>();
        EXPECT_GE(determinant, area * area * (1.0 - 1e-9));
        EXPECT_LE(determinant, area * area * cEta(fovRad) * cEta(fovRad) * (1.0 + 1e-9));
    }
}

TEST(SplatMath, FiltersAgreeInTheirLimits) {
    EyeSplat splat{.centre = {0.0, 0.0, 2.0}, .radius = 0.1};
    // Facing the eye: a circle of radius · focal / z; the low-pass adds its own square.
    const glm::dmat2 h = ewaCovariance(splat, 100.0, 0.5);
    EXPECT_NEAR(h[0][0], 25.25, 1e-12);
    EXPECT_NEAR(h[1][1], 25.25, 1e-12);
    EXPECT_NEAR(h[0][1], 0.0, 1e-12);
    splat.radius = 0.0;  // far away: the low-pass alone
    EXPECT_EQ(ewaCovariance(splat, 100.0, 0.5), 0.25 * glm::dmat2(1.0));
}

}  // namespace
}  // namespace gfxrepro::point_splatting
