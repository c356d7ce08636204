// A straight line through measurements, and how much of their variation it explains.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>

namespace gfxrepro::reflection_reuse {

struct LinearFit {
    double slope = 0.0;
    double intercept = 0.0;
    double rSquared = 0.0;  // 1: all points lie on the line; 0: x says nothing about y
};

/// Least squares of y over x. Nothing for fewer than three points, which any line fits, and where
/// x or y does not vary.
std::optional<LinearFit> linearFit(std::span<const glm::dvec2> points);

}  // namespace gfxrepro::reflection_reuse
