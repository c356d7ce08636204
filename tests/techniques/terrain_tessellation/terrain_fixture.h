// A device, a small terrain, views, and pictures read back.
#pragma once

#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <optional>
#include <random>
#include <vector>

#include "engine/core/files.h"
#include "techniques/terrain_tessellation/factor_check.h"
#include "tests/gl/gl_fixture.h"
#include "tests/techniques/terrain_tessellation/terrain_views_fixture.h"

namespace gfxrepro::terrain_tessellation {

class TerrainTest : public test::GlTest {
  protected:
    /// 257² samples in blocks of 8, patches of 16 and tiles of 64 samples at level 0.
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
            Tile added;
            added.level = level;
            added.firstBlock = glm::ivec2(i % side, i / side) * blocks;
            added.originSample = glm::ivec2(i % side, i / side) * span;
            added.sizeSamples = span;
            if (added.originSample.x >= 256 || added.originSample.y >= 256) continue;
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
