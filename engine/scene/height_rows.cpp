// Rows of PNG, SRTM, raw and TIFF files; samples without data.
#include "engine/scene/height_rows.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tiffio.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string_view>
#include <utility>

#include "engine/core/checks.h"
#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/core/node.h"
#include "engine/image/formats.h"
#include "engine/image/image.h"
#include "engine/image/png_io.h"
#include "engine/scene/geo_tiff.h"
#include "engine/scene/height_map.h"
#include "engine/scene/model_files.h"

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
    PngHeightRows(const fs::path& path, bool /*needsSpacing*/) : rows_(path, kMaxHeightFileSide) {
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
        // Fewer bits come as parts of 16: heights are the numbers that are stored.
        step_ = 65535 / ((1 << std::min(rows_.bitDepth(), 8)) - 1);
        canBeNan = rows_.channels() == 2;
        row_.resize(static_cast<std::size_t>(rows_.width()) *
                    static_cast<std::size_t>(rows_.channels()));
        findScale(path);
    }

    void read(float* values) override {
        rows_.read(row_.data());
        const auto channels = static_cast<std::size_t>(rows_.channels());
        for (std::size_t i = 0; i < row_.size(); i += channels) {
            const bool isHole = channels == 2 && row_[i + 1] == 0;
            const int value = isEightBit ? row_[i] / step_ : row_[i];
            *values++ = isHole ? NAN : static_cast<float>(value);
        }
    }

  private:
    void findScale(const fs::path& path) {
        const image::PngPhysics said = image::pngPhysics(MappedFile(path).bytes());
        if (said.isTurned) throw Error(path.string() + ": turned by its Exif; allowed: as stored");
        if (said.pixelM) spacingM = glm::vec2((*said.pixelM)[0], (*said.pixelM)[1]);
        if (said.hasSize && !spacingM) {
            spacingWarning = "left out: the size of its pixels (chunk sCAL), none in metres";
        }
        if (said.hasValues) {
            unitWarning =
                "left out: what its values mean (chunk pCAL): heights are the numbers that are "
                "stored";
        }
    }

    image::PngRows rows_;
    int step_ = 257;
    std::vector<std::uint16_t> row_;
};

enum class ValueType { U8, I8, U16, I16, U32, I32, F32, F64 };

std::size_t valueBytes(ValueType type) {
    constexpr std::size_t kBytes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return kBytes[static_cast<std::size_t>(type)];
}

double valueAt(const char* bytes, ValueType type, bool isBigEndian) {
    const std::size_t size = valueBytes(type), spare = 64 - 8 * size;
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < size; ++i) {
        bits = bits << 8 | static_cast<unsigned char>(bytes[isBigEndian ? i : size - 1 - i]);
    }
    if (type == ValueType::F64) return std::bit_cast<double>(bits);
    if (type == ValueType::F32) return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
    const bool isSigned = type == ValueType::I8 || type == ValueType::I16 || type == ValueType::I32;
    return isSigned ? static_cast<double>(static_cast<std::int64_t>(bits << spare) >> spare)
                    : static_cast<double>(bits);
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
            *values++ = static_cast<float>(valueAt(&row_[i], type_, isBigEndian_));
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

std::unique_ptr<HeightRows> openSrtmRows(const fs::path& path, bool /*needsSpacing*/) {
    const std::uintmax_t bytes = bytesOfFile(path);
    for (const int side : {1201, 3601}) {
        if (bytes != 2 * static_cast<std::uintmax_t>(side) * static_cast<std::uintmax_t>(side)) {
            continue;
        }
        auto rows = std::make_unique<BareRows>(path, glm::ivec2(side), ValueType::I16, true);
        const double southM = kMetresPerDegree / (side - 1);  // of a tile's degree
        const auto latitude = middleOfTile(path.stem().string());
        rows->spacingM = glm::vec2(groundStep({southM, southM}, latitude.value_or(0.0)));
        if (!latitude) {
            rows->spacingWarning =
                "its name says no latitude, as that of N46E007.hgt does: its samples are drawn as "
                "far apart from west to east as from north to south";
        }
        return rows;
    }
    throw Error(
        fmt::format("{}: {} bytes; an SRTM tile has 2884802 (1201 x 1201) or 25934402 "
                    "(3601 x 3601)",
                    path.string(), bytes));
}

