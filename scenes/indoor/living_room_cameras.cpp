#include <initializer_list>
#include <string_view>
#include <utility>

#include "scenes/indoor/living_room_parts.h"

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
        camera("overview", {2.05F, 1.60F, 1.5F}, {-0.70F, 0.72F, -0.80F}, 1.0F));
    scene.cameras.push_back(camera("vase", {-0.05F, 1.05F, -0.55F}, {-0.95F, 0.66F, -1.5F}, 0.8F));
    // Standing people's ways over free floor. Keys were searched for views with the reflective and
    // planar shares of [xie2017] Tables 13 and 21: past the columns to the ball chair, and around
    // the vase.
    scene.paths.push_back(path("path_1", {{{-0.27F, 1.55F, -0.63F}, {1.18F, 1.24F, -0.87F}},
                                          {{0.07F, 1.57F, -0.78F}, {1.55F, 1.35F, -0.94F}},
                                          {{0.48F, 1.58F, -1.07F}, {1.92F, 1.18F, -1.02F}},
                                          {{0.74F, 1.57F, -0.83F}, {2.11F, 1.12F, -1.22F}},
                                          {{1.02F, 1.54F, -0.62F}, {2.36F, 1.00F, -1.02F}},
                                          {{1.25F, 1.53F, -0.39F}, {2.49F, 0.87F, -0.91F}},
                                          {{0.99F, 1.56F, 0.09F}, {1.99F, 0.88F, -0.80F}},
                                          {{0.96F, 1.60F, 0.51F}, {1.78F, 0.82F, -0.48F}},
                                          {{0.96F, 1.56F, 0.98F}, {1.62F, 0.81F, -0.14F}},
                                          {{1.31F, 1.60F, 1.16F}, {1.98F, 1.00F, -0.04F}},
                                          {{1.61F, 1.60F, 1.46F}, {1.79F, 0.84F, 0.18F}},
                                          {{2.15F, 1.60F, 1.51F}, {1.89F, 0.94F, 0.19F}},
                                          {{2.30F, 1.60F, 1.80F}, {1.91F, 0.96F, 0.50F}},
                                          {{2.58F, 1.55F, 1.95F}, {1.96F, 0.98F, 0.71F}}}));
    scene.paths.push_back(path("path_2", {{{0.46F, 1.33F, -2.00F}, {-0.96F, 0.95F, -1.69F}},
                                          {{0.10F, 1.38F, -1.57F}, {-1.33F, 0.93F, -1.60F}},
                                          {{0.17F, 1.35F, -1.24F}, {-1.16F, 0.74F, -1.58F}},
                                          {{-0.00F, 1.40F, -0.71F}, {-0.93F, 0.82F, -1.74F}},
                                          {{-0.37F, 1.45F, -0.59F}, {-1.11F, 0.80F, -1.72F}},
                                          {{-0.75F, 1.45F, -0.51F}, {-1.29F, 0.85F, -1.78F}},
                                          {{-1.08F, 1.41F, -0.59F}, {-0.88F, 0.73F, -1.91F}},
                                          {{-1.61F, 1.45F, -0.58F}, {-0.69F, 0.84F, -1.60F}},
                                          {{-1.83F, 1.48F, -0.79F}, {-0.72F, 0.78F, -1.51F}},
                                          {{-2.06F, 1.52F, -1.19F}, {-0.79F, 0.72F, -1.24F}},
                                          {{-1.93F, 1.47F, -1.76F}, {-0.71F, 0.77F, -1.24F}},
                                          {{-1.72F, 1.44F, -2.15F}, {-0.95F, 0.60F, -1.18F}},
                                          {{-1.45F, 1.42F, -2.34F}, {-0.70F, 0.72F, -1.25F}},
                                          {{-1.15F, 1.44F, -2.48F}, {-0.99F, 0.76F, -1.16F}}}));
    // From the overview 0.3 m to its left and back: frames that show the whole room.
    scene.paths.push_back(
        {"aside",
         {camera("aside", {2.05F, 1.60F, 1.5F}, {-0.70F, 0.72F, -0.80F}, 1.0F),
          camera("aside", {1.8575F, 1.60F, 1.73F}, {-0.8925F, 0.72F, -0.57F}, 1.0F),
          camera("aside", {2.05F, 1.60F, 1.5F}, {-0.70F, 0.72F, -0.80F}, 1.0F)}});
}

}  // namespace gfxrepro::scene::living_room
