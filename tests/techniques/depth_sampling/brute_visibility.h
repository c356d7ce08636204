// Visibility redundancy by the definitions, word for word: all triangles in a loop, in double
// precision, without Embree.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "engine/scene/scene.h"
#include "techniques/depth_sampling/visibility.h"

namespace gfxrepro::depth_sampling {

class BruteVisibility {
  public:
    BruteVisibility(const scene::Scene& scene, std::vector<kit::View> views, bool isNonRedundant)
        : mesh_(flattened(scene)), views_(std::move(views)), isNonRedundant_(isNonRedundant) {
        for (const scene::Instance& instance : scene.instances) {
            const scene::Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
            const bool isDoubleSided =
                mesh.material >= 0 &&
                scene.materials[static_cast<std::size_t>(mesh.material)].isDoubleSided;
            isDoubleSided_.insert(isDoubleSided_.end(), mesh.triangles.size(), isDoubleSided);
        }
    }

    /// Whether something came so near to an edge or a border that rounding decides, since start().
    bool isUnclear() const { return isUnclear_; }
    void start() { isUnclear_ = false; }

    /// Walks the ray from Vⱼ to the point; the first hit that no earlier view sees (of layers, that
    /// no earlier layer holds) must be it.
    bool holds(std::size_t index, const SurfacePoint& point) {
        if (!isInFrustum(index, glm::dvec3(point.positionWorld))) return false;
        const glm::dvec3 eye(views_[index].eyeWorld);
        for (const Found& hit : hitsAlong(index, glm::dvec3(point.positionWorld) - eye)) {
            if (isSkipped(index, hit)) continue;
            return hit.point.triangleId == point.triangleId;
        }
        return false;
    }

    std::optional<SurfacePoint> sample(std::size_t index, const glm::vec3& direction) {
        for (const Found& hit : hitsAlong(index, glm::dvec3(direction))) {
            if (!isSkipped(index, hit)) return hit.point;
        }
        return std::nullopt;
    }

  private:
    static constexpr double kClear = 1e-4;  // relative; far above all rounding

    struct Found {
        double distance;
        SurfacePoint point;
    };

    bool isSkipped(std::size_t index, const Found& hit) {
        if (!isNonRedundant_) return false;
        const bool isPeeling = std::ranges::all_of(
            views_, [&](const kit::View& view) { return isSameView(view, views_.front()); });
        for (std::size_t i = 0; i < index; ++i) {
            if (isPeeling ? holds(i, hit.point) : isVisible(i, hit.point)) return true;
        }
        return false;
    }

    bool isVisible(std::size_t index, const SurfacePoint& point) {
        if (!isInFrustum(index, glm::dvec3(point.positionWorld))) return false;
        const glm::dvec3 eye(views_[index].eyeWorld);
        const auto hits = hitsAlong(index, glm::dvec3(point.positionWorld) - eye);
        return !hits.empty() && hits.front().point.triangleId == point.triangleId;
    }

    bool isInFrustum(std::size_t index, const glm::dvec3& point) {
        const kit::View& view = views_[index];
        const glm::dvec4 clip =
            glm::dmat4(view.clipFromView) * glm::dmat4(view.viewFromWorld) * glm::dvec4(point, 1.0);
        if (clip.w <= 0.0) return false;
        const double inside = std::min({clip.w - std::abs(clip.x), clip.w - std::abs(clip.y),
                                        clip.w - view.nearM, view.farM - clip.w});
        if (std::abs(inside) < kClear * clip.w) isUnclear_ = true;
        return inside > 0.0;
    }

    /// Drawn faces within the image's near and far planes, nearest first.
    std::vector<Found> hitsAlong(std::size_t index, const glm::dvec3& direction) {
        const kit::View& view = views_[index];
        const glm::dvec3 eye(view.eyeWorld);
        const glm::dvec3 unit = glm::normalize(direction);
        std::vector<Found> found;
        for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
            const auto distance = distanceTo(t, eye, unit);
            if (!distance) continue;
            const glm::dvec3 at = eye + *distance * unit;
            const double depth = -(glm::dmat4(view.viewFromWorld) * glm::dvec4(at, 1.0)).z;
            if (std::min(std::abs(depth - view.nearM), std::abs(depth - view.farM)) <
                kClear * depth) {
                isUnclear_ = true;
            }
            if (depth < view.nearM || depth > view.farM) continue;
            found.push_back({*distance, {glm::vec3(at), static_cast<std::uint32_t>(t + 1)}});
        }
        std::sort(found.begin(), found.end(),
                  [](const Found& a, const Found& b) { return a.distance < b.distance; });
        for (std::size_t i = 1; i < found.size(); ++i) {
            if (found[i].distance - found[i - 1].distance < kClear * found[i].distance) {
                isUnclear_ = true;
            }
        }
        return found;
    }

    /// Cramer's rule (Möller & Trumbore 1997).
    std::optional<double> distanceTo(std::size_t number, const glm::dvec3& eye,
                                     const glm::dvec3& unit) {
        const glm::uvec3 t = mesh_.triangles[number];
        const glm::dvec3 a(mesh_.positions[t.x]);
        const glm::dvec3 ab = glm::dvec3(mesh_.positions[t.y]) - a;
        const glm::dvec3 ac = glm::dvec3(mesh_.positions[t.z]) - a;
        const glm::dvec3 across = glm::cross(unit, ac);
        const double determinant = glm::dot(ab, across);  // > 0: the outside is turned to the eye
        if (std::abs(determinant) < kClear * glm::length(ab) * glm::length(ac)) {
            isUnclear_ = true;  // edge-on
            return std::nullopt;
        }
        if (determinant < 0.0 && !isDoubleSided_[number]) return std::nullopt;
        const double u = glm::dot(eye - a, across) / determinant;
        const double v = glm::dot(unit, glm::cross(eye - a, ab)) / determinant;
        const double distance = glm::dot(ac, glm::cross(eye - a, ab)) / determinant;
        if (distance <= 0.0) return std::nullopt;
        const double inside = std::min({u, v, 1.0 - u - v});
        if (std::abs(inside) < kClear) isUnclear_ = true;
        return inside > 0.0 ? std::optional(distance) : std::nullopt;
    }

    scene::Mesh mesh_;
    std::vector<bool> isDoubleSided_;
    std::vector<kit::View> views_;
    bool isNonRedundant_;
    bool isUnclear_ = false;
};

}  // namespace gfxrepro::depth_sampling
