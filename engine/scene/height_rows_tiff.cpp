// Rows of TIFF files (libtiff).
#include <fmt/format.h>
#include <tiffio.h>

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "engine/core/error.h"
#include "engine/image/limits.h"
#include "engine/scene/height_map.h"
#include "engine/scene/height_rows.h"

namespace gfxrepro::scene {

namespace {

constexpr std::uint32_t kGdalNoData = 42113;
/// Tiles of 1,024² of floats across the widest map.
constexpr std::size_t kMostTileRowBytes = std::size_t{260} << 20;

int keepFirstMessage(TIFF*, void* to, const char*, const char* format, va_list arguments) {
    auto& message = *static_cast<std::string*>(to);
    if (!message.empty()) return 1;
    char text[256];
    std::vsnprintf(text, sizeof text, format, arguments);
    message = text;
    return 1;
}

/// Unknown tags, which GeoTIFF is full of, are no harm. A tag that lies beyond the end of the file
/// is: it may be the one that says which values are none.
int keepReadWarning(TIFF* tiff, void* to, const char* module, const char* format,
                    va_list arguments) {
    if (std::strstr(format, "IO error") == nullptr) return 1;
    return keepFirstMessage(tiff, to, module, format, arguments);
}

class TiffRows : public HeightRows {
  public:
    explicit TiffRows(const std::filesystem::path& path) : name_(path.string()) {
        const std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions*)> options(
            TIFFOpenOptionsAlloc(), TIFFOpenOptionsFree);
        TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keepFirstMessage, &message_);
        TIFFOpenOptionsSetWarningHandlerExtR(options.get(), keepReadWarning, &message_);
        // Not mapped ("m"): what is read of a file need not stay.
        tiff_.reset(TIFFOpenExt(name_.c_str(), "rm", options.get()));
        if (!tiff_ || !message_.empty()) fail();
        fileBytes_ = std::filesystem::file_size(path);
        readHeader();
        sizeSamples = {static_cast<int>(width_), static_cast<int>(height_)};
        isEightBit = bits_ == 8;
        canBeNan = format_ == SAMPLEFORMAT_IEEEFP;
        if (TIFFIsTiled(tiff_.get()) != 0) {
            prepareTiles();
        } else {
            band_.resize(static_cast<std::size_t>(TIFFScanlineSize(tiff_.get())));
            if (band_.size() < rowBytes()) fail();
        }
        findNoData();
    }

    void read(float* values) override {
        const std::byte* row = band_.data();
        if (tileHeight_ == 0) {
            if (TIFFReadScanline(tiff_.get(), band_.data(), row_, 0) != 1) fail();
        } else {
            if (row_ % tileHeight_ == 0) readTiles();
            row += std::size_t{row_ % tileHeight_} * width_ * (bits_ / 8U);
        }
        for (std::uint32_t x = 0; x < width_; ++x) values[x] = valueAt(row + x * (bits_ / 8U));
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
        TIFFGetFieldDefaulted(tiff_.get(), TIFFTAG_BITSPERSAMPLE, &bits_);
        TIFFGetFieldDefaulted(tiff_.get(), TIFFTAG_SAMPLEFORMAT, &format_);
        std::uint16_t channels = 1;
        TIFFGetFieldDefaulted(tiff_.get(), TIFFTAG_SAMPLESPERPIXEL, &channels);
        const bool isInteger = format_ == SAMPLEFORMAT_UINT || format_ == SAMPLEFORMAT_INT;
        if (channels != 1 || !((isInteger && (bits_ == 8 || bits_ == 16)) ||
                               (format_ == SAMPLEFORMAT_IEEEFP && bits_ == 32))) {
            throw Error(
                fmt::format("{}: {} channels of {} bits (sample format {}); allowed: one "
                            "of 8 or 16 bit integers or 32 bit floats",
                            name_, channels, bits_, format_));
        }
        checkHeightMapSize(width_, height_, name_);
        image::checkDeclaredSize(width_, height_, bits_ / 8U, fileBytes_, name_,
                                 kMaxHeightFileSide);
    }

