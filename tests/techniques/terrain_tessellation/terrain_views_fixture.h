// A small terrain and views of it, without a device.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "techniques/kit/view.h"
#include "techniques/terrain_tessellation/tile_selection.h"

namespace gfxrepro::terrain_tessellation {

/// Sums of sines with rough detail: neither flat nor periodic in the tiles.
inline scene::HeightMap roughMap(int side, float reliefM) {
    scene::HeightMap map;
    map.sizeSamples = {side, side};
    map.spacingM = 1.0F;
    std::mt19937 random(7);
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            const float x = static_cast<float>(column), z = static_cast<float>(row);
            const float noise = static_cast<float>(random() % 1024U) / 1024.0F;
            map.heightsM.push_back(reliefM *
                                   (0.5F + 0.3F * std::sin(0.031F * x) * std::cos(0.043F * z) +
                                    0.1F * std::sin(0.17F * x + 0.11F * z) + 0.05F * noise));
        }
    }
    return map;
}

inline kit::View viewAt(glm::vec3 eye, glm::vec3 target, glm::ivec2 sizePx = {160, 100}) {
    scene::Camera camera;
    camera.position = eye;
    camera.target = target;
    camera.up = {0.0F, 1.0F, 0.0F};
    camera.verticalFovRad = 0.9F;
    camera.nearM = 0.5F;
    camera.farM = 2000.0F;
    return kit::viewOf(camera, sizePx);
}

/// A number of [low, high), the same on every machine.
inline float anywhere(std::mt19937& random, float low, float high) {
    return low + (high - low) * static_cast<float>(random() % 4096U) / 4096.0F;
}

/// Over roughMap(257, 40): from above it, within it, low along it and from straight above.
inline std::vector<kit::View> terrainViews() {
    return {viewAt({-20, 60, 300}, {128, 10, 100}), viewAt({100, 55, 120}, {200, 10, 60}),
            viewAt({10, 50, 10}, {250, 30, 240}), viewAt({128, 300, 128}, {129, 0, 127})};
}

}  // namespace gfxrepro::terrain_tessellation
