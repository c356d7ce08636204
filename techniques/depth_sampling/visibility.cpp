#include "techniques/depth_sampling/visibility.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/core/error.h"
#include "techniques/kit/depth_image_renderer.h"

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
                                       bool isNonRedundant)
    : tracer_(&tracer),
      views_(std::move(views)),
      isNonRedundant_(isNonRedundant),
      isPeeling_(isNonRedundant && std::ranges::all_of(views_, [&](const View& view) {
                     return isSameView(view, views_.front());
                 })) {
    for (const View& view : views_) clipFromWorld_.push_back(view.clipFromWorld());
}

struct VisibilitySequence::Target {
    glm::vec3 positionWorld;
    unsigned number;  // of its triangle
    raycast::WorldTriangle triangle;
};

VisibilitySequence::Target VisibilitySequence::targetOf(const SurfacePoint& point) const {
    GFXREPRO_ASSERT(point.triangleId > 0);
    const unsigned number = point.triangleId - 1;
    return {point.positionWorld, number, tracer_->triangle(number)};
}

/// Nothing where the image cannot hold the point: outside of its frustum, or turned away.
std::optional<VisibilitySequence::Sight> VisibilitySequence::sightOf(std::size_t index,
                                                                     const Target& target) const {
    const View& view = views_[index];
    if (!kit::pixelOf(clipFromWorld_[index], view.sizePx, target.positionWorld)) {
        return std::nullopt;
    }
    const glm::vec3 towards = target.positionWorld - view.eyeWorld;
    const float depthM = glm::dot(towards, forwardOf(view));
    if (depthM < view.nearM || depthM > view.farM) return std::nullopt;
    if (!target.triangle.isDrawnFrom(view.eyeWorld)) return std::nullopt;
    const float distance = glm::length(towards);
    return Sight{view.eyeWorld, towards, view.nearM * (distance / depthM), distance};
}

/// [xie2017] Algorithm 2: the ray from Vⱼ to the point meets nothing before it.
bool VisibilitySequence::isVisible(std::size_t index, const Target& target) const {
    const auto sight = sightOf(index, target);
    // The point's own triangle cannot hide it, however grazing the ray.
    return sight && !tracer_->isOccluded(sight->eye, sight->direction, sight->begin, sight->end(),
                                         Faces::Drawn, target.number);
}

bool VisibilitySequence::isVisibleFromOneOf(std::size_t count, const SurfacePoint& point) const {
    const Target target = targetOf(point);
    for (std::size_t j = 0; j < count; ++j) {
        if (isVisible(j, target)) return true;
    }
    return false;
}

/// What a ray meets before a point, nearest first. Good until the thread asks again.
const std::vector<TriangleHit>& VisibilitySequence::hitsBefore(const Sight& sight,
                                                               const SurfacePoint& point) const {
    thread_local std::vector<TriangleHit> hits;
    tracer_->hitsBetween(sight.eye, sight.direction, sight.begin, sight.end(), Faces::Drawn, hits);
    std::erase_if(hits, [&](const TriangleHit& h) { return h.triangle == point.triangleId - 1; });
    return hits;
}

/// Whether image j holds the point unless an earlier view sees it: whether one does see all that
/// lies before the point on the ray from Vⱼ.
bool VisibilitySequence::isFirstNew(std::size_t index, const SurfacePoint& point) const {
    const auto sight = sightOf(index, targetOf(point));
    if (!sight) return false;
    // From the back, where hits are hidden most often: the first that no view sees decides.
    const std::vector<TriangleHit>& hits = hitsBefore(*sight, point);
    const glm::vec3 unit = sight->direction / sight->distance;
    return std::all_of(hits.rbegin(), hits.rend(), [&](const TriangleHit& hit) {
        return isVisibleFromOneOf(index, {sight->eye + hit.distance * unit, hit.triangle + 1});
    });
}

/// How many surfaces lie before the point; nothing where no layer can hold it.
std::optional<std::size_t> VisibilitySequence::layerOf(const SurfacePoint& point) const {
    const auto sight = sightOf(0, targetOf(point));
    if (!sight) return std::nullopt;
    const std::vector<TriangleHit>& hits = hitsBefore(*sight, point);
    std::size_t layer = 0;
    float distance = sight->distance;
    for (auto hit = hits.rbegin(); hit != hits.rend(); ++hit) {
        if (hit->distance >= strictlyBefore(distance, sight->eye)) continue;
        distance = hit->distance;
        ++layer;
    }
    return layer;
}

bool VisibilitySequence::isRedundant(std::size_t count, const SurfacePoint& point) const {
    // Departure [xie2017] Algorithm 2: a layer is tested against the layers before, of whose one
    // view the algorithm would see the first alone.
    if (isPeeling_) return anyHolds(count, point);
    return isVisibleFromOneOf(count, point);
}