constexpr NumberRange kSides{kMinHeightMapSide, kMaxHeightFileSide, false, false, true};
constexpr std::array<std::string_view, 3> kRawTypeNames = {"u16", "i16", "f32"};
constexpr std::array kRawTypes = {ValueType::U16, ValueType::I16, ValueType::F32};
constexpr std::array<std::string_view, 2> kByteOrders = {"little", "big"};

struct RawKeys {
    GivenKey width, height, type, byteOrder, noData;
};
const KeyTable<RawKeys>& rawTable() {
    using R = RawKeys;
    static const KeyTable<R> table{
        {"raw_heights", "", "", false},
        {{&R::width, types::numberKey("width", kSides, "required", "samples from west to east")},
         {&R::height, types::numberKey("height", kSides, "required", "from north to south")},
         {&R::type, types::choiceKey("type", kRawTypeNames, "required", "of a sample")},
         {&R::byteOrder, types::choiceKey("byte_order", kByteOrders, "little", "of a sample")},
         {&R::noData, noDataKey()}}};
    return table;
}

std::unique_ptr<HeightRows> openRawRows(const fs::path& path, bool /*needsSpacing*/) {
    const fs::path sidecar = path.string() + ".yaml";
    if (!fs::is_regular_file(sidecar)) {
        std::string keys;
        for (const SchemaKey& key : rawTable().section().keys) {
            keys += fmt::format("{}{} ({})", keys.empty() ? "" : ", ", key.name, key.inWords());
        }
        throw Error(
            fmt::format("{0}: a raw height map needs {0}.yaml with {1}", path.string(), keys));
    }
    const Node root = parseYamlFile(sidecar);
    const RawKeys given = rawTable().read(root, "a raw height map's sidecar");
    const auto side = [](const GivenKey& key) { return static_cast<std::uint32_t>(key.number()); };
    const std::uint32_t width = side(given.width), height = side(given.height);
    const ValueType type = kRawTypes[given.type.choice()];
    const GivenKey &order = given.byteOrder, &noData = given.noData;
    const bool isBigEndian = order && order.choice() == 1;
    const std::uintmax_t bytes = bytesOfFile(path);
    const std::uintmax_t wanted = std::uintmax_t{width} * height * valueBytes(type);
    if (bytes != wanted) {
        throw Error(fmt::format("{}: {} bytes; {} x {} samples of {} need {}", path.string(), bytes,
                                width, height, given.type->text(), wanted));
    }
    auto rows = std::make_unique<BareRows>(path, glm::ivec2(width, height), type, isBigEndian);
    if (noData) rows->noData.push_back(static_cast<float>(noData.number()));
    return rows;
}

constexpr std::uint32_t kGdalNoData = 42113, kGdalMetadata = 42112;
constexpr std::uint32_t kGeoPixelScale = 33550, kGeoTiepoint = 33922, kGeoTransform = 34264;
constexpr std::uint32_t kGeoKeys = 34735, kGeoKeyDoubles = 34736;
/// Tiles of 1,024² of floats across the widest map.
constexpr std::size_t kMostTileRowBytes = std::size_t{260} << 20;

/// Grey TIFF of integers of 8 to 32 bits or floats of 32 or 64, in strips or tiles, with GDAL's
/// no-data tag (libtiff).
class TiffRows : public HeightRows {
  public:
    TiffRows(const fs::path& path, bool needsSpacing)
        : name_(path.string()), tiff_(image::openTiff(path, message_)) {
        fileBytes_ = fs::file_size(path);
        image::requireOnePage(*tiff_, path, message_);
        readHeader();
        sizeSamples = {static_cast<int>(width_), static_cast<int>(height_)};
        isEightBit = valueBytes(type_) == 1;
        areDoubles = type_ == ValueType::F64;
        canBeNan = type_ == ValueType::F32 || areDoubles;
        if (TIFFIsTiled(tiff_.get()) != 0) {
            prepareTiles();
        } else {
            band_.resize(static_cast<std::size_t>(TIFFScanlineSize(tiff_.get())));
            if (band_.size() < rowBytes()) fail();
        }
        findNoData();
        findUnits(needsSpacing);
    }

