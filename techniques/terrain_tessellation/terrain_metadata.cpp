#include "techniques/terrain_tessellation/terrain_metadata.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <type_traits>

#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/hash.h"
#include "engine/core/wide.h"
#include "techniques/kit/kept_file.h"

namespace gfxrepro::terrain_tessellation {

namespace {

constexpr std::uint32_t kVersion = 2;
constexpr const char* kMagic = "gfxterra";

struct Header {
    kit::FileStamp stamp;
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

/// Adds a row of samples from `first` on to the extremes of their columns; of a sample beyond
/// `border` the one there. `grid` begins with the cell of `first`.
GFXREPRO_WIDE void addSamples(const float* __restrict heightsM, int border,
                              const float* __restrict grid, int level, int first, int count,
                              float* __restrict lowestM, float* __restrict highestM,
                              float* __restrict errorM) {
    const int west = first >> level;
    const float perStep = 1.0F / static_cast<float>(1 << level);  // exact: a power of two
    for (int i = 0; i < count; ++i) {
        const int column = first + i, cell = column >> level;
        const float t = static_cast<float>(column - (cell << level)) * perStep;
        const float height = heightsM[std::min(column, border)];
        const float error = std::abs(height - between(grid[cell - west], grid[cell - west + 1], t));
        lowestM[i] = std::min(lowestM[i], height);
        highestM[i] = std::max(highestM[i], height);
        errorM[i] = std::max(errorM[i], error);
    }
}

/// Heights of a square's samples against the grid of one level.
class SquareErrors {
  public:
    SquareErrors(const scene::HeightMap& map, int level)
        : map_(map), level_(level), step_(1 << level) {}

    HeightRange over(const Square& square) {
        const auto count = static_cast<std::size_t>(square.size) + 1;
        lowestM_.assign(count, kNothing.minM);
        highestM_.assign(count, kNothing.maxM);
        errorM_.assign(count, kNothing.errorM);
        for (int row = square.origin.y; row <= square.origin.y + square.size; ++row) {
            interpolateGrid(square, row);
            addRow(square, row);
        }
        return {*std::ranges::min_element(lowestM_), *std::ranges::max_element(highestM_),
                *std::ranges::max_element(errorM_)};
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

    void addRow(const Square& square, int row) {
        const float* heightsM =
            (map_.file ? map_.file->heightsM(0) : map_.heightsM.data()) +
            static_cast<std::ptrdiff_t>(std::min(row, map_.sizeSamples.y - 1)) * map_.sizeSamples.x;
        addSamples(heightsM, map_.sizeSamples.x - 1, grid_.data(), level_, square.origin.x,
                   square.size + 1, lowestM_.data(), highestM_.data(), errorM_.data());
    }

    const scene::HeightMap& map_;
    int level_;
    int step_;
    std::vector<float> grid_;
    std::vector<float> lowestM_, highestM_, errorM_;  // of the square's columns
};

/// Rows of finest squares whose samples a file's heights keep in memory at a time.
constexpr int kSquareRowsAtOnce = 8;

/// fill(row) of many rows at once; what they looked at leaves the memory with every few.
template <class Fill>
void forRows(const scene::HeightMap& map, int rows, const Fill& fill) {
    for (int first = 0; first < rows; first += kSquareRowsAtOnce) {
        tbb::parallel_for(first, std::min(rows, first + kSquareRowsAtOnce), fill);
        map.release();
    }
}

/// `size` samples and one more from `begin` on along an axis, against the line through every
/// 2^level-th. It depends on these samples alone, so that both neighbours of an edge find the same.
HeightRange pieceRange(const scene::HeightMap& map, glm::ivec2 begin, int axis, int size,
                       int level) {
    const int step = 1 << level;
    glm::ivec2 along(0);
    along[axis] = 1;
    const auto heightAt = [&](int i) {
        const glm::ivec2 at = begin + along * (i - begin[axis]);
        return map.clampedHeightM(at.x, at.y);
    };
    HeightRange range = kNothing;
    for (int i = begin[axis]; i <= begin[axis] + size; ++i) {
        const int from = i >> level << level;
        const float t = static_cast<float>(i - from) / static_cast<float>(step);
        const float height = heightAt(i);
        const float line = between(heightAt(from), heightAt(from + step), t);
        range.add({height, height, std::abs(height - line)});
    }
    return range;
}

/// A grid of ranges.
struct Ranges {
    int width = 0;
    std::vector<HeightRange> values;

    Ranges(int columns, int rows)
        : width(columns),
          values(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), kNothing) {}
    HeightRange& at(int column, int row) {
        return values[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(column)];
    }
    HeightRange greatestOf(glm::ivec2 first, glm::ivec2 count) {
        HeightRange range = kNothing;
        for (int row = first.y; row < first.y + count.y; ++row) {
            for (int column = first.x; column < first.x + count.x; ++column) {
                range.add(at(column, row));
            }
        }
        return range;
    }
};

/// One level's ranges over all squares of the size of a finest block, and over pieces of its
/// blocks' edges as long as that: work of equal parts at every level, however few blocks it has.
struct FinestRanges {
    Ranges squares;
    Ranges alongZ;  // column: of a block's western edge, row: of the piece
    Ranges alongX;  // column: of the piece, row: of a block's northern edge

