#include "techniques/depth_sampling/visibility.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include "engine/core/error.h"

namespace gfxrepro::depth_sampling {
namespace {

using kit::View;
using raycast::Faces;
using raycast::TriangleHit;

/// Hits nearer to a point than this, in distances from the eye (or the eye's largest coordinate,
/// which rounding follows likewise), are at the point. Positions come out of depth images and off
/// rays with a few units in the last place, 2⁻²³ each; 64 of them (8 µm at a metre) leave room for
/// surfaces seen at a slant. Without it a sample on an edge that two triangles share would hide
/// behind the neighbour. Surfaces nearer to each other than this count as one.
constexpr float kSamePoint = 64.0F * std::numeric_limits<float>::epsilon();

float largestCoordinate(const glm::vec3& point) {
    return std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)});
}

/// What is nearer than this is before a point at `distance`.
float strictlyBefore(float distance, const glm::vec3& eye) {
    return distance - kSamePoint * std::max(distance, largestCoordinate(eye));
}

glm::vec3 forwardOf(const View& view) {
    const glm::mat4& m = view.viewFromWorld;
    return {-m[0].z, -m[1].z, -m[2].z};
}

/// Memory for the hits of one walk, reused from query to query. Walks nest (a walk of image j asks
/// for earlier images), each under its image's index; a deque keeps the outer ones in place.
std::vector<TriangleHit>& hitsOfWalk(std::size_t index) {
    thread_local std::deque<std::vector<TriangleHit>> buffers;
    while (buffers.size() <= index) buffers.emplace_back();
    return buffers[index];
}

}  // namespace

bool isSameView(const View& a, const View& b) {
    return a.eyeWorld == b.eyeWorld && a.viewFromWorld == b.viewFromWorld &&
           a.clipFromView == b.clipFromView && a.sizePx == b.sizePx;
}

struct VisibilitySequence::Sight {
    glm::vec3 eye;
    glm::vec3 direction;
    float begin;
    float distance;

    float end() const { return strictlyBefore(distance, eye); }
};

VisibilitySequence::VisibilitySequence(const raycast::RayTracer& tracer, std::vector<View> views,
                                       bool isNonRedundant, Earlier earlier)
    : tracer_(&tracer),
      views_(std::move(views)),
      nextOfView_(views_.size(), views_.size()),
      isNonRedundant_(isNonRedundant),
      earlier_(earlier),
      isPeeling_(isNonRedundant) {
    for (std::size_t i = 0; i < views_.size(); ++i) {
        isPeeling_ = isPeeling_ && isSameView(views_[i], views_[0]);
        for (std::size_t j = views_.size() - 1; j > i; --j) {
            if (isSameView(views_[i], views_[j])) nextOfView_[i] = j;
        }
    }
}

/// Nothing where the image cannot hold the point: outside of its frustum, or turned away.
std::optional<VisibilitySequence::Sight> VisibilitySequence::sightOf(
    std::size_t index, const SurfacePoint& point) const {
    GFXREPRO_ASSERT(point.triangleId > 0);
    const View& view = views_[index];
    if (!pixelOf(view, point.positionWorld)) return std::nullopt;
    const glm::vec3 towards = point.positionWorld - view.eyeWorld;
    const float depthM = glm::dot(towards, forwardOf(view));
    if (depthM < view.nearM || depthM > view.farM) return std::nullopt;
    if (!tracer_->triangle(point.triangleId - 1).isDrawnFrom(view.eyeWorld)) return std::nullopt;
    const float distance = glm::length(towards);
    return Sight{view.eyeWorld, towards, view.nearM * (distance / depthM), distance};
}

/// [xie2017] Algorithm 2: the ray from Vⱼ to the point meets nothing before it.
bool VisibilitySequence::isVisible(std::size_t index, const SurfacePoint& point) const {
    const auto sight = sightOf(index, point);
    // The point's own triangle cannot hide it, however grazing the ray.
    return sight && !tracer_->isOccluded(sight->eye, sight->direction, sight->begin, sight->end(),
                                         Faces::Drawn, point.triangleId - 1);
}

