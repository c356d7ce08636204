// Height maps' files, read row by row.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

namespace gfxrepro::scene {

/// A file's values, from north to south. In memory are a row or, of a file in tiles, a row of them.
class HeightRows {
  public:
    virtual ~HeightRows() = default;

    /// Of the next row, as the file has them; NaN is "no data". Throws Error that names the file.
    virtual void read(float* values) = 0;

    glm::ivec2 sizeSamples{0};
    std::vector<float> noData;  // further values that mean "no data"
    bool canBeNan = false;
    bool isEightBit = false;
};

/// Throws Error for sides that are not kMinHeightMapSide … kMaxHeightFileSide; `name` stands in the
/// message.
void checkHeightMapSize(std::int64_t width, std::int64_t height, const std::string& name);

/// By extension (loadHeightMap()). Reads what stands before the first row, and throws Error for
/// what cannot be read so: an interlaced PNG and a row of tiles come whole, which is bounded.
std::unique_ptr<HeightRows> openHeightRows(const std::filesystem::path& path);

/// Grey TIFF of 8 or 16 bit integers or 32 bit floats, in strips or tiles, with GDAL's no-data tag.
std::unique_ptr<HeightRows> openTiffRows(const std::filesystem::path& path);

}  // namespace gfxrepro::scene