bool VisibilitySequence::anyHolds(std::size_t count, const SurfacePoint& point) const {
    if (isPeeling_) {
        const auto layer = layerOf(point);
        return layer && *layer < count;
    }
    // The first view that sees a point has it in its image; this settles most points.
    if (isVisibleFromOneOf(count, point)) return true;
    for (std::size_t j = 1; isNonRedundant_ && j < count; ++j) {
        if (isFirstNew(j, point)) return true;
    }
    return false;
}

bool VisibilitySequence::holds(std::size_t index, const SurfacePoint& point) const {
    if (isPeeling_) return layerOf(point) == index;
    if (!isNonRedundant_) return isVisible(index, targetOf(point));
    return isFirstNew(index, point) && !isVisibleFromOneOf(index, point);
}

std::optional<std::size_t> VisibilitySequence::visibleFrom(const SurfacePoint& point,
                                                           std::size_t first) const {
    const std::size_t count = views_.size();
    const Target target = targetOf(point);
    // What hid the point from the last views mostly hides it from the next one, and is quicker to
    // ask than all of the scene.
    std::array<raycast::WorldTriangle, 4> hiders{};
    std::size_t oldest = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t index = (first + i) % count;
        const auto sight = sightOf(index, target);
        if (!sight) continue;
        const auto& [eye, direction, begin, distance] = *sight;
        const float end = sight->end();
        const auto isHider = [&](const raycast::WorldTriangle& triangle) {
            return triangle.isClearlyHit(eye, direction, begin, end);
        };
        if (std::ranges::any_of(hiders, isHider)) continue;
        const auto hider =
            tracer_->occluder(eye, direction, begin, end, Faces::Drawn, target.number);
        if (!hider) return index;
        hiders[oldest] = tracer_->triangle(*hider);
        oldest = (oldest + 1) % hiders.size();
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

    std::vector<TriangleHit> hits;
    tracer_->hitsBetween(view.eyeWorld, direction, first->distance, end, Faces::Drawn, hits);
    for (const TriangleHit& hit : hits) {
        const SurfacePoint point = pointOf(hit.distance, hit.triangle);
        if (!isRedundant(index, point)) return point;
    }
    return std::nullopt;
}

namespace {

glm::vec3 unitOr(const glm::vec3& vector, const glm::vec3& otherwise) {
    const float length = glm::length(vector);
    return length > 0.0F ? vector / length : otherwise;
}

/// Weights of the corners at the point of the triangle's plane nearest to `point`.
glm::dvec3 barycentricAt(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                         const glm::dvec3& point) {
    const glm::dvec3 twiceArea = glm::cross(b - a, c - a);
    const double squared = glm::dot(twiceArea, twiceArea);
    if (squared == 0.0) return {1.0, 0.0, 0.0};
    const double ofB = glm::dot(glm::cross(point - a, c - a), twiceArea) / squared;
    const double ofC = glm::dot(glm::cross(b - a, point - a), twiceArea) / squared;
    return {1.0 - ofB - ofC, ofB, ofC};
}

glm::u8vec4 quantized(const glm::vec3& radiance) {
    return {glm::u8vec3(glm::clamp(radiance, 0.0F, 1.0F) * 255.0F + 0.5F), 255};
}

}  // namespace

SurfaceShading::SurfaceShading(const scene::Scene& scene) {
    // Vertices in the order of flattened(), which drops attributes that not all meshes have.
    scene::Mesh mesh = flattened(scene);
    positions_ = std::move(mesh.positions);
    triangles_ = std::move(mesh.triangles);
    for (const scene::Instance& instance : scene.instances) {
        const scene::Mesh& part = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        const scene::Material material = materialOf(scene, part);
        const glm::mat3 toWorld = scene::normalMatrix(glm::mat3(instance.worldFromMesh));
        for (std::size_t v = 0; v < part.positions.size(); ++v) {
            normals_.push_back(part.normals.empty() ? glm::vec3(0.0F) : toWorld * part.normals[v]);
            colors_.push_back(glm::vec3(material.baseColor) *
                              (part.colors.empty() ? glm::vec3(1.0F) : part.colors[v]));
        }
        isDoubleSided_.insert(isDoubleSided_.end(), part.triangles.size(), material.isDoubleSided);
    }
}

