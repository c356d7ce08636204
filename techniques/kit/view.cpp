#include "techniques/kit/view.h"

#include <glm/gtc/matrix_transform.hpp>

namespace gfxrepro::kit {

namespace {

/// From world space to (x·d, y·d, d, 1) of reprojection().
glm::dmat4 pixelsFromWorld(const View& view) {
    // Row by row of clip: x·d = (clip.x + clip.w) · width / 2, d = clip.w.
    glm::dmat4 pixelsFromClip(0.0);
    pixelsFromClip[0].x = 0.5 * view.sizePx.x;
    pixelsFromClip[1].y = 0.5 * view.sizePx.y;
    pixelsFromClip[3] = {0.5 * view.sizePx.x, 0.5 * view.sizePx.y, 1.0, 0.0};
    glm::dmat4 result =
        pixelsFromClip * glm::dmat4(view.clipFromView) * glm::dmat4(view.viewFromWorld);
    for (int column = 0; column < 4; ++column) result[column].w = column == 3 ? 1.0 : 0.0;
    return result;
}

}  // namespace

std::array<glm::vec4, 6> frustumPlanes(const View& view) {
    const glm::mat4 rows = glm::transpose(view.clipFromWorld());
    std::array<glm::vec4, 6> planes;
    for (int axis = 0; axis < 3; ++axis) {
        planes[static_cast<std::size_t>(2 * axis)] = rows[3] + rows[axis];
        planes[static_cast<std::size_t>(2 * axis) + 1] = rows[3] - rows[axis];
    }
    for (glm::vec4& plane : planes) plane /= glm::length(glm::vec3(plane));
    return planes;
}

View viewOf(const scene::Camera& camera, glm::ivec2 sizePx, glm::vec2 offsetPx) {
    View view;
    view.eyeWorld = camera.position;
    view.viewFromWorld = glm::lookAt(camera.position, camera.target, camera.up);
    view.sizePx = sizePx;
    view.nearM = camera.nearM;
    view.farM = camera.farM;
    const float aspect = static_cast<float>(sizePx.x) / static_cast<float>(sizePx.y);
    view.clipFromView = glm::perspective(camera.verticalFovRad, aspect, camera.nearM, camera.farM);
    return withOffset(view, offsetPx);
}

View withOffset(View view, glm::vec2 offsetPx) {
    // A point seen offsetPx further right and up lands in the middle of the pixel: the image moves
    // left and down. w = −z, so the shift in normalized coordinates goes into the third column.
    const glm::vec2 shift = 2.0F * offsetPx / glm::vec2(view.sizePx);
    view.clipFromView[2].x += shift.x;
    view.clipFromView[2].y += shift.y;
    return view;
}

namespace {

std::optional<glm::vec2> project(const glm::mat4& clipFromWorld, glm::ivec2 sizePx,
                                 const glm::vec3& pointWorld) {
    const glm::vec4 clip = clipFromWorld * glm::vec4(pointWorld, 1.0F);
    if (clip.w <= 0.0F) return std::nullopt;
    return (glm::vec2(clip) / clip.w * 0.5F + 0.5F) * glm::vec2(sizePx);
}

}  // namespace

std::optional<glm::vec2> project(const View& view, const glm::vec3& pointWorld) {
    return project(view.clipFromWorld(), view.sizePx, pointWorld);
}

std::optional<glm::ivec2> pixelOf(const View& view, const glm::vec3& pointWorld) {
    return pixelOf(view.clipFromWorld(), view.sizePx, pointWorld);
}

std::optional<glm::ivec2> pixelOf(const glm::mat4& clipFromWorld, glm::ivec2 sizePx,
                                  const glm::vec3& pointWorld) {
    const std::optional<glm::vec2> position = project(clipFromWorld, sizePx, pointWorld);
    if (!position) return std::nullopt;
    const glm::vec2 size(sizePx);
    if (position->x < 0.0F || position->y < 0.0F || position->x >= size.x ||
        position->y >= size.y) {
        return std::nullopt;
    }
    return glm::ivec2(*position);
}

float footprintPerDepth(const View& view) {
    return 2.0F / (view.clipFromView[0].x * static_cast<float>(view.sizePx.x));
}

glm::vec3 rayThrough(const View& view, const glm::vec2& positionPx) {
    return glm::normalize(unproject(view, positionPx, 1.0F) - view.eyeWorld);
}

glm::vec3 unproject(const View& view, const glm::vec2& positionPx, float depthM) {
    const glm::vec2 ndc = positionPx / glm::vec2(view.sizePx) * 2.0F - 1.0F;
    const glm::mat4& p = view.clipFromView;
    // clip.xy = p[0].x · x + p[2].x · z …, w = −z = depth
    const glm::vec3 pointView((ndc.x + p[2].x) * depthM / p[0].x,
                              (ndc.y + p[2].y) * depthM / p[1].y, -depthM);
    const glm::mat3 rotation(view.viewFromWorld);
    return glm::transpose(rotation) * (pointView - glm::vec3(view.viewFromWorld[3]));
}

glm::mat4 worldFromPixels(const View& view) {
    return glm::mat4(glm::inverse(pixelsFromWorld(view)));
}

glm::mat4 reprojection(const View& from, const View& to) {
    return glm::mat4(pixelsFromWorld(to) * glm::inverse(pixelsFromWorld(from)));
}

}  // namespace gfxrepro::kit