    void read(float* values) override {
        const char* row = band_.data();
        if (tileHeight_ == 0) {
            if (TIFFReadScanline(tiff_.get(), band_.data(), row_, 0) != 1) {
                image::failInPart(*tiff_, name_, TIFFComputeStrip(tiff_.get(), row_, 0), message_);
            }
        } else {
            if (row_ % tileHeight_ == 0) readTiles();
            row += std::size_t{row_ % tileHeight_} * rowBytes();
        }
        constexpr bool kIsBigEndian = std::endian::native == std::endian::big;  // by libtiff
        for (std::uint32_t x = 0; x < width_; ++x) {
            const double value = valueAt(row + x * valueBytes(type_), type_, kIsBigEndian);
            values[x] = static_cast<float>(value);
            const bool isExact = double{values[x]} == value;
            const bool fits = isExact || (areDoubles && std::isfinite(values[x]));
            isRounded |= fits && !isExact;
            if (fits || !std::isfinite(value) || std::ranges::count(noData, values[x]) > 0)
                continue;
            throw Error(
                fmt::format("{}: sample {} of row {} is {:.17g}; allowed: what fits into a "
                            "float, as whole numbers up to 16777216",
                            name_, x, row_, value));
        }
        ++row_;
    }

  private:
    [[noreturn]] void fail() const {
        throw Error(
            fmt::format("{}: {}", name_, message_.empty() ? "not a whole TIFF file" : message_));
    }

    void readHeader() {
        TIFFGetField(tiff_.get(), TIFFTAG_IMAGEWIDTH, &width_);
        TIFFGetField(tiff_.get(), TIFFTAG_IMAGELENGTH, &height_);
        std::uint16_t channels = 1, bits = 1, format = SAMPLEFORMAT_UINT;
        TIFFGetFieldDefaulted(tiff_.get(), TIFFTAG_BITSPERSAMPLE, &bits);
        TIFFGetFieldDefaulted(tiff_.get(), TIFFTAG_SAMPLEFORMAT, &format);
        TIFFGetFieldDefaulted(tiff_.get(), TIFFTAG_SAMPLESPERPIXEL, &channels);
        struct Kind {
            std::uint16_t bits, format;
            ValueType type;
        };
        constexpr Kind kKinds[] = {
            {8, SAMPLEFORMAT_UINT, ValueType::U8},     {8, SAMPLEFORMAT_INT, ValueType::I8},
            {16, SAMPLEFORMAT_UINT, ValueType::U16},   {16, SAMPLEFORMAT_INT, ValueType::I16},
            {32, SAMPLEFORMAT_UINT, ValueType::U32},   {32, SAMPLEFORMAT_INT, ValueType::I32},
            {32, SAMPLEFORMAT_IEEEFP, ValueType::F32}, {64, SAMPLEFORMAT_IEEEFP, ValueType::F64}};
        const Kind* kind = std::ranges::find_if(
            kKinds, [&](const Kind& each) { return each.bits == bits && each.format == format; });
        if (channels != 1 || kind == std::end(kKinds)) {
            throw Error(
                fmt::format("{}: {} × {} bits a sample (sample format {}); allowed: one number, "
                            "an integer of 8, 16 or 32 bits or a float of 32 or 64",
                            name_, channels, bits, format));
        }
        type_ = kind->type;
        std::uint16_t colours = PHOTOMETRIC_MINISBLACK;
        TIFFGetField(tiff_.get(), TIFFTAG_PHOTOMETRIC, &colours);
        if (colours == PHOTOMETRIC_PALETTE) {
            throw Error(name_ + ": a palette of colours; a height map is grey");
        }
        std::uint16_t orientation = ORIENTATION_TOPLEFT;
        TIFFGetFieldDefaulted(tiff_.get(), TIFFTAG_ORIENTATION, &orientation);
        if (orientation != ORIENTATION_TOPLEFT) {
            throw Error(fmt::format("{}: orientation {}; allowed: 1 (rows from the top)", name_,
                                    orientation));
        }
        checkHeightMapSize(width_, height_, name_);
        image::checkDeclaredSize(width_, height_, valueBytes(type_), fileBytes_, name_,
                                 kMaxHeightFileSide);
    }

