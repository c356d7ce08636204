// Clouds of points, and directions, that the tests share.
#pragma once

#include <cmath>
#include <glm/glm.hpp>

#include "engine/core/random.h"
#include "engine/scene/scene.h"

namespace gfxrepro::point_splatting {

inline glm::vec3 randomUnit(Random& random) {
    for (;;) {
        const glm::vec3 v{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
        if (glm::length(v) > 0.1F && glm::length(v) < 1.0F) return glm::normalize(v);
    }
}

/// Points of the unit sphere on a spiral (Fibonacci's), evenly spread, discs overlapping.
inline scene::PointCloud sphere(int count) {
    scene::PointCloud points;
    for (int i = 0; i < count; ++i) {
        const double z = 1.0 - 2.0 * (i + 0.5) / count, angle = 2.399963229728653 * i;
        const double r = std::sqrt(1.0 - z * z);
        points.positions.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    }
    points.normals = points.positions;
    points.radii.assign(points.positions.size(), static_cast<float>(1.5 * std::sqrt(4.0 / count)));
    return points;
}

}  // namespace gfxrepro::point_splatting
