// Small meshes with known answers.
#pragma once

#include "engine/core/random.h"
#include "engine/scene/scene.h"

namespace gfxrepro::voxelization::shapes {

/// Axis-aligned, 12 triangles, closed.
scene::Mesh cube(const glm::vec3& low, const glm::vec3& high);
/// An icosahedron subdivided `levels` times: 20 · 4^levels triangles, closed.
scene::Mesh sphere(const glm::vec3& centre, float radius, int levels);
/// Around y through `centre`, closed.
scene::Mesh torus(const glm::vec3& centre, float radius, float tube, int around, int across);
/// Unconnected triangles within [0, 1]³; every fourth is a sliver, every eighth without area (a
/// segment or a point).
scene::Mesh randomTriangles(int count, std::uint64_t seed);
/// Several meshes as one.
scene::Mesh joined(const scene::Mesh& a, const scene::Mesh& b);

}  // namespace gfxrepro::voxelization::shapes
