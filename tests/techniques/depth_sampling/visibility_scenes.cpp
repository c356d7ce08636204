#include "tests/techniques/depth_sampling/visibility_scenes.h"

#include <glm/gtc/matrix_transform.hpp>

#include "engine/core/random.h"

namespace gfxrepro::depth_sampling {
namespace {

glm::vec3 randomPoint(Random& random, float reach) {
    const float x = random.uniform(-reach, reach);
    const float y = random.uniform(-reach, reach);
    return {x, y, random.uniform(-reach, reach)};
}

scene::Mesh randomTriangles(Random& random, int count) {
    scene::Mesh mesh;
    for (unsigned i = 0; i < static_cast<unsigned>(count); ++i) {
        const glm::vec3 centre = randomPoint(random, 0.8F);
        for (int corner = 0; corner < 3; ++corner) {
            mesh.positions.push_back(centre + randomPoint(random, 0.35F));
        }
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh;
}

scene::Mesh box(const glm::vec3& half) {
    scene::Mesh mesh;
    for (int corner = 0; corner < 8; ++corner) {
        mesh.positions.push_back(half * glm::vec3((corner & 1) != 0 ? 1 : -1,
                                                  (corner & 2) != 0 ? 1 : -1,
                                                  (corner & 4) != 0 ? 1 : -1));
    }
    mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

}  // namespace

scene::Scene clutter(std::uint64_t seed) {
    Random random(seed);
    scene::Scene scene;
    scene.materials.resize(2);
    scene.materials[1].isDoubleSided = true;
    scene.meshes = {randomTriangles(random, 60), randomTriangles(random, 30),
                    box({0.3F, 0.15F, 0.2F})};
    scene.meshes[0].material = 0;
    scene.meshes[1].material = 1;
    const glm::mat4 one(1.0F);
    const glm::mat4 turned =
        glm::rotate(glm::translate(one, randomPoint(random, 0.5F)), 0.7F, glm::vec3(0.6F, 0.8F, 0));
    const glm::mat4 mirrored =
        glm::scale(glm::translate(one, randomPoint(random, 0.5F)), glm::vec3(-1.3F, 0.8F, 1.0F));
    scene.instances = {{2, turned}, {0, one}, {2, mirrored}, {1, one}};
    return scene;
}

std::vector<kit::View> threeViews(int sizePx) {
    std::vector<kit::View> views;
    for (const glm::vec3 eye :
         {glm::vec3(-1.3F, -0.4F, 4), glm::vec3(1.2F, -0.3F, 3.9F), glm::vec3(0.1F, 1.1F, 3.8F)}) {
        scene::Camera camera;
        camera.position = eye;
        camera.target = {0.07F, -0.03F, 0};
        camera.verticalFovRad = 0.42F;
        camera.nearM = 3.4F;
        camera.farM = 4.9F;
        views.push_back(kit::viewOf(camera, glm::ivec2(sizePx)));
    }
    return views;
}

scene::Mesh squareAt(const glm::vec3& centre, float half) {
    scene::Mesh mesh;
    mesh.positions = {centre + glm::vec3(-half, -half, 0), centre + glm::vec3(half, -half, 0),
                      centre + glm::vec3(half, half, 0), centre + glm::vec3(-half, half, 0)};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

FourObjects::FourObjects() {
    scene.meshes = {squareAt({0, 0, 2}, 1.2F), squareAt({0, 0, 0}, 0.3F),
                    squareAt({0, 0, -2}, 0.2F), squareAt({0, 0, -5}, 6.0F)};
    for (int mesh = 0; mesh < 4; ++mesh) scene.instances.push_back({mesh, glm::mat4(1.0F)});
}

kit::View FourObjects::viewFrom(float side) const {
    scene::Camera camera;
    camera.position = {3.0F * side, 0, 10};
    camera.target = {0, 0, 0};
    camera.nearM = 1.0F;
    camera.farM = 30.0F;
    return kit::viewOf(camera, {32, 32});
}

}  // namespace gfxrepro::depth_sampling
