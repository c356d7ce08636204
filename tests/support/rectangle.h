// A mesh of two triangles.
#pragma once

#include "engine/scene/scene.h"

namespace gfxrepro::test {

/// Facing cross(u, v); texture coordinates have v = 0 at the top.
inline scene::Mesh rectangle(const glm::vec3& centre = glm::vec3(0.0F),
                             const glm::vec3& u = {1, 0, 0}, const glm::vec3& v = {0, 1, 0}) {
    scene::Mesh mesh;
    mesh.positions = {centre - u - v, centre + u - v, centre + u + v, centre - u + v};
    mesh.texcoords = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

}  // namespace gfxrepro::test