glm::vec3 SurfaceShading::radiance(const SurfacePoint& point, const glm::vec3& eyeWorld) const {
    const std::size_t number = point.triangleId - 1;
    const glm::uvec3 t = triangles_[number];
    const glm::dvec3 a(positions_[t.x]);
    const glm::dvec3 b(positions_[t.y]);
    const glm::dvec3 c(positions_[t.z]);
    const glm::vec3 weights(barycentricAt(a, b, c, glm::dvec3(point.positionWorld)));
    const auto interpolated = [&](const std::vector<glm::vec3>& values) {
        return weights.x * values[t.x] + weights.y * values[t.y] + weights.z * values[t.z];
    };
    const glm::vec3 ofTriangle = unitOr(glm::vec3(glm::cross(b - a, c - a)), glm::vec3(0.0F));
    glm::vec3 normal = unitOr(interpolated(normals_), ofTriangle);
    if (isDoubleSided_[number] && glm::dot(normal, eyeWorld - point.positionWorld) < 0.0F) {
        normal = -normal;
    }
    const float light = std::max(glm::dot(normal, kit::kLightDirectionWorld), 0.0F);
    return interpolated(colors_) * (0.3F + 0.7F * light);
}

ImageSamples samplesOf(const VisibilitySequence& sequence, std::size_t index) {
    const glm::ivec2 size = sequence.views()[index].sizePx;
    ImageSamples samples{index, std::vector<SurfacePoint>(static_cast<std::size_t>(size.x) *
                                                          static_cast<std::size_t>(size.y))};
    tbb::parallel_for(0, size.y, [&](int y) {
        for (int x = 0; x < size.x; ++x) {
            const auto point = sequence.sample(index, {x, y});
            if (point) samples.points[static_cast<std::size_t>(y) * size.x + x] = *point;
        }
    });
    return samples;
}

kit::HostDepthImage rayCastImage(const View& view, const ImageSamples& samples,
                                 const SurfaceShading& shading) {
    kit::HostDepthImage image;
    image.view = view;
    const std::size_t pixelCount = samples.points.size();
    image.shading.assign(pixelCount, glm::u8vec4(0));
    image.depthM.assign(pixelCount, 0.0F);
    image.triangleId.assign(pixelCount, 0);
    tbb::parallel_for(std::size_t{0}, pixelCount, [&](std::size_t at) {
        const SurfacePoint& point = samples.points[at];
        if (point.triangleId == 0) return;
        image.shading[at] = quantized(shading.radiance(point, view.eyeWorld));
        image.depthM[at] = -(view.viewFromWorld * glm::vec4(point.positionWorld, 1.0F)).z;
        image.triangleId[at] = point.triangleId;
    });
    return image;
}

std::vector<std::uint32_t> markedSamples(const VisibilitySequence& sequence,
                                         const ImageSamples& samples,
                                         const VisibilitySequence& conventional,
                                         std::size_t conventionalCount,
                                         const VisibilitySequence& outputs) {
    const std::size_t index = samples.index;
    const glm::ivec2 size = sequence.views()[index].sizePx;
    std::vector<std::uint32_t> marks(samples.points.size());
    // The nearest points on a view's rays are what its conventional image holds, whatever rounding
    // makes of a ray that is cast to one of them again.
    const bool isConventional = index == 0 && conventionalCount > 0 &&
                                isSameView(sequence.views()[0], conventional.views()[0]);
    tbb::parallel_for(0, size.y, [&](int y) {
        std::size_t frameBefore = 0;
        for (int x = 0; x < size.x; ++x) {
            const std::size_t at = static_cast<std::size_t>(y) * size.x + x;
            const SurfacePoint& point = samples.points[at];
            if (point.triangleId == 0) continue;
            std::uint32_t& mark = marks[at];
            mark = kSample;
            if (sequence.isRedundant(index, point)) mark |= kRedundant;
            if (isConventional || conventional.anyHolds(conventionalCount, point)) continue;
            mark |= kOccluded;
            const auto frame = outputs.visibleFrom(point, frameBefore);
            if (!frame) continue;
            mark |= kUseful;
            frameBefore = *frame;
        }
    });
    return marks;
}

ImageCounts countsOf(std::span<const std::uint32_t> marks) {
    const auto having = [&](std::uint32_t bit) {
        return static_cast<std::uint64_t>(
            std::ranges::count_if(marks, [&](std::uint32_t mark) { return (mark & bit) != 0; }));
    };
    return {having(kSample), having(kRedundant), having(kOccluded), having(kUseful)};
}

std::vector<FrameCounts> countAvailable(const VisibilitySequence& sequence,
                                        const VisibilitySequence& outputs) {
    std::vector<FrameCounts> frames(outputs.views().size());
    const std::size_t imageCount = sequence.views().size();
    tbb::parallel_for(std::size_t{0}, frames.size(), [&](std::size_t frame) {
        const glm::ivec2 size = outputs.views()[frame].sizePx;
        FrameCounts counts;
        for (int y = 0; y < size.y; ++y) {
            for (int x = 0; x < size.x; ++x) {
                const auto point = outputs.sample(frame, {x, y});
                if (!point) continue;
                ++counts.samples;
                counts.available += sequence.anyHolds(imageCount, *point) ? 1 : 0;
            }
        }
        frames[frame] = counts;
    });
    return frames;
}

}  // namespace gfxrepro::depth_sampling
