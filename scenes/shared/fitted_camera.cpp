#include "scenes/shared/fitted_camera.h"

#include <algorithm>
#include <cmath>

#include "scenes/shared/sdf.h"

namespace gfxrepro::scene {

Camera fittedCamera(const Scene& scene, const glm::vec3& target, const glm::vec3& toCamera,
                    float verticalFovRad, float fill) {
    const glm::vec3 back = glm::normalize(toCamera);
    const glm::vec3 right = glm::normalize(glm::cross(glm::vec3(0, 1, 0), back));
    const glm::vec3 up = glm::cross(back, right);
    const float slope =
        fill * sdf::sine(0.5F * verticalFovRad) / sdf::cosine(0.5F * verticalFovRad);

    float distance = 0.0F;
    for (const Instance& instance : scene.instances) {
        for (const glm::vec3& position :
             scene.meshes[static_cast<std::size_t>(instance.mesh)].positions) {
            const glm::vec3 offset =
                glm::vec3(instance.worldFromMesh * glm::vec4(position, 1.0F)) - target;
            const float across =
                std::max(std::abs(glm::dot(offset, right)), std::abs(glm::dot(offset, up)));
            distance = std::max(distance, glm::dot(offset, back) + across / slope);
        }
    }

    Camera camera;
    camera.name = "whole";
    camera.target = target;
    camera.position = target + back * distance;
    camera.verticalFovRad = verticalFovRad;
    const float diagonal = glm::length(scene.bounds().size());
    camera.nearM = std::max(distance - diagonal, 0.01F * diagonal);
    camera.farM = distance + 2.0F * diagonal;
    return camera;
}

}  // namespace gfxrepro::scene
