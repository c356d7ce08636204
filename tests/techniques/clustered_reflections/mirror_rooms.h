// A box of a room with reflectors in it, whose reflections are known.
#pragma once

#include "engine/scene/scene.h"

namespace gfxrepro::clustered_reflections::rooms {

const scene::Box kWalls{glm::vec3(-2.0F, -1.5F, -2.0F), glm::vec3(2.0F, 1.5F, 2.0F)};

enum class Surface { Diffuse, Mirror };

/// Adds a mesh with one instance.
void add(scene::Scene& scene, scene::Mesh mesh, const glm::vec3& colour,
         Surface surface = Surface::Diffuse);

/// A rectangle of 2 · extents, its normal cross(u, v).
scene::Mesh rectangle(const glm::vec3& centre, const glm::vec3& u, const glm::vec3& v);
/// A bowl: the lower part of a sphere, open upwards, with normals inwards.
scene::Mesh bowl(const glm::vec3& centre, float radius);

/// A pot and, above it, its knob: two balls that do not touch, one mesh.
struct Ball {
    glm::vec3 centre;
    float radius;
};
constexpr Ball kPot{{0.0F, -0.4F, 0.0F}, 0.4F}, kKnob{{0.0F, 0.3F, 0.0F}, 0.2F};
scene::Mesh potAndKnob();

/// mattRoom() of kWalls with two lights.
scene::Scene room(bool hasWallAtMinusZ = true);
/// A block, a ball and a pole on the floor.
void addFurniture(scene::Scene& scene);
/// The same scene behind a mirror in the plane z = `plane`.
scene::Scene mirroredInZ(const scene::Scene& scene, float plane);

}  // namespace gfxrepro::clustered_reflections::rooms
