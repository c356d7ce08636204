// Where the reference images are taken from, and the output frames between them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/raycast/ray_tracer.h"
#include "engine/scene/scene.h"
#include "techniques/kit/view.h"

namespace gfxrepro::depth_sampling {

/// The triangle V₀V₁V₂ before the scene ([xie2017] Fig. 8). Its centre is where the camera of
/// `view` stands (kit::stillCamera()); all views look at that camera's target.
struct ViewTriangle {
    scene::Camera centre;
    glm::vec3 corners[3];
};

struct ViewTriangleSettings {
    float spread = 0.5F;    // side of the triangle, in diagonals of the scene's box
    float distance = 1.0F;  // factor on the camera's distance from its target
    float yawRad = 0.0F;    // turns the camera about its target, about the up axis
    float pitchRad = 0.0F;  // … and about its right axis, upwards
    float rollRad = 0.0F;   // turns the triangle in its plane, counter-clockwise seen from the eye
    float aspect = 1.0F;    // width : height
    std::string view;
};

/// Equilateral, upright, across the direction of view. Near and far planes are fitted to the scene
/// from every point of the triangle. Throws Error when the camera looks along its up direction, and
/// as kit::stillCamera().
ViewTriangle makeViewTriangle(const scene::Scene& scene, const ViewTriangleSettings& settings);

/// The camera at barycentric coordinates (a, b) of corners 1 and 2.
scene::Camera cameraAt(const ViewTriangle& triangle, glm::vec2 barycentric);

/// n reference cameras: n = 1 the centre, n = 2 the corners V₀ and V₁, n ≥ 3 the corners and then a
/// low-discrepancy sequence inside.
std::vector<scene::Camera> referenceCameras(const ViewTriangle& triangle, int count);

/// Most places to choose reference views from.
constexpr int kMaxCandidates = 64;

/// `count` places to choose reference views from: the fixed ones, three at most, then more that
/// fill their hull evenly.
std::vector<scene::Camera> candidateCameras(const ViewTriangle& triangle, int referenceCount,
                                            int count);

/// `count` output cameras that fill the hull of the first min(3, referenceCount) reference views
/// evenly (point, segment or triangle; the R₂ sequence, folded).
std::vector<scene::Camera> outputCameras(const ViewTriangle& triangle, int referenceCount,
                                         int count);

// Whether reference views stand where a depth image can be taken.

/// Throws Error, naming the view and what to change, for the first view more than half of whose
/// rays that meet anything first meet the back of a single-sided triangle. The eye is then inside
/// of a closed surface, or looks at an open one from behind: culling would show the scene without
/// what is nearest, and no measure would mean anything. A view without any hit passes.
void checkViews(const raycast::RayTracer& tracer, std::span<const kit::View> views);

}  // namespace gfxrepro::depth_sampling