    std::size_t rowBytes() const { return std::size_t{width_} * valueBytes(type_); }

    void prepareTiles() {
        TIFFGetField(tiff_.get(), TIFFTAG_TILEWIDTH, &tileWidth_);
        TIFFGetField(tiff_.get(), TIFFTAG_TILELENGTH, &tileHeight_);
        image::checkDeclaredSize(tileWidth_, tileHeight_, valueBytes(type_), fileBytes_,
                                 name_ + ": a tile", kMaxHeightFileSide);
        // The last tile may reach beyond the map.
        const std::size_t bytes =
            std::size_t{width_ + tileWidth_} * tileHeight_ * valueBytes(type_);
        if (bytes > kMostTileRowBytes) {
            throw Error(fmt::format(
                "{}: a row of tiles of {} x {} samples has {} MiB; allowed: at most {}, as it is "
                "read whole",
                name_, tileWidth_, tileHeight_, (bytes >> 20) + 1, kMostTileRowBytes >> 20));
        }
        band_.resize(rowBytes() * tileHeight_);
        tile_.resize(static_cast<std::size_t>(TIFFTileSize(tiff_.get())));
        if (tile_.size() < std::size_t{tileWidth_} * tileHeight_ * valueBytes(type_)) fail();
    }

    /// The row of tiles that begins with the next row.
    void readTiles() {
        const std::size_t bytes = valueBytes(type_);
        const std::uint32_t rows = std::min(tileHeight_, height_ - row_);
        for (std::uint32_t left = 0; left < width_; left += tileWidth_) {
            if (TIFFReadTile(tiff_.get(), tile_.data(), left, row_, 0, 0) < 0) {
                image::failInPart(*tiff_, name_, TIFFComputeTile(tiff_.get(), left, row_, 0, 0),
                                  message_);
            }
            const std::size_t columns = std::min(tileWidth_, width_ - left);
            for (std::size_t y = 0; y < rows; ++y) {
                std::memcpy(&band_[y * rowBytes() + left * bytes], &tile_[y * tileWidth_ * bytes],
                            columns * bytes);
            }
        }
    }

    void findNoData() {
        if (type_ != ValueType::U8 && type_ != ValueType::U16) noData.push_back(kSrtmVoid);
        if (const auto value = floatIn(textOf(kGdalNoData), name_ + ": its GDAL_NODATA")) {
            noData.push_back(*value);
        }
    }

    void findUnits(bool needsSpacing) {
        // Values of another type than GeoTIFF's would be read beyond their end.
        const GeoUnits units =
            unitsOf({textOf(kGdalMetadata), valuesOf<double>(kGeoPixelScale, TIFF_DOUBLE),
                     valuesOf<double>(kGeoTransform, TIFF_DOUBLE),
                     valuesOf<std::uint16_t>(kGeoKeys, TIFF_SHORT),
                     valuesOf<double>(kGeoKeyDoubles, TIFF_DOUBLE),
                     valuesOf<double>(kGeoTiepoint, TIFF_DOUBLE), sizeSamples},
                    name_, needsSpacing);
        scale = units.scale;
        offset = units.offset;
        spacingM = units.spacingM;
        spacingWarning = units.warning;
        unitWarning = units.unitWarning;
    }

    /// Of a tag that libtiff itself does not know; empty where there is none.
    std::string textOf(std::uint32_t tag) {
        std::uint32_t count = 0;
        const char* text = nullptr;
        if (TIFFGetField(tiff_.get(), tag, &count, &text) != 1 || text == nullptr) return {};
        return {text, strnlen(text, count)};
    }

    template <class T>
    std::vector<T> valuesOf(std::uint32_t tag, TIFFDataType type) {
        std::uint32_t count = 0;
        const T* values = nullptr;
        if (TIFFGetField(tiff_.get(), tag, &count, &values) != 1 || values == nullptr) return {};
        const TIFFField* field = TIFFFindField(tiff_.get(), tag, TIFF_ANY);
        if (field == nullptr || TIFFFieldDataType(field) != type) return {};
        return {values, values + count};
    }

