// The quadtree of terrain blocks and what the preprocess knows of each: [zhang2012] Sec. 2, Fig. 3.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "engine/scene/height_map.h"

namespace gfxrepro::terrain_tessellation {

/// h_min, h_max and ε_max of [zhang2012] Sec. 2, in metres, over every full-resolution sample of a
/// block or of an edge, its ends included.
///
/// The paper does not say what ε measures. Here: the greatest |difference| in height between the
/// full-resolution samples and the grid of the block's level (every 2^level-th sample), which
/// is interpolated bilinearly in a block and linearly along an edge. It is 0 at level 0, and exact:
/// a parent's may be less than a child's.
struct HeightRange {
    float minM = 0.0F;
    float maxM = 0.0F;
    float errorM = 0.0F;

    void add(const HeightRange& other) {
        minM = glm::min(minM, other.minM);
        maxM = glm::max(maxM, other.maxM);
        errorM = glm::max(errorM, other.errorM);
    }
    bool operator==(const HeightRange&) const = default;
};

/// The order of gl_TessLevelOuter for quads whose u runs east (x) and v south (z).
enum Edge { kWest, kNorth, kEast, kSouth };

/// 19 floats without padding, as an std430 array of float sees them. Neighbours of one level have
/// equal values on the edge that they share.
struct Block {
    HeightRange whole;
    std::array<HeightRange, 4> edges;  // by Edge
    std::array<float, 4> cornersM{};   // heights: north-west, north-east, south-west, south-east

    bool operator==(const Block&) const = default;
};
constexpr int kBlockFloats = 19;
static_assert(sizeof(Block) == kBlockFloats * sizeof(float));

struct MetadataSettings {
    int blockSegments = 32;  // a side of a block, at its level's spacing: 33 × 33 vertices
    int tileBlocks = 16;     // M · N: the tree is at least one tile wide

    bool operator==(const MetadataSettings&) const = default;
};

/// Level 0 has the full resolution; each level above halves it; the last is one block.
/// Block (column, row) of a level spans the samples [column, column + 1] · blockSegments · 2^level,
/// and the same in rows. The tree is square, a power of two blocks wide, and may reach beyond the
/// height map, where the border's heights go on.
class TerrainMetadata {
  public:
    static TerrainMetadata build(const scene::HeightMap& map, const MetadataSettings& settings);
    /// Reads `folder`/<key>.terrain, made first where it is not there or damaged (a checksum
    /// tells). Where the folder cannot be written nothing is kept.
    static TerrainMetadata openOrBuild(const std::filesystem::path& folder,
                                       const scene::HeightMap& map,
                                       const MetadataSettings& settings);
    /// A digest of heights (of a file its key) and settings.
    static std::string keyOf(const scene::HeightMap& map, const MetadataSettings& settings);

    const MetadataSettings& settings() const { return settings_; }
    int levelCount() const { return levelCount_; }
    int blocksPerSide(int level) const { return 1 << (levelCount_ - 1 - level); }
    /// In samples of the full resolution.
    int blockSizeSamples(int level) const { return settings_.blockSegments << level; }
    int treeSizeSamples() const { return blockSizeSamples(levelCount_ - 1); }
    glm::ivec2 sizeSamples() const { return sizeSamples_; }
    glm::vec2 spacingM() const { return spacingM_; }

    /// All levels one after the other, the finest first, each row by row from the north.
    std::span<const Block> blocks() const { return blocks_; }
    /// Where each level begins in them.
    std::span<const int> firstBlocks() const { return firstBlocks_; }
    std::size_t blockIndex(int level, int column, int row) const;
    const Block& block(int level, int column, int row) const {
        return blocks_[blockIndex(level, column, row)];
    }
    bool wasBuilt() const { return wasBuilt_; }  // by openOrBuild(), else found

  private:
    TerrainMetadata(const scene::HeightMap& map, const MetadataSettings& settings);

    MetadataSettings settings_;
    glm::ivec2 sizeSamples_{0};
    glm::vec2 spacingM_{1.0F};
    int levelCount_ = 1;
    std::vector<int> firstBlocks_;  // by level
    std::vector<Block> blocks_;
    bool wasBuilt_ = true;
};

}  // namespace gfxrepro::terrain_tessellation
