// Rows of PNG, SRTM and raw files; TIFF has a file of its own.
#include "engine/scene/height_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string_view>

#include "engine/core/error.h"
#include "engine/core/node.h"
#include "engine/image/png_io.h"
#include "engine/scene/height_map.h"

namespace gfxrepro::scene {

namespace fs = std::filesystem;

void checkHeightMapSize(std::int64_t width, std::int64_t height, const std::string& name) {
    const auto [least, most] = std::minmax(width, height);
    if (least >= kMinHeightMapSide && most <= kMaxHeightFileSide) return;
    throw Error(fmt::format("{}: a height map of {} x {} samples; allowed: {} to {} a side", name,
                            width, height, kMinHeightMapSide, kMaxHeightFileSide));
}

namespace {

constexpr float kSrtmVoid = -32768.0F;

class PngHeightRows : public HeightRows {
  public:
    explicit PngHeightRows(const fs::path& path) : rows_(path, kMaxHeightFileSide) {
        if (rows_.channels() > 2) {
            throw Error(fmt::format("{}: {} channels; a height map is grey, with or without alpha",
                                    path.string(), rows_.channels()));
        }
        checkHeightMapSize(rows_.width(), rows_.height(), path.string());
        sizeSamples = {rows_.width(), rows_.height()};
        if (rows_.isInterlaced() && std::max(rows_.width(), rows_.height()) > kMaxHeightMapSide) {
            throw Error(
                fmt::format("{0}: interlaced, {1} x {2} samples; allowed: {3} to {4} a side, as "
                            "it is decoded whole, and {3} to {5} where it is not interlaced",
                            path.string(), rows_.width(), rows_.height(), kMinHeightMapSide,
                            kMaxHeightMapSide, kMaxHeightFileSide));
        }
        isEightBit = rows_.bitDepth() != 16;
        canBeNan = rows_.channels() == 2;
        row_.resize(static_cast<std::size_t>(rows_.width()) *
                    static_cast<std::size_t>(rows_.channels()));
    }

    void read(float* values) override {
        rows_.read(row_.data());
        const auto channels = static_cast<std::size_t>(rows_.channels());
        for (std::size_t i = 0; i < row_.size(); i += channels) {
            const bool isHole = channels == 2 && row_[i + 1] == 0;
            const int value = isEightBit ? row_[i] / 257 : row_[i];
            *values++ = isHole ? NAN : static_cast<float>(value);
        }
    }

  private:
    image::PngRows rows_;
    std::vector<std::uint16_t> row_;
};

enum class ValueType { U16, I16, F32 };

std::size_t valueBytes(ValueType type) {
    return type == ValueType::F32 ? 4 : 2;
}

float valueAt(const char* bytes, ValueType type, bool isBigEndian) {
    std::array<char, 4> ordered{};
    const std::size_t size = valueBytes(type);
    const bool isSwapped = isBigEndian != (std::endian::native == std::endian::big);
    for (std::size_t i = 0; i < size; ++i) ordered[isSwapped ? size - 1 - i : i] = bytes[i];
    if (type == ValueType::F32) return std::bit_cast<float>(ordered);
    std::uint16_t bits = 0;
    std::memcpy(&bits, ordered.data(), sizeof bits);
    return type == ValueType::U16 ? static_cast<float>(bits)
                                  : static_cast<float>(static_cast<std::int16_t>(bits));
}

/// A file of nothing but values.
class BareRows : public HeightRows {
  public:
    BareRows(const fs::path& path, glm::ivec2 size, ValueType type, bool isBigEndian)
        : name_(path.string()),
          file_(path, std::ios::binary),
          type_(type),
          isBigEndian_(isBigEndian) {
        sizeSamples = size;
        canBeNan = type == ValueType::F32;
        if (type != ValueType::U16) noData.push_back(kSrtmVoid);
        row_.resize(static_cast<std::size_t>(size.x) * valueBytes(type));
    }

    void read(float* values) override {
        if (!file_.read(row_.data(), static_cast<std::streamsize>(row_.size()))) {
            throw Error(fmt::format("cannot read {}: {}", name_, std::strerror(errno)));
        }
        const std::size_t step = valueBytes(type_);
        for (std::size_t i = 0; i < row_.size(); i += step) {
            *values++ = valueAt(&row_[i], type_, isBigEndian_);
        }
    }

