// A rectangular light and the views from its points.
#pragma once

#include <vector>

#include "techniques/kit/view.h"

namespace gfxrepro::soft_shadows {

struct AreaLightSettings {
    float sizeRatio = 1.0F;     // diagonal of the light : diagonal of the scene's box; 0: a point
    float height = 1.5F;        // distance of its centre from the box's centre, in box diagonals
    float azimuthRad = 0.6F;    // of the direction to the light, about y, from +z towards +x
    float elevationRad = 1.0F;  // of that direction above the horizon
};

/// A square in space that faces the centre of the scene's box. Corner order: around the square.
struct AreaLight {
    glm::vec3 centre;
    glm::vec3 right;  // half an edge each
    glm::vec3 up;
    scene::Box casters;  // what its views must hold

    glm::vec3 corner(int index) const;  // 0 … 3
    /// Point (i, j) of an n × n grid: the middle of its cell.
    glm::vec3 sample(int i, int j, int n) const;
};

AreaLight makeAreaLight(const scene::Box& casters, const AreaLightSettings& settings);

/// The view from a point on the light towards the centre of the casters; its frustum is as narrow
/// as holds their box (square image, a margin of two pixels). Throws Error when the point lies
/// inside the box: the frustum would have to be wider than half of space.
kit::View lightView(const AreaLight& light, const glm::vec3& point, int sizePx);

}  // namespace gfxrepro::soft_shadows
