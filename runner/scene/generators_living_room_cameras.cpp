#include <initializer_list>
#include <string_view>
#include <utility>

#include "runner/scene/generators_living_room_parts.h"

namespace gfxrepro::scene::living_room {

namespace {

constexpr float kFovRad = 0.95F;

Camera camera(std::string_view name, const glm::vec3& position, const glm::vec3& target,
              float verticalFovRad = kFovRad) {
    Camera result;
    result.name = name;
    result.position = position;
    result.target = target;
    result.verticalFovRad = verticalFovRad;
    result.nearM = 0.05F;
    result.farM = 20.0F;
    return result;
}

/// Position and target of each key.
CameraPath path(std::string_view name,
                std::initializer_list<std::pair<glm::vec3, glm::vec3>> keys) {
    CameraPath result;
    result.name = name;
    for (const auto& [position, target] : keys) {
        result.keys.push_back(camera(name, position, target));
    }
    return result;
}

}  // namespace

void addCameras(Scene& scene) {
    // As [xie2017] Table 12, first row: floor, table, vase, teapot and lamp; second row: the vase.
    scene.cameras.push_back(
        camera("overview", {2.55F, 1.6F, 2.35F}, {-0.35F, 0.62F, -0.55F}, 1.0F));
    scene.cameras.push_back(camera("vase", {-0.05F, 1.05F, -0.55F}, {-0.95F, 0.66F, -1.5F}, 0.8F));
    scene.paths.push_back(path("path_1", {{{2.2F, 1.4F, 1.2F}, {0.0F, 0.5F, -1.0F}},
                                          {{1.2F, 1.4F, -0.6F}, {-0.9F, 0.5F, -1.5F}}}));
    scene.paths.push_back(path("path_2", {{{0.3F, 1.3F, -0.6F}, {-0.9F, 0.6F, -1.5F}},
                                          {{1.2F, 1.3F, -0.6F}, {2.0F, 0.6F, -0.2F}}}));
}

}  // namespace gfxrepro::scene::living_room
