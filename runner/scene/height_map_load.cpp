// Height maps from PNG, SRTM and raw files; TIFF has a file of its own.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <span>
#include <string_view>

#include "runner/config/node.h"
#include "runner/core/error.h"
#include "runner/core/files.h"
#include "runner/core/text.h"
#include "runner/image/png_io.h"
#include "runner/scene/height_map.h"
#include "runner/scene/height_map_values.h"

namespace gfxrepro::scene {

namespace fs = std::filesystem;

void checkHeightMapSize(std::int64_t width, std::int64_t height, const std::string& name) {
    if (width >= 1 && height >= 1 && width <= kMaxHeightMapSide && height <= kMaxHeightMapSide) {
        return;
    }
    throw Error(fmt::format("{}: a height map of {} x {} samples; allowed: 1 to {} a side", name,
                            width, height, kMaxHeightMapSide));
}

namespace {

constexpr float kSrtmVoid = -32768.0F;

HeightValues readPngValues(const fs::path& path) {
    const image::Image16 image = image::readPng16(path);
    checkHeightMapSize(image.width(), image.height(), path.string());
    if (image.channels() > 2) {
        throw Error(fmt::format("{}: {} channels; a height map is grey, with or without alpha",
                                path.string(), image.channels()));
    }
    constexpr std::size_t kBitDepthAt = 24;  // signature, length, "IHDR", width, height
    const MappedFile file(path);
    HeightValues result;
    result.isEightBit = file.bytes()[kBitDepthAt] != std::byte{16};
    result.size = {image.width(), image.height()};
    result.values.reserve(static_cast<std::size_t>(image.width()) *
                          static_cast<std::size_t>(image.height()));
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) {
            const bool isHole = image.channels() == 2 && image.at(x, y, 1) == 0;
            const int value = result.isEightBit ? image.at(x, y) / 257 : image.at(x, y);
            result.values.push_back(isHole ? NAN : static_cast<float>(value));
        }
    }
    return result;
}

enum class ValueType { U16, I16, F32 };

float valueAt(const std::byte* bytes, ValueType type, bool isBigEndian) {
    std::array<std::byte, 4> ordered{};
    const std::size_t size = type == ValueType::F32 ? 4 : 2;
    const bool isSwapped = isBigEndian != (std::endian::native == std::endian::big);
    for (std::size_t i = 0; i < size; ++i) ordered[isSwapped ? size - 1 - i : i] = bytes[i];
    if (type == ValueType::F32) return std::bit_cast<float>(ordered);
    std::uint16_t bits = 0;
    std::memcpy(&bits, ordered.data(), sizeof bits);
    return type == ValueType::U16 ? static_cast<float>(bits)
                                  : static_cast<float>(static_cast<std::int16_t>(bits));
}

