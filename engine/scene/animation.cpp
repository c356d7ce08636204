#include "engine/scene/animation.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/core/error.h"

namespace gfxrepro::scene {
Camera cameraAt(const CameraPath& path, double time) {
    if (path.keys.empty()) throw Error("the camera path '" + path.name + "' has no keys");
    const auto last = static_cast<int>(path.keys.size()) - 1;
    const double place = std::clamp(time, 0.0, 1.0) * last;
    const int segment = std::min(static_cast<int>(place), std::max(last - 1, 0));
    const auto u = static_cast<float>(place - segment);
    const auto key = [&](int index) -> const Camera& {
        return path.keys[static_cast<std::size_t>(std::clamp(index, 0, last))];
    };
    const Camera &a = key(segment - 1), &b = key(segment), &c = key(segment + 1),
                 &d = key(segment + 2);
    Camera camera = b;
    camera.name = path.name;
    camera.position = catmullRom(a.position, b.position, c.position, d.position, u);
    camera.target = catmullRom(a.target, b.target, c.target, d.target, u);
    camera.up = glm::normalize(catmullRom(a.up, b.up, c.up, d.up, u));
    camera.verticalFovRad =
        catmullRom(a.verticalFovRad, b.verticalFovRad, c.verticalFovRad, d.verticalFovRad, u);
    camera.nearM = glm::mix(b.nearM, c.nearM, u);
    camera.farM = glm::mix(b.farM, c.farM, u);
    return camera;
}

std::vector<glm::mat4> posesAt(const Scene& scene, double time) {
    std::vector<glm::mat4> poses;
    poses.reserve(scene.instances.size());
    for (const Instance& instance : scene.instances) poses.push_back(instance.worldFromMesh);
    const auto t = static_cast<float>(std::clamp(time, 0.0, 1.0));
    for (const Motion& motion : scene.motions) {
        const glm::vec3 moved =
            motion.swing * std::sin(glm::two_pi<float>() * motion.swingCount * t);
        glm::mat4 pose = glm::translate(glm::mat4(1.0F), motion.pivot + moved);
        pose = glm::rotate(pose, motion.turnRad * t, motion.axis);
        pose = glm::translate(pose, -motion.pivot);
        glm::mat4& worldFromMesh = poses[static_cast<std::size_t>(motion.instance)];
        worldFromMesh = pose * worldFromMesh;
    }
    return poses;
}

}  // namespace gfxrepro::scene
