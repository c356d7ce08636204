#include "techniques/terrain_tessellation/terrain_metadata.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <type_traits>

#include "runner/core/error.h"
#include "runner/core/files.h"
#include "runner/core/hash.h"

namespace gfxrepro::terrain_tessellation {

namespace {

/// Goes up when the file's layout or what a value means changes.
constexpr std::uint32_t kVersion = 1;
constexpr char kMagic[8] = {'g', 'f', 'x', 't', 'e', 'r', 'r', 'a'};

struct Header {
    char magic[8];
    std::uint32_t version;
    char key[64];
    char checksum[64];  // sha256 of the blocks
};

constexpr HeightRange kNothing{std::numeric_limits<float>::infinity(),
                               -std::numeric_limits<float>::infinity(), 0.0F};

float between(float a, float b, float t) {
    return a + (b - a) * t;
}

/// A square of samples, its border included.
struct Square {
    glm::ivec2 origin;
    int size;
};

/// Heights of a square's samples against the grid of one level.
class SquareErrors {
  public:
    SquareErrors(const scene::HeightMap& map, int level)
        : map_(map), level_(level), step_(1 << level) {}

    HeightRange over(const Square& square) {
        HeightRange range = kNothing;
        for (int row = square.origin.y; row <= square.origin.y + square.size; ++row) {
            interpolateGrid(square, row);
            addRow(square, row, range);
        }
        return range;
    }

  private:
    int firstCell(int at) const { return at >> level_; }

    /// The grid's columns along one row of samples.
    void interpolateGrid(const Square& square, int row) {
        const int first = firstCell(square.origin.x);
        const int last = firstCell(square.origin.x + square.size) + 1;
        const int north = firstCell(row) * step_;
        const float t = static_cast<float>(row - north) / static_cast<float>(step_);
        grid_.resize(static_cast<std::size_t>(last - first + 1));
        for (int cell = first; cell <= last; ++cell) {
            grid_[static_cast<std::size_t>(cell - first)] =
                between(map_.clampedHeightM(cell * step_, north),
                        map_.clampedHeightM(cell * step_, north + step_), t);
        }
    }

    void addRow(const Square& square, int row, HeightRange& range) const {
        const int first = firstCell(square.origin.x);
        for (int column = square.origin.x; column <= square.origin.x + square.size; ++column) {
            const int cell = firstCell(column);
            const float t = static_cast<float>(column - cell * step_) / static_cast<float>(step_);
            const float* ends = &grid_[static_cast<std::size_t>(cell - first)];
            const float height = map_.clampedHeightM(column, row);
            range.add({height, height, std::abs(height - between(ends[0], ends[1], t))});
        }
    }