    FinestRanges(const scene::HeightMap& map, int level, int perSide, int squareSize)
        : squares(perSide, perSide),
          alongZ((perSide >> level) + 1, perSide),
          alongX(perSide, (perSide >> level) + 1) {
        const int blockSize = squareSize << level;
        forRows(map, perSide + 1, [&](int row) {
            const int z = row * squareSize;
            if (z % blockSize == 0) {
                for (int column = 0; column < perSide; ++column) {
                    alongX.at(column, z / blockSize) =
                        pieceRange(map, {column * squareSize, z}, 0, squareSize, level);
                }
            }
            if (row == perSide) return;  // of the southern rim alone
            SquareErrors errors(map, level);
            for (int column = 0; column < perSide; ++column) {
                squares.at(column, row) = errors.over({{column * squareSize, z}, squareSize});
            }
            for (int column = 0; column < alongZ.width; ++column) {
                alongZ.at(column, row) =
                    pieceRange(map, {column * blockSize, z}, 1, squareSize, level);
            }
        });
    }

    Block block(glm::ivec2 place, int level) {
        const int count = 1 << level;
        const glm::ivec2 first = place * count;
        Block block;
        block.whole = squares.greatestOf(first, {count, count});
        block.edges[kWest] = alongZ.greatestOf({place.x, first.y}, {1, count});
        block.edges[kEast] = alongZ.greatestOf({place.x + 1, first.y}, {1, count});
        block.edges[kNorth] = alongX.greatestOf({first.x, place.y}, {count, 1});
        block.edges[kSouth] = alongX.greatestOf({first.x, place.y + 1}, {count, 1});
        return block;
    }
};

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

/// The blocks of a file of this version and key; nothing when it is another's or damaged.
std::optional<std::vector<Block>> blocksIn(const std::filesystem::path& path,
                                           const std::string& key, std::size_t count) {
    if (!std::filesystem::is_regular_file(path)) return std::nullopt;
    const MappedFile file(path);
    Header header;
    if (file.bytes().size() != sizeof header + count * sizeof(Block)) return std::nullopt;
    std::memcpy(&header, file.bytes().data(), sizeof header);
    const auto content = file.bytes().subspan(sizeof header);
    if (header.stamp != kit::FileStamp(kMagic, kVersion, key) ||
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
    header.stamp = {kMagic, kVersion, key};
    const std::string checksum = sha256(std::as_bytes(blocks));
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
    int count = 0;
    for (int level = 0; level < levelCount_; ++level) {
        firstBlocks_.push_back(count);
        count += blocksPerSide(level) * blocksPerSide(level);
    }
    blocks_.resize(static_cast<std::size_t>(count));
}

std::size_t TerrainMetadata::blockIndex(int level, int column, int row) const {
    const int side = blocksPerSide(level);
    GFXREPRO_ASSERT(column >= 0 && column < side && row >= 0 && row < side);
    return static_cast<std::size_t>(firstBlocks_[static_cast<std::size_t>(level)] + row * side +
                                    column);
}

TerrainMetadata TerrainMetadata::build(const scene::HeightMap& map,
                                       const MetadataSettings& settings) {
    TerrainMetadata result(map, settings);
    for (int level = 0; level < result.levelCount_; ++level) {
        FinestRanges finest(map, level, result.blocksPerSide(0), settings.blockSegments);
        const int size = result.blockSizeSamples(level);
        const int side = result.blocksPerSide(level);
        forRows(map, side, [&](int row) {
            for (int column = 0; column < side; ++column) {
                Block& block = result.blocks_[result.blockIndex(level, column, row)];
                block = finest.block({column, row}, level);
                for (int i = 0; i < 4; ++i) {
                    block.cornersM[static_cast<std::size_t>(i)] =
                        map.clampedHeightM((column + i % 2) * size, (row + i / 2) * size, level);
                }
            }
        });
    }
    return result;
}

std::string TerrainMetadata::keyOf(const scene::HeightMap& map, const MetadataSettings& settings) {
    const std::string heights =
        map.file ? "file " + map.file->key() : sha256(std::as_bytes(std::span(map.heightsM)));
    return sha256(fmt::format("terrain {} {} {} {} {} {}", kVersion, map.sizeSamples.x,
                              map.sizeSamples.y, settings.blockSegments, settings.tileBlocks,
                              heights));
}

TerrainMetadata TerrainMetadata::openOrBuild(const std::filesystem::path& folder,
                                             const scene::HeightMap& map,
                                             const MetadataSettings& settings) {
    const std::string key = keyOf(map, settings);
    const std::filesystem::path path = folder / (key + ".terrain");
    const auto find = [&]() -> std::optional<TerrainMetadata> {
        TerrainMetadata result(map, settings);
        auto blocks = blocksIn(path, key, result.blocks_.size());
        if (!blocks) return std::nullopt;
        result.blocks_ = std::move(*blocks);
        result.wasBuilt_ = false;
        return result;
    };
    const auto make = [&] {
        TerrainMetadata result = build(map, settings);
        kit::keepFile(path, serialized(result.blocks_, key));
        return result;
    };
    return kit::foundOrMade<TerrainMetadata>(path, find, make);
}

}  // namespace gfxrepro::terrain_tessellation
