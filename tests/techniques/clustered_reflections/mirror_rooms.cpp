#include "tests/techniques/clustered_reflections/mirror_rooms.h"

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <utility>

#include "tests/techniques/voxelization/shapes.h"

namespace gfxrepro::clustered_reflections::rooms {

namespace shapes = voxelization::shapes;

void add(scene::Scene& scene, scene::Mesh mesh, const glm::vec3& colour, Surface surface) {
    scene::Material material;
    material.baseColor = glm::vec4(colour, 1.0F);
    if (surface == Surface::Mirror) {
        material.metallic = 1.0F;
        material.roughness = 0.0F;
    }
    mesh.material = static_cast<int>(scene.materials.size());
    scene.materials.push_back(material);
    scene.instances.push_back({static_cast<int>(scene.meshes.size()), glm::mat4(1.0F)});
    scene.meshes.push_back(std::move(mesh));
}

scene::Mesh rectangle(const glm::vec3& centre, const glm::vec3& u, const glm::vec3& v) {
    scene::Mesh mesh;
    mesh.positions = {centre - u - v, centre + u - v, centre + u + v, centre - u + v};
    mesh.normals.assign(4, glm::normalize(glm::cross(u, v)));
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

scene::Mesh bowl(const glm::vec3& centre, float radius) {
    constexpr unsigned kAround = 64, kDown = 24;
    scene::Mesh mesh;
    for (unsigned j = 0; j <= kDown; ++j) {
        for (unsigned i = 0; i <= kAround; ++i) {
            const float longitude = glm::two_pi<float>() * static_cast<float>(i) / kAround;
            const float polar = 0.45F * glm::pi<float>() * static_cast<float>(j) / kDown;
            const glm::vec3 outwards(std::sin(polar) * std::cos(longitude), -std::cos(polar),
                                     std::sin(polar) * std::sin(longitude));
            mesh.positions.push_back(centre + radius * outwards);
            mesh.normals.push_back(-outwards);
        }
    }
    for (unsigned j = 0; j < kDown; ++j) {
        for (unsigned i = 0; i < kAround; ++i) {
            const unsigned a = j * (kAround + 1) + i, b = a + kAround + 1;
            mesh.triangles.emplace_back(a, a + 1, b + 1);
            mesh.triangles.emplace_back(a, b + 1, b);
        }
    }
    return mesh;
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
    float nearest = std::numeric_limits<float>::infinity();
    int wall = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const float side = direction[axis] > 0.0F ? 1.0F : -1.0F;
        const float distance = (side * kHalfSize[axis] - origin[axis]) / direction[axis];
        if (distance < nearest) {
            nearest = distance;
            wall = 2 * axis + (side > 0.0F ? 1 : 0);
        }
    }
    glm::vec3 normal(0.0F);
    normal[wall / 2] = wall % 2 == 0 ? 1.0F : -1.0F;
    return {origin + nearest * direction, normal, kWallColours[wall]};
}

scene::Camera cameraAt(const glm::vec3& position, const glm::vec3& target) {
    scene::Camera camera;
    camera.position = position;
    camera.target = target;
    camera.verticalFovRad = 0.9F;
    camera.nearM = 0.05F;
    camera.farM = 50.0F;
    return camera;
}

}  // namespace gfxrepro::clustered_reflections::rooms