    const scene::HeightMap& map_;
    int level_;
    int step_;
    std::vector<float> grid_;
};

/// The samples from `begin` on in direction `along`, against the line through every 2^level-th.
/// It depends on these samples alone, so that both neighbours of an edge find the same.
HeightRange edgeRange(const scene::HeightMap& map, glm::ivec2 begin, glm::ivec2 along, int size,
                      int level) {
    const int step = 1 << level;
    const auto heightAt = [&](int i) {
        const glm::ivec2 at = begin + along * i;
        return map.clampedHeightM(at.x, at.y);
    };
    HeightRange range = kNothing;
    for (int from = 0; from < size; from += step) {
        const float a = heightAt(from);
        const float b = heightAt(from + step);
        for (int i = 0; i <= step; ++i) {
            const float t = static_cast<float>(i) / static_cast<float>(step);
            const float height = heightAt(from + i);
            range.add({height, height, std::abs(height - between(a, b, t))});
        }
    }
    return range;
}

std::array<HeightRange, 4> edgeRanges(const scene::HeightMap& map, const Square& block, int level) {
    const glm::ivec2 east(1, 0);
    const glm::ivec2 south(0, 1);
    const int size = block.size;
    std::array<HeightRange, 4> edges;
    edges[kWest] = edgeRange(map, block.origin, south, size, level);
    edges[kNorth] = edgeRange(map, block.origin, east, size, level);
    edges[kEast] = edgeRange(map, block.origin + size * east, south, size, level);
    edges[kSouth] = edgeRange(map, block.origin + size * south, east, size, level);
    return edges;
}

/// One level's ranges over all squares of the size of a finest block: work of equal pieces at every
/// level, however few blocks it has.
std::vector<HeightRange> finestRanges(const scene::HeightMap& map, int level, int squaresPerSide,
                                      int squareSize) {
    std::vector<HeightRange> ranges(static_cast<std::size_t>(squaresPerSide) *
                                    static_cast<std::size_t>(squaresPerSide));
    tbb::parallel_for(0, squaresPerSide, [&](int row) {
        SquareErrors errors(map, level);
        for (int column = 0; column < squaresPerSide; ++column) {
            ranges[static_cast<std::size_t>(row) * static_cast<std::size_t>(squaresPerSide) +
                   static_cast<std::size_t>(column)] =
                errors.over({{column * squareSize, row * squareSize}, squareSize});
        }
    });
    return ranges;
}

HeightRange greatestOf(const std::vector<HeightRange>& ranges, int perSide, glm::ivec2 first,
                       int count) {
    HeightRange range = kNothing;
    for (int row = first.y; row < first.y + count; ++row) {
        for (int column = first.x; column < first.x + count; ++column) {
            range.add(ranges[static_cast<std::size_t>(row) * static_cast<std::size_t>(perSide) +
                             static_cast<std::size_t>(column)]);
        }
    }
    return range;
}

void checkSettings(const MetadataSettings& settings) {
    const auto isPowerOfTwo = [](int value) {
        return value > 0 && std::has_single_bit(static_cast<unsigned>(value));
    };
    if (!isPowerOfTwo(settings.blockSegments) || settings.blockSegments > 1024) {
        throw Error(fmt::format("terrain: blocks of {} segments; allowed: powers of two to 1024",
                                settings.blockSegments));
    }
    if (!isPowerOfTwo(settings.tileBlocks) || settings.tileBlocks > 256) {
        throw Error(fmt::format("terrain: tiles of {} blocks; allowed: powers of two to 256",
                                settings.tileBlocks));
    }
}

std::span<const std::byte> bytesOf(std::span<const Block> blocks) {
    return std::as_bytes(blocks);
}

/// The blocks of a file of this version and key; nothing when it is another's or damaged.
std::optional<std::vector<Block>> blocksIn(const std::filesystem::path& path,
                                           const std::string& key, std::size_t count) {
    if (!std::filesystem::is_regular_file(path)) return std::nullopt;
    const MappedFile file(path);
    Header header;
    if (file.bytes().size() != sizeof header + count * sizeof(Block)) return std::nullopt;
    std::memcpy(&header, file.bytes().data(), sizeof header);
    const auto content = file.bytes().subspan(sizeof header);
    if (std::memcmp(header.magic, kMagic, sizeof kMagic) != 0 || header.version != kVersion ||
        key.compare(0, key.size(), header.key, sizeof header.key) != 0 ||
        sha256(content).compare(0, std::string::npos, header.checksum, sizeof header.checksum) !=
            0) {
        return std::nullopt;
    }
    std::vector<Block> blocks(count);
    std::memcpy(blocks.data(), content.data(), content.size());
    return blocks;
}

std::string serialized(std::span<const Block> blocks, const std::string& key) {
    Header header{};
    std::memcpy(header.magic, kMagic, sizeof kMagic);
    header.version = kVersion;
    std::memcpy(header.key, key.data(), sizeof header.key);
    const std::string checksum = sha256(bytesOf(blocks));
    std::memcpy(header.checksum, checksum.data(), sizeof header.checksum);
    std::string file(sizeof header + blocks.size_bytes(), '\0');
    std::memcpy(file.data(), &header, sizeof header);
    std::memcpy(file.data() + sizeof header, blocks.data(), blocks.size_bytes());
    return file;
}

}  // namespace

TerrainMetadata::TerrainMetadata(const scene::HeightMap& map, const MetadataSettings& settings)
    : settings_(settings), sizeSamples_(map.sizeSamples), spacingM_(map.spacingM) {
    checkSettings(settings);
    if (map.isEmpty()) throw Error("terrain: the height map has no samples; allowed: at least one");
    const int segments = std::max(map.sizeSamples.x, map.sizeSamples.y) - 1;
    levelCount_ = 1 + std::bit_width(static_cast<unsigned>(settings.tileBlocks)) - 1;
    while (treeSizeSamples() < segments) ++levelCount_;
    std::size_t count = 0;
    for (int level = 0; level < levelCount_; ++level) {
        firstBlock_.push_back(count);
        const auto side = static_cast<std::size_t>(blocksPerSide(level));
        count += side * side;
    }
    blocks_.resize(count);
}

std::size_t TerrainMetadata::blockIndex(int level, int column, int row) const {
    const int side = blocksPerSide(level);
    GFXREPRO_ASSERT(column >= 0 && column < side && row >= 0 && row < side);
    return firstBlock_[static_cast<std::size_t>(level)] +
           static_cast<std::size_t>(row) * static_cast<std::size_t>(side) +
           static_cast<std::size_t>(column);
}

TerrainMetadata TerrainMetadata::build(const scene::HeightMap& map,
                                       const MetadataSettings& settings) {
    TerrainMetadata result(map, settings);
    const int finestPerSide = result.blocksPerSide(0);
    for (int level = 0; level < result.levelCount_; ++level) {
        const std::vector<HeightRange> finest =
            finestRanges(map, level, finestPerSide, settings.blockSegments);
        const int side = result.blocksPerSide(level);
        const int size = result.blockSizeSamples(level);
        const int finestPerBlock = 1 << level;
        tbb::parallel_for(0, side * side, [&](int i) {
            const glm::ivec2 place(i % side, i / side);
            Block& block = result.blocks_[result.blockIndex(level, place.x, place.y)];
            block.whole = greatestOf(finest, finestPerSide, place * finestPerBlock, finestPerBlock);
            block.edges = edgeRanges(map, {place * size, size}, level);
        });
    }
    return result;
}

std::string TerrainMetadata::keyOf(const scene::HeightMap& map, const MetadataSettings& settings) {
    return sha256(fmt::format("terrain {} {} {} {} {} {}", kVersion, map.sizeSamples.x,
                              map.sizeSamples.y, settings.blockSegments, settings.tileBlocks,
                              sha256(std::as_bytes(std::span(map.heightsM)))));
}

TerrainMetadata TerrainMetadata::openOrBuild(const std::filesystem::path& folder,
                                             const scene::HeightMap& map,
                                             const MetadataSettings& settings) {
    TerrainMetadata result(map, settings);
    const std::string key = keyOf(map, settings);
    const std::filesystem::path path = folder / (key + ".terrain");
    if (auto blocks = blocksIn(path, key, result.blocks_.size())) {
        result.blocks_ = std::move(*blocks);
        result.wasBuilt_ = false;
        return result;
    }
    result = build(map, settings);
    try {
        writeFileAtomic(path, serialized(result.blocks_, key));
    } catch (const Error&) {
        // A folder that cannot be written costs the next run its time, no more.
    }
    return result;
}

}  // namespace gfxrepro::terrain_tessellation
