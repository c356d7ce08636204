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
    scene::Mesh mesh = reflections::joined(shapes::sphere(kPot.centre, kPot.radius, 5),
                                           shapes::sphere(kKnob.centre, kKnob.radius, 5));
    mesh.normals = scene::vertexNormals(mesh);
    return mesh;
}

scene::Scene room(bool hasWallAtMinusZ) {
    scene::Scene scene = reflections::mattRoom(kWalls);
    if (!hasWallAtMinusZ) scene.instances.erase(scene.instances.begin() + 4);
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

}  // namespace gfxrepro::clustered_reflections::rooms