  private:
    std::string name_;
    std::ifstream file_;
    ValueType type_;
    bool isBigEndian_;
    std::vector<char> row_;
};

std::uintmax_t bytesOfFile(const fs::path& path) {
    std::error_code failure;
    const std::uintmax_t bytes = fs::file_size(path, failure);
    if (failure) throw Error(fmt::format("cannot read {}: {}", path.string(), failure.message()));
    return bytes;
}

std::unique_ptr<HeightRows> openSrtmRows(const fs::path& path) {
    const std::uintmax_t bytes = bytesOfFile(path);
    for (const int side : {1201, 3601}) {
        if (bytes != 2 * static_cast<std::uintmax_t>(side) * static_cast<std::uintmax_t>(side)) {
            continue;
        }
        return std::make_unique<BareRows>(path, glm::ivec2(side), ValueType::I16, true);
    }
    throw Error(
        fmt::format("{}: {} bytes; an SRTM tile has 2884802 (1201 x 1201) or 25934402 "
                    "(3601 x 3601)",
                    path.string(), bytes));
}

const Node& required(const Node& map, std::string_view key) {
    const Node* value = map.find(key);
    if (value == nullptr) throw Error(map.location(), fmt::format("'{}' is missing", key));
    return *value;
}

ValueType typeOf(const Node& node) {
    const std::string& text = node.text();
    if (text == "u16") return ValueType::U16;
    if (text == "i16") return ValueType::I16;
    if (text == "f32") return ValueType::F32;
    throw Error(node.location(), fmt::format("type is '{}'; allowed: u16 | i16 | f32", text));
}

bool isBigEndian(const Node* node) {
    if (node == nullptr || node->text() == "little") return false;
    if (node->text() == "big") return true;
    throw Error(node->location(),
                fmt::format("byte_order is '{}'; allowed: little | big", node->text()));
}

std::unique_ptr<HeightRows> openRawRows(const fs::path& path) {
    const fs::path sidecar = path.string() + ".yaml";
    if (!fs::is_regular_file(sidecar)) {
        throw Error(
            fmt::format("{}: a raw height map needs {} with width, height, type (u16 | i16 "
                        "| f32) and byte_order (little | big)",
                        path.string(), sidecar.string()));
    }
    const Node root = parseYamlFile(sidecar);
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
    const std::uintmax_t bytes = bytesOfFile(path);
    const auto wanted =
        static_cast<std::uintmax_t>(width) * static_cast<std::uintmax_t>(height) * valueBytes(type);
    if (bytes != wanted) {
        throw Error(fmt::format("{}: {} bytes; {} x {} samples of {} need {}", path.string(), bytes,
                                width, height, root.find("type")->text(), wanted));
    }
    auto rows = std::make_unique<BareRows>(path, glm::ivec2(width, height), type,
                                           isBigEndian(root.find("byte_order")));
    if (const Node* noData = root.find("no_data")) {
        rows->noData.push_back(static_cast<float>(noData->asDouble()));
    }
    return rows;
}

std::unique_ptr<HeightRows> openPngRows(const fs::path& path) {
    return std::make_unique<PngHeightRows>(path);
}

struct HeightFormat {
    std::string_view extension;
    std::unique_ptr<HeightRows> (*open)(const fs::path& path);
};

constexpr HeightFormat kHeightFormats[] = {
    {".bin", &openRawRows},   {".hgt", &openSrtmRows}, {".png", &openPngRows},
    {".r16", &openRawRows},   {".raw", &openRawRows},  {".tif", &openTiffRows},
    {".tiff", &openTiffRows},
};

const HeightFormat* heightFormatOf(const fs::path& path) {
    std::string extension = path.extension().string();
    for (char& c : extension) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    for (const HeightFormat& format : kHeightFormats) {
        if (format.extension == extension) return &format;
    }
    return nullptr;
}

}  // namespace

bool isHeightMapFile(const fs::path& path) {
    return heightFormatOf(path) != nullptr;
}

std::unique_ptr<HeightRows> openHeightRows(const fs::path& path) {
    if (const HeightFormat* format = heightFormatOf(path)) return format->open(path);
    throw Error(
        fmt::format("{}: unknown kind of height map; allowed: .png .tif .tiff .hgt "
                    ".raw .r16 .bin",
                    path.string()));
}

}  // namespace gfxrepro::scene