    std::size_t rowBytes() const { return std::size_t{width_} * (bits_ / 8U); }

    float valueAt(const std::byte* at) const {
        if (bits_ == 32) {
            float value = 0.0F;
            std::memcpy(&value, at, sizeof value);
            return value;
        }
        std::uint16_t value = 0;
        std::memcpy(&value, at, bits_ / 8U);
        if (bits_ == 8) {
            value = static_cast<std::uint16_t>(*at);
            return format_ == SAMPLEFORMAT_INT ? static_cast<float>(static_cast<std::int8_t>(value))
                                               : static_cast<float>(value);
        }
        return format_ == SAMPLEFORMAT_INT ? static_cast<float>(static_cast<std::int16_t>(value))
                                           : static_cast<float>(value);
    }

    void prepareTiles() {
        TIFFGetField(tiff_.get(), TIFFTAG_TILEWIDTH, &tileWidth_);
        TIFFGetField(tiff_.get(), TIFFTAG_TILELENGTH, &tileHeight_);
        image::checkDeclaredSize(tileWidth_, tileHeight_, bits_ / 8U, fileBytes_,
                                 name_ + ": a tile", kMaxHeightFileSide);
        // The last tile may reach beyond the map.
        const std::size_t bytes = std::size_t{width_ + tileWidth_} * tileHeight_ * (bits_ / 8U);
        if (bytes > kMostTileRowBytes) {
            throw Error(fmt::format(
                "{}: a row of tiles of {} x {} samples has {} MiB; allowed: at most {}, as it is "
                "read whole",
                name_, tileWidth_, tileHeight_, (bytes >> 20) + 1, kMostTileRowBytes >> 20));
        }
        band_.resize(rowBytes() * tileHeight_);
        tile_.resize(static_cast<std::size_t>(TIFFTileSize(tiff_.get())));
        if (tile_.size() < std::size_t{tileWidth_} * tileHeight_ * (bits_ / 8U)) fail();
    }

    /// The row of tiles that begins with the next row.
    void readTiles() {
        const std::size_t valueBytes = bits_ / 8U;
        const std::uint32_t rows = std::min(tileHeight_, height_ - row_);
        for (std::uint32_t left = 0; left < width_; left += tileWidth_) {
            if (TIFFReadTile(tiff_.get(), tile_.data(), left, row_, 0, 0) < 0) fail();
            const std::size_t columns = std::min(tileWidth_, width_ - left);
            for (std::size_t y = 0; y < rows; ++y) {
                std::memcpy(&band_[y * rowBytes() + left * valueBytes],
                            &tile_[y * tileWidth_ * valueBytes], columns * valueBytes);
            }
        }
    }

    void findNoData() {
        if (format_ != SAMPLEFORMAT_UINT) noData.push_back(-32768.0F);
        std::uint32_t count = 0;
        const char* text = nullptr;
        if (TIFFGetField(tiff_.get(), kGdalNoData, &count, &text) != 1 || text == nullptr) return;
        const std::string number(text, strnlen(text, count));
        char* end = nullptr;
        const float value = std::strtof(number.c_str(), &end);
        if (end != number.c_str()) noData.push_back(value);
    }

    std::string name_;
    std::string message_;
    std::unique_ptr<TIFF, void (*)(TIFF*)> tiff_{nullptr, TIFFClose};
    std::uintmax_t fileBytes_ = 0;
    std::uint32_t width_ = 0;
    std::uint32_t height_ = 0;
    std::uint16_t bits_ = 1;
    std::uint16_t format_ = SAMPLEFORMAT_UINT;
    std::uint32_t tileWidth_ = 0, tileHeight_ = 0;  // 0: strips
    std::vector<std::byte> band_;                   // a row, or a row of tiles
    std::vector<std::byte> tile_;
    std::uint32_t row_ = 0;
};

}  // namespace

std::unique_ptr<HeightRows> openTiffRows(const std::filesystem::path& path) {
    return std::make_unique<TiffRows>(path);
}

}  // namespace gfxrepro::scene
