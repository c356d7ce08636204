// A small terrain and views of it; a device, what it draws of them, and pictures read back.
#pragma once

#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <optional>
#include <random>
#include <vector>

#include "engine/core/files.h"
#include "techniques/kit/view.h"
#include "techniques/terrain_tessellation/patch_checks.h"
#include "techniques/terrain_tessellation/tile_selection.h"
#include "tests/gl/gl_fixture.h"
#include "tests/support/grid.h"

namespace gfxrepro::terrain_tessellation {

/// Sums of sines with rough detail: neither flat nor periodic in the tiles.
inline scene::HeightMap roughMap(int side, float reliefM) {
    scene::HeightMap map{.sizeSamples = {side, side}, .spacingM = glm::vec2(1.0F)};
    std::mt19937 random(7);
    for (const auto [row, column] : test::grid(side, side)) {
        const float x = static_cast<float>(column), z = static_cast<float>(row);
        const float noise = static_cast<float>(random() % 1024U) / 1024.0F;
        map.heightsM.push_back(reliefM *
                               (0.5F + 0.3F * std::sin(0.031F * x) * std::cos(0.043F * z) +
                                0.1F * std::sin(0.17F * x + 0.11F * z) + 0.05F * noise));
    }
    return map;
}

inline kit::View viewAt(glm::vec3 eye, glm::vec3 target, glm::ivec2 sizePx = {160, 100}) {
    const scene::Camera camera{.position = eye,
                               .target = target,
                               .up = {0.0F, 1.0F, 0.0F},
                               .verticalFovRad = 0.9F,
                               .nearM = 0.5F,
                               .farM = 2000.0F};
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

struct TerrainTest : test::GlTest {
    /// Blocks of 8, patches of 16 and tiles of 64 samples at level 0.
    void makeTerrain(scene::HeightMap heights) {
        map = std::move(heights);
        tile = {4, 2};
        metadata.emplace(TerrainMetadata::build(map, {8, tile.blocksPerTile()}));
        terrain.emplace(map, *metadata);
    }
    RenderSettings settings() const {
        RenderSettings result;
        result.factors.tile = tile;
        result.batches.emplace();
        return result;
    }
    std::vector<Tile> tilesOf(int level) const {
        std::vector<Tile> tiles;
        const int blocks = tile.blocksPerTile(), side = metadata->blocksPerSide(level) / blocks;
        const int span = blocks * metadata->blockSizeSamples(level);
        for (int i = 0; i < side * side; ++i) {
            const Tile added{.level = level,
                             .originSample = glm::ivec2(i % side, i / side) * span,
                             .sizeSamples = span,
                             .firstBlock = glm::ivec2(i % side, i / side) * blocks};
            const glm::ivec2 last = map.sizeSamples - 1;
            if (added.originSample.x >= last.x || added.originSample.y >= last.y) continue;
            tiles.push_back(added);
        }
        return tiles;
    }
    /// A picture cleared to magenta with an alpha of 0; what is drawn has an alpha of 1.
    template <class Draw>
    std::vector<glm::vec4> picture(glm::ivec2 sizePx, const Draw& draw) {
        gl::Texture colour = gl::Texture::make2D(GL_RGBA32F, sizePx);
        gl::Texture depth = gl::Texture::make2D(GL_DEPTH_COMPONENT32F, sizePx);
        const std::array<const gl::Texture*, 1> colours{&colour};
        gl::Framebuffer target(colours, &depth);
        target.clearColour(0, {1.0F, 0.0F, 1.0F, 0.0F});
        target.clearDepth(1.0F);
        draw(target);
        const auto values = colour.read<float>(GL_RGBA, GL_FLOAT, 4);
        std::vector<glm::vec4> pixels;
        for (std::size_t i = 0; i < values.size(); i += 4) {
            pixels.emplace_back(values[i], values[i + 1], values[i + 2], values[i + 3]);
        }
        return pixels;
    }

    gl::ShaderLibrary shaders{dataFolder("shaders")};
    TileSettings tile;
    scene::HeightMap map;
    std::optional<TerrainMetadata> metadata;
    std::optional<DeviceTerrain> terrain;
};

}  // namespace gfxrepro::terrain_tessellation
