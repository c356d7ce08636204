#include "techniques/depth_sampling/reference_views.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "techniques/kit/path_view.h"

namespace gfxrepro::depth_sampling {
namespace {

glm::vec3 turned(const glm::vec3& direction, const glm::vec3& axis, float angleRad) {
    return glm::vec3(glm::rotate(glm::mat4(1.0F), angleRad, axis) * glm::vec4(direction, 0.0F));
}

/// Point i of the R₂ sequence (Roberts 2018): evenly spread over the unit square, any prefix.
glm::vec2 evenlySpread(int i) {
    constexpr double kPlastic = 1.32471795724474602596;
    const double n = i + 1;
    const auto fraction = [](double x) { return static_cast<float>(x - std::floor(x)); };
    return {fraction(0.5 + n / kPlastic), fraction(0.5 + n / (kPlastic * kPlastic))};
}

/// The same over the triangle of barycentric coordinates: the upper half of the square folded down.
glm::vec2 evenlyInTriangle(int i) {
    const glm::vec2 p = evenlySpread(i);
    return p.x + p.y > 1.0F ? 1.0F - p : p;
}

/// Distances from `eye` along the direction to the target between which the whole box lies.
struct DepthRange {
    float nearestM = std::numeric_limits<float>::infinity();
    float farthestM = -std::numeric_limits<float>::infinity();
};

void addDepths(DepthRange& range, const glm::vec3& eye, const glm::vec3& target,
               const scene::Box& box) {
    const glm::vec3 forward = glm::normalize(target - eye);
    for (int corner = 0; corner < 8; ++corner) {
        const float depthM = glm::dot(box.corner(corner) - eye, forward);
        range.nearestM = std::min(range.nearestM, depthM);
        range.farthestM = std::max(range.farthestM, depthM);
    }
}

/// Near and far planes that hold the whole box as seen from every point of the triangle.
void fitPlanes(ViewTriangle& triangle, const scene::Box& box) {
    // Neither extreme lies at a corner of the triangle in general (the centre is the point nearest
    // to the target), so look from a lattice; the margin takes what lies between its points.
    constexpr int kSteps = 8;
    DepthRange range;
    for (int a = 0; a <= kSteps; ++a) {
        for (int b = 0; a + b <= kSteps; ++b) {
            const glm::vec2 at = glm::vec2(a, b) / static_cast<float>(kSteps);
            addDepths(range, cameraAt(triangle, at).position, triangle.centre.target, box);
        }
    }
    addDepths(range, triangle.centre.position, triangle.centre.target, box);
    const float diagonalM = glm::length(box.size());
    scene::Camera& centre = triangle.centre;
    // An eye inside of the box has a near plane at 0.2 % of the diagonal: a nearer one would cost
    // depth precision and show nothing that a reference image is taken for.
    centre.nearM = std::max(range.nearestM - 0.01F * diagonalM, 0.002F * diagonalM);
    centre.farM = std::max(range.farthestM + 0.01F * diagonalM, 2.0F * centre.nearM);
}

/// A camera that looks along its up direction has no right and no left.
void checkUpright(const scene::Camera& camera) {
    const glm::vec3 back = camera.position - camera.target;
    // Sine of the angle, 0.06°: below it, lookAt() loses half of a float's digits.
    constexpr float kMinSine = 0.001F;
    if (glm::length(glm::cross(glm::normalize(camera.up), glm::normalize(back))) >= kMinSine)
        return;
    throw Error(fmt::format(
        "the camera at ({:g}, {:g}, {:g}) looks along its up direction; change 'view' or "
        "'view_pitch_deg'",
        camera.position.x, camera.position.y, camera.position.z));
}

/// Camera i of those that fill the hull of the first min(3, referenceCount) reference views.
scene::Camera cameraInHull(const ViewTriangle& triangle, int referenceCount, int i) {
    if (referenceCount == 1) return triangle.centre;
    if (referenceCount == 2) return cameraAt(triangle, {evenlySpread(i).x, 0.0F});
    return cameraAt(triangle, evenlyInTriangle(i));
}

}  // namespace

ViewTriangle makeViewTriangle(const scene::Scene& scene, const ViewTriangleSettings& settings) {
    const scene::Box box = scene.bounds();
    ViewTriangle triangle;
    triangle.centre = kit::stillCamera(scene, settings.view, settings.aspect);
    scene::Camera& centre = triangle.centre;
    glm::vec3 back = (centre.position - centre.target) * settings.distance;
    checkUpright(centre);
    back = turned(back, glm::normalize(centre.up), settings.yawRad);
    const glm::vec3 rightOfYaw = glm::normalize(glm::cross(centre.up, back));
    back = turned(back, rightOfYaw, -settings.pitchRad);
    centre.position = centre.target + back;

    checkUpright(centre);
    // The triangle's own axes; the views stay upright.
    const glm::vec3 right =
        turned(glm::normalize(glm::cross(centre.up, back)), glm::normalize(back), settings.rollRad);
    const glm::vec3 up = glm::normalize(glm::cross(back, right));
    const float side = settings.spread * glm::length(box.size());
    const float height = side * std::sqrt(3.0F) / 2.0F;
    triangle.corners[0] = centre.position - 0.5F * side * right - height / 3.0F * up;
    triangle.corners[1] = centre.position + 0.5F * side * right - height / 3.0F * up;
    triangle.corners[2] = centre.position + 2.0F / 3.0F * height * up;

    fitPlanes(triangle, box);
    return triangle;
}

scene::Camera cameraAt(const ViewTriangle& triangle, glm::vec2 barycentric) {
    scene::Camera camera = triangle.centre;
    const glm::vec3* v = triangle.corners;
    camera.position = v[0] + barycentric.x * (v[1] - v[0]) + barycentric.y * (v[2] - v[0]);
    return camera;
}

std::vector<scene::Camera> referenceCameras(const ViewTriangle& triangle, int count) {
    if (count == 1) return {triangle.centre};
    std::vector<scene::Camera> cameras;
    for (const glm::vec2 corner : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1)}) {
        if (static_cast<int>(cameras.size()) == count) break;
        cameras.push_back(cameraAt(triangle, corner));
    }
    for (int i = 3; i < count; ++i) cameras.push_back(cameraInHull(triangle, count, i - 3));
    return cameras;
}