    std::string name_;
    std::string message_;
    std::unique_ptr<TIFF, void (*)(TIFF*)> tiff_;
    std::uintmax_t fileBytes_ = 0;
    std::uint32_t width_ = 0;
    std::uint32_t height_ = 0;
    ValueType type_ = ValueType::U8;
    std::uint32_t tileWidth_ = 0, tileHeight_ = 0;  // 0: strips
    std::vector<char> band_;                        // a row, or a row of tiles
    std::vector<char> tile_;
    std::uint32_t row_ = 0;
};

template <class Rows>
std::unique_ptr<HeightRows> openRows(const fs::path& path, bool needsSpacing) {
    return std::make_unique<Rows>(path, needsSpacing);
}

struct HeightFormat {
    std::string_view extension;
    std::unique_ptr<HeightRows> (*open)(const fs::path& path, bool needsSpacing);
};

constexpr HeightFormat kHeightFormats[] = {
    {".bin", &openRawRows},         {".hgt", &openSrtmRows}, {".png", &openRows<PngHeightRows>},
    {".r16", &openRawRows},         {".raw", &openRawRows},  {".tif", &openRows<TiffRows>},
    {".tiff", &openRows<TiffRows>},
};

const HeightFormat* heightFormatOf(const fs::path& path) {
    const auto* format =
        std::ranges::find(kHeightFormats, lowerCaseExtension(path), &HeightFormat::extension);
    return format == std::end(kHeightFormats) ? nullptr : format;
}

}  // namespace

SchemaFile rawHeightSchema() {
    return {"raw_heights",
            "FILE.yaml, beside a height map FILE that is samples alone",
            {rawTable().section()}};
}

bool isHeightMapFile(const fs::path& path) {
    return heightFormatOf(path) != nullptr;
}

std::unique_ptr<HeightRows> openHeightRows(const fs::path& path, bool needsSpacing) {
    if (const HeightFormat* format = heightFormatOf(path)) return format->open(path, needsSpacing);
    throw Error(path.string() +
                ": unknown kind of height map; allowed: .png .tif .tiff .hgt .raw .r16 .bin");
}

namespace {

/// Steps of the pyramid from the map to the levels that are kept.
constexpr int kFineLevels = std::bit_width(unsigned{HoleFilling::kBandRows}) - 1;

std::size_t valueCount(glm::ivec2 size) {
    return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
}

/// Each value the mean of those of the four below it that have data. The fine rows begin at an even
/// one, and end at one or with the map.
HoleLevel pushed(HoleLevel& fine) {
    HoleLevel coarse{(fine.sizeSamples + 1) / 2, fine.firstRow / 2, {}};
    const int end = (fine.endRow() + 1) / 2;
    coarse.values.resize(valueCount({coarse.sizeSamples.x, end - coarse.firstRow}));
    tbb::parallel_for(coarse.firstRow, end, [&](int y) {
        for (int x = 0; x < coarse.sizeSamples.x; ++x) {
            float sum = 0.0F;
            int count = 0;
            for (int i = 0; i < 4; ++i) {
                const int fineX = 2 * x + i % 2;
                const int fineY = 2 * y + i / 2;
                if (fineX >= fine.sizeSamples.x || fineY >= fine.sizeSamples.y) continue;
                const float value = fine.at(fineX, fineY);
                if (!std::isfinite(value)) continue;
                sum += value;
                ++count;
            }
            coarse.at(x, y) = count > 0 ? sum / static_cast<float>(count) : NAN;
        }
    });
    return coarse;
}

/// Holes of rows [from, end) take the bilinear value of the level above, which has none there.
void pull(HoleLevel& coarse, HoleLevel& fine, int from, int end) {
    tbb::parallel_for(from, end, [&](int y) {
        for (int x = 0; x < fine.sizeSamples.x; ++x) {
            float& value = fine.at(x, y);
            if (std::isfinite(value)) continue;
            // A coarse value stands between its four: the nearest weighs 3/4 a direction.
            const int nearX = x / 2;
            const int nearY = y / 2;
            const int farX = nearX + (x % 2 == 0 ? -1 : 1);
            const int farY = nearY + (y % 2 == 0 ? -1 : 1);
            value = 0.5625F * coarse.clamped(nearX, nearY) + 0.1875F * coarse.clamped(farX, nearY) +
                    0.1875F * coarse.clamped(nearX, farY) + 0.0625F * coarse.clamped(farX, farY);
        }
    });
}

}  // namespace

