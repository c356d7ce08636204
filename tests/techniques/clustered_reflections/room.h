// A small room with a mirror for a floor and a bent one, for tests of the technique as a whole.
#pragma once

#include <array>
#include <cmath>

#include "tests/techniques/reflections/reflections_fixture.h"

namespace gfxrepro::clustered_reflections {

inline void addPart(scene::Scene& scene, scene::MeshBuilder& builder,
                    const scene::Material& material) {
    reflections::addPart(scene, builder.take("part", 0), material);
}

inline const scene::Material kMirror{
    .name = "mirror", .baseColor = {0.3F, 0.3F, 0.3F, 1.0F}, .metallic = 0.9F, .roughness = 0.0F};

/// Four walls of coloured stripes and a ceiling, three metres wide, and two boxes on the floor. The
/// floor is another part.
inline void addRoom(scene::Scene& scene) {
    scene::MeshBuilder builder;
    constexpr int kStripes = 6;
    const std::array<glm::vec3, 4> corners{glm::vec3(-1.5F, 0, 1.5F), glm::vec3(1.5F, 0, 1.5F),
                                           glm::vec3(1.5F, 0, -1.5F), glm::vec3(-1.5F, 0, -1.5F)};
    for (std::size_t side = 0; side < 4; ++side) {
        const glm::vec3 from = corners[side];
        const glm::vec3 step = (corners[(side + 1) % 4] - from) / static_cast<float>(kStripes);
        for (int i = 0; i < kStripes; ++i) {
            const glm::vec3 a = from + static_cast<float>(i) * step;
            const glm::vec3 b = a + step;
            const glm::vec3 up(0, 2, 0);
            builder.setColor(i % 2 == 0
                                 ? glm::vec3(0.9F, 0.7F - 0.15F * static_cast<float>(side), 0.2F)
                                 : glm::vec3(0.2F, 0.3F, 0.2F + 0.2F * static_cast<float>(side)));
            builder.addQuad(b, a, a + up, b + up);
        }
    }
    builder.setColor({0.8F, 0.8F, 0.8F});
    builder.addQuad({-1.5F, 2, -1.5F}, {1.5F, 2, -1.5F}, {1.5F, 2, 1.5F}, {-1.5F, 2, 1.5F});
    builder.setColor({0.9F, 0.1F, 0.1F});
    builder.addBox({-0.7F, 0.3F, -0.4F}, {0.2F, 0.3F, 0.2F});
    builder.setColor({0.1F, 0.2F, 0.9F});
    builder.addBox({0.6F, 0.2F, -0.8F}, {0.25F, 0.2F, 0.15F});
    addPart(scene, builder, {.name = "walls"});
    scene.name = "room";
    scene.cameras = {{.name = "front",
                      .position = {0.2F, 1.2F, 1.4F},
                      .target = {0, 0.35F, -0.6F},
                      .verticalFovRad = 0.9F},
                     {.name = "ceiling",
                      .position = {0, 1.0F, 0.5F},
                      .target = {0, 2.0F, 0},
                      .verticalFovRad = 0.6F}};
}

inline void addFloor(scene::Scene& scene, const scene::Material& material) {
    scene::MeshBuilder builder;
    builder.addQuad({-1.5F, 0, 1.5F}, {1.5F, 0, 1.5F}, {1.5F, 0, -1.5F}, {-1.5F, 0, -1.5F});
    addPart(scene, builder, material);
}

/// A floor that mirrors.
inline scene::Scene roomWithMirror() {
    scene::Scene scene;
    addRoom(scene);
    addFloor(scene, kMirror);
    return scene;
}

inline void addColumn(scene::Scene& scene, const scene::Material& material) {
    scene::MeshBuilder builder;
    std::vector<scene::MeshBuilder::Station> stations;
    for (int i = 0; i <= 8; ++i) {
        const float t = static_cast<float>(i) / 8.0F;
        stations.push_back({{0, 0.05F + 0.8F * t, 0.1F}, 0.15F + 0.1F * std::sin(3.0F * t)});
    }
    builder.addTube(stations, 32, true);
    addPart(scene, builder, material);
}

/// Beside it, a column that mirrors and moves along.
inline scene::Scene roomWithMirrors() {
    scene::Scene scene = roomWithMirror();
    scene.motions = {{.instance = static_cast<int>(scene.instances.size()), .swing = {0.4F, 0, 0}}};
    addColumn(scene, kMirror);
    return scene;
}

/// The column alone mirrors.
inline scene::Scene roomWithColumn(const scene::Material& material) {
    scene::Scene scene;
    addRoom(scene);
    addFloor(scene, {.name = "floor"});
    addColumn(scene, material);
    return scene;
}

}  // namespace gfxrepro::clustered_reflections