std::vector<scene::Camera> candidateCameras(const ViewTriangle& triangle, int referenceCount,
                                            int count) {
    GFXREPRO_ASSERT(count <= kMaxCandidates);
    const int fixed = std::min({3, referenceCount, count});
    std::vector<scene::Camera> cameras = referenceCameras(triangle, fixed);
    for (int i = fixed; i < count; ++i) {
        cameras.push_back(cameraInHull(triangle, referenceCount, i - fixed));
    }
    return cameras;
}

std::vector<scene::Camera> outputCameras(const ViewTriangle& triangle, int referenceCount,
                                         int count) {
    std::vector<scene::Camera> cameras;
    cameras.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
        // Past the points of reference views and candidates: an output frame at a reference view
        // would find every sample.
        cameras.push_back(cameraInHull(triangle, referenceCount, kMaxCandidates + i));
    }
    return cameras;
}

namespace {

/// Whether the nearest surface on the ray is drawn. A thin sheet of two single-sided triangles is
/// met at both at once, in any order; 1e-5: their distances differ by rounding.
bool isDrawn(const raycast::RayTracer& tracer, const glm::vec3& eye, const glm::vec3& direction,
             const raycast::Hit& nearest) {
    const auto drawn = tracer.closestHit(eye, direction, 0.0F, nearest.distance * (1.0F + 1e-5F),
                                         raycast::Faces::Drawn);
    return drawn.has_value();
}

/// How a sparse grid of primary rays meets a scene.
struct FirstHits {
    int all = 0;
    int ofBacks = 0;  // of triangles that are drawn from the front only
};

FirstHits firstHits(const raycast::RayTracer& tracer, const kit::View& view) {
    constexpr int kRays = 32;  // each way: a tenth of a second for 16 views, and no thin miss
    FirstHits hits;
    for (int y = 0; y < kRays; ++y) {
        for (int x = 0; x < kRays; ++x) {
            const glm::vec2 at = (glm::vec2(x, y) + 0.5F) / static_cast<float>(kRays);
            const glm::vec3 direction = rayThrough(view, at * glm::vec2(view.sizePx));
            // From the eye, not from the near plane: a surface in between makes the eye an inside.
            const std::optional<raycast::Hit> hit = tracer.closestHit(view.eyeWorld, direction);
            if (!hit) continue;
            ++hits.all;
            if (!isDrawn(tracer, view.eyeWorld, direction, *hit)) ++hits.ofBacks;
        }
    }
    return hits;
}

}  // namespace

void checkViews(const raycast::RayTracer& tracer, std::span<const kit::View> views) {
    for (std::size_t i = 0; i < views.size(); ++i) {
        const FirstHits hits = firstHits(tracer, views[i]);
        if (2 * hits.ofBacks <= hits.all) continue;
        const glm::vec3& eye = views[i].eyeWorld;
        throw Error(fmt::format(
            "view {} at ({:.4g}, {:.4g}, {:.4g}) is inside of geometry or looks at an open surface "
            "from behind: {} of {} rays that meet the scene meet the back of a single-sided "
            "triangle first; change 'view_distance', 'view_spread', 'view_yaw_deg' or "
            "'view_pitch_deg', or make the material double-sided",
            i, eye.x, eye.y, eye.z, hits.ofBacks, hits.all));
    }
}

}  // namespace gfxrepro::depth_sampling