HeightValues valuesOf(std::span<const std::byte> bytes, glm::ivec2 size, ValueType type,
                      bool isBigEndian) {
    HeightValues result;
    result.size = size;
    result.values.resize(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
    const std::size_t valueBytes = type == ValueType::F32 ? 4 : 2;
    for (std::size_t i = 0; i < result.values.size(); ++i) {
        result.values[i] = valueAt(bytes.data() + i * valueBytes, type, isBigEndian);
    }
    if (type != ValueType::U16) result.noData.push_back(kSrtmVoid);
    return result;
}

HeightValues readSrtmValues(const fs::path& path) {
    const MappedFile file(path);
    for (const int side : {1201, 3601}) {
        const auto sizeBytes = 2 * static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
        if (file.bytes().size() == sizeBytes) {
            return valuesOf(file.bytes(), glm::ivec2(side), ValueType::I16, true);
        }
    }
    throw Error(
        fmt::format("{}: {} bytes; an SRTM tile has 2884802 (1201 x 1201) or 25934402 "
                    "(3601 x 3601)",
                    path.string(), file.bytes().size()));
}

const config::Node& required(const config::Node& map, std::string_view key) {
    const config::Node* value = map.find(key);
    if (value == nullptr) throw Error(map.location(), fmt::format("'{}' is missing", key));
    return *value;
}

ValueType typeOf(const config::Node& node) {
    const std::string& text = node.text();
    if (text == "u16") return ValueType::U16;
    if (text == "i16") return ValueType::I16;
    if (text == "f32") return ValueType::F32;
    throw Error(node.location(), fmt::format("type is '{}'; allowed: u16 | i16 | f32", text));
}

bool isBigEndian(const config::Node* node) {
    if (node == nullptr || node->text() == "little") return false;
    if (node->text() == "big") return true;
    throw Error(node->location(),
                fmt::format("byte_order is '{}'; allowed: little | big", node->text()));
}

HeightValues readRawValues(const fs::path& path) {
    const fs::path sidecar = path.string() + ".yaml";
    if (!fs::is_regular_file(sidecar)) {
        throw Error(
            fmt::format("{}: a raw height map needs {} with width, height, type (u16 | i16 "
                        "| f32) and byte_order (little | big)",
                        path.string(), sidecar.string()));
    }
    const config::Node root = config::parseYamlFile(sidecar);
    if (!root.isMap()) throw Error(root.location(), "a raw height map's sidecar must be a map");
    for (const auto& [key, value] : root.entries()) {
        constexpr std::string_view kKeys[] = {"width", "height", "type", "byte_order", "no_data"};
        if (std::find(std::begin(kKeys), std::end(kKeys), key) == std::end(kKeys)) {
            throw Error(root.keyLocation(key),
                        fmt::format("unknown key '{}' (allowed: width, height, type, byte_order, "
                                    "no_data)",
                                    key));
        }
    }
    const long long width = required(root, "width").asInteger();
    const long long height = required(root, "height").asInteger();
    checkHeightMapSize(width, height, sidecar.string());
    const ValueType type = typeOf(required(root, "type"));
    const MappedFile file(path);
    const auto wanted = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                        (type == ValueType::F32 ? 4 : 2);
    if (file.bytes().size() != wanted) {
        throw Error(fmt::format("{}: {} bytes; {} x {} samples of {} need {}", path.string(),
                                file.bytes().size(), width, height, root.find("type")->text(),
                                wanted));
    }
    HeightValues result =
        valuesOf(file.bytes(), {width, height}, type, isBigEndian(root.find("byte_order")));
    if (const config::Node* noData = root.find("no_data")) {
        result.noData.push_back(static_cast<float>(noData->asDouble()));
    }
    return result;
}

struct Format {
    std::string_view extension;
    HeightValues (*read)(const fs::path& path);
};

constexpr Format kFormats[] = {
    {".bin", &readRawValues},   {".hgt", &readSrtmValues}, {".png", &readPngValues},
    {".r16", &readRawValues},   {".raw", &readRawValues},  {".tif", &readTiffValues},
    {".tiff", &readTiffValues},
};

const Format* formatOf(const fs::path& path) {
    std::string extension = path.extension().string();
    for (char& c : extension) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    for (const Format& format : kFormats) {
        if (format.extension == extension) return &format;
    }
    return nullptr;
}

}  // namespace

bool isHeightMapFile(const fs::path& path) {
    return formatOf(path) != nullptr;
}

HeightMap loadHeightMap(const fs::path& path, const HeightMapUnits& units) {
    const Format* format = formatOf(path);
    if (format == nullptr) {
        throw Error(
            fmt::format("{}: unknown kind of height map; allowed: .png .tif .tiff .hgt "
                        ".raw .r16 .bin",
                        path.string()));
    }
    HeightValues source = format->read(path);
    if (units.noData) source.noData.push_back(*units.noData);
    HeightMap map;
    map.sizeSamples = source.size;
    map.spacingM = units.spacingM;
    map.isEightBit = source.isEightBit;
    map.heightsM = std::move(source.values);
    for (float& height : map.heightsM) {
        const bool isHole =
            std::find(source.noData.begin(), source.noData.end(), height) != source.noData.end();
        height = isHole ? NAN : height * units.heightScaleM;
    }
    try {
        fillHoles(map);
    } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", path.string(), error.what()));
    }
    return map;
}

}  // namespace gfxrepro::scene
