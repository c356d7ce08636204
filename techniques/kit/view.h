// A pinhole view of a given size in pixels.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>

#include "engine/scene/scene.h"

namespace gfxrepro::kit {

/// Pixel coordinates are continuous; pixel (x, y) covers [x, x + 1) × [y, y + 1), its sample lies
/// at its centre, and y grows upwards: (0, 0) is the lower left corner of the image, as GL has it.
struct View {
    glm::vec3 eyeWorld{0.0F};
    glm::mat4 viewFromWorld{1.0F};  // looks along −z
    glm::mat4 clipFromView{1.0F};   // clip z from −w (near) to w (far)
    glm::ivec2 sizePx{0};
    float nearM = 0.0F;  // eye distance along the view axis
    float farM = 0.0F;

    glm::mat4 clipFromWorld() const { return clipFromView * viewFromWorld; }
    bool operator==(const View&) const = default;
};

/// Planes a·x + b·y + c·z + d ≥ 0 of what the view holds, in world space, of unit normals: −w ≤ x,
/// y, z ≤ w, a plane each, from the rows of the matrix to clip space (Gribb and Hartmann 2001).
std::array<glm::vec4, 6> frustumPlanes(const View& view);

/// The view of a camera, its samples moved by `offsetPx` (see withOffset).
View viewOf(const scene::Camera& camera, glm::ivec2 sizePx, glm::vec2 offsetPx = glm::vec2(0.0F));

/// The same view with its samples moved: pixel p samples where p + offsetPx does in `view` (half a
/// pixel makes the offset image H of [xie2017] algorithm 4).
View withOffset(View view, glm::vec2 offsetPx);

/// Where a point lands, in pixel coordinates; may lie outside of the image. Nothing for points on
/// or behind the plane through the eye.
std::optional<glm::vec2> project(const View& view, const glm::vec3& pointWorld);

/// The pixel whose square holds the projection; nothing when that is outside of the image.
std::optional<glm::ivec2> pixelOf(const View& view, const glm::vec3& pointWorld);
/// The same by View::clipFromWorld(), for who asks of many points.
std::optional<glm::ivec2> pixelOf(const glm::mat4& clipFromWorld, glm::ivec2 sizePx,
                                  const glm::vec3& pointWorld);

/// The width of a pixel at a distance of 1 along the view axis.
float footprintPerDepth(const View& view);

/// The unit direction from the eye through a position in pixel coordinates.
glm::vec3 rayThrough(const View& view, const glm::vec2& positionPx);

/// The point seen at a position in pixel coordinates at `depthM`, the distance along the view axis.
glm::vec3 unproject(const View& view, const glm::vec2& positionPx, float depthM);

/// The distance along the view axis of a window z, 0 where it is 1: nothing is there.
inline float depthOfWindow(const View& view, float windowZ) {
    const double n = view.nearM, f = view.farM;
    return windowZ == 1.0F ? 0.0F : static_cast<float>(n * f / (f - double{windowZ} * (f - n)));
}

/// Takes (x·d, y·d, d, 1) to the point of the world that is seen at pixel coordinates (x, y) and
/// the distance d along the view axis.
glm::mat4 worldFromPixels(const View& view);

/// Takes a sample of `from` to `to`: (x·d, y·d, d, 1) becomes (x'·d', y'·d', d', 1), (x, y) being
/// pixel coordinates and d the distance along the view axis. Worked out in double precision:
/// between equal views it is the identity. For reproject() of kit/redundancy_tests.glsl.
glm::mat4 reprojection(const View& from, const View& to);

}  // namespace gfxrepro::kit
