// What the readers of height map files hand to loadHeightMap().
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace gfxrepro::scene {

/// As the file has them; NaN is "no data".
struct HeightValues {
    glm::ivec2 size{0};
    std::vector<float> values;
    std::vector<float> noData;  // further values that mean "no data"
    bool isEightBit = false;
};

/// Throws Error for sides that are not 1 … kMaxHeightMapSide; `name` stands in the message.
void checkHeightMapSize(std::int64_t width, std::int64_t height, const std::string& name);

/// Grey TIFF of 8 or 16 bit integers or 32 bit floats, in strips or tiles, with GDAL's no-data tag.
HeightValues readTiffValues(const std::filesystem::path& path);

}  // namespace gfxrepro::scene
