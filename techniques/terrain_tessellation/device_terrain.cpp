#include "techniques/terrain_tessellation/device_terrain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/error.h"
#include "engine/gl/gl.h"

namespace gfxrepro::terrain_tessellation {
namespace {

std::vector<std::uint16_t> asUnorm16(const std::vector<float>& heightsM, glm::vec2 heightOfTexel) {
    std::vector<std::uint16_t> texels(heightsM.size());
    const float scale = heightOfTexel.y > 0.0F ? 65535.0F / heightOfTexel.y : 0.0F;
    for (std::size_t i = 0; i < texels.size(); ++i) {
        const float value = std::clamp((heightsM[i] - heightOfTexel.x) * scale, 0.0F, 65535.0F);
        texels[i] = static_cast<std::uint16_t>(std::lround(value));
    }
    return texels;
}

int pageCount(std::size_t budgetBytes, std::size_t pageBytes, int side, int tileCount) {
    if (budgetBytes < pageBytes) {
        throw Error(fmt::format(
            "{:.2f} MiB for heights hold no tile of {} × {}; allowed: {:.2f} MiB or more",
            static_cast<double>(budgetBytes) / (1 << 20), side, side,
            std::ceil(100.0 * static_cast<double>(pageBytes) / (1 << 20)) / 100.0));
    }
    GLint mostLayers = 1;
    glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &mostLayers);
    const std::size_t pages = budgetBytes / pageBytes;
    return static_cast<int>(std::min(
        pages, static_cast<std::size_t>(std::min(std::max(1, tileCount), int{mostLayers}))));
}

}  // namespace

HeightPages::HeightPages(const scene::HeightMap& map, const HeightPageSettings& settings,
                         glm::vec2 heightOfTexel, int tileSegments, int tileCount)
    : map_(&map), format_(settings.format), heightOfTexel_(heightOfTexel) {
    const bool isFloat = format_ == HeightFormat::Float32;
    const int side = tileSegments + kMoreTexels;
    const std::size_t pageBytes = static_cast<std::size_t>(side) * static_cast<std::size_t>(side) *
                                  (isFloat ? sizeof(float) : sizeof(std::uint16_t));
    const int count = pageCount(settings.budgetBytes, pageBytes, side, tileCount);
    texture_ = gl::Texture::make2DArray(isFloat ? GL_R32F : GL_R16, glm::ivec2(side), count);
    keys_.resize(static_cast<std::size_t>(count));
    lastUse_.resize(keys_.size(), 0);
}

int HeightPages::leastRecentlyUsed() const {
    return static_cast<int>(std::min_element(lastUse_.begin(), lastUse_.end()) - lastUse_.begin());
}

std::vector<int> HeightPages::load(std::span<const Tile> tiles) {
    GFXREPRO_ASSERT(tiles.size() <= keys_.size());
    ++clock_;
    const auto keyOf = [](const Tile& tile) {
        return Key(tile.level, tile.originSample.x, tile.originSample.y);
    };
    // First those that are there: they must not make room for the others.
    for (const Tile& tile : tiles) {
        const auto found = layers_.find(keyOf(tile));
        if (found != layers_.end()) lastUse_[static_cast<std::size_t>(found->second)] = clock_;
    }
    std::vector<int> result;
    for (const Tile& tile : tiles) {
        const Key key = keyOf(tile);
        auto found = layers_.find(key);
        if (found == layers_.end()) {
            const int layer = leastRecentlyUsed();
            const auto index = static_cast<std::size_t>(layer);
            if (lastUse_[index] != 0) layers_.erase(keys_[index]);
            fill(layer, tile);
            keys_[index] = key;
            lastUse_[index] = clock_;
            found = layers_.emplace(key, layer).first;
        }
        result.push_back(found->second);
    }
    return result;
}

void HeightPages::fill(int layer, const Tile& tile) {
    const int side = texture_.size().x;
    std::vector<float> heightsM;
    heightsM.reserve(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
    const int step = 1 << tile.level;
    // Rows of a coarse tile beyond the map's rim repeat samples that are far apart in the file.
    constexpr int kRowsAtOnce = 16;
    for (int j = 0; j < side; ++j) {
        if (j % kRowsAtOnce == 0) map_->release();
        for (int i = 0; i < side; ++i) {
            const glm::ivec2 at = tile.originSample + (glm::ivec2(i, j) - kBorder) * step;
            heightsM.push_back(map_->clampedHeightM(at.x, at.y, tile.level));
        }
    }
    const bool isFloat = format_ == HeightFormat::Float32;
    const std::vector<std::uint16_t> texels =
        isFloat ? std::vector<std::uint16_t>() : asUnorm16(heightsM, heightOfTexel_);
    // Rows of an odd count of 16-bit samples are not whole words.
    glPixelStorei(GL_UNPACK_ALIGNMENT, 2);
    glTextureSubImage3D(texture_.id(), 0, 0, 0, layer, side, side, 1, GL_RED,
                        isFloat ? GL_FLOAT : GL_UNSIGNED_SHORT,
                        isFloat ? static_cast<const void*>(heightsM.data())
                                : static_cast<const void*>(texels.data()));
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    map_->release();
    ++loadedCount_;
}

namespace {

/// Tiles of all levels that have ground.
int tileCountOf(const TerrainMetadata& metadata) {
    const int perTile = metadata.settings().tileBlocks;
    const glm::ivec2 cells = glm::max(metadata.sizeSamples() - 1, 1);
    int count = 0;
    for (int level = 0; level < metadata.levelCount() && metadata.blocksPerSide(level) >= perTile;
         ++level) {
        const int span = perTile * metadata.blockSizeSamples(level);
        const glm::ivec2 tiles = (cells + span - 1) / span;
        count += tiles.x * tiles.y;
    }
    return count;
}

const TerrainMetadata& requireOfMap(const TerrainMetadata& metadata, const scene::HeightMap& map) {
    if (map.sizeSamples == metadata.sizeSamples()) return metadata;
    throw Error(fmt::format("height map of {} × {} samples with metadata of {} × {}",
                            map.sizeSamples.x, map.sizeSamples.y, metadata.sizeSamples().x,
                            metadata.sizeSamples().y));
}

}  // namespace

DeviceTerrain::DeviceTerrain(const scene::HeightMap& map, const TerrainMetadata& metadata,
                             const HeightPageSettings& settings)
    : metadata_(&requireOfMap(metadata, map)),
      lowestM_(metadata.blocks().back().whole.minM),  // the root's
      highestM_(metadata.blocks().back().whole.maxM),
      heightOfTexel_(settings.format == HeightFormat::Float32
                         ? glm::vec2(0.0F, 1.0F)
                         : glm::vec2(lowestM_, highestM_ - lowestM_)),
      pages_(map, settings, heightOfTexel_,
             metadata.settings().tileBlocks * metadata.settings().blockSegments,
             tileCountOf(metadata)),
      blocks_(gl::Buffer::of(metadata.blocks())),
      firstBlocks_(gl::Buffer::of(metadata.firstBlocks())) {}

gl::Resources DeviceTerrain::resources() const {
    return {{"heightPages", pages_.texture()}, {"Blocks", blocks_}, {"FirstBlocks", firstBlocks_}};
}

std::size_t DeviceTerrain::sizeBytes() const {
    return pages_.texture().sizeBytes() + blocks_.sizeBytes() + firstBlocks_.sizeBytes();
}

}  // namespace gfxrepro::terrain_tessellation
