// Height maps' files, read row by row.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/key_schema.h"

namespace gfxrepro::scene {

/// A file's values, from north to south. In memory are a row or, of a file in tiles, a row of them.
class HeightRows {
  public:
    virtual ~HeightRows() = default;

    /// Of the next row, as the file has them; NaN is "no data". Throws Error that names the file.
    virtual void read(float* values) = 0;

    glm::ivec2 sizeSamples{0};
    std::vector<float> noData;  // further values that mean "no data"
    float scale = 1.0F;         // as the file says: height = value · scale + offset
    float offset = 0.0F;
    std::optional<glm::vec2> spacingM;  // as the file says: along x and z
    std::string spacingWarning;         // of one that is a guess, or not known
    std::string unitWarning;            // of heights that are taken as metres
    bool canBeNan = false;
    bool areDoubles = false, isRounded = false;  // the latter once one was read that no float is
    bool isEightBit = false;
};

/// Throws Error for sides that are not kMinHeightMapSide … kMaxHeightFileSide; `name` stands in the
/// message.
void checkHeightMapSize(std::int64_t width, std::int64_t height, const std::string& name);

/// By extension (loadHeightMap()). Reads what stands before the first row, and throws Error for
/// what cannot be read so: an interlaced PNG and a row of tiles come whole, which is bounded. Where
/// a spacing is given the file's is not read.
std::unique_ptr<HeightRows> openHeightRows(const std::filesystem::path& path,
                                           bool needsSpacing = true);

/// Of every source of heights.
inline SchemaKey noDataKey() {
    return types::numberKey("no_data", {}, "none", "the value of samples that are missing");
}
/// Of what stands beside a file of nothing but samples.
SchemaFile rawHeightSchema();

// Samples without data, filled by a push-pull pyramid: of a map in memory, and of one that comes in
// bands of rows.

/// Rows of one step of the pyramid; NaN is "no data".
struct HoleLevel {
    glm::ivec2 sizeSamples{0};  // of the whole step
    int firstRow = 0;
    std::vector<float> values;  // of whole rows

    int endRow() const;
    float& at(int x, int y);
    float clamped(int x, int y);
};

/// Each hole takes a value from the finest level that has data around it. Levels coarser than a
/// band's are kept whole, the finer ones made again for each band and the bands beside it.
class HoleFilling {
  public:
    /// A coarse row stands for as many rows of the map.
    static constexpr int kBandRows = 64;
    /// Reads kBandRows rows, or those that are left, behind those that were read before.
    using Reader = std::function<void(int count, float* values)>;

    /// Reads all rows.
    HoleFilling(glm::ivec2 sizeSamples, const Reader& read);

    std::size_t holeCount() const { return holeCount_; }

    /// Reads all rows once more, band by band as they are asked for. Throws Error where no sample
    /// has data.
    void restart(Reader read);
    /// The next band, filled.
    void next(float* values);

  private:
    void readBand();

    glm::ivec2 sizeSamples_;
    std::size_t holeCount_ = 0;
    std::vector<HoleLevel> coarse_;
    Reader read_;
    HoleLevel window_;  // the band and those beside it, as read
    int nextRow_ = 0;
};

}  // namespace gfxrepro::scene
