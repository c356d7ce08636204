#include "techniques/terrain_tessellation/height_textures.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/core/error.h"

namespace gfxrepro::terrain_tessellation {

namespace {

std::vector<int> firstBlocksOf(const TerrainMetadata& metadata) {
    std::vector<int> first(static_cast<std::size_t>(metadata.levelCount()), 0);
    for (int level = 1; level < metadata.levelCount(); ++level) {
        const int side = metadata.blocksPerSide(level - 1);
        first[static_cast<std::size_t>(level)] =
            first[static_cast<std::size_t>(level - 1)] + side * side;
    }
    return first;
}

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
      firstBlocks_(gl::Buffer::of(firstBlocksOf(metadata))) {}

gl::Resources DeviceTerrain::resources() const {
    return {{"heightPages", pages_.texture()}, {"Blocks", blocks_}, {"FirstBlocks", firstBlocks_}};
}

std::size_t DeviceTerrain::sizeBytes() const {
    return pages_.texture().sizeBytes() + blocks_.sizeBytes() + firstBlocks_.sizeBytes();
}

}  // namespace gfxrepro::terrain_tessellation
