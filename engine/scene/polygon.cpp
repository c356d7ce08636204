#include "engine/scene/polygon.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace gfxrepro::scene {
namespace {

/// Twice the area of a triangle, negative where it turns clockwise.
double twiceAreaOf(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Whether both halves beside the diagonal from the first corner look to one side.
bool isFanOfQuad(std::span<const glm::vec3> corners) {
    const glm::dvec3 origin(corners[0]);
    const glm::dvec3 diagonal = glm::dvec3(corners[2]) - origin;
    return glm::dot(glm::cross(glm::dvec3(corners[1]) - origin, diagonal),
                    glm::cross(diagonal, glm::dvec3(corners[3]) - origin)) >= 0.0;
}

}  // namespace

std::span<const glm::uvec3> PolygonFiller::fill(std::span<const glm::vec3> corners) {
    triangles_.clear();
    for (std::uint32_t i = 2; i < corners.size(); ++i) triangles_.emplace_back(0, i - 1, i);
    if (corners.size() < 4 || (corners.size() == 4 && isFanOfQuad(corners))) return triangles_;
    project(corners);
    if (isFilled()) return triangles_;
    constexpr std::size_t kMostCorners = 4096;
    if (corners.size() <= kMostCorners) clipEars();
    if (!isFilled()) ++overlappingCount_;
    return triangles_;
}

/// Along the largest part of the normal (Newell's): areas shrink, but nothing changes its side.
void PolygonFiller::project(std::span<const glm::vec3> corners) {
    const glm::dvec3 origin(corners[0]);
    glm::dvec3 normal(0.0);
    for (std::size_t i = 2; i < corners.size(); ++i) {
        normal += glm::cross(glm::dvec3(corners[i - 1]) - origin, glm::dvec3(corners[i]) - origin);
    }
    int axis = 2;
    if (std::abs(normal.x) > std::abs(normal[axis])) axis = 0;
    if (std::abs(normal.y) > std::abs(normal[axis])) axis = 1;
    const bool isBehind = normal[axis] < 0.0;
    const int u = (axis + (isBehind ? 2 : 1)) % 3;
    const int v = (axis + (isBehind ? 1 : 2)) % 3;
    points_.clear();
    for (const glm::vec3& corner : corners) {
        points_.emplace_back(double{corner[u]} - origin[u], double{corner[v]} - origin[v]);
    }
    twiceArea_ = std::abs(normal[axis]);
}

/// Triangles that turn as the polygon does, and together have its area, do not overlap.
bool PolygonFiller::isFilled() const {
    constexpr double kRounding = 1e-6;
    double sum = 0.0;
    for (const glm::uvec3& t : triangles_) {
        sum += std::abs(twiceAreaOf(points_[t.x], points_[t.y], points_[t.z]));
    }
    return sum <= twiceArea_ * (1.0 + kRounding);
}

/// Whether the triangle of a corner and its neighbours lies inside of what is left: no corner where
/// the border turns inwards lies in it, or, with `mayTouch`, on its border.
bool PolygonFiller::isEar(std::uint32_t corner, bool mayTouch) const {
    const glm::dvec2 a = points_[previous_[corner]];
    const glm::dvec2 b = points_[corner];
    const glm::dvec2 c = points_[next_[corner]];
    const double area = twiceAreaOf(a, b, c);
    if (area <= 0.0) return area == 0.0;
    for (std::uint32_t i = next_[next_[corner]]; i != previous_[corner]; i = next_[i]) {
        const glm::dvec2 p = points_[i];
        // Where a hole is joined to the border by two edges, corners lie on each other.
        if (p == a || p == b || p == c) continue;
        if (twiceAreaOf(points_[previous_[i]], p, points_[next_[i]]) >= 0.0) continue;
        const double least =
            std::min({twiceAreaOf(a, b, p), twiceAreaOf(b, c, p), twiceAreaOf(c, a, p)});
        if (mayTouch ? least > 0.0 : least >= 0.0) return false;
    }
    return true;
}

void PolygonFiller::clipEars() {
    const auto count = static_cast<std::uint32_t>(points_.size());
    next_.resize(count);
    previous_.resize(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        next_[i] = (i + 1) % count;
        previous_[i] = (i + count - 1) % count;
    }
    triangles_.clear();
    std::uint32_t corner = 0;
    std::uint32_t left = count;
    const auto clip = [&](std::uint32_t ear) {
        const std::uint32_t before = previous_[ear];
        const std::uint32_t after = next_[ear];
        triangles_.emplace_back(before, ear, after);
        next_[before] = after;
        previous_[after] = before;
        corner = before;
        --left;
    };
    // Where a corner is written twice, the border would turn at neither of the two.
    for (std::uint32_t i = 0; i < count && left > 3; ++i) {
        if (points_[i] == points_[previous_[i]]) clip(i);
    }
    std::uint32_t testsLeft = 16 * count;  // usual polygons take two or three a corner
    bool mayTouch = false;
    for (std::uint32_t failures = 0; left > 3 && testsLeft > 0; --testsLeft) {
        if (isEar(corner, mayTouch)) {
            clip(corner);
            failures = 0;
            continue;
        }
        corner = next_[corner];
        if (++failures <= left) continue;
        if (mayTouch) break;
        mayTouch = true;
        failures = 0;
    }
    for (; left > 2; --left) {  // the last one; more where the polygon crosses itself
        const std::uint32_t middle = next_[corner];
        triangles_.emplace_back(corner, middle, next_[middle]);
        next_[corner] = next_[middle];
    }
}

}  // namespace gfxrepro::scene
