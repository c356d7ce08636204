#include "techniques/depth_sampling/reference_views.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

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

/// Near and far planes that hold the whole box as seen from `eye` towards the target.
void fitPlanes(scene::Camera& camera, const scene::Box& box) {
    const glm::vec3 forward = glm::normalize(camera.target - camera.position);
    float nearest = std::numeric_limits<float>::infinity();
    float farthest = 0.0F;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 point((corner & 1) != 0 ? box.max.x : box.min.x,
                              (corner & 2) != 0 ? box.max.y : box.min.y,
                              (corner & 4) != 0 ? box.max.z : box.min.z);
        const float distance = glm::dot(point - camera.position, forward);
        nearest = std::min(nearest, distance);
        farthest = std::max(farthest, distance);
    }
    const float diagonal = glm::length(box.size());
    camera.nearM = std::max(nearest - 0.01F * diagonal, 0.002F * diagonal);
    camera.farM = std::max(farthest + 0.01F * diagonal, 2.0F * camera.nearM);
}

}  // namespace

ViewTriangle makeViewTriangle(const scene::Scene& scene, const ViewTriangleSettings& settings) {
    const scene::Box box = scene.bounds();
    ViewTriangle triangle;
    triangle.centre =
        scene.cameras.empty() ? scene::framingCamera(box, settings.aspect) : scene.cameras.front();
    scene::Camera& centre = triangle.centre;
    glm::vec3 back = (centre.position - centre.target) * settings.distance;
    back = turned(back, glm::normalize(centre.up), settings.yawRad);
    const glm::vec3 rightOfYaw = glm::normalize(glm::cross(centre.up, back));
    back = turned(back, rightOfYaw, -settings.pitchRad);
    centre.position = centre.target + back;

    const glm::vec3 right = glm::normalize(glm::cross(centre.up, back));
    const glm::vec3 up = glm::normalize(glm::cross(back, right));
    const float side = settings.spread * glm::length(box.size());
    const float height = side * std::sqrt(3.0F) / 2.0F;
    triangle.corners[0] = centre.position - 0.5F * side * right - height / 3.0F * up;
    triangle.corners[1] = centre.position + 0.5F * side * right - height / 3.0F * up;
    triangle.corners[2] = centre.position + 2.0F / 3.0F * height * up;

    for (const glm::vec3& corner : triangle.corners) {
        scene::Camera at = centre;
        at.position = corner;
        fitPlanes(at, box);
        if (&corner == &triangle.corners[0]) {
            centre.nearM = at.nearM;
            centre.farM = at.farM;
        }
        centre.nearM = std::min(centre.nearM, at.nearM);
        centre.farM = std::max(centre.farM, at.farM);
    }
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
    for (int i = 3; i < count; ++i) {
        cameras.push_back(cameraAt(triangle, evenlyInTriangle(i - 3)));
    }
    return cameras;
}

std::vector<scene::Camera> outputCameras(const ViewTriangle& triangle, int referenceCount,
                                         int count) {
    std::vector<scene::Camera> cameras;
    for (int i = 0; i < count; ++i) {
        if (referenceCount == 1) {
            cameras.push_back(triangle.centre);
        } else if (referenceCount == 2) {
            cameras.push_back(cameraAt(triangle, {evenlySpread(i).x, 0.0F}));
        } else {
            cameras.push_back(cameraAt(triangle, evenlyInTriangle(i)));
        }
    }
    return cameras;
}

}  // namespace gfxrepro::depth_sampling