int HoleLevel::endRow() const {
    return firstRow + static_cast<int>(values.size() / static_cast<std::size_t>(sizeSamples.x));
}

float& HoleLevel::at(int x, int y) {
    return values[static_cast<std::size_t>(y - firstRow) * static_cast<std::size_t>(sizeSamples.x) +
                  static_cast<std::size_t>(x)];
}

float HoleLevel::clamped(int x, int y) {
    return at(std::clamp(x, 0, sizeSamples.x - 1), std::clamp(y, 0, sizeSamples.y - 1));
}

HoleFilling::HoleFilling(glm::ivec2 sizeSamples, const Reader& read) : sizeSamples_(sizeSamples) {
    HoleLevel kept;
    for (int row = 0; row < sizeSamples.y; row += kBandRows) {
        HoleLevel band{sizeSamples, row, {}};
        const int count = std::min(kBandRows, sizeSamples.y - row);
        band.values.resize(valueCount({sizeSamples.x, count}));
        read(count, band.values.data());
        holeCount_ += static_cast<std::size_t>(
            std::count_if(band.values.begin(), band.values.end(),
                          [](float value) { return !std::isfinite(value); }));
        for (int level = 0; level < kFineLevels; ++level) band = pushed(band);
        kept.sizeSamples = band.sizeSamples;
        kept.values.insert(kept.values.end(), band.values.begin(), band.values.end());
    }
    coarse_.push_back(std::move(kept));
    while (coarse_.back().sizeSamples != glm::ivec2(1)) {
        HoleLevel coarser = pushed(coarse_.back());
        coarse_.push_back(std::move(coarser));
    }
    for (std::size_t i = coarse_.size() - 1; i > 0; --i) {
        pull(coarse_[i], coarse_[i - 1], 0, coarse_[i - 1].sizeSamples.y);
    }
}

void HoleFilling::restart(Reader read) {
    if (holeCount_ == valueCount(sizeSamples_)) {
        throw Error("no sample has data; allowed: at least one");
    }
    read_ = std::move(read);
    window_ = {sizeSamples_, 0, {}};
    nextRow_ = 0;
    readBand();
}

void HoleFilling::readBand() {
    const int count = std::min(kBandRows, sizeSamples_.y - window_.endRow());
    if (count <= 0) return;
    const std::size_t before = window_.values.size();
    window_.values.resize(before + valueCount({sizeSamples_.x, count}));
    read_(count, &window_.values[before]);
}

void HoleFilling::next(float* values) {
    GFXREPRO_ASSERT(nextRow_ < sizeSamples_.y);
    if (nextRow_ - window_.firstRow > kBandRows) {
        window_.values.erase(window_.values.begin(),
                             window_.values.begin() + std::ptrdiff_t{kBandRows} * sizeSamples_.x);
        window_.firstRow += kBandRows;
    }
    readBand();
    const int end = std::min(nextRow_ + kBandRows, sizeSamples_.y);
    std::vector<HoleLevel> fine{window_};
    for (int level = 1; level < kFineLevels; ++level) fine.push_back(pushed(fine.back()));
    // Rows of each level that holes of the band reach: the one before, and the one after.
    std::vector<glm::ivec2> rows{{nextRow_, end}};
    for (int level = 1; level < kFineLevels; ++level) {
        const glm::ivec2 below = rows.back();
        rows.emplace_back(
            std::max(below.x / 2 - 1, 0),
            std::min((below.y - 1) / 2 + 2, fine[static_cast<std::size_t>(level)].sizeSamples.y));
    }
    for (std::size_t level = fine.size(); level > 0; --level) {
        HoleLevel& coarser = level == fine.size() ? coarse_.front() : fine[level];
        pull(coarser, fine[level - 1], rows[level - 1].x, rows[level - 1].y);
    }
    std::copy_n(&fine.front().at(0, nextRow_), valueCount({sizeSamples_.x, end - nextRow_}),
                values);
    nextRow_ = end;
}

}  // namespace gfxrepro::scene