/// Whether everything before the point, seen from Vⱼ, is held by earlier images: then image j or an
/// earlier one holds the point.
bool VisibilitySequence::isReached(std::size_t index, const SurfacePoint& point) const {
    const auto sight = sightOf(index, point);
    if (!sight) return false;
    std::vector<TriangleHit>& hits = hitsOfWalk(index);
    tracer_->hitsBetween(sight->eye, sight->direction, sight->begin, sight->end(), Faces::Drawn,
                         hits);
    std::erase_if(hits, [&](const TriangleHit& h) { return h.triangle == point.triangleId - 1; });
    if (isPeeling_) {
        // The same in closed form, without a ray for every hit: the rank along the ray.
        std::size_t rank = 0;
        float distance = sight->distance;
        for (auto hit = hits.rbegin(); hit != hits.rend(); ++hit) {
            if (hit->distance >= strictlyBefore(distance, sight->eye)) continue;
            distance = hit->distance;
            ++rank;
        }
        return rank <= index;
    }
    // From the back, where hits are hidden most often: the first that is not held decides.
    const glm::vec3 unit = sight->direction / sight->distance;
    return std::all_of(hits.rbegin(), hits.rend(), [&](const TriangleHit& hit) {
        return isRedundant(index, {sight->eye + hit.distance * unit, hit.triangle + 1});
    });
}

bool VisibilitySequence::anyHolds(std::size_t count, const SurfacePoint& point) const {
    // What is visible from Vⱼ, image j or an earlier one holds; this settles most points. Images of
    // one view reach the farther the later they come, so the last one speaks for all.
    for (std::size_t i = 0; i < count; ++i) {
        if (isLastOfItsView(i, count) && isVisible(i, point)) return true;
    }
    if (!isNonRedundant_) return false;
    for (std::size_t i = 1; i < count; ++i) {
        if (isLastOfItsView(i, count) && isReached(i, point)) return true;
    }
    return false;
}

bool VisibilitySequence::holds(std::size_t index, const SurfacePoint& point) const {
    if (!isNonRedundant_ || index == 0) return isVisible(index, point);
    return isReached(index, point) && !isRedundant(index, point);
}

bool VisibilitySequence::isRedundant(std::size_t count, const SurfacePoint& point) const {
    // Departure [xie2017] Algorithm 2: a layer is tested against the layers before, of whose one
    // view the algorithm would see the first alone; Earlier::Samples does so of all images.
    if (isPeeling_ || earlier_ == Earlier::Samples) return anyHolds(count, point);
    for (std::size_t i = 0; i < count; ++i) {
        if (isLastOfItsView(i, count) && isVisible(i, point)) return true;
    }
    return false;
}

std::optional<std::size_t> VisibilitySequence::visibleFrom(const SurfacePoint& point,
                                                           std::size_t first) const {
    const std::size_t count = views_.size();
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t index = (first + i) % count;
        if (isVisible(index, point)) return index;
    }
    return std::nullopt;
}

std::optional<SurfacePoint> VisibilitySequence::sample(std::size_t index, glm::ivec2 pixel) const {
    const View& view = views_[index];
    const glm::vec3 direction = rayThrough(view, glm::vec2(pixel) + 0.5F);
    const float perDepth = 1.0F / glm::dot(direction, forwardOf(view));
    const float begin = view.nearM * perDepth;
    const float end = view.farM * perDepth;
    const auto pointOf = [&](float distance, unsigned triangle) {
        return SurfacePoint{view.eyeWorld + distance * direction, triangle + 1};
    };

    const auto first = tracer_->closestHit(view.eyeWorld, direction, begin, end, Faces::Drawn);
    if (!first) return std::nullopt;
    const SurfacePoint nearest = pointOf(first->distance, first->flattenedTriangle);
    if (!isNonRedundant_ || !isRedundant(index, nearest)) return nearest;

    std::vector<TriangleHit>& hits = hitsOfWalk(index);
    tracer_->hitsBetween(view.eyeWorld, direction, first->distance, end, Faces::Drawn, hits);
    for (const TriangleHit& hit : hits) {
        const SurfacePoint point = pointOf(hit.distance, hit.triangle);
        if (!isRedundant(index, point)) return point;
    }
    return std::nullopt;
}

}  // namespace gfxrepro::depth_sampling
