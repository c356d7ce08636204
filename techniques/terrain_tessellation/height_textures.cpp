#include "techniques/terrain_tessellation/height_textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "runner/core/error.h"

namespace gfxrepro::terrain_tessellation {

namespace {

std::vector<std::uint16_t> asUnorm16(const std::vector<float>& heightsM, float lowestM,
                                     float reliefM) {
    std::vector<std::uint16_t> texels(heightsM.size());
    const float scale = reliefM > 0.0F ? 65535.0F / reliefM : 0.0F;
    for (std::size_t i = 0; i < texels.size(); ++i) {
        const float value = std::clamp((heightsM[i] - lowestM) * scale, 0.0F, 65535.0F);
        texels[i] = static_cast<std::uint16_t>(std::lround(value));
    }
    return texels;
}

std::vector<int> firstBlocksOf(const TerrainMetadata& metadata) {
    std::vector<int> first(static_cast<std::size_t>(metadata.levelCount()), 0);
    for (int level = 1; level < metadata.levelCount(); ++level) {
        const int side = metadata.blocksPerSide(level - 1);
        first[static_cast<std::size_t>(level)] =
            first[static_cast<std::size_t>(level - 1)] + side * side;
    }
    return first;
}

}  // namespace

DeviceTerrain::DeviceTerrain(const scene::HeightMap& map, const TerrainMetadata& metadata,
                             HeightFormat format)
    : metadata_(&metadata) {
    if (map.sizeSamples != metadata.sizeSamples()) {
        throw Error(fmt::format("height map of {} × {} samples with metadata of {} × {}",
                                map.sizeSamples.x, map.sizeSamples.y, metadata.sizeSamples().x,
                                metadata.sizeSamples().y));
    }
    const HeightRange all = metadata.blocks().back().whole;  // the root
    lowestM_ = all.minM;
    highestM_ = all.maxM;
    if (format == HeightFormat::Float32) {
        heights_ = gl::Texture::make2D(GL_R32F, map.sizeSamples);
        heights_.upload(GL_RED, GL_FLOAT, map.heightsM.data());
    } else {
        heightOfTexel_ = {lowestM_, highestM_ - lowestM_};
        const auto texels = asUnorm16(map.heightsM, lowestM_, highestM_ - lowestM_);
        heights_ = gl::Texture::make2D(GL_R16, map.sizeSamples);
        // Rows of an odd count of 16-bit samples are not whole words.
        glPixelStorei(GL_UNPACK_ALIGNMENT, 2);
        heights_.upload(GL_RED, GL_UNSIGNED_SHORT, texels.data());
        glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    }
    blocks_ = gl::Buffer::of(metadata.blocks());
    firstBlocks_ = gl::Buffer::of(firstBlocksOf(metadata));
}

std::size_t DeviceTerrain::sizeBytes() const {
    return heights_.sizeBytes() + blocks_.sizeBytes() + firstBlocks_.sizeBytes();
}

}  // namespace gfxrepro::terrain_tessellation
