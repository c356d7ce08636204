#include "tests/techniques/clustered_reflections/mirror_rooms.h"

#include <utility>

#include "tests/techniques/reflections/traced_scenes.h"
#include "tests/techniques/voxelization/shapes.h"

namespace gfxrepro::clustered_reflections::rooms {

namespace shapes = voxelization::shapes;

void add(scene::Scene& scene, scene::Mesh mesh, const glm::vec3& colour, Surface surface) {
    scene::Material material = reflections::matt(colour);
    if (surface == Surface::Mirror) {
        material.metallic = 1.0F;
        material.roughness = 0.0F;
    }
    reflections::addPart(scene, std::move(mesh), material);
}

scene::Mesh rectangle(const glm::vec3& centre, const glm::vec3& u, const glm::vec3& v) {
    scene::Mesh mesh = reflections::rectangle(centre, u, v);
    mesh.normals.assign(4, glm::normalize(glm::cross(u, v)));
    return mesh;
}

scene::Mesh bowl(const glm::vec3& centre, float radius) {
    return reflections::dome(centre, -radius, 0.45F * glm::pi<float>(), 64, 24);
}

scene::Mesh potAndKnob() {
    scene::Mesh pot = shapes::sphere(kPot.centre, kPot.radius, 5);
    const scene::Mesh knob = shapes::sphere(kKnob.centre, kKnob.radius, 5);
    const auto count = static_cast<unsigned>(pot.positions.size());
    pot.positions.insert(pot.positions.end(), knob.positions.begin(), knob.positions.end());
    for (const glm::uvec3& t : knob.triangles) pot.triangles.push_back(t + count);
    pot.normals = scene::vertexNormals(pot);
    return pot;
}

scene::Scene room(bool hasWallAtMinusZ) {
    scene::Scene scene;
    scene.name = "room";
    for (int wall = 0; wall < 6; ++wall) {
        const int axis = wall / 2;
        if (wall == 4 && !hasWallAtMinusZ) continue;
        glm::vec3 centre(0.0F), u(0.0F), v(0.0F);
        centre[axis] = (wall % 2 == 0 ? -1.0F : 1.0F) * kHalfSize[axis];
        u[(axis + 1) % 3] = kHalfSize[(axis + 1) % 3];
        v[(axis + 2) % 3] = (wall % 2 == 0 ? 1.0F : -1.0F) * kHalfSize[(axis + 2) % 3];
        add(scene, rectangle(centre, u, v), kWallColours[wall]);
    }
    scene.lights.push_back({{0.3F, 1.2F, 0.4F}, glm::vec3(0.5F), 1.5F});
    scene.lights.push_back({{-1.0F, 0.5F, -0.5F}, {0.3F, 0.2F, 0.1F}, 1.0F});
    return scene;
}

void addFurniture(scene::Scene& scene) {
    add(scene, shapes::cube({-1.2F, -1.5F, -0.6F}, {-0.5F, -0.8F, 0.2F}), {0.2F, 0.6F, 0.7F});
    add(scene, shapes::sphere({0.8F, -1.0F, -0.4F}, 0.5F, 4), {0.8F, 0.3F, 0.6F});
    add(scene, shapes::cube({0.0F, -1.5F, 0.9F}, {0.1F, 1.0F, 1.0F}), {0.9F, 0.9F, 0.2F});
}

scene::Scene mirroredInZ(const scene::Scene& scene, float plane) {
    scene::Scene mirrored = scene;
    glm::mat4 mirror(1.0F);
    mirror[2].z = -1.0F;
    mirror[3].z = 2.0F * plane;
    for (scene::Instance& instance : mirrored.instances) {
        instance.worldFromMesh = mirror * instance.worldFromMesh;
    }
    for (scene::PointLight& light : mirrored.lights) {
        light.position.z = 2.0F * plane - light.position.z;
    }
    return mirrored;
}

WallHit wallHit(const glm::vec3& origin, const glm::vec3& direction) {
    const reflections::WallHit hit =
        reflections::wallHit({-kHalfSize, kHalfSize}, origin, direction);
    return {glm::vec3(hit.position), hit.normal, kWallColours[hit.side]};
}

}  // namespace gfxrepro::clustered_reflections::rooms
